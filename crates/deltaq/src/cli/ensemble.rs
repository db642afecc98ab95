//! Options of `deltaq ensemble`, and those that it has in common with `deltaq solve`.

use std::path::PathBuf;

use clap::Args;
use equations::Formulation;

use super::range::{Range, range};
use super::{Format, SceneArguments};

/// One motion of a scene, and how it is printed.
#[derive(Args, Debug)]
pub struct MotionArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// chetaev, vakonomic, removed-constraint, kappa; or one of their forms, `show` lists them.
    #[arg(long, short, value_parser = motion::formulation)]
    pub formulation: &'static Formulation,
    /// Form of the equations of chetaev and vakonomic: the one that suits the system, or with multipliers,
    /// costates (vakonomic), or quasi-velocities (constraints linear in the velocities).
    #[arg(long, default_value = "auto", value_parser = clap::builder::PossibleValuesParser::new(motion::FORM_WORDS))]
    pub form: String,
    #[command(flatten)]
    pub free: FreeArguments,
    /// Tolerance. A second run has a hundredth of it; the difference is the error estimate.
    #[arg(long, default_value = "1e-10", allow_negative_numbers = true)]
    pub tolerance: f64,
    /// Times to print: `a,b,c` or `from:to:count`. If left out, 101 equidistant ones; of an ensemble the end.
    #[arg(long, value_name = "TIMES", allow_hyphen_values = true)]
    pub times: Option<String>,
    /// No projection onto the constraint.
    #[arg(long)]
    pub no_projection: bool,
    #[command(flatten)]
    pub limits: Limits,
    /// Output format.
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    pub format: Format,
}

/// What the start leaves free.
#[derive(Args, Default, Debug)]
pub struct FreeArguments {
    /// Vakonomic multipliers at the start, one per constraint.
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub mu0: Option<Vec<f64>>,
    /// Name of the removal: one of the scene, `coordinates` or `quasi-velocities`. The first one if left out.
    #[arg(long, value_name = "NAME")]
    pub removal: Option<String>,
    /// Free constants of the removed-constraint equations: `zero`, `horizon=T` or `start=A,B,…` (P(t₀), in
    /// the order of the memory variables). Those of the removal if left out.
    #[arg(long, value_name = "RULE", allow_hyphen_values = true)]
    pub constants: Option<String>,
}

/// Limits on steps and time. A run that reaches one stops, with what it has so far.
#[derive(Args, Debug)]
pub struct Limits {
    /// Maximum number of steps per run; a motion is integrated in two runs. If left out, a limit that only
    /// stalled runs reach.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_steps: Option<u32>,
    /// Maximum step, in the scene's unit of time; the tighter run, which is reported, uses half of it. If
    /// left out, the tolerance alone decides.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub max_step: Option<f64>,
    /// Maximum seconds of the clock per run; of an ensemble, per run of 4096 members, or of fewer with very
    /// many times.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub time_limit: Option<f64>,
}

/// `deltaq ensemble`.
#[derive(Args, Debug)]
pub struct EnsembleArguments {
    #[command(flatten)]
    pub motion: MotionArguments,
    /// File with one member per line: commas between numbers, the first line names what they replace (a
    /// parameter, a coordinate or a velocity at the start, mu0_1, …, P0_w of a memory variable w).
    #[arg(long, value_name = "FILE")]
    pub members: Option<PathBuf>,
    /// Equally spaced values, both ends included; repeat the option for all combinations, also with the file.
    /// FROM..TO:COUNT means the same.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", value_parser = range)]
    pub vary: Vec<Range>,
    /// File to write; to standard output if left out or `-`. What deltaq did not write is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
