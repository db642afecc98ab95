//! Options of `deltaq review`.

use std::path::PathBuf;

use clap::Args;
use equations::Formulation;
use program::TextOrJson;

use super::SceneArguments;

/// `deltaq review`.
#[derive(Args, Debug)]
pub struct ReviewArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Their equations: text, one equation per line (`m*x'' = lambda*sin(phi)`; any multipliers, definitions
    /// `name = …`); LaTeX (`.tex`); a C function of time, state and rates (`.c`); a table (`.csv`) with
    /// columns `x`, `x'` and `x''` of each coordinate; `-` for standard input.
    pub theirs: PathBuf,
    /// A coordinate or parameter of the scene as a formula in their names: `--where "theta = q2 - pi/2"`.
    #[arg(long = "where", value_name = "NAME=FORMULA")]
    pub wheres: Vec<String>,
    /// The formulation whose equations they are to be.
    #[arg(short, long, value_name = "NAME", default_value = "chetaev", value_parser = motion::formulation)]
    pub formulation: &'static Formulation,
    /// Relative errors of the numbers of a table.
    #[arg(long, default_value_t = 1e-8)]
    pub tolerance: f64,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}
