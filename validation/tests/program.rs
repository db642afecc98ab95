//! The program as a person meets it, run as a process: where answers and files go.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::support::{all_may_be_left, all_refused, answer, commands, elsewhere, none_is_lost, refused, text};

/// Reports of the main job.
const REPORTS: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/main-job");

/// Reference motions.
const TABLES: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/benchmark");

/// A page on integrals.
const INTEGRALS: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/integrals");

/// A page on test problems.
const IVP: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/ivp");

/// A page on films.
const FILMS: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/films");

/// One call of every command, and of none, but of `reports`, which is the whole main job.
const ANSWERS: [&[&str]; 10] = [
    &["--scenes", "bowl", "--quiet", "--out", REPORTS],
    &["random", "--count", "1", "--quiet"],
    &["bench", "bowl", "--seconds", "0.0001", "--quiet"],
    &["benchmark", "--systems", "particle", "--starts", "1", "--quiet", "--out", TABLES],
    &["films", "--scenes", "appell-hamel", "--quiet", "--out", FILMS],
    &["ivp", "--problems", "car-axis", "--quiet", "--out", IVP],
    &["integrals", "--scenes", "particle", "--parts", "scenes", "--quiet", "--out", INTEGRALS],
    &["scaling", "--longest", "1", "--repeats", "1", "--quiet"],
    &["stability", "--case", "blow-up", "--quiet"],
    &["--help"],
];

#[test]
fn every_command_is_called() {
    let commands = commands();
    assert!(commands.iter().any(|name| name == "stability"), "{commands:?}");
    for command in commands.into_iter().filter(|name| !["reports", "help"].contains(&name.as_str())) {
        assert!(ANSWERS.iter().any(|call| call[0] == command), "{command}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_an_error() {
    none_is_lost(&ANSWERS);
    refused(&["random", "--count", "1", "--quiet", "--log", "/dev/full"], &["is not a file"]);
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    all_may_be_left(&ANSWERS);
}

#[test]
fn outside_of_its_sources_it_explains_itself() {
    for arguments in [&[][..], &["--scenes", "sledge"]] {
        let output = elsewhere(arguments);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        for words in ["say what to do", "--out DIR", "Usage: evidence", "random", "stability"] {
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

#[cfg(unix)]
#[test]
fn an_installed_program_makes_its_environments_in_the_users_cache() {
    use std::os::unix::fs::PermissionsExt;
    let home = tempfile::tempdir().expect("a folder");
    let at = |path: &str| home.path().join(path);
    let installed = at("bin/evidence");
    fs::create_dir_all(at("bin")).expect("a folder");
    fs::create_dir_all(at("work")).expect("a folder");
    // a file that was written just now may be busy: a copy only where there is no other way
    let program = env!("CARGO_BIN_EXE_evidence");
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

#[test]
fn files_of_the_main_job_are_counted() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("UTF-8");
    let told =
        answer(&["--quiet", "--scenes", "heisenberg", "--sections", "scenes", "--out", path, "--format", "json"], 0).0;
    let told: Value = serde_json::from_str(&told).expect("JSON");
    fn count(folder: &Path) -> usize {
        let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
        entries.map(|path| if path.is_dir() { count(&path) } else { 1 }).sum()
    }
    // the list of files is one more
    assert_eq!(told["files"], count(folder.path()) - 1);
}

#[test]
fn results_do_not_depend_on_threads() {
    let random = ["random", "--count", "12", "--format", "json", "--quiet", "--threads"];
    let of = |threads| answer(&[&random[..], &[threads]].concat(), 0).0;
    assert_eq!(of("1"), of("3"));
    refused(&["random", "--threads", "0"], &["--threads"]);
}

#[test]
fn the_page_of_the_evidence_is_true() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/evidence.md");
    trycmd::TestCases::new().case(&page).run();
}

#[test]
fn bad_input_is_refused_in_words() {
    all_refused(include_str!("refusals.txt"));
}
