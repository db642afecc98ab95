//! The Python module: built as a wheel, installed into an environment of its own, and tested.

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::checks::{Outcome, outside, succeed, target};

/// The crate, from the root of the project.
const CRATE: &str = "crates/python";
/// The oldest Python for which the module is built.
const OLDEST: (u32, u32) = (3, 11);
/// Where a Python is looked for.
const NAMES: [&str; 3] = ["python3.11", "python3", "python"];

pub(crate) fn check() -> Result<Outcome> {
    let target = target()?;
    let python = environment(&target, "python", &Path::new(CRATE).join("requirements.txt"))?;
    let size = install(&target, &python)?;
    succeed(outside(&python).args(["-B", "-m", "pytest", "--quiet"]).current_dir(CRATE))?;
    Ok(Outcome::Passed(format!(", a wheel of {:.1} MB", size as f64 / 1e6)))
}

/// Times other tools beside the module, each in Python, and writes `reports/peers.md`.
pub(crate) fn peers(arguments: &[&str]) -> Result<Outcome> {
    let target = target()?;
    let scripts = Path::new("validation").join("peers");
    let python = environment(&target, "peers", &scripts.join("requirements.txt"))?;
    install(&target, &python)?;
    let mut run = outside(&python);
    run.arg("-B").arg(scripts.join("peers.py")).arg("--target").arg(target.join("peers"));
    succeed(run.args(arguments))
}

/// Builds the module as a wheel and installs it for `python`, which has maturin; the size of the wheel in bytes.
fn install(target: &Path, python: &Path) -> Result<u64> {
    let wheels = target.join("python-wheels");
    if wheels.exists() {
        std::fs::remove_dir_all(&wheels).with_context(|| wheels.display().to_string())?;
    }
    let manifest = Path::new(CRATE).join("Cargo.toml");
    let mut build = outside(python);
    build.args(["-m", "maturin", "build", "--quiet", "--release", "--manifest-path"]).arg(manifest);
    succeed(build.arg("--interpreter").arg(python).arg("--out").arg(&wheels))?;
    let wheel =
        std::fs::read_dir(&wheels).context("the folder of wheels")?.next().context("maturin built no wheel")??;
    let mut install = outside(python);
    install.args(["-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--force-reinstall"]);
    succeed(install.arg(wheel.path()))?;
    Ok(wheel.metadata().context("the wheel")?.len())
}

/// The Python of an environment with what a file of requirements pins. It is built once for each content of that file: in a folder beside its
/// place, and then moved, so that half an environment is never used.
fn environment(target: &Path, name: &str, requirements: &Path) -> Result<PathBuf> {
    let text = std::fs::read_to_string(requirements).with_context(|| requirements.display().to_string())?;
    let (program, version) = interpreter()?;
    let mut hasher = DefaultHasher::new();
    (text, version).hash(&mut hasher);
    let place = target.join(format!("{name}-venv-{:016x}", hasher.finish()));
    if !place.exists() {
        let draft = target.join(format!("{name}-venv-draft-{}", std::process::id()));
        succeed(outside(program).args(["-m", "venv"]).arg(&draft))?;
        let mut install = outside(interpreter_of(&draft));
        succeed(install.args(["-m", "pip", "install", "--quiet", "--requirement"]).arg(requirements))?;
        // Another run may have been faster; its environment is as good.
        if std::fs::rename(&draft, &place).is_err() {
            std::fs::remove_dir_all(&draft).with_context(|| draft.display().to_string())?;
        }
    }
    Ok(interpreter_of(&place))
}

fn interpreter_of(environment: &Path) -> PathBuf {
    environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" })
}

/// Name and version of the first Python that is new enough.
fn interpreter() -> Result<(&'static str, (u32, u32))> {
    let mut found = Vec::new();
    for name in NAMES {
        let ask = outside(name).args(["-c", "import sys; print(*sys.version_info[:2])"]).output();
        let Ok(output) = ask else { continue };
        match version(&String::from_utf8_lossy(&output.stdout)) {
            Some(version) if version >= OLDEST => return Ok((name, version)),
            Some((major, minor)) => found.push(format!("`{name}` is {major}.{minor}")),
            None => found.push(format!("`{name}` does not say its version")),
        }
    }
    let found = if found.is_empty() { "there is none".into() } else { found.join(", ") };
    bail!("Python {}.{} or newer is needed: {found}", OLDEST.0, OLDEST.1)
}

fn version(text: &str) -> Option<(u32, u32)> {
    let (major, minor) = text.trim().split_once(' ')?;
    Some((major.parse().ok()?, minor.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_as_numbers() {
        assert!(version("3 11\n").is_some_and(|v| v >= OLDEST));
        assert!(version("3 9").is_some_and(|v| v < OLDEST));
        assert!(version("4 0").is_some_and(|v| v >= OLDEST));
        assert_eq!(version(""), None);
    }
}
