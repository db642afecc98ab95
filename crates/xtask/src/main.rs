//! Chores of the project: `cargo xtask` lists them, `cargo xtask test` runs every check.

mod checks;
mod dependencies;
mod explore;
mod identity;
mod lint;
mod numbers;
mod packed;
mod pages;
mod python;
mod references;
mod site;
mod sources;
mod tools;
mod words;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;

use tools::Outcome;

/// A chore that is not a check: its name, what it does, and what it does with further words.
type Chore = (&'static str, &'static str, fn(&[&str]) -> Result<Outcome>);

const CHORES: [Chore; 9] = [
    (
        "address",
        "sets the address of the project (URL, or none), and writes it and the authors to every file that says them",
        identity::write,
    ),
    (
        "wheel",
        "builds wheel (for glibc 2.28 and newer) and source distribution of the Python module, tests the wheel",
        |_| python::wheel(),
    ),
    (
        "packed",
        "installs program, library and Python module from what is given away, in an empty folder: seconds, sizes",
        |_| packed::used(),
    ),
    (
        "site",
        "builds the site of documents, reports and references into target/site, follows its links, looks at it",
        |_| site::build(),
    ),
    ("explore", "builds the page to explore scenes, writes reports/explore.html", |_| explore::write()),
    ("firefox", "tries the page to explore scenes in Firefox, where it is installed", |_| explore::firefox()),
    (
        "growth",
        "moves sliders of a fresh page for five minutes, or in ROUNDS, then times frames; fails if it grows or slows",
        explore::growth,
    ),
    ("engine", "tests and runs the physics engine, writes reports/evidence/engine.md", |_| checks::engine()),
    (
        "peers",
        "times other tools beside ours, writes reports/evidence/peers.md; --quick for a look, --redraw for pictures",
        python::peers,
    ),
];

fn main() -> ExitCode {
    if let Some(code) = lint::in_place_of_rustc().or_else(tools::in_place_of_rustc) {
        return code;
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if let Err(error) = std::env::set_current_dir(root()) {
        eprintln!("{}: {error}", root().display());
        return ExitCode::FAILURE;
    }
    if let [name, rest @ ..] = arguments.as_slice()
        && let Some((_, _, chore)) = CHORES.iter().find(|chore| chore.0 == *name)
    {
        return checks::chore(chore(rest));
    }
    let checks = checks::all();
    let chosen = match arguments.as_slice() {
        [] | ["help" | "--help" | "-h"] => {
            list(&checks);
            return ExitCode::SUCCESS;
        }
        ["test"] => checks,
        [name] => checks.into_iter().filter(|check| check.name == *name).collect(),
        _ => Vec::new(),
    };
    if chosen.is_empty() {
        eprintln!("no chore is called `{}`; `cargo xtask` lists them", arguments.join(" "));
        return ExitCode::FAILURE;
    }
    checks::run(&chosen)
}

/// The root of the workspace. Cargo names the directory of this package at run time.
fn root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| "crates/xtask".into());
    Path::new(&package).ancestors().nth(2).unwrap_or(Path::new(".")).to_owned()
}

fn list(checks: &[checks::Check]) {
    println!(
        "cargo xtask CHORE\n\n  {:<10} every check below, in this order; those after `lint` three at a time",
        "test"
    );
    for check in checks {
        println!("  {:<10} {}", check.name, check.about);
    }
    for (name, about, _) in CHORES {
        println!("\n  {name:<10} no check: {about}");
    }
}
