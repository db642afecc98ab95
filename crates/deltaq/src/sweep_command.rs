//! `deltaq compare --sweep`: where two motions part, over one or two numbers.

use anyhow::{Context, Result, bail};
use comparison::{Sweep, SweepPoint};
use motion::Settings;

use crate::cli::CompareArguments;
use crate::columns::quoted;
use crate::grid::Grid;
use crate::solve_command::limited;
use pages::sweep_files;
use program::write_all;

const COLUMNS: [&str; 9] =
    ["verdict", "apart", "largest", "limit", "answer", "order", "dimension", "mismatch", "cause"];

/// A table, one row per point; of a file that was cut off the rest is computed.
pub(crate) fn run(arguments: &CompareArguments, quiet: bool) -> Result<String> {
    let settings = limited(Settings { tolerance: arguments.tolerance, ..Settings::protocol() }, &arguments.limits)?;
    let [name] = &arguments.scenes[..] else { bail!("--sweep is for one scene, not for {}", arguments.scenes.len()) };
    let grid = Grid::of(&arguments.sweep)?;
    grid.is_free_in(&arguments.set.overrides)?;
    let formulations = match &arguments.formulation[..] {
        [] => None,
        [first, second] => Some([*first, *second]),
        other => bail!("--sweep compares two formulations, not {}", other.len()),
    };
    // a name that means nothing is a fault of the call, a start that there is not an answer
    let text = scene::catalogue::source(name)?;
    let scene = scene::catalogue::read(name, &text, &arguments.set.overrides)?;
    let names: Vec<String> = grid.names().map(String::from).collect();
    let sweep = Sweep::new(&scene.name, &text, &arguments.set.overrides, &names, formulations, &settings)?;

    let path = arguments.output.out.as_ref().map(|folder| folder.join(format!("{}-sweep.csv", scene.name)));
    let written = grid.write(path.as_deref(), &COLUMNS, quiet, |point| row(&sweep.point(point)))?;
    let Some(told) = written else { return Ok(String::new()) };
    let (Some(path), Some(folder)) = (&path, &arguments.output.out) else { return Ok(told) };
    let table = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    write_all(folder, &sweep_files(&scene, sweep.titles(), &grid.swept(), &table)?)?;
    Ok(told)
}

fn row(point: &SweepPoint) -> String {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
    let count = |n: Option<usize>| n.map_or(String::new(), |n| n.to_string());
    let SweepPoint { verdict, apart, largest, limit, answer, order, dimension, mismatch, cause } = point;
    let cells = [
        verdict.to_string(),
        number(*apart),
        number(*largest),
        number(*limit),
        answer.to_string(),
        count(*order),
        count(*dimension),
        number(*mismatch),
        quoted(cause),
    ];
    cells.join(",") + "\n"
}
