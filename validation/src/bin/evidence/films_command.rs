//! `evidence films`: the page on films.

use anyhow::Result;

use crate::cli::FilmsArguments;
use program::{parallel, write_all};
use validation::films::files;

/// Writes the page.
pub(crate) fn run(arguments: &FilmsArguments, quiet: bool) -> Result<String> {
    let known: Vec<&str> = catalogue::built_in().map(|(name, _)| *name).collect();
    let asked: Vec<&str> = arguments.scenes.iter().map(String::as_str).collect();
    let scenes = if asked.is_empty() { known } else { asked };
    let bar = parallel::progress(scenes.len(), quiet);
    let files = files(&scenes, |name| {
        bar.set_message(name.to_string());
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    write_all(&arguments.out, &files)?;
    Ok(format!("{} file in {}\n", files.len(), arguments.out.display()))
}
