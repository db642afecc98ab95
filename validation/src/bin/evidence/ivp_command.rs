//! `evidence ivp`: test problems of others.

use anyhow::Result;

use crate::cli::IvpArguments;
use program::{parallel, write_all};
use validation::ivp::{METHODS, TOLERANCES, problems};
use validation::report::ivp_files;

/// Solves all problems by all methods, one after another, and writes the page.
pub(crate) fn run(arguments: &IvpArguments, quiet: bool) -> Result<String> {
    let mut problems = problems()?;
    problems.retain(|problem| arguments.problems.is_empty() || arguments.problems.contains(&problem.name));
    let bar = parallel::progress(problems.len() * METHODS.len() * TOLERANCES.len(), quiet);
    let mut measured = Vec::new();
    for problem in problems {
        let mut points = Vec::new();
        for method in METHODS {
            for tolerance in TOLERANCES.into_iter().filter(|tolerance| problem.is_tried(*tolerance, method)) {
                bar.set_message(format!("{} at {tolerance:.0e}", problem.name));
                points.push(problem.measure(tolerance, method)?);
                bar.inc(1);
            }
        }
        measured.push((problem, points));
    }
    bar.finish_and_clear();
    let files = ivp_files(&measured)?;
    write_all(&arguments.out, &files)?;
    Ok(format!("{} files in {}\n", files.len(), arguments.out.display()))
}
