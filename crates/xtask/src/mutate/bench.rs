//! A copy of the workspace, in which mutants are built and tested.
//!
//! It is built with the release profile and incremental compilation: after a change in a derivation the four packages
//! that see it are built anew in 1 s, against 12 s without (8 s with these packages at optimization level 1), while
//! the tests take 7 s either way. A lower level beside incremental compilation gains nothing (0.8 s to 1.3 s) and makes
//! the tests slower.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;

use super::finder::Mutant;
use super::results::{Outcome, Verdict, hash};
use crate::checks::cargo;
use crate::sources;

/// Test binaries that must notice a mutant: a file without which the suite does not exist, and arguments for `cargo test`.
const SUITES: [(&str, &[&str]); 2] = [
    ("tests/tests/main.rs", &["--package", "tests", "--test", "tests"]),
    ("crates/deltaq/tests/main.rs", &["--package", "deltaq", "--test", "deltaq-tests"]),
];
/// What of them is left out: long runs, and what no derivation can change.
const LEFT_OUT: [&str; 4] = ["architecture::", "discrete::", "reference_motions::", "stability::"];
/// Shortest time that the tests of a mutant are given.
const PATIENCE: Duration = Duration::from_secs(60);
/// How many times as long as unmutated the tests of a mutant may take.
const SLOWER: u32 = 5;

/// One copy of the workspace and its build.
pub(crate) struct Bench {
    tree: PathBuf,
    build: PathBuf,
    /// What the running tests print.
    output: PathBuf,
    limit: Duration,
    /// Stands for all sources that verdicts depend on.
    pub(crate) sources: u64,
}

/// A test binary and the folder that it runs in.
struct Binary {
    program: PathBuf,
    folder: PathBuf,
}

/// How the tests ended.
enum Ending {
    Passed,
    /// The first test that failed.
    Failed(String),
    TooLate,
}

impl Bench {
    /// Copies the workspace, builds it, and makes sure that the tests pass as it is.
    pub(crate) fn prepare(folder: &Path, number: usize) -> Result<Self> {
        let name = |stem: &str| folder.join(if number == 1 { stem.to_owned() } else { format!("{stem}-{number}") });
        let mut bench = Bench {
            tree: name("tree"),
            build: name("build"),
            output: name("output.txt"),
            limit: Duration::from_secs(3600),
            sources: 0,
        };
        bench.sources = bench.copy()?;
        let binaries = match bench.compile(Stdio::inherit())? {
            Ok(binaries) => binaries,
            Err(_) => bail!("the workspace does not compile as it is; see above"),
        };
        let start = Instant::now();
        match bench.test(&binaries)? {
            Ending::Passed => {}
            Ending::Failed(test) => bail!("as it is, without a mutant, {test}: mend that first"),
            Ending::TooLate => bail!("the tests did not end within an hour"),
        }
        bench.limit = PATIENCE.max(start.elapsed() * SLOWER);
        println!("   as it is, the tests pass in {:.1} s", start.elapsed().as_secs_f64());
        Ok(bench)
    }

    /// Builds and tests one mutant, and restores its source.
    pub(crate) fn judge(&self, mutant: &Mutant, source: &str) -> Result<Outcome> {
        let start = Instant::now();
        let path = self.tree.join(&mutant.file);
        let range = mutant.range.clone();
        let mutated = [&source[..range.start], &mutant.text, &source[range.end..]].concat();
        std::fs::write(&path, mutated).with_context(|| path.display().to_string())?;
        let outcome = self.compile(Stdio::piped()).and_then(|built| match built {
            Err(error) => Ok((Verdict::Unviable, error)),
            Ok(binaries) => Ok(match self.test(&binaries)? {
                Ending::Passed => (Verdict::Survived, String::new()),
                Ending::Failed(test) => (Verdict::Killed, test),
                Ending::TooLate => (Verdict::Timeout, format!("not done after {:.0} s", self.limit.as_secs_f64())),
            }),
        });
        std::fs::write(&path, source).with_context(|| path.display().to_string())?;
        let (verdict, note) = outcome?;
        Ok(Outcome { verdict, note, seconds: start.elapsed().as_secs_f64() })
    }

