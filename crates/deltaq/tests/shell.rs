//! What the program is to a shell: a version, completions, a manual, standard input, threads.

use std::io::Write;
use std::path::Path;
use std::process::{Output, Stdio};

use crate::support::{answer, command, refused, text};

const SLEDGE: &str = include_str!("../../scene/scenes/sledge.toml");

/// What the program does with this on its standard input.
fn given(arguments: &[&str], input: &str) -> Output {
    let mut child = command(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command runs");
    child.stdin.take().expect("a pipe").write_all(input.as_bytes()).expect("written");
    child.wait_with_output().expect("the command ends")
}

#[test]
fn the_version_has_the_commit() {
    let (told, _) = answer(&["--version"], 0);
    let version = concat!("deltaq ", env!("CARGO_PKG_VERSION"));
    let rest = told.trim_end().strip_prefix(version).expect("name and version");
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')'));
    assert!(commit.is_none_or(|commit| commit.len() > 6 && u128::from_str_radix(commit, 16).is_ok()), "{told}");
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../.git").exists();
    assert_eq!(commit.is_some(), repository, "{told}");
}

#[test]
fn shells_complete_commands_and_options() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let (script, _) = answer(&["completions", shell], 0);
        assert!(["ensemble", "formulation", "radau5"].iter().all(|word| script.contains(word)), "{shell}: {script}");
    }
    refused(&["completions", "tcsh"], &["tcsh", "zsh"]);
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    for (arguments, words) in [(&["man"][..], r"deltaq\-solve(1)"), (&["man", "solve"], r"\-\-formulation")] {
        let (page, _) = answer(arguments, 0);
        assert!(page.contains(".TH deltaq") && page.contains(words), "{page}");
    }
    refused(&["man", "solv"], &["`solv`"]);
}

#[test]
fn a_scene_is_read_from_standard_input() {
    let solve = ["-f", "chetaev", "--times", "0,1"];
    let ensemble = ["-f", "chetaev", "--vary", "phi=0..0.3:3"];
    for (name, options) in [("solve", solve), ("ensemble", ensemble)] {
        let output = given(&[&[name, "-"], &options[..]].concat(), SLEDGE);
        let (expected, _) = answer(&[&[name, "sledge"], &options[..]].concat(), 0);
        assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), expected), "{}", text(&output.stderr));
    }
    let output = given(&["show", "-"], &SLEDGE.replace("u'*sin(phi)", "u'*sin(psi)"));
    let complaint = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    assert!(complaint.contains("stdin:") && complaint.contains("undefined name `psi`"), "{complaint}");
}

#[test]
fn results_do_not_depend_on_threads() {
    let sweep = ["compare", "turntable", "--sweep", "psi'=0.3:0.9:6", "--set", "duration=1", "--quiet", "--threads"];
    let of = |threads| answer(&[&sweep[..], &[threads]].concat(), 0).0;
    assert_eq!(of("1"), of("3"));
    refused(&["solve", "sledge", "--threads", "0"], &["--threads"]);
}
