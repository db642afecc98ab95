//! The command line.

mod ensemble;
mod linearize;
mod range;
mod scenes;

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use deltaq::Fits;
pub use ensemble::{EnsembleArguments, FreeArguments, Limits, MotionArguments};
pub use linearize::{LinearizeArguments, TableFormat};
use random::Kind;
pub use range::{MOST_MEMBERS, Range};
pub use scenes::{CheckArguments, NewArguments, Overrides, SceneArguments, ShowArguments};
use validation::bench::MEMBERS;
use validation::stability::Stepping;

/// What may a virtual displacement be? One system with velocity constraints, several formulations of motion.
#[derive(Parser, Debug)]
#[command(name = "deltaq", version = env!("DELTAQ_VERSION"), propagate_version = true, max_term_width = 100)]
pub struct Cli {
    /// What to do; without it the main job runs: every scene in every formulation, reports written.
    #[command(subcommand)]
    pub command: Option<Command>,
    /// No progress bar.
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Number of worker threads; one per processor if left out. Does not affect results.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Options of the main job.
    #[command(flatten)]
    pub job: JobArguments,
}

/// Options of the main job.
#[derive(Args, Debug)]
pub struct JobArguments {
    /// Folder that the reports are written to; `reports` of the project's sources if left out.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Folder that pages of times are written to, which differ from machine to machine; `reports/measured` is
    /// the committed one, `target/measured` that of the sources if left out.
    #[arg(long, value_name = "DIR")]
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
    /// The claims T1 to T14 on 1,000 random systems.
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
    /// List the built-in scenes.
    List(ListArguments),
    /// Write a commented scene to begin with.
    New(NewArguments),
    /// Look for all that is wrong with scene files, without deriving anything.
    Check(CheckArguments),
    /// Show the equations of a scene, what was left out of them, and whether its constraints are integrable.
    Show(ShowArguments),
    /// Integrate a scene in one formulation.
    Solve(SolveArguments),
    /// Integrate many starts or parameters of a scene at once, by Taylor series, in one formulation.
    Ensemble(EnsembleArguments),
    /// Linearize a steady motion: eigenvalues with errors, and where stability to first order changes.
    Linearize(LinearizeArguments),
    /// Compare all formulations of one or more scenes.
    Compare(CompareArguments),
    /// Write a self-contained page for browsers, without a server: sliders, bodies in motion, verdicts.
    Explore(ExploreArguments),
    /// Prove that no multipliers make a scene's vakonomic motion Chetaev's: a certificate others can check.
    Prove(ProveArguments),
    /// Put the claims T1 to T14 to the test on random systems.
    Random(RandomArguments),
    /// Measure error against run time, by every method at every tolerance.
    Bench(BenchArguments),
    /// Measure how cost grows with the length of a train of trailers.
    Scaling(ScalingArguments),
    /// Put every method to stiff and extreme cases: is what comes back right, and if not, does it say so?
    Stability(StabilityArguments),
    /// Run the main job in memory and compare its verdicts with those in the reports folder.
    Reports(ReportsArguments),
    /// Print completions for a shell.
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Print a page of the manual, for `man -l -`.
    Man {
        /// The command that it is about; the whole program if left out.
        command: Option<String>,
    },
}

/// What a command with tables answers with.
#[derive(Args, Debug)]
pub struct Output {
    /// Folder for the page and its pictures, or for scene files.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// Output formats of commands with tables.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextOrJson {
    /// Tables.
    Text,
    /// One object.
    Json,
}

/// `deltaq list`.
#[derive(Args, Debug)]
pub struct ListArguments {
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// `deltaq solve`.
#[derive(Args, Debug)]
pub struct SolveArguments {
    #[command(flatten)]
    pub motion: MotionArguments,
    /// Time-stepping method: auto, the one that suits equations and motion (taylor, or else dop853 or
    /// radau5); Taylor series, of the order that the tolerance asks for; explicit Runge–Kutta of
    /// order 8 (dop853) or 5 (tsit45); stiff: implicit Runge–Kutta of order 5 (radau5), 4 (esdirk34) or 2
    /// (tr-bdf2) and backward differentiation formulas (bdf); leapfrog, a discrete variational principle in
    /// equal steps, which keeps constraints, reversibility and (vakonomic, removed) the symplectic form.
    #[arg(long, value_parser = by_name(Stepping::all(), Stepping::name, None), default_value = "auto")]
    pub method: Stepping,
    /// Longest step of `--method leapfrog`, at most the duration, which is cut into two at least. A second
    /// run in half as many steps gives the error estimate.
    #[arg(long, value_name = "H", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Order of `--method leapfrog`: 2, 4, 6 or 8; 2 if left out.
    #[arg(long, value_parser = ["2", "4", "6", "8"])]
    pub order: Option<String>,
}

/// `deltaq compare`.
#[derive(Args, Debug)]
pub struct CompareArguments {
    /// Built-in names, paths of scene files, or `-` for standard input.
    #[arg(required = true)]
    pub scenes: Vec<String>,
    #[command(flatten)]
    pub output: Output,
    #[command(flatten)]
    pub set: Overrides,
    /// Print the whole page, in Markdown, and not only the answer.
    #[arg(long, conflicts_with_all = ["out", "format"])]
    pub markdown: bool,
    /// Formulations to compare, all if left out.
    #[arg(long, short, value_name = "NAME,…", value_delimiter = ',', value_parser = formulations())]
    pub formulation: Vec<String>,
    /// Also fit free constants where it is decided whether some constants give the motion.
    #[arg(long = "with", value_name = "PART")]
    pub with: Option<Searched>,
    /// Fit no free constants, not even where nothing is decided.
    #[arg(long, value_name = "PART", conflicts_with = "with")]
    pub without: Option<Searched>,
    /// Vary a parameter, a start value, `mu0_1`, … or `P0_w`, … and compare two motions at each value, both
    /// ends included: a table. The motions are Chetaev's and the vakonomic one, or of costates `P0_w` the one
    /// without constraints, or two given by `--formulation`. Several combine; with `--out` a file, which goes
    /// on where it was cut off.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", value_parser = range::range,
          conflicts_with_all = ["markdown", "format", "with"])]
    pub sweep: Vec<Range>,
    /// Tolerance of the looser of the two runs of every motion.
    #[arg(long, default_value = "1e-11", allow_negative_numbers = true)]
    pub tolerance: f64,
    #[command(flatten)]
    pub limits: Limits,
}

