//! Options of `deltaq integrals`.

use std::path::PathBuf;

use clap::Args;
use equations::Formulation;
use program::TextOrJson;

use super::SceneArguments;
use super::range::{Range, range};

/// `deltaq integrals`.
#[derive(Args, Debug)]
pub struct IntegralsArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// chetaev, or a formulation whose equations are looked at in the ansatz alone: vakonomic, kappa.
    #[arg(long, short, default_value = motion::CHETAEV.name, value_parser = motion::formulation)]
    pub formulation: &'static Formulation,
    /// Highest degree in the velocities; 0 for measures alone.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u8).range(0..=3))]
    pub degree: u8,
    /// Coordinates that the functions of the ansatz contain; those in L and in the constraints if left out.
    #[arg(long = "in", value_name = "NAME,…", value_delimiter = ',')]
    pub names: Vec<String>,
    /// Vary a number: a row per value, as CSV, of measure and numbers of integrals; again for more numbers.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", value_parser = range,
          conflicts_with_all = ["certificates", "format", "names", "formulation"])]
    pub sweep: Vec<Range>,
    /// Folder for certificates of what is proved or written down, a file for each, which others can check.
    #[arg(long, value_name = "FOLDER", value_parser = program::folder())]
    pub certificates: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
    /// File for the answer; to standard output if left out or `-`. What deltaq did not write is not replaced.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}
