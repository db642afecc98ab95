//! `evidence integrals`: the page on measures and integrals.

use anyhow::{Result, bail};

use crate::cli::IntegralsArguments;
use program::{parallel, write_all};
use validation::integrals::files;

/// The built-in scenes of these names, all if there are none.
///
/// # Errors
/// A name that is no scene's.
pub(crate) fn asked(names: &[String]) -> Result<Vec<&str>> {
    let known: Vec<&str> = scene::catalogue::built_in().map(|(name, _)| *name).collect();
    if let Some(unknown) = names.iter().find(|name| !known.contains(&&name[..])) {
        bail!("--scenes: unknown scene `{unknown}`; known: {}", known.join(", "));
    }
    let asked: Vec<&str> = names.iter().map(String::as_str).collect();
    Ok(if asked.is_empty() { known } else { asked })
}

/// Writes the page and its pictures.
pub(crate) fn run(arguments: &IntegralsArguments, quiet: bool) -> Result<String> {
    let scenes = asked(&arguments.scenes)?;
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
