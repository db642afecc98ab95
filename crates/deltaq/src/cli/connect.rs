//! Options of `deltaq connect`.

use clap::Args;
use equations::Formulation;
use program::TextOrJson;
use scene::Number;

use super::SceneArguments;
use super::ensemble::{FreeArguments, Limits};
use super::scenes::assignment;

/// `deltaq connect`.
#[derive(Args, Debug)]
pub struct ConnectArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Coordinates at the end, as many as there are unknowns: free start velocities and free constants.
    #[arg(long, required = true, value_name = "NAME=VALUE,…", value_delimiter = ',', value_parser = assignment)]
    pub to: Vec<(String, Number)>,
    /// Time of the end; that of the scene's run if left out.
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    pub at: Option<f64>,
    /// vakonomic, chetaev, removed-constraint, kappa; or one of their forms.
    #[arg(long, short, default_value = motion::VAKONOMIC.name, value_parser = motion::formulation)]
    pub formulation: &'static Formulation,
    /// What is given here is where the search begins.
    #[command(flatten)]
    pub free: FreeArguments,
    /// From how many starts motions are searched.
    #[arg(long, value_name = "N", default_value_t = motion::CONNECT_STARTS as u32, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub starts: u32,
    /// Tolerance of the motions that are found.
    #[arg(long, default_value = "1e-11", allow_negative_numbers = true)]
    pub tolerance: f64,
    #[command(flatten)]
    pub limits: Limits,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}
