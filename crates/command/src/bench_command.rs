//! `deltaq bench` and `deltaq scaling`: what it costs, over accuracy and over size.

use anyhow::{Result, bail};
use serde_json::json;

use crate::cli::{BenchArguments, ScalingArguments};
use crate::main_job::{bench_all, references};
use random::parallel;
use validation::bench::{Effort, ensemble_throughput};
use validation::report::{bench_files, bench_json, bench_table, ensemble_text, scaling_files, scaling_text};
use validation::scaling::{FORMULATIONS, Limits, TRAILERS, measure};

/// Repeats of each way to integrate an ensemble; the least time counts.
const REPEATS: usize = 5;

/// Measures error against run time.
pub(crate) fn run(arguments: &BenchArguments, quiet: bool) -> Result<String> {
    if !(arguments.seconds > 0.0 && arguments.seconds.is_finite()) {
        bail!("--seconds is {}; it must be above 0", arguments.seconds);
    }
    if let Some(tolerance) = arguments.ensemble {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            bail!("--ensemble is {tolerance}; it must be between 0 and 1");
        }
        let measured = ensemble_throughput(arguments.members.into(), tolerance, REPEATS)?;
        let json = || json!({ "formulations": measured });
        return arguments.output.answer("bench-ensemble", || Ok(Vec::new()), || ensemble_text(&measured), json);
    }
    let effort = Effort { seconds: arguments.seconds, ..Effort::default() };
    let all = || catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let given: Vec<&str> = arguments.scenes.iter().map(String::as_str).collect();
    let names: Vec<&str> = if given.is_empty() { all() } else { given };
    let benches = bench_all(references(&names, &arguments.set.overrides, quiet)?, &effort, quiet)?;
    arguments.output.answer("bench", || bench_files(&benches, &[]), || bench_table(&benches), || bench_json(&benches))
}

/// Measures how cost grows with the length of a train of trailers.
pub(crate) fn scaling(arguments: &ScalingArguments, quiet: bool) -> Result<String> {
    let limits = Limits { trailers: arguments.longest, seconds: arguments.seconds, repeats: arguments.repeats.into() };
    let bar = parallel::progress(FORMULATIONS.len() * TRAILERS.len(), quiet);
    let lines = measure(&limits, &mut |name, trailers| {
        bar.set_message(format!("{name}, n = {trailers}"));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    arguments.output.answer("scaling", || scaling_files(&lines), || scaling_text(&lines), || json!({ "lines": lines }))
}
