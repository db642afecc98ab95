//! `deltaq bench`.

use anyhow::{Result, bail};

use crate::cli::{BenchArguments, TextOrJson};
use crate::main_job::bench_all;
use validation::bench::{Effort, MEMBERS, ensemble_table, ensemble_throughput};
use validation::catalogue;
use validation::report::{bench_files, bench_json, bench_table, write_all};

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
    let all = || catalogue::SCENES.iter().map(|(name, _)| *name).collect();
    let given: Vec<&str> = arguments.scenes.iter().map(String::as_str).collect();
    let names: Vec<&str> = if given.is_empty() { all() } else { given };
    let benches = bench_all(&names, &arguments.overrides, &effort, arguments.quiet)?;
    if let Some(folder) = &arguments.out {
        write_all(folder, &bench_files(&benches, &[])?)?;
    }
    Ok(match arguments.format {
        TextOrJson::Text => bench_table(&benches),
        TextOrJson::Json => serde_json::to_string_pretty(&bench_json(&benches))? + "\n",
    })
}
