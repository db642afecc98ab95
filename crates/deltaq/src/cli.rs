//! The command line.

mod connect;
mod design;
mod ensemble;
mod fit;
mod integrals;
mod judge;
mod linearize;
mod range;
mod review;
mod scenes;

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use comparison::Fits;
pub use connect::ConnectArguments;
pub use design::DesignArguments;
pub use ensemble::{EnsembleArguments, FreeArguments, Limits, MotionArguments};
use equations::Formulation;
pub use fit::FitArguments;
pub use integrals::IntegralsArguments;
use integrate::Method;
pub use judge::JudgeArguments;
pub use linearize::{LinearizeArguments, TableFormat};
use motion::Stepping;
use program::{Common, Output, TextOrJson, by_name};
pub use range::Range;
pub use review::ReviewArguments;
pub use scenes::{CheckArguments, NewArguments, Overrides, SceneArguments, ShowArguments};

/// The methods of time stepping that are built in.
#[cfg(feature = "diffsol")]
pub const METHODS: &[Method] = &diffsol_methods::EVERY;
/// The methods of time stepping that are built in.
#[cfg(not(feature = "diffsol"))]
pub const METHODS: &[Method] = &Method::ALL;

/// What exit codes mean, below the help of the program.
const EXIT_CODES: &str = "Exit codes: 0 for an answer that can be trusted; 1 if it cannot be written or `review` finds equations wrong; 2 for bad input; \
3 for an answer that cannot be trusted, or none; 4 if results contradict each other; 5 if a computation breaks off. \
4 and 5 are faults of deltaq: please report them.";

/// Derives, integrates and compares the equations of motion of nonholonomic systems: d'Alembert–Lagrange
/// (Chetaev), vakonomic, removed-constraint.
///
/// Wheels, skates and rolling bodies follow d'Alembert–Lagrange (`-f chetaev`). Vakonomic equations belong to
/// constrained variational problems, such as optimal control.
#[derive(Parser, Debug)]
#[command(name = "deltaq", version = env!("DELTAQ_VERSION"), propagate_version = true, max_term_width = 100)]
#[command(after_help = EXIT_CODES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
    /// Seconds that each question of algebra may take (a proof, integrals of one degree, brackets,
    /// eigenvalues) before it stays open; 0 for no bound.
    #[arg(long, global = true, value_name = "SECONDS", default_value_t = 10)]
    pub patience: u32,
}

