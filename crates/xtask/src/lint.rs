//! clippy and rustdoc on our own crates, beside dependencies as the build left them.
//!
//! `cargo clippy` and `cargo doc` check every dependency once more, nine tenths of their work. Here cargo
//! builds the workspace with this program as rustc for our own crates (`RUSTC_WORKSPACE_WRAPPER`): each call
//! goes to clippy-driver and asks for metadata, not code; rustdoc reads what is not a test.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result};

use crate::tools::{ALL, Outcome, cargo, succeed, target};

/// Set for the calls that are to be linted: the folder of the tools.
const TOOLS: &str = "XTASK_LINT_TOOLS";

/// Lints every target of the workspace.
pub(crate) fn check() -> Result<Outcome> {
    let program = std::env::current_exe().context("this program")?;
    let cargo_program = PathBuf::from(cargo().get_program());
    let tools = cargo_program.parent().unwrap_or(Path::new(""));
    let mut build = cargo();
    build.arg("build").args(ALL).arg("--all-targets");
    build.env("RUSTC_WORKSPACE_WRAPPER", program).env(TOOLS, tools).env("CARGO_TARGET_DIR", target()?);
    // the separator is clippy-driver's own
    build.env("CLIPPY_ARGS", "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__");
    succeed(&mut build)
}

/// The call instead of rustc, if this is one.
pub(crate) fn in_place_of_rustc() -> Option<ExitCode> {
    let tools = PathBuf::from(std::env::var_os(TOOLS)?);
    let call: Vec<OsString> = std::env::args_os().skip(1).collect();
    let failure = |error: std::io::Error| {
        eprintln!("{}: {error}", tools.display());
        ExitCode::FAILURE
    };
    Some(lint(&tools, &call).unwrap_or_else(failure))
}

fn lint(tools: &Path, call: &[OsString]) -> std::io::Result<ExitCode> {
    let words: Vec<String> = call.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let run = |command: &mut Command| command.status().map(|status| if status.success() { 0 } else { 1 });
    // cargo also asks rustc for its version and its targets
    let Some(source) = words.iter().find(|word| word.ends_with(".rs")) else {
        return Ok(run(Command::new(&call[0]).args(&call[1..]))?.into());
    };
    // a build script is run, and so is a macro
    let runs = follows(&words, "--crate-name", "build_script_build") || follows(&words, "--crate-type", "proc-macro");
    let metadata = if runs { words.clone() } else { without_code(&words) };
    let code = run(Command::new(tools.join("clippy-driver")).args(&metadata))?;
    let documented = ["lib", "bin"].iter().any(|kind| follows(&words, "--crate-type", kind));
    if code != 0 || !documented || words.iter().any(|word| word == "--test") {
        return Ok(code.into());
    }
    let folder = std::env::var_os("CARGO_TARGET_DIR").map(PathBuf::from).unwrap_or_default().join("doc-check");
    let mut rustdoc = Command::new(tools.join("rustdoc"));
    rustdoc.arg(source).args(for_rustdoc(&metadata)).arg("-Dwarnings").arg("--out-dir").arg(folder);
    Ok(run(&mut rustdoc)?.into())
}

fn follows(words: &[String], option: &str, value: &str) -> bool {
    words.windows(2).any(|pair| pair[0] == option && pair[1] == value)
}

/// The call with metadata instead of code, which is then all that there is of our own crates.
fn without_code(words: &[String]) -> Vec<String> {
    let of_word = |word: &String| match word.strip_prefix("--emit=") {
        Some(_) => "--emit=dep-info,metadata".to_owned(),
        None => match word.strip_suffix(".rlib").map(|library| format!("{library}.rmeta")) {
            Some(metadata) if metadata.split_once('=').is_some_and(|(_, path)| Path::new(path).exists()) => metadata,
            _ => word.clone(),
        },
    };
    words.iter().map(of_word).collect()
}

/// What rustdoc takes of a call of rustc.
fn for_rustdoc(words: &[String]) -> Vec<String> {
    let pair =
        |option: &str| matches!(option, "--crate-name" | "--crate-type" | "--cfg" | "--check-cfg" | "--extern" | "-L");
    let pairs = words.windows(2).filter(|words| pair(&words[0])).flat_map(<[String]>::to_vec);
    pairs.chain(words.iter().filter(|word| word.starts_with("--edition=")).cloned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_call_of_rustc_is_rewritten() {
        let words = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
        let call = words(
            "rustc --crate-name a --edition=2024 src/lib.rs --crate-type lib --emit=dep-info,metadata,link -C opt-level=3 --extern b=/none/libb.rlib",
        );
        let rewritten = without_code(&call);
        assert!(rewritten.contains(&"--emit=dep-info,metadata".to_owned()), "{rewritten:?}");
        assert!(rewritten.contains(&"b=/none/libb.rlib".to_owned()), "{rewritten:?}");
        let expected = words("--crate-name a --crate-type lib --extern b=/none/libb.rlib --edition=2024");
        assert_eq!(for_rustdoc(&call), expected);
        assert!(follows(&call, "--crate-type", "lib") && !follows(&call, "--crate-type", "bin"));
    }
}
