//! Options of `deltaq judge`.

use std::path::PathBuf;

use clap::Args;
use program::TextOrJson;

use super::SceneArguments;

/// `deltaq judge`.
#[derive(Args, Debug)]
pub struct JudgeArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Tables of motions, CSV: a column `t`, one of each coordinate by its name, and of each rate, `x'`, or
    /// of none, which are then taken from differences.
    #[arg(required = true)]
    pub motions: Vec<PathBuf>,
    /// Steps of the method that made the motions, one per table: from three motions of one start its order
    /// follows. The distances of the samples if left out.
    #[arg(long, value_name = "H,…", value_delimiter = ',')]
    pub steps: Vec<f64>,
    /// No law fits that leaves a larger part of the forces than this.
    #[arg(long, default_value_t = 0.01)]
    pub tolerance: f64,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}
