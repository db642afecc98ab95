//! Options of `deltaq linearize`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use equations::Formulation;

use super::SceneArguments;
use super::ensemble::FreeArguments;
use super::range::{Range, range};

/// `deltaq linearize`.
#[derive(Args, Debug)]
pub struct LinearizeArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// chetaev, vakonomic, removed-constraint or kappa; in quasi-velocities if the constraints allow it.
    #[arg(long, short, default_value = motion::CHETAEV.name, value_parser = motion::formulation)]
    pub formulation: &'static Formulation,
    #[command(flatten)]
    pub free_constants: FreeArguments,
    /// Linearize about the motion at this time, steady or not: the eigenvalues are those of an instant.
    #[arg(long, value_name = "T", allow_negative_numbers = true, conflicts_with_all = ["sweep", "find"])]
    pub at: Option<f64>,
    /// Coordinates of the eigenvalues, with their velocities and all states coupled with them in both
    /// directions; all coordinates if left out.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub free: Vec<String>,
    /// Equidistant values of a parameter, a start value or mu0_1, …, both ends included.
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", value_parser = range)]
    pub sweep: Option<Range>,
    /// Search for a steady motion near the start (Chetaev's), along displacements that the constraints admit,
    /// and print it; critical values are those of the motions found.
    #[arg(long)]
    pub find: bool,
    /// Folder for a page and a picture of the eigenvalues over what varies.
    #[arg(long, value_name = "DIR", requires = "sweep", value_parser = program::folder())]
    pub out: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TableFormat::Table)]
    pub format: TableFormat,
}

/// Output formats of eigenvalues.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableFormat {
    /// A table, one line per value, with the digits that are certain.
    Table,
    /// One line per eigenvalue other than zero, all digits.
    Csv,
    /// One object.
    Json,
}
