//! `deltaq integrals`: invariant measures and first integrals, printed, counted, or proved not to exist.

use std::path::Path;

use anyhow::Result;
use integrals::{Integrals, Reversed, reversible_scene};
use program::{Answer, File, TextOrJson, keep, typed, write_all};

use scene::Number;

use crate::cli::{FreeArguments, IntegralsArguments, SceneArguments};
use crate::columns::quoted;
use crate::grid::Grid;
use crate::solve_command::choice;

/// Decides and writes.
///
/// # Errors
/// Bad input, with its place; answers that contradict each other; a file that cannot be written.
pub fn run(arguments: &IntegralsArguments, quiet: bool) -> Result<Answer> {
    if !arguments.sweep.is_empty() {
        return swept(arguments, quiet).map(Answer::from);
    }
    let scene = arguments.scene.find()?;
    let choice = choice(&scene, (arguments.formulation, "auto"), &FreeArguments::default())?;
    let found = Integrals::find(&scene, &choice, arguments.degree.into(), &arguments.names)?;
    let text = match arguments.format {
        TextOrJson::Text => found.to_string(),
        TextOrJson::Json => typed(&found.answer())?,
    };
    let mut complaint = None;
    if let Some(folder) = &arguments.certificates {
        let missing = write_certificates(arguments, &found, folder)?;
        complaint = if missing.is_empty() { None } else { Some(missing) };
    }
    let told = |file: &str| format!("{}: the answers are in {file}\n", scene.name);
    let text = keep(arguments.out.as_deref(), text, told)?;
    Ok(Answer { text, complaint, ..Answer::default() })
}

/// Writes certificates, and says which there are not and why.
fn write_certificates(arguments: &IntegralsArguments, found: &Integrals, folder: &Path) -> Result<String> {
    let (mut files, mut missing) = (Vec::new(), Vec::new());
    for (name, certificate) in found.certificates(&arguments.scene.set.written())? {
        match certificate {
            Ok(certified) => {
                files.push(File { path: format!("{}-{name}.json", found.scene.name).into(), text: typed(&certified)? })
            }
            Err(open) => missing.push(format!("no certificate of `{name}`: {open}")),
        }
    }
    write_all(folder, &files)?;
    Ok(missing.join("\n"))
}

/// A table of what is decided without an ansatz.
fn swept(arguments: &IntegralsArguments, quiet: bool) -> Result<String> {
    let SceneArguments { scene: name, set } = &arguments.scene;
    let grid = Grid::of(&arguments.sweep)?;
    grid.is_free_in(&set.overrides)?;
    let (text, degree) = (scene::catalogue::source(name)?, usize::from(arguments.degree));
    let asked = |point: &[f64]| -> Result<Reversed> {
        let values = grid.names().map(String::from).zip(point.iter().map(|&x| Number::from(x)));
        let scene =
            scene::catalogue::read(name, &text, &set.overrides.iter().cloned().chain(values).collect::<Vec<_>>())?;
        Ok(reversible_scene(&scene, degree)?)
    };
    // a name that means nothing is a fault of the call
    asked(&grid.point(0))?;
    let row = |point: &[f64]| {
        let (cells, why) = match asked(point) {
            Ok(found) => found.cells(),
            Err(error) => (vec!["open".into(); 2 + degree], error.to_string()),
        };
        format!("{},{}\n", cells.join(","), quoted(&why))
    };
    let columns = ["measure", "multiplier", "linear", "quadratic", "cubic"].into_iter().take(2 + degree).chain(["why"]);
    Ok(grid.write(arguments.out.as_deref(), &columns.collect::<Vec<_>>(), quiet, row)?.unwrap_or_default())
}
