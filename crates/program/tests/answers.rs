//! What a terminal is told, and exit codes.

use anyhow::Error;
use comparison::Contradicted;
use motion::Broken;
use program::{Unwritten, exit_code, plain, pretty};

#[test]
fn a_terminal_is_told_nothing_that_it_would_obey() {
    assert_eq!(plain("a\x1b]0;x\x07\u{9b}31m\rb\x7f"), "a\\u{1b}]0;x\\u{7}\\u{9b}31m\\rb\\u{7f}");
    let json = pretty("show", &serde_json::json!({ "title": "a\x1b[31m\u{9b}\x7f" }));
    assert_eq!(plain(&json), json);
    assert!(json.contains(r"a\u001b[31m\u009b\u007f"), "{json}");
    assert_eq!(plain("x\ty\r\nκ µ\n"), "x\ty\r\nκ µ\n");
}

#[test]
fn every_kind_of_error_has_its_exit_code() {
    let contradicted = || Error::from(Contradicted(vec!["scene: one, but another".into()]));
    let errors = [
        Error::msg("bad input"),
        Error::msg("full").context(Unwritten),
        contradicted(),
        contradicted().context("scene"),
        Error::from(Broken::default()),
    ];
    assert_eq!(errors.map(|error| exit_code(&error)), [2, 1, 4, 4, 5]);
}