    /// Makes the tree what the workspace is. Only files that differ are written, so that no more is built than has changed.
    fn copy(&self) -> Result<u64> {
        let names: BTreeSet<String> = sources::names()?.into_iter().filter(|name| Path::new(name).is_file()).collect();
        let mut contents = Vec::new();
        for name in &names {
            let content = std::fs::read(name).with_context(|| name.clone())?;
            let to = self.tree.join(name);
            if std::fs::read(&to).ok().as_ref() != Some(&content) {
                let folder = to.parent().unwrap_or(&self.tree);
                std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
                std::fs::write(&to, &content).with_context(|| to.display().to_string())?;
            }
            let counts = [".rs", ".toml", ".lock"].iter().any(|end| name.ends_with(end));
            if counts && !name.starts_with("crates/xtask/") {
                contents.push((name, hash(&content)));
            }
        }
        remove_others(&self.tree, &self.tree, &names)?;
        Ok(hash(&contents))
    }

    /// Builds the suites; the first error of the compiler where that fails.
    fn compile(&self, words: Stdio) -> Result<Result<Vec<Binary>, String>> {
        let mut binaries = Vec::new();
        let mut words = Some(words);
        for (file, arguments) in SUITES {
            if !self.tree.join(file).exists() {
                continue;
            }
            let output = cargo()
                .current_dir(&self.tree)
                .env("CARGO_TARGET_DIR", &self.build)
                .env("CARGO_PROFILE_RELEASE_INCREMENTAL", "true")
                .args(["test", "--release", "--no-run", "--message-format", "json-render-diagnostics"])
                .args(arguments)
                .stderr(words.take().unwrap_or_else(Stdio::piped))
                .output()
                .context("cargo test")?;
            if !output.status.success() {
                let words = String::from_utf8_lossy(&output.stderr);
                let error = words.lines().find(|line| line.starts_with("error")).unwrap_or("it does not build");
                return Ok(Err(error.to_owned()));
            }
            binaries.extend(String::from_utf8_lossy(&output.stdout).lines().filter_map(binary));
        }
        ensure!(!binaries.is_empty(), "`cargo test --no-run` built no tests");
        Ok(Ok(binaries))
    }

    /// Runs test binaries up to the first failure.
    fn test(&self, binaries: &[Binary]) -> Result<Ending> {
        let start = Instant::now();
        for binary in binaries {
            let output = File::create(&self.output).with_context(|| self.output.display().to_string())?;
            let mut child = Command::new(&binary.program)
                .current_dir(&binary.folder)
                .env("CARGO_MANIFEST_DIR", &binary.folder)
                .env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "true")
                .args(LEFT_OUT.iter().flat_map(|module| ["--skip", module]))
                .stdout(output)
                .stderr(Stdio::null())
                .spawn()
                .with_context(|| binary.program.display().to_string())?;
            let status = loop {
                let status = child.try_wait()?;
                let printed = std::fs::read_to_string(&self.output).unwrap_or_default();
                let failed = printed.lines().find(|line| line.starts_with("test ") && line.ends_with("... FAILED"));
                let late = start.elapsed() > self.limit;
                if status.is_none() && (failed.is_some() || late) {
                    child.kill()?;
                    child.wait()?;
                }
                if let Some(line) = failed {
                    let name = line.trim_start_matches("test ").trim_end_matches(" ... FAILED");
                    return Ok(Ending::Failed(format!("{name} fails")));
                }
                match status {
                    Some(status) => break status,
                    None if late => return Ok(Ending::TooLate),
                    None => std::thread::sleep(Duration::from_millis(50)),
                }
            };
            if !status.success() {
                return Ok(Ending::Failed(format!("the tests end with {status}")));
            }
        }
        Ok(Ending::Passed)
    }
}

/// The test binary of which a line of cargo tells, if it does.
fn binary(line: &str) -> Option<Binary> {
    let message: Value = serde_json::from_str(line).ok()?;
    let program = message["executable"].as_str().filter(|_| message["profile"]["test"] == true)?;
    let folder = Path::new(message["manifest_path"].as_str()?).parent()?;
    Some(Binary { program: program.into(), folder: folder.to_owned() })
}

/// Removes files that the workspace does not have any more.
fn remove_others(root: &Path, folder: &Path, names: &BTreeSet<String>) -> Result<()> {
    for entry in std::fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(root, &path, names)?;
        } else if !path.strip_prefix(root).is_ok_and(|name| name.to_str().is_some_and(|name| names.contains(name))) {
            std::fs::remove_file(&path).with_context(|| path.display().to_string())?;
        }
    }
    Ok(())
}
