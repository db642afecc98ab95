//! What chores run: cargo, other programs, and where they build.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};

/// A chore that did not fail.
pub(crate) enum Outcome {
    /// It holds: what was looked at, if that needs saying.
    Passed(String),
    /// Some of it was not looked at, as something is lacking.
    NotRun(String),
}

/// The cargo that runs this.
pub(crate) fn cargo() -> Command {
    outside(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// A program that runs as if nobody had run this one.
pub(crate) fn outside(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    // What cargo says of this package is not meant for the ones it is asked about.
    for (name, _) in std::env::vars_os() {
        if name.to_str().is_some_and(|name| name.starts_with("CARGO_PKG_") || name.starts_with("CARGO_MANIFEST_")) {
            command.env_remove(name);
        }
    }
    command
}

/// Runs a program that must succeed.
pub(crate) fn succeed(command: &mut Command) -> Result<Outcome> {
    let line = line(command);
    let status = command.status().with_context(|| line.clone())?;
    if !status.success() {
        bail!("`{line}` ended with {status}");
    }
    Ok(Outcome::Passed(String::new()))
}

/// What a program prints that must succeed.
pub(crate) fn output_of(command: &mut Command) -> Result<String> {
    let line = line(command);
    let output = command.output().with_context(|| line.clone())?;
    let complaint = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "`{line}` ended with {}: {}", output.status, complaint.trim());
    String::from_utf8(output.stdout).context(line)
}

/// The call of a program as one would type it.
fn line(command: &Command) -> String {
    let arguments: Vec<_> = command.get_args().map(|argument| argument.to_string_lossy().into_owned()).collect();
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default().to_string_lossy();
    format!("{program} {}", arguments.join(" "))
}

/// A program of the workspace, which [`build`] has made.
pub(crate) fn own(name: &str) -> Result<PathBuf> {
    Ok(target()?.join("release").join(name))
}

/// What checks compile: all but the physics engine, which brings fifty packages for one page
/// ([`crate::checks::engine`]).
pub(crate) const ALL: [&str; 4] = ["--release", "--workspace", "--exclude", "engine"];

/// Set for calls of rustc that come through this program.
const TESTS: &str = "XTASK_COMPILES_TESTS";

/// Everything, with one set of features; programs are in the folder `release` of [`target`] then. Programs of
/// tests are compiled without optimization, in a quarter of the time: what works in them is the libraries,
/// which have theirs. A wrapper of somebody's own, a cache, is left alone.
pub(crate) fn build() -> Result<Outcome> {
    let mut build = cargo();
    build.arg("build").args(ALL).arg("--all-targets");
    if std::env::var_os("RUSTC_WRAPPER").is_none() {
        build.env("RUSTC_WRAPPER", std::env::current_exe().context("this program")?).env(TESTS, "");
    }
    succeed(&mut build)
}

/// The call of rustc, if this is one for [`build`]. The last of its options is the one that counts.
pub(crate) fn in_place_of_rustc() -> Option<ExitCode> {
    std::env::var_os(TESTS)?;
    let mut rustc = Command::new(std::env::args_os().nth(1)?);
    rustc.args(std::env::args_os().skip(2));
    if std::env::args_os().any(|word| word == "--test") {
        rustc.args(["-Copt-level=0", "-Cdebug-assertions=off", "-Coverflow-checks=off"]);
    }
    Some(if rustc.status().is_ok_and(|status| status.success()) { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The folder of build results.
pub(crate) fn target() -> Result<PathBuf> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    std::path::absolute(target).context("the folder of build results")
}
