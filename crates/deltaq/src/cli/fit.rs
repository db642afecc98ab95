//! Options of `deltaq fit`.

use std::path::PathBuf;

use clap::Args;
use fit::Unknown;
use program::TextOrJson;

use super::SceneArguments;

/// `deltaq fit`.
#[derive(Args, Debug)]
pub struct FitArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Recordings (films), CSV: a column `t`; the name of each other column is an expression in coordinates,
    /// velocities and parameters, `x` or `a*theta`, or with a unit, `x [mm]`. Empty cells are gaps.
    #[arg(required = true)]
    pub films: Vec<PathBuf>,
    /// Unknowns: parameters and start values. `NAME~VALUE` gives the first guess, `NAME~MEAN±DEVIATION` a
    /// prior, `NAME>=BOUND` a bound. Each film has start values of its own and
    /// shares parameters; `NAME@2` is the second film's own; `start` is all coordinates and given velocities;
    /// `clock` is the relative error of the recordings' clock. Multipliers and costates at the start are
    /// unknown anyway.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', required = true, allow_hyphen_values = true)]
    pub free: Vec<Unknown>,
    /// Numbers of the first-order law, which adds a row: `eps` (ε ≥ 0), `slip` (1/N, above 0); as in
    /// `--free`.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub law: Vec<Unknown>,
    /// Standard deviations of columns: `0.5mm` of all, `x=0.5mm` of one; `free`: estimated from what the best
    /// formulation leaves.
    #[arg(long, value_name = "σ,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub sigma: Vec<String>,
    /// Numbers with another known value in one film: `psi'@2=6`.
    #[arg(long, value_name = "NAME@FILM=VALUE,…", value_delimiter = ',')]
    pub known: Vec<String>,
    /// Formulations by name, or `all`.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', default_value = "chetaev,vakonomic")]
    pub formulations: Vec<String>,
    /// Starts of the search, which differ in multipliers and costates.
    #[arg(long, default_value_t = 16)]
    pub starts: usize,
    /// Outliers count little: residuals above 1.345 σ count linearly.
    #[arg(long)]
    pub robust: bool,
    /// Tolerance of motions.
    #[arg(long, default_value_t = 1e-9)]
    pub tolerance: f64,
    /// Maximum number of steps of a motion; the search avoids numbers with which motions need more.
    #[arg(long, default_value_t = 2_000)]
    pub max_steps: usize,
    /// Folder for pictures, SVG: the films with the fitted motions, residuals, profiles of the law's numbers.
    #[arg(long, value_name = "FOLDER", value_parser = program::folder())]
    pub pictures: Option<PathBuf>,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}
