//! `evidence benchmark`: reference motions for other programs.

use std::path::Path;

use anyhow::{Result, bail};

use crate::cli::BenchmarkArguments;
use program::{parallel, write_all, write_own};
use validation::benchmark::{SYSTEMS, files};

/// Writes the tables.
pub(crate) fn run(arguments: &BenchmarkArguments, quiet: bool) -> Result<String> {
    let known: Vec<String> = SYSTEMS.map(String::from).to_vec();
    if let Some(unknown) = arguments.systems.iter().find(|name| !known.contains(name)) {
        bail!("--systems: unknown system `{unknown}`; known: {}", known.join(", "));
    }
    let systems = if arguments.systems.is_empty() { known } else { arguments.systems.clone() };
    let bar = parallel::progress(systems.len(), quiet);
    let files = files(&systems, arguments.starts.into(), |name| {
        bar.set_message(name.to_string());
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("benchmark");
    let folder = arguments.out.as_deref().unwrap_or(&own);
    if arguments.out.is_some() {
        write_all(folder, &files)?
    } else {
        write_own(folder, &files)?
    }
    Ok(format!("{} tables in {}\n", files.len() - 1, folder.display()))
}
