//! Every check, and how they are run.
//!
//! All that compiles is compiled in the release profile: integration needs the optimisation, the reports are
//! written by a release build, and so the dependencies are built once.

use std::fs::File;
use std::process::{Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use anyhow::{Context, Result};

use crate::tools::{ALL, Outcome, build, cargo, outside, own, succeed, target};
use crate::{dependencies, explore, identity, lint, python, sources, words};

/// One thing that must hold.
pub(crate) struct Check {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    /// What to do when it fails.
    mend: &'static str,
    run: fn() -> Result<Outcome>,
}

/// The last check that runs alone: all after it need what the build has made, and run side by side.
const LAST_ALONE: &str = "lint";

/// All checks, cheap ones first; of those side by side first the ones that wait or have one thread, so that
/// others can be beside them: name, what it is about, what mends it.
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
            "copies",
            "licences and the page in packages are those of the project, and nothing is a symbolic link",
            "copy the original over it",
            sources::copies,
        ),
        check(
            "identity",
            "authors and address are those of Cargo.toml everywhere, and nothing pretends to have an address",
            "cargo xtask address; or name the folder of the project in the place of an index",
            identity::check,
        ),
        check(
            "words",
            "no page has a long sentence, a habit that readers stumble over, or a number without a source",
            "say it in two sentences and other words; link the number's page, or list its source in docs/numbers.txt",
            words::check,
        ),
        check(
            "once",
            "nothing that the main job has compiled is compiled again with other features",
            "name the features in validation/Cargo.toml, or do without the package that asks for them",
            dependencies::once,
        ),
        check(
            "build",
            "libraries, programs, tests and the Python module compile, each once",
            "cargo build --release --workspace --exclude engine --all-targets",
            build,
        ),
        check(
            "lint",
            "clippy and rustdoc find nothing",
            "cargo clippy --release --workspace --exclude engine --all-targets; cargo doc --workspace --no-deps",
            lint::check,
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
            "tests",
            "unit, crate, property and verification tests",
            "cargo test --release --package PACKAGE TEST, with the names from above",
            tests,
        ),
        check(
            "reports",
            "the committed reports are those a fresh run writes",
            "cargo run --release, then look at what changed and commit it",
            reports,
        ),
        check(
            "engine-fits",
            "the crate of the physics engine compiles",
            "cargo check --release --package engine --all-targets",
            engine_fits,
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
    ]
}

