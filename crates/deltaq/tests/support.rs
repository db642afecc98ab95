//! Running a program of the workspace, which is `PROGRAM` of the tests that say this is a part of them.

use std::process::{Command, Output};

use crate::PROGRAM;

/// The program with these arguments, to be started.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(arguments);
    command
}

/// What the program did.
pub fn run(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the command runs")
}

/// What it wrote to one of its streams.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// Standard output and standard error of a program that has to end with this code.
#[track_caller]
pub fn answer(arguments: &[&str], code: i32) -> (String, String) {
    let output = run(arguments);
    let (stdout, stderr) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    assert!(!stderr.contains("panicked"), "{arguments:?}: {stderr}");
    (stdout, stderr)
}

/// The program must refuse with all these words and print nothing.
#[track_caller]
pub fn refused(arguments: &[&str], words: &[&str]) {
    let (stdout, stderr) = answer(arguments, 2);
    println!("{arguments:?}\n    {}", stderr.trim().replace('\n', "\n    "));
    assert!(stdout.is_empty(), "{arguments:?}: a partial answer: {stdout}");
    for word in words {
        assert!(stderr.contains(word), "{arguments:?}: `{word}` is not in {stderr}");
    }
}

/// What the program does in a folder of its own; the folder must be as empty afterwards.
#[track_caller]
pub fn elsewhere(arguments: &[&str]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    let output = command(arguments).current_dir(&folder).output().expect("the command runs");
    assert_eq!(std::fs::read_dir(&folder).expect("a folder").count(), 0, "{arguments:?} left something behind");
    output
}

/// Every call of a list must be refused: its words, `=>`, and those of the error, between bars.
#[track_caller]
pub fn all_refused(calls: &str) {
    for row in calls.lines().filter(|row| !row.is_empty() && !row.starts_with('#')) {
        let (call, words) = row.split_once(" =>").unwrap_or_else(|| panic!("`{row}` in refusals.txt"));
        let words: Vec<&str> = words.split('|').map(str::trim).collect();
        refused(&call.split(' ').collect::<Vec<_>>(), &words);
    }
}

/// The names of the commands that the help lists.
pub fn commands() -> Vec<String> {
    let (help, _) = answer(&["--help"], 0);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = listed
        .filter_map(|line| line.strip_prefix("  ")?.split(' ').next().map(String::from))
        .filter(|name| !name.is_empty());
    names.collect()
}

/// Of each of these calls, an answer that cannot be written is an error.
#[track_caller]
pub fn none_is_lost(calls: &[&[&str]]) {
    for arguments in calls {
        let full = std::fs::File::options().write(true).open("/dev/full").expect("the device that is always full");
        let output = command(arguments).stdout(full).output().expect("the command runs");
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
        assert!(stderr.contains("cannot write the answer") && stderr.contains("No space left"), "{stderr}");
    }
}

/// Of each of these calls, a reader that has seen enough and closes the pipe is no error.
#[track_caller]
pub fn all_may_be_left(calls: &[&[&str]]) {
    for arguments in calls {
        let mut child = command(arguments)
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("it runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("the command ends");
        assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), ""), "{arguments:?}");
    }
}