/// The subcommands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// List the built-in scenes: classic nonholonomic and holonomic systems.
    List(ListArguments),
    /// Write a commented scene to begin with.
    New(NewArguments),
    /// Find every fault in scene files, without deriving anything.
    Check(CheckArguments),
    /// Show the equations of motion of a scene, omitted equations, and whether its constraints are holonomic.
    Show(ShowArguments),
    /// Integrate a scene in one formulation.
    Solve(SolveArguments),
    /// Find the motions between two points, with their conjugate times.
    Connect(ConnectArguments),
    /// Integrate many starts or parameters of a scene at once, by Taylor series, in one formulation.
    Ensemble(EnsembleArguments),
    /// Linearize a steady motion: eigenvalues with errors, and where linear stability changes.
    Linearize(LinearizeArguments),
    /// Compare all formulations of one or more scenes.
    Compare(CompareArguments),
    /// Write a self-contained page for browsers, without a server: sliders, bodies in motion, verdicts.
    Explore(ExploreArguments),
    /// Prove that no multipliers make a scene's vakonomic motion Chetaev's: a certificate others can check.
    Prove(ProveArguments),
    /// Decide which invariant measures and first integrals exist: printed, counted, or proved not to exist.
    Integrals(IntegralsArguments),
    /// Identify the constraint law of a program from its motions: slip, epsilon and drag with errors.
    Judge(JudgeArguments),
    /// Check whether given equations of motion are right, and if not, what is wrong with them.
    Review(ReviewArguments),
    /// Fit unknown numbers to recordings (films): intervals, and which formulation the data support.
    Fit(FitArguments),
    /// Plan the recording that separates two formulations best, or determines a number best.
    Design(DesignArguments),
    /// Print the JSON schema of an answer.
    Schema {
        /// The answer, such as `solve`; without it all kinds are listed.
        kind: Option<String>,
    },
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
    /// Time-stepping method: auto, which deltaq chooses by equations and motion (taylor, or else dop853 or
    /// radau5); Taylor series, whose order follows from the tolerance; explicit Runge–Kutta of order 8
    /// (dop853); stiff: implicit Runge–Kutta of order 5 (radau5); leapfrog, a discrete variational principle
    /// in equal steps, which keeps constraints, reversibility and (vakonomic, removed) the symplectic form.
    /// A program built with `--features diffsol` has those of the library diffsol as well: explicit
    /// Runge–Kutta of order 5 (tsit45); stiff: backward differentiation formulas (bdf), implicit Runge–Kutta
    /// of order 2 (tr-bdf2) and 4 (esdirk34).
    #[arg(long, value_parser = by_name(Stepping::all(METHODS), Stepping::name, None), default_value = "auto")]
    pub method: Stepping,
    /// Longest step of `--method leapfrog`, at most the duration, which is cut into two at least. A second
    /// run in half as many steps gives the error estimate.
    #[arg(long, value_name = "H", allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// Order of `--method leapfrog`: 2, 4, 6 or 8; 2 if left out.
    #[arg(long, value_parser = ["2", "4", "6", "8"])]
    pub order: Option<String>,
    /// Add the derivatives of all columns by these numbers, with their error estimates: parameters, start
    /// values (dependent velocities follow from the constraints), `mu0_1`, … and `P0_w`, …
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub sensitivities: Vec<String>,
    /// Add a column for each integral that `deltaq integrals` finds for this formulation, except those with
    /// multipliers, and report their drift among the invariants.
    #[arg(long)]
    pub integrals: bool,
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
    /// Formulations to compare; by default all whose parameters the scene has.
    #[arg(long, short, value_name = "NAME,…", value_delimiter = ',', value_parser = formulations())]
    pub formulation: Vec<&'static Formulation>,
    /// Also fit free constants if it is already decided whether some constants give the motion.
    #[arg(long = "with", value_name = "PART")]
    pub with: Option<Searched>,
    /// Fit no free constants, even if the decision stays open.
    #[arg(long, value_name = "PART", conflicts_with = "with")]
    pub without: Option<Searched>,
    /// Vary a parameter, a start value, `mu0_1`, … or `P0_w`, … and compare two motions at each value, both
    /// ends included: a table. The motions are Chetaev's and the vakonomic one, for costates `P0_w` Chetaev's
    /// and the removed-constraint one, or two given by `--formulation`. Several options combine. With `--out`
    /// the table is a file, and the same call resumes an interrupted one.
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

/// What needs a search.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Searched {
    /// Fits of free constants.
    Fits,
}

fn formulations() -> impl TypedValueParser<Value = &'static Formulation> {
    let names = PossibleValuesParser::new(motion::FORMULATIONS.iter().map(|formulation| formulation.name));
    names.try_map(|name| motion::formulation(&name))
}

/// `deltaq explore`.
#[derive(Args, Debug)]
pub struct ExploreArguments {
    /// The scene that it opens with: a built-in name, the path of a scene file, or `-` for standard input.
    pub scene: Option<String>,
    #[command(flatten)]
    pub set: Overrides,
    /// File for the page; `-` for standard output. What deltaq did not write is not replaced.
    #[arg(long, value_name = "FILE", default_value = "explore.html")]
    pub out: PathBuf,
}

/// `deltaq prove`.
#[derive(Args, Debug)]
pub struct ProveArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// File for the certificate, which `validation/proof/verify.py` checks; `-` for standard output. What
    /// deltaq did not write is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Prove it for a random start, and so for almost every start, instead of the scene's own.
    #[arg(long)]
    pub almost_every: bool,
    /// Output format of the answer; a certificate is JSON.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}

/// Output formats.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// One line per time.
    Csv,
    /// One object.
    Json,
}
