//! `evidence scaling`: what it costs, over size.

use anyhow::Result;
use serde_json::json;

use crate::cli::ScalingArguments;
use program::parallel;
use validation::report::{scaling_files, scaling_text};
use validation::scaling::{FORMULATIONS, Limits, TRAILERS, measure};

/// Measures how cost grows with the length of a train of trailers.
pub(crate) fn run(arguments: &ScalingArguments, quiet: bool) -> Result<String> {
    let limits = Limits { trailers: arguments.longest, seconds: arguments.seconds, repeats: arguments.repeats.into() };
    let bar = parallel::progress(FORMULATIONS.len() * TRAILERS.len(), quiet);
    let lines = measure(&limits, &mut |name, trailers| {
        bar.set_message(format!("{name}, n = {trailers}"));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    arguments.output.answer("scaling", || scaling_files(&lines), || scaling_text(&lines), || json!({ "lines": lines }))
}
