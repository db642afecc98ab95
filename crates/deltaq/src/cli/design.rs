//! Options of `deltaq design`.

use clap::Args;
use equations::Formulation;
use fit::{Range, Sampling, Unknown};
use program::TextOrJson;

use super::SceneArguments;

/// `deltaq design`.
#[derive(Args, Debug)]
pub struct DesignArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Two formulations: films of the first that show that it is not the second.
    #[arg(long, value_name = "TRUE,OTHER", value_delimiter = ',', value_parser = motion::formulation,
          required_unless_present = "estimate", conflicts_with = "estimate")]
    pub tell: Vec<&'static Formulation>,
    /// The number whose standard error is to be small: `eps`, `g`, `x@2`. That of ε and slip by the law of
    /// first order, that of others by Chetaev's.
    #[arg(long, value_name = "NAME")]
    pub estimate: Option<String>,
    /// What can be chosen, starts and parameters: `psi'=-5:20`, `psi'@2=-5:20` in the second film alone.
    #[arg(long, value_name = "NAME=LOW:HIGH,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub over: Vec<Range>,
    /// Samples per second, standard deviation of columns that have no other, and length.
    #[arg(long, value_name = "60Hz,0.5mm,10s")]
    pub film: Sampling,
    /// How many films of this kind.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=16))]
    pub films: u8,
    /// What is filmed, as expressions: that of `[film]` if left out, or the coordinates.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub columns: Vec<String>,
    /// Standard deviations of columns by name: `phi=1mrad`.
    #[arg(long, value_name = "NAME=σ,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub sigma: Vec<String>,
    /// What will not be known, as for `deltaq fit`: `start,g`. Multipliers and costates at the start are
    /// unknown anyway.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub free: Vec<Unknown>,
    /// Numbers of the law of first order that will not be known: `eps`, `slip`.
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub law: Vec<Unknown>,
    /// Starts of each search for the numbers of the other formulation; the best film is looked at again from
    /// four times as many.
    #[arg(long, default_value_t = 8)]
    pub starts: usize,
    /// Films of the scan, beside the corners.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub points: u32,
    /// Tolerance of motions.
    #[arg(long, default_value_t = 1e-9)]
    pub tolerance: f64,
    /// Most steps of a motion.
    #[arg(long, default_value_t = 2_000)]
    pub max_steps: usize,
    /// Output format.
    #[arg(long, value_enum, default_value_t = TextOrJson::Text)]
    pub format: TextOrJson,
}
