//! `evidence films`: the page on films.

use anyhow::Result;

use crate::cli::FilmsArguments;
use crate::integrals_command::asked;
use program::{parallel, write_all};
use validation::films::files;

/// Writes the page.
pub(crate) fn run(arguments: &FilmsArguments, quiet: bool) -> Result<String> {
    let scenes = asked(&arguments.scenes)?;
    let bar = parallel::progress(scenes.len(), quiet);
    let files = files(&scenes, |name| {
        bar.set_message(name.to_string());
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    write_all(&arguments.out, &files)?;
    Ok(format!("{} file in {}\n", files.len(), arguments.out.display()))
}
