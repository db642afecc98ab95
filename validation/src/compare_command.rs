//! `deltaq compare`: the protocol for scenes of the user's own.

use anyhow::{Result, bail};
use deltaq::Settings;

use crate::catalogue;
use crate::cli::CompareArguments;
use crate::main_job::scene_files;
use crate::report::write_all;

/// Runs the command: pages to the terminal, or pages and pictures to a folder.
///
/// # Errors
/// Bad input, with its place; then nothing is written.
pub fn run(arguments: &CompareArguments) -> Result<()> {
    if !(arguments.tolerance > 0.0 && arguments.tolerance < 1.0) {
        bail!("--tolerance is {}; it must be above 0 and below 1", arguments.tolerance);
    }
    let settings = Settings { tolerance: arguments.tolerance, ..Settings::default() };
    let mut all = Vec::new();
    for name in &arguments.scenes {
        let scene = catalogue::find(name, &arguments.overrides)?;
        let (_, files) = scene_files(scene, &settings)?;
        all.extend(files);
    }
    match &arguments.out {
        Some(folder) => {
            write_all(folder, &all)?;
            println!("{} files in {}", all.len(), folder.display());
        }
        None => {
            for page in all.iter().filter(|f| f.path.extension().is_some_and(|e| e == "md")) {
                println!("{}", page.text);
            }
        }
    }
    Ok(())
}