/// Runs checks in order up to the first that fails; those after [`LAST_ALONE`] side by side.
pub(crate) fn run(checks: &[Check]) -> ExitCode {
    let start = Instant::now();
    if checks.iter().any(|check| ["deny", "python"].contains(&check.name)) {
        // beside the checks before these; who asks for it waits, and hears of it if it failed
        std::thread::spawn(python::environment);
    }
    let alone = checks.iter().position(|check| check.name == LAST_ALONE).map_or(checks.len(), |last| last + 1);
    let mut ended = Vec::new();
    for check in &checks[..alone] {
        println!("── {}: {}", check.name, check.about);
        let start = Instant::now();
        let outcome = (check.run)();
        ended.push(told(check, &outcome, start.elapsed().as_secs_f64()));
        if outcome.is_err() {
            break;
        }
    }
    if ended.iter().all(|end| *end != End::Failed) {
        ended.extend(side_by_side(&checks[alone..]));
    }
    println!("all in {:.1} s\n{}", start.elapsed().as_secs_f64(), counted(&ended));
    if ended.contains(&End::Failed) { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

/// How a check ended.
#[derive(Clone, Debug, PartialEq)]
enum End {
    Passed,
    /// And what is lacking.
    NotRun(String),
    Failed,
}

/// Says how a check ended.
fn told(check: &Check, outcome: &Result<Outcome>, seconds: f64) -> End {
    let name = check.name;
    match outcome {
        Ok(Outcome::Passed(note)) => {
            println!("   {name} passed in {seconds:.1} s{note}\n");
            End::Passed
        }
        Ok(Outcome::NotRun(lacking)) => {
            println!("   {name}{NOT_RUN}{lacking}\n");
            End::NotRun(format!("{name}: {lacking}"))
        }
        Err(error) => {
            println!("   {name} FAILED after {seconds:.1} s: {error:#}\n   to mend: {}\n", check.mend);
            End::Failed
        }
    }
}

const NOT_RUN: &str = " NOT RUN: ";

/// Two processors, and one check that waits.
const AT_A_TIME: usize = 3;

/// [`AT_A_TIME`] checks, as some of them wait for a browser or an interpreter. Each is another call of this
/// program, so that what it says comes whole, at its end. After a failure none is begun.
fn side_by_side(checks: &[Check]) -> Vec<End> {
    let (next, ended) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(check) = checks.get(next.fetch_add(1, Ordering::Relaxed)) {
            if lock(&ended).contains(&End::Failed) {
                break;
            }
            println!("── {} begins", check.name);
            let (said, end) = kept(check);
            let mut ended = lock(&ended);
            println!("{said}");
            ended.push(end);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME {
            scope.spawn(work);
        }
    });
    ended.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn lock(ended: &Mutex<Vec<End>>) -> MutexGuard<'_, Vec<End>> {
    ended.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs a check by another call of this program: all that it says but the sums at its end, and how it ended.
fn kept(check: &Check) -> (String, End) {
    let ran = || -> Result<(String, bool)> {
        let file = target()?.join("checks").join(check.name).with_extension("txt");
        std::fs::create_dir_all(file.parent().context("a file without a folder")?)?;
        let out = File::create(&file).with_context(|| file.display().to_string())?;
        let mut call = Command::new(std::env::current_exe()?);
        let status = call.arg(check.name).stdin(Stdio::null()).stderr(out.try_clone()?).stdout(out).status()?;
        Ok((std::fs::read_to_string(&file)?, status.success()))
    };
    match ran() {
        Ok((said, success)) => {
            let words = said.rsplit_once("\nall in ").map_or(&said[..], |(words, _)| words);
            (words.to_owned(), end_of(check.name, words, success))
        }
        Err(error) => (format!("   {} FAILED: {error:#}\n", check.name), End::Failed),
    }
}

/// How a check ended, by what its call said and whether that succeeded.
fn end_of(name: &str, said: &str, success: bool) -> End {
    let start = format!("   {name}{NOT_RUN}");
    match said.lines().find_map(|line| line.strip_prefix(&start[..])) {
        _ if !success => End::Failed,
        Some(lacking) => End::NotRun(format!("{name}: {lacking}")),
        None => End::Passed,
    }
}

/// The last line: what was not run is not a pass.
fn counted(ended: &[End]) -> String {
    let count = |end: End| ended.iter().filter(|other| **other == end).count();
    let lacking: Vec<&str> =
        ended.iter().filter_map(|end| if let End::NotRun(what) = end { Some(&what[..]) } else { None }).collect();
    let sums = format!("{} passed, {} failed", count(End::Passed), count(End::Failed));
    match &lacking[..] {
        [] => sums,
        lacking => format!("{sums}, {} not run ({})", lacking.len(), lacking.join("; ")),
    }
}

/// Runs a chore that is not a check.
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

/// Tests the physics engine's crate and writes `reports/evidence/engine.md`. Not a check: what it runs is
/// another program, at a length of its own.
pub(crate) fn engine() -> Result<Outcome> {
    succeed(cargo().args(["test", "--release", "--package", "engine"]))?;
    succeed(cargo().args(["run", "--release", "--package", "engine"]))
}

/// The physics engine is not built for the checks; what it is made of has to fit all the same.
fn engine_fits() -> Result<Outcome> {
    succeed(cargo().args(["check", "--release", "--package", "engine", "--all-targets", "--quiet"]))
}

fn fmt() -> Result<Outcome> {
    succeed(cargo().args(["fmt", "--all", "--check"]))
}

fn tests() -> Result<Outcome> {
    succeed(cargo().arg("test").args(ALL).arg("--tests"))
}

fn doctests() -> Result<Outcome> {
    succeed(cargo().arg("test").args(ALL).arg("--doc"))
}

fn reports() -> Result<Outcome> {
    // the features of one package would build every dependency once more
    build()?;
    succeed(outside(own("evidence")?).args(["reports", "--check"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_run_is_no_pass() {
        let lacking = "page: there is no browser";
        assert_eq!(counted(&[End::Passed, End::Passed]), "2 passed, 0 failed");
        let ended = [End::Passed, End::NotRun(lacking.into()), End::Failed];
        assert_eq!(counted(&ended), format!("1 passed, 1 failed, 1 not run ({lacking})"));
        assert_eq!(end_of("page", "── page: a\n   page NOT RUN: there is no browser\n", true), ended[1]);
        assert_eq!(end_of("page", "── page: a\n   page passed in 1.0 s\n", true), End::Passed);
        assert_eq!(end_of("page", "── page: a\n", false), End::Failed);
    }
}
