//! Every check, and how they are run.
//!
//! All that compiles is compiled in the release profile: integration needs the optimisation, the reports are
//! written by a release build, and so the dependencies are built once.

use std::process::ExitCode;
use std::time::Instant;

use anyhow::Result;

use crate::tools::{Outcome, build, cargo, outside, succeed, target};
use crate::{dependencies, explore, lint, python, sources};

/// One thing that must hold.
pub(crate) struct Check {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// What to do when it fails.
    mend: &'static str,
    run: fn() -> Result<Outcome>,
}

/// All checks, cheap ones first: name, what it is about, what mends it.
pub(crate) fn all() -> Vec<Check> {
    let check = |name, about, mend, run: fn() -> Result<Outcome>| Check { name, about, mend, run };
    vec![
        check("fmt", "sources are formatted", "cargo fmt --all", fmt),
        check(
            "lengths",
            "no Rust source is over 400 lines, no comment over 110 columns",
            "split the file by what its parts know; say the sentence shorter",
            sources::lengths,
        ),
        check(
            "paths",
            "no file names a place on one machine or a private registry",
            "write the path relative to the root of the project",
            sources::paths,
        ),
        check(
            "build",
            "libraries, programs, tests and the Python module compile, each once",
            "cargo build --release --workspace --all-targets",
            build,
        ),
        check(
            "lint",
            "clippy and rustdoc find nothing",
            "cargo clippy --release --workspace --all-targets; cargo doc --workspace --no-deps",
            lint::check,
        ),
        check(
            "tests",
            "unit, crate, property and verification tests",
            "cargo test --release --package PACKAGE TEST, with the names from above",
            tests,
        ),
        check(
            "doctests",
            "examples in the documentation",
            "cargo test --release --doc --package PACKAGE, with the name from above",
            doctests,
        ),
        check(
            "deny",
            "licences, sources and advisories of every dependency, and how many packages are compiled",
            "do without the package (cargo tree --workspace --invert PACKAGE), or say in deny.toml why not",
            dependencies::check,
        ),
        check(
            "package",
            "every crate can be packaged",
            "name version and path of what it is built on in the table of the workspace (cargo package --workspace)",
            dependencies::package,
        ),
        check(
            "python",
            "the Python module does what its tests say",
            "pip install ./crates/python, then pytest in that folder; it needs Python 3.11 or newer with venv",
            python::check,
        ),
        check(
            "page",
            "the page to explore scenes works in a browser and says what the native program says",
            "cargo xtask explore, then commit reports/explore.html; pictures are in target/explore/pictures",
            explore::check,
        ),
        check(
            "reports",
            "the committed reports are those a fresh run writes",
            "cargo run --release, then look at what changed and commit it",
            reports,
        ),
    ]
}

/// Run checks in order up to the first that fails.
pub(crate) fn run(checks: &[Check]) -> ExitCode {
    let start = Instant::now();
    if checks.iter().any(|check| ["deny", "python"].contains(&check.name)) {
        // beside the checks before these; who asks for it waits, and hears of it if it failed
        std::thread::spawn(python::environment);
    }
    let (mut passed, mut not_run) = (0, Vec::new());
    for check in checks {
        println!("── {}: {}", check.name, check.about);
        let start = Instant::now();
        let outcome = (check.run)();
        let seconds = start.elapsed().as_secs_f64();
        match outcome {
            Ok(Outcome::Passed(note)) => {
                passed += 1;
                println!("   {} passed in {seconds:.1} s{note}\n", check.name);
            }
            Ok(Outcome::NotRun(lacking)) => {
                println!("   {} NOT RUN: {lacking}\n", check.name);
                not_run.push(format!("{}: {lacking}", check.name));
            }
            Err(error) => {
                println!("   {} FAILED after {seconds:.1} s: {error:#}\n   to mend: {}\n", check.name, check.mend);
                println!("{passed} passed, 1 failed");
                return ExitCode::FAILURE;
            }
        }
    }
    println!("all in {:.1} s", start.elapsed().as_secs_f64());
    println!("{}", counted(passed, &not_run));
    ExitCode::SUCCESS
}

/// The last line: what was not run is no pass.
fn counted(passed: usize, not_run: &[String]) -> String {
    match not_run {
        [] => format!("{passed} passed, 0 failed"),
        lacking => format!("{passed} passed, 0 failed, {} not run ({})", lacking.len(), lacking.join("; ")),
    }
}

/// Runs a chore that is no check.
pub(crate) fn chore(outcome: Result<Outcome>) -> ExitCode {
    match outcome {
        Ok(Outcome::Passed(told)) => {
            println!("done{told}");
            ExitCode::SUCCESS
        }
        Ok(Outcome::NotRun(lacking)) => {
            println!("not done: {lacking}");
            ExitCode::FAILURE
        }
        Err(error) => {
            println!("{error:#}");
            ExitCode::FAILURE
        }
    }
}

/// Writes `reports/engine.md`. No check: what it runs is another program, at a length of its own.
pub(crate) fn engine() -> Result<Outcome> {
    succeed(cargo().args(["run", "--release", "--package", "engine"]))
}

fn fmt() -> Result<Outcome> {
    succeed(cargo().args(["fmt", "--all", "--check"]))
}

fn tests() -> Result<Outcome> {
    succeed(cargo().args(["test", "--release", "--workspace", "--tests", "--examples"]))
}

fn doctests() -> Result<Outcome> {
    succeed(cargo().args(["test", "--release", "--workspace", "--doc"]))
}

fn reports() -> Result<Outcome> {
    // the features of one package would build every dependency once more
    build()?;
    succeed(outside(target()?.join("release").join("evidence")).args(["reports", "--check"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_run_is_no_pass() {
        assert_eq!(counted(12, &[]), "12 passed, 0 failed");
        let lacking = ["page: there is no browser".to_owned()];
        assert_eq!(counted(11, &lacking), "11 passed, 0 failed, 1 not run (page: there is no browser)");
    }
}
