//! The command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use bench::MEMBERS;
use program::{Common, Output, TextOrJson, by_name};
use random::Kind;
use validation::benchmark::STARTS;

/// The evidence for deltaq: every scene in every formulation, random systems, stiff cases; the reports.
#[derive(Parser, Debug)]
#[command(name = "evidence", version, propagate_version = true, max_term_width = 100)]
pub struct Cli {
    /// What to do; without it the main job runs: every scene in every formulation, reports written.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
    /// Options of the main job.
    #[command(flatten)]
    pub job: JobArguments,
}

/// Options of the main job.
#[derive(Args, Debug)]
pub struct JobArguments {
    /// Folder that the reports are written to; `reports` of the project's sources if left out.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub out: Option<PathBuf>,
    /// Folder that pages of times are written to, which differ from machine to machine; `reports/measured` is
    /// the committed one, `target/measured` that of the sources if left out.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub measured: Option<PathBuf>,
    /// Sections to run, all if left out. The overview is written only when all of them run.
    #[arg(long, value_enum, value_name = "NAME,…", value_delimiter = ',')]
    pub sections: Vec<Section>,
    /// Sections to leave out.
    #[arg(long, value_enum, value_name = "NAME,…", value_delimiter = ',')]
    pub without: Vec<Section>,
    /// Scenes to run, all if left out; other sections run only if they are named.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub scenes: Vec<String>,
    /// Output format of what is said at the end.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// Sections of the main job.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Every built-in scene in every formulation.
    Scenes,
    /// Scenes and 50 random systems derived again by CasADi and SymPy; needs Python 3.11, a package index.
    Casadi,
    /// The claims T1 to T18 on 1,000 random systems.
    Random,
    /// Friction, added mass, and what they tend to.
    Realization,
    /// The paper's equations, each shown to hold or not.
    PaperAudit,
    /// Which motions of classic systems are vakonomic, and what was published about that.
    Equivalence,
    /// The benchmark bicycle to first order, against its published equations.
    Bicycle,
    /// Error against run time.
    ErrorVsTime,
    /// Every method on stiff and extreme cases, against references.
    Stability,
}

/// The subcommands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Put the claims T1 to T18 to the test on random systems.
    Random(RandomArguments),
    /// Measure how cost grows with the length of a train of trailers.
    Scaling(ScalingArguments),
    /// Put every method to stiff and extreme cases: is what comes back right, and if not, does it say so?
    Stability(StabilityArguments),
    /// Measure error against run time, by every method at every tolerance.
    Bench(BenchArguments),
    /// Write the reference motions that other programs are held against.
    Benchmark(BenchmarkArguments),
    /// Write the page on the shortest films that decide.
    Films(FilmsArguments),
    /// Write the page on invariant measures and first integrals.
    Integrals(IntegralsArguments),
    /// Solve test problems of others, whose ends are printed, and write the page.
    Ivp(IvpArguments),
    /// Run the main job in memory and compare its verdicts with those in the reports folder.
    Reports(ReportsArguments),
}

/// The first system of a part of a batch is at most this one.
const MOST_INDEX: u64 = 1 << 40;

/// `evidence random`.
#[derive(Args, Debug)]
pub struct RandomArguments {
    /// Number of systems.
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=10_000_000))]
    pub count: u64,
    /// Index of the first system: so a batch can be divided among machines.
    #[arg(long, value_name = "INDEX", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..=MOST_INDEX),
          conflicts_with = "index")]
    pub from: u64,
    /// Seed. A system is a function of seed and index (and of the kind, where one is chosen).
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Systems of one kind only; all kinds in turn if left out.
    #[arg(long, value_parser = by_name(Kind::ALL, Kind::name, Some(Kind::about)))]
    pub kind: Option<Kind>,
    /// One system only: what is claimed of it, claim by claim, and what was found.
    #[arg(long, conflicts_with = "count")]
    pub index: Option<u64>,
    /// File that every finished system is added to, and that a run which was cut off goes on from.
    #[arg(long, value_name = "FILE", conflicts_with = "index")]
    pub log: Option<PathBuf>,
    /// No systems but those that these logs hold already, of one batch: what parts of it found together.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["count", "from", "seed", "kind", "index", "log"])]
    pub merge: Vec<PathBuf>,
    #[command(flatten)]
    pub output: Output,
}

