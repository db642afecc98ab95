//! Chores of the project: `cargo xtask` lists them, `cargo xtask test` runs every check.

mod checks;
mod dependencies;
mod explore;
mod lint;
mod python;
mod sources;
mod tools;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Seconds.
const FIVE_MINUTES: u32 = 300;

fn main() -> ExitCode {
    if let Some(code) = lint::in_place_of_rustc() {
        return code;
    }
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    if let Err(error) = std::env::set_current_dir(root()) {
        eprintln!("{}: {error}", root().display());
        return ExitCode::FAILURE;
    }
    let checks = checks::all();
    if arguments == ["engine"] {
        return checks::chore(checks::engine());
    }
    if arguments == ["explore"] {
        return checks::chore(explore::write());
    }
    if let ["growth", rest @ ..] = arguments.as_slice() {
        return match rest.first().map_or(Ok(FIVE_MINUTES), |seconds| seconds.parse()) {
            Ok(seconds) => checks::chore(explore::growth(seconds)),
            Err(error) => {
                eprintln!("growth takes a number of seconds: {error}");
                ExitCode::FAILURE
            }
        };
    }
    if arguments == ["wheel"] {
        return checks::chore(python::wheel());
    }
    if let ["peers", rest @ ..] = arguments.as_slice() {
        return checks::chore(python::peers(rest));
    }
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
    println!("cargo xtask CHORE\n\n  {:<10} every check below, in this order", "test");
    for check in checks {
        println!("  {:<10} {}", check.name, check.about);
    }
    println!(
        "\n  {:<10} no check: builds wheel (for glibc 2.28 and newer) and source distribution of the Python module, tests the wheel",
        "wheel"
    );
    println!("\n  {:<10} no check: builds the page to explore scenes, writes reports/explore.html", "explore");
    println!(
        "\n  {:<10} no check: moves sliders of a fresh page for five minutes, or SECONDS, and fails if it grows",
        "growth"
    );
    println!("\n  {:<10} no check: runs the physics engine, writes reports/engine.md", "engine");
    println!(
        "\n  {:<10} no check: times other tools beside ours, writes reports/peers.md; --quick for a look, --redraw for pictures",
        "peers"
    );
}
