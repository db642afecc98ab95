//! Where answers and files go: nothing is lost in silence, and nothing is written where nobody asked for it.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

use crate::support::{answer, command, refused, text};

/// Reports of the main job.
const REPORTS: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/reports");

/// One call of every command, and of none, but of `reports`, which is the whole main job.
const ANSWERS: [&[&str]; 19] = [
    &["new"],
    &["check", "sledge"],
    &["--scenes", "bowl", "--quiet", "--out", REPORTS],
    &["solve", "sledge", "-f", "chetaev", "--times", "0,1"],
    &["list"],
    &["show", "sledge"],
    &["compare", "bowl", "--set", "duration=1"],
    &["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2"],
    &["linearize", "bicycle"],
    &["random", "--count", "1", "--quiet"],
    &["explore", "sledge", "--out", concat!(env!("CARGO_TARGET_TMPDIR"), "/explore.html")],
    &["prove", "sledge", "--out", "-"],
    &["bench", "bowl", "--set", "duration=0.01", "--seconds", "0.0001", "--quiet"],
    &["scaling", "--longest", "1", "--repeats", "1", "--quiet"],
    &["stability", "--case", "blow-up", "--quiet"],
    &["completions", "bash"],
    &["man"],
    &["help", "solve"],
    &["--help"],
];

#[test]
fn every_command_is_called() {
    let (help, _) = answer(&["--help"], 0);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let commands: Vec<&str> = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next()).collect();
    assert!(commands.contains(&"solve"), "{help}");
    for command in commands.iter().filter(|command| !command.is_empty() && **command != "reports") {
        assert!(ANSWERS.iter().any(|call| call[0] == *command), "{command}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_an_error() {
    for arguments in ANSWERS {
        let full = fs::File::options().write(true).open("/dev/full").expect("the device that is always full");
        let output = command(arguments).stdout(full).output().expect("the command runs");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(stderr.contains("cannot write the answer") && stderr.contains("No space left"), "{stderr}");
    }
    for file in [&["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2"][..], &["prove", "sledge"]] {
        refused(&[file, &["--out", "/dev/full"]].concat(), &["cannot write", "/dev/full", "No space left"]);
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    for arguments in ANSWERS {
        let mut child = command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("the command ends");
        assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), ""), "{arguments:?}");
    }
}

/// What the program does in a folder of its own; the folder must be as empty afterwards.
#[track_caller]
fn elsewhere(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let output = command(arguments).current_dir(&folder).output().expect("the command runs");
    assert_eq!(fs::read_dir(&folder).expect("a folder").count(), 0, "{arguments:?} left something behind");
    output
}

#[test]
fn outside_of_its_sources_it_explains_itself() {
    for arguments in [&[][..], &["--scenes", "sledge"]] {
        let output = elsewhere(arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        for words in ["say what to do", "--out DIR", "Usage: deltaq", "solve", "compare"] {
            assert!(stderr.contains(words), "`{words}` is not in {stderr}");
        }
    }
    // a folder that is named is a folder that is wanted
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("reports");
    let named = ["--scenes", "bowl", "--quiet", "--out", out.to_str().expect("UTF-8")];
    assert!(elsewhere(&named).status.success());
    assert!(out.join("scenes/bowl.md").exists());
}

#[test]
fn built_in_scenes_are_known_everywhere() {
    for scene in ["sledge", "trailer", "n-trailer-3"] {
        let output = elsewhere(&["solve", scene, "-f", "chetaev", "--times", "0"]);
        assert!(output.status.success(), "{scene}: {}", text(&output.stderr));
    }
}

#[cfg(unix)]
#[test]
fn an_installed_program_makes_its_environments_in_the_users_cache() {
    use std::os::unix::fs::PermissionsExt;
    let home = tempfile::tempdir().expect("a folder");
    let at = |path: &str| home.path().join(path);
    let installed = at("bin/deltaq");
    fs::create_dir_all(at("bin")).expect("a folder");
    fs::create_dir_all(at("work")).expect("a folder");
    // a file that was written just now may be busy: a copy only where there is no other way
    let program = env!("CARGO_BIN_EXE_deltaq");
    fs::hard_link(program, &installed).or_else(|_| fs::copy(program, &installed).map(drop)).expect("a copy");
    // an interpreter that is new enough and makes no environment
    fs::write(at("bin/python3"), "#!/bin/sh\ntest \"$1\" = -c\n").expect("written");
    fs::set_permissions(at("bin/python3"), fs::Permissions::from_mode(0o755)).expect("executable");
    let output = std::process::Command::new(&installed)
        .args(["--scenes", "bowl", "--sections", "scenes,casadi", "--quiet", "--out", "reports"])
        .current_dir(at("work"))
        .env("PATH", format!("{}:/usr/bin:/bin", at("bin").display()))
        .env("XDG_CACHE_HOME", at("cache"))
        .output()
        .expect("the command runs");
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("python3 -m venv"), "{}", text(&output.stdout));
    assert!(at("cache/deltaq").is_dir() && at("work/reports/scenes/bowl.md").exists());
    let names = |folder: &Path| fs::read_dir(folder).expect("a folder").count();
    assert_eq!(names(&at("work")), 1, "something besides the reports");
}

#[test]
fn what_cannot_be_written_to_a_folder_is_an_error() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let out = file.path().to_str().expect("UTF-8");
    for arguments in [&["random", "--index", "0"][..], &["stability", "--case", "blow-up", "--quiet"]] {
        refused(&[arguments, &["--out", out]].concat(), &["cannot create"]);
    }
}
