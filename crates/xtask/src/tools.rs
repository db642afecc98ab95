//! What chores run: cargo, other programs, and where they build.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

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
    let arguments: Vec<_> = command.get_args().map(|argument| argument.to_string_lossy().into_owned()).collect();
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default().to_string_lossy();
    let line = format!("{program} {}", arguments.join(" "));
    let status = command.status().with_context(|| line.clone())?;
    if !status.success() {
        bail!("`{line}` ended with {status}");
    }
    Ok(Outcome::Passed(String::new()))
}

/// What checks compile: all but the physics engine, which brings fifty packages for one page
/// ([`crate::checks::engine`]).
pub(crate) const ALL: [&str; 4] = ["--release", "--workspace", "--exclude", "engine"];

/// Everything, with one set of features; programs are in the folder `release` of [`target`] then.
pub(crate) fn build() -> Result<Outcome> {
    succeed(cargo().arg("build").args(ALL).arg("--all-targets"))
}

/// The folder of build results.
pub(crate) fn target() -> Result<PathBuf> {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| PathBuf::from("target"), PathBuf::from);
    std::path::absolute(target).context("the folder of build results")
}
