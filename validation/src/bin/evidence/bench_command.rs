//! `evidence bench`: error against run time.

use anyhow::{Result, bail};
use diffsol_methods::EVERY;

use crate::cli::BenchArguments;
use bench::{
    Effort, KeptReferences, bench_all, bench_files, bench_json, bench_table, ensemble_json, ensemble_text,
    ensemble_throughput, references,
};

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
        let (text, json) = (|| ensemble_text(&measured), || ensemble_json(&measured));
        return arguments.output.answer("bench-ensemble", || Ok(Vec::new()), text, json);
    }
    let effort = Effort { methods: EVERY.to_vec(), seconds: arguments.seconds, ..Effort::default() };
    let all = || scene::catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let given: Vec<&str> = arguments.scenes.iter().map(String::as_str).collect();
    let names: Vec<&str> = if given.is_empty() { all() } else { given };
    let benches = bench_all(references(&names, &KeptReferences::default(), quiet)?, &effort, quiet)?;
    arguments.output.answer("bench", || bench_files(&benches, &[]), || bench_table(&benches), || bench_json(&benches))
}
