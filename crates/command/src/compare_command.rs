//! `deltaq compare`: the protocol for scenes of the user's own.

use anyhow::Result;
use deltaq::Settings;
use serde_json::json;

use crate::cli::CompareArguments;
use crate::main_job::{compared, protocol, scene_files};
use crate::solve_command::{check_tolerance, limited};
use validation::catalogue;
use validation::report::verdicts;

/// Returns pages or verdicts, or writes pages and pictures to a folder and says so; on bad input nothing.
pub(crate) fn run(arguments: &CompareArguments) -> Result<String> {
    check_tolerance(arguments.tolerance)?;
    let settings = limited(Settings { tolerance: arguments.tolerance, ..protocol() }, &arguments.limits)?;
    let (mut files, mut comparisons) = (Vec::new(), Vec::new());
    for name in &arguments.scenes {
        let mut comparison = compared(catalogue::find(name, &arguments.set.overrides)?, &settings)?;
        files.extend(scene_files(&mut comparison, &settings)?);
        comparisons.push(comparison);
    }
    let text = || match &arguments.output.out {
        Some(folder) => format!("{} files in {}\n", files.len(), folder.display()),
        None => {
            let pages = files.iter().filter(|file| file.path.extension().is_some_and(|e| e == "md"));
            pages.map(|page| page.text.clone() + "\n").collect()
        }
    };
    let json = || {
        let mut value = verdicts(&comparisons);
        for comparison in &comparisons {
            for (i, pair) in comparison.pairs.iter().enumerate() {
                let found = &mut value["scenes"][&comparison.scene.name]["pairs"][i];
                (found["largest"], found["estimates"]) = (json!(pair.gap.largest), json!(pair.gap.estimates));
            }
        }
        value
    };
    arguments.output.answer("compare", || Ok(files.clone()), text, json)
}
