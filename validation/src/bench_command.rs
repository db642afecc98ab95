//! `deltaq bench`.

use anyhow::{Result, bail};

use crate::bench::{Effort, MEMBERS, bench, ensemble_table, ensemble_throughput};
use crate::catalogue;
use crate::cli::{BenchArguments, TextOrJson};
use crate::parallel;
use crate::report::{bench_files, bench_json, bench_table, write_all};

/// Repeats of each way to integrate an ensemble; the least time counts.
const REPEATS: usize = 5;

/// Measures error against run time.
///
/// # Errors
/// Where a scene cannot be read or the page cannot be written.
pub fn run(arguments: &BenchArguments) -> Result<String> {
    if !(arguments.seconds > 0.0 && arguments.seconds.is_finite()) {
        bail!("--seconds is {}; it must be above 0", arguments.seconds);
    }
    if let Some(tolerance) = arguments.ensemble {
        if !(tolerance > 0.0 && tolerance < 1.0) {
            bail!("--ensemble is {tolerance}; it must be between 0 and 1");
        }
        return Ok(ensemble_table(&ensemble_throughput(MEMBERS, tolerance, REPEATS)?));
    }
    let effort = Effort { seconds: arguments.seconds, ..Effort::default() };
    let all: Vec<String> = catalogue::SCENES.iter().map(|(name, _)| name.to_string()).collect();
    let names = if arguments.scenes.is_empty() { &all } else { &arguments.scenes };
    let bar = parallel::progress(names.len(), arguments.quiet);
    let mut benches = Vec::new();
    for name in names {
        benches.push(bench(name, &arguments.overrides, &effort, |words| bar.set_message(words.to_string()))?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    if let Some(folder) = &arguments.out {
        write_all(folder, &bench_files(&benches)?)?;
    }
    Ok(match arguments.format {
        TextOrJson::Text => bench_table(&benches),
        TextOrJson::Json => serde_json::to_string_pretty(&bench_json(&benches))? + "\n",
    })
}
