//! The virtual environment of the referee, made once for each version of its requirements.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Why nothing could be run in Python. The words name no place on this machine: they go into reports.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotRun {
    /// No interpreter.
    #[error("there is no `python3`, version 3.11 or later")]
    NoPython,
    /// `python3 -m venv` failed: how it ended.
    #[error("`python3 -m venv` ended with {0}")]
    NoEnvironment(String),
    /// The packages could not be installed: how pip ended.
    #[error("pip could not install the required packages ({0}): is there a package index?")]
    NoPackages(String),
    /// A folder or a file could not be written, and what the file system says.
    #[error("cannot write {0}: {1}")]
    Files(&'static str, std::io::ErrorKind),
    /// The scripts ended without an answer: how, and the last line of what they complained of.
    #[error("the scripts ended with {0}: {1}")]
    NoAnswer(String, String),
}

/// Files that cargo writes into its build folder; the first one only if it made that folder itself.
const MARKS: [&str; 2] = ["CACHEDIR.TAG", ".rustc_info.json"];

/// Where to keep what can be made again: cargo's target folder; for an installed program the user's cache.
pub fn target() -> PathBuf {
    let program = std::env::current_exe().unwrap_or_default();
    let marked = |folder: &&Path| MARKS.iter().any(|mark| folder.join(mark).exists());
    let built = program.ancestors().find(marked).map(Path::to_path_buf);
    built.unwrap_or_else(|| cache(std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from), std::env::home_dir()))
}

/// This program's folder in the user's cache (XDG base directories); without a home, among temporary files.
pub fn cache(named: Option<PathBuf>, home: Option<PathBuf>) -> PathBuf {
    let named = named.filter(|folder| folder.is_absolute());
    let folder = named.or(home.map(|home| home.join(".cache"))).unwrap_or_else(std::env::temp_dir);
    folder.join("deltaq")
}

pub(super) fn files(what: &'static str) -> impl Fn(std::io::Error) -> NotRun {
    move |error| NotRun::Files(what, error.kind())
}

/// The interpreter of the environment with the packages of `requirements`, made now if it is not there yet.
/// What is half made is never seen: it is built beside its place and moved there when it is complete.
pub(super) fn interpreter(requirements: &str) -> Result<PathBuf, NotRun> {
    let target = target();
    let place = target.join(format!("casadi-{:016x}", reference::digest(requirements)));
    let python = Path::new("bin").join("python");
    if place.join(&python).exists() {
        return Ok(place.join(python));
    }
    let version = Command::new("python3").args(["-c", "import sys; sys.exit(sys.version_info < (3, 11))"]).output();
    if !version.is_ok_and(|output| output.status.success()) {
        return Err(NotRun::NoPython);
    }
    std::fs::create_dir_all(&target).map_err(files("the folder of environments"))?;
    let building =
        tempfile::Builder::new().prefix("casadi-new-").tempdir_in(&target).map_err(files("an environment"))?;
    let folder = building.path().join("environment");
    let run = |command: &mut Command| command.output().map_err(|_| NotRun::NoPython);
    let made = run(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
    if !made.status.success() {
        return Err(NotRun::NoEnvironment(made.status.to_string()));
    }
    let list = building.path().join("requirements.txt");
    std::fs::write(&list, requirements).map_err(files("the requirements"))?;
    let options = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-input"];
    let mut pip = Command::new(folder.join(&python));
    let installed =
        run(pip.args(options).args(["--retries", "1", "--timeout", "20", "--only-binary", ":all:", "-r"]).arg(&list))?;
    if !installed.status.success() {
        return Err(NotRun::NoPackages(installed.status.to_string()));
    }
    // Another process may have been quicker; its environment is as good.
    let moved = std::fs::rename(&folder, &place);
    if !place.join(&python).exists() {
        moved.map_err(files("an environment"))?;
    }
    Ok(place.join(python))
}
