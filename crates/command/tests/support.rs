//! Running the program.

use std::process::{Command, Output};

/// The program with these arguments, to be started.
pub fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_deltaq"));
    command.args(arguments);
    command
}

/// What the program did.
pub fn deltaq(arguments: &[&str]) -> Output {
    command(arguments).output().expect("the command runs")
}

/// What it wrote to one of its streams.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// Standard output and standard error of a program that has to end with this code.
#[track_caller]
pub fn answer(arguments: &[&str], code: i32) -> (String, String) {
    let output = deltaq(arguments);
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
