//! `deltaq compare`: the protocol for scenes of the user's own.

use anyhow::Result;
use deltaq::Settings;

use crate::cli::CompareArguments;
use crate::main_job::{protocol, scene_files};
use crate::solve_command::check_tolerance;
use validation::catalogue;
use validation::report::write_all;

/// Runs the command: returns the pages, or writes pages and pictures to a folder and says so; on bad input nothing is written.
pub(crate) fn run(arguments: &CompareArguments) -> Result<String> {
    check_tolerance(arguments.tolerance)?;
    let settings = Settings { tolerance: arguments.tolerance, ..protocol() };
    let mut all = Vec::new();
    for name in &arguments.scenes {
        let scene = catalogue::find(name, &arguments.set.overrides)?;
        all.extend(scene_files(scene, &settings)?.files);
    }
    match &arguments.out {
        Some(folder) => {
            write_all(folder, &all)?;
            Ok(format!("{} files in {}\n", all.len(), folder.display()))
        }
        None => {
            let pages = all.into_iter().filter(|f| f.path.extension().is_some_and(|e| e == "md"));
            Ok(pages.map(|page| page.text + "\n").collect())
        }
    }
}