impl CompareArguments {
    /// Which free constants are fitted.
    pub(crate) fn fits(&self) -> Fits {
        match (self.with, self.without) {
            (Some(Searched::Fits), _) => Fits::All,
            (None, Some(Searched::Fits)) => Fits::None,
            (None, None) => Fits::Undecided,
        }
    }
}

/// What takes a search.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Searched {
    /// Fits of free constants.
    Fits,
}

fn formulations() -> PossibleValuesParser {
    PossibleValuesParser::new(deltaq::FORMULATIONS.iter().map(|formulation| formulation.name))
}

/// `deltaq explore`.
#[derive(Args, Debug)]
pub struct ExploreArguments {
    /// The scene that it opens with: a built-in name, the path of a scene file, or `-` for standard input.
    pub scene: Option<String>,
    #[command(flatten)]
    pub set: Overrides,
    /// File for the page.
    #[arg(long, value_name = "FILE", default_value = "explore.html")]
    pub out: PathBuf,
}

/// `deltaq prove`.
#[derive(Args, Debug)]
pub struct ProveArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// File for the certificate, which `validation/proof/verify.py` checks; `-` for the terminal.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Prove it for a start drawn at random, and so for almost every start, in the place of the scene's own.
    #[arg(long)]
    pub almost_every: bool,
    /// Output format of the answer; a certificate is JSON.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// The first system of a part of a batch is at most this one.
const MOST_INDEX: u64 = 1 << 40;

/// `deltaq random`.
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

/// `deltaq stability`.
#[derive(Args, Debug)]
pub struct StabilityArguments {
    /// Cases to run, all if left out.
    #[arg(long = "case", value_name = "NAME,…", value_delimiter = ',')]
    pub cases: Vec<String>,
    #[command(flatten)]
    pub output: Output,
}

/// `deltaq bench`.
#[derive(Args, Debug)]
pub struct BenchArguments {
    /// Built-in names or paths of scene files; every built-in scene if left out.
    pub scenes: Vec<String>,
    /// Seconds over which the runs of one setting are repeated; the least time counts.
    #[arg(long, default_value_t = 0.05)]
    pub seconds: f64,
    #[command(flatten)]
    pub set: Overrides,
    /// Measure throughput of ensembles of sledges instead, at this tolerance: alone, in lanes, on all cores.
    #[arg(long, value_name = "TOLERANCE", num_args = 0..=1, default_missing_value = "1e-10", conflicts_with_all = ["scenes", "overrides", "out"])]
    pub ensemble: Option<f64>,
    /// Members of each of these ensembles.
    #[arg(long, default_value_t = MEMBERS as u16, requires = "ensemble", value_parser = clap::value_parser!(u16).range(1..))]
    pub members: u16,
    #[command(flatten)]
    pub output: Output,
}

/// `deltaq scaling`.
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

/// `deltaq reports`.
#[derive(Args, Debug)]
pub struct ReportsArguments {
    /// Compare only; nothing is written. Says, too, which pages of times are older than their code.
    #[arg(long, required_unless_present = "stamp", conflicts_with = "stamp")]
    pub check: bool,
    /// Pages that the main job does not write, and that were measured now: their last line says when, and
    /// with which code.
    #[arg(long, value_name = "PAGE,…", value_delimiter = ',')]
    pub stamp: Vec<String>,
    /// Folder of the reports.
    #[arg(long, default_value = "reports")]
    pub out: PathBuf,
}

/// Output formats.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One line per time.
    Csv,
    /// One object.
    Json,
}

/// One of `all`, by its name; with a word on it in the help where there is one.
fn by_name<T: Copy + Send + Sync + 'static>(
    all: impl IntoIterator<Item = T>,
    name: fn(T) -> &'static str,
    help: Option<fn(T) -> &'static str>,
) -> impl TypedValueParser<Value = T> {
    let all: Vec<T> = all.into_iter().collect();
    let possible: Vec<PossibleValue> = all
        .iter()
        .map(|&one| {
            let value = PossibleValue::new(name(one));
            help.map_or(value.clone(), |help| value.help(help(one)))
        })
        .collect();
    PossibleValuesParser::new(possible)
        .try_map(move |given| all.iter().copied().find(|&one| name(one) == given).ok_or("unknown"))
}
