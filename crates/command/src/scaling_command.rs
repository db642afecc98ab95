//! `deltaq scaling`.

use anyhow::Result;
use serde_json::json;

use crate::cli::{ScalingArguments, TextOrJson};
use random::parallel;
use validation::report::{scaling_files, scaling_text, write_all};
use validation::scaling::{FORMULATIONS, Limits, TRAILERS, measure};

/// Runs the command: the tables or one object, and with a folder the page with its pictures.
///
/// # Errors
/// Where a train has no equations, or the folder cannot be written.
pub fn run(arguments: &ScalingArguments) -> Result<String> {
    let limits = Limits { trailers: arguments.longest, seconds: arguments.seconds, repeats: arguments.repeats.into() };
    let bar = parallel::progress(FORMULATIONS.len() * TRAILERS.len(), arguments.quiet);
    let lines = measure(&limits, &mut |name, trailers| {
        bar.set_message(format!("{name}, n = {trailers}"));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    if let Some(folder) = &arguments.out {
        write_all(folder, &scaling_files(&lines)?)?;
    }
    Ok(match arguments.format {
        TextOrJson::Text => scaling_text(&lines),
        TextOrJson::Json => serde_json::to_string_pretty(&json!({ "lines": lines }))? + "\n",
    })
}