/// `evidence stability`.
#[derive(Args, Debug)]
pub struct StabilityArguments {
    /// Cases to run, all if left out.
    #[arg(long = "case", value_name = "NAME,…", value_delimiter = ',')]
    pub cases: Vec<String>,
    #[command(flatten)]
    pub output: Output,
}

/// `evidence scaling`.
#[derive(Args, Debug)]
pub struct ScalingArguments {
    /// Longest train.
    #[arg(long, default_value_t = 320)]
    pub longest: usize,
    /// Seconds for one derivation or one solve: after a derivation that takes longer, longer trains are left
    /// out, and solves that would.
    #[arg(long, default_value_t = 2.0)]
    pub seconds: f64,
    /// Repeats of everything that is timed; the shortest time counts.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub repeats: u16,
    #[command(flatten)]
    pub output: Output,
}

/// `evidence bench`.
#[derive(Args, Debug)]
pub struct BenchArguments {
    /// Built-in names or paths of scene files; every built-in scene if left out.
    pub scenes: Vec<String>,
    /// Seconds over which the runs of one setting are repeated; the least time counts.
    #[arg(long, default_value_t = 0.05)]
    pub seconds: f64,
    /// Measure throughput of ensembles of sledges instead, at this tolerance: alone, in lanes, on all cores.
    #[arg(long, value_name = "TOLERANCE", num_args = 0..=1, default_missing_value = "1e-10", conflicts_with_all = ["scenes", "out"])]
    pub ensemble: Option<f64>,
    /// Members of each of these ensembles.
    #[arg(long, default_value_t = MEMBERS as u16, requires = "ensemble", value_parser = clap::value_parser!(u16).range(1..))]
    pub members: u16,
    #[command(flatten)]
    pub output: Output,
}

/// `evidence benchmark`.
#[derive(Args, Debug)]
pub struct BenchmarkArguments {
    /// Systems, all if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', requires = "out")]
    pub systems: Vec<String>,
    /// Starts of each.
    #[arg(long, default_value_t = STARTS as u16, requires = "out", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub starts: u16,
    /// Folder for the tables; `validation/benchmark` of the project's sources if left out.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub out: Option<PathBuf>,
}

/// `evidence films`.
#[derive(Args, Debug)]
pub struct FilmsArguments {
    /// Scenes, the whole catalogue if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub scenes: Vec<String>,
    /// Folder for the page.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub out: PathBuf,
}

/// `evidence ivp`.
#[derive(Args, Debug)]
pub struct IvpArguments {
    /// Problems, all if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', value_parser = ["andrews", "car-axis", "fekete", "pleiades"])]
    pub problems: Vec<String>,
    /// Folder for the page; `reports/measured` is the committed one.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub out: PathBuf,
}

/// `evidence integrals`.
#[derive(Args, Debug)]
pub struct IntegralsArguments {
    /// Scenes, those of the catalogue's reports if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub scenes: Vec<String>,
    /// Parts of the page, all if left out: scenes, literature, maps. The last two take minutes.
    #[arg(long, value_name = "PART,…", value_delimiter = ',', value_parser = ["scenes", "literature", "maps"])]
    pub parts: Vec<String>,
    /// Folder for the page and its pictures.
    #[arg(long, value_name = "DIR", value_parser = program::folder())]
    pub out: PathBuf,
}

/// `evidence reports`.
#[derive(Args, Debug)]
pub struct ReportsArguments {
    /// Compare only; nothing is written. Also says which pages of times are older than their code.
    #[arg(long, required_unless_present_any = ["stamp", "ages"], conflicts_with_all = ["stamp", "ages"])]
    pub check: bool,
    /// Only list the measured pages that are older than their code, or do not say how old they are.
    #[arg(long, conflicts_with = "stamp")]
    pub ages: bool,
    /// Pages that the main job does not write, and that were measured now: their last line says when, and
    /// with which code.
    #[arg(long, value_name = "PAGE,…", value_delimiter = ',')]
    pub stamp: Vec<String>,
    /// Folder of the reports.
    #[arg(long, default_value = "reports")]
    pub out: PathBuf,
}
