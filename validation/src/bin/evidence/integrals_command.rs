//! `evidence integrals`: the page on measures and integrals.

use anyhow::{Result, bail};

use crate::cli::IntegralsArguments;
use program::{parallel, write_all};
use validation::integrals::files;

/// Writes the page and its pictures.
pub(crate) fn run(arguments: &IntegralsArguments, quiet: bool) -> Result<String> {
    let known: Vec<&str> = catalogue::built_in().map(|(name, _)| *name).collect();
    if let Some(unknown) = arguments.scenes.iter().find(|name| !known.contains(&&name[..])) {
        bail!("--scenes: unknown scene `{unknown}`; known: {}", known.join(", "));
    }
    let asked: Vec<&str> = arguments.scenes.iter().map(String::as_str).collect();
    let scenes = if asked.is_empty() { known } else { asked };
    let bar = parallel::progress(scenes.len(), quiet);
    let has = |part: &str| arguments.parts.is_empty() || arguments.parts.iter().any(|own| own == part);
    let files = files(&scenes, &has, |name| {
        bar.set_message(name.to_string());
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    write_all(&arguments.out, &files)?;
    Ok(format!("{} files in {}\n", files.len(), arguments.out.display()))
}
