//! Where the program itself is at fault: broken on purpose at a border, which no user comes near.

use crate::support::{command, text};

/// Exit code, standard output and standard error of a call that breaks at this border.
fn broken(border: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = command(arguments).env("DELTAQ_PANICS", border).output().expect("the command runs");
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn a_panic_is_one_line_with_its_place_and_a_code_of_its_own() {
    let (code, out, error) = broken("program", &["check", "sledge"]);
    assert_eq!((code, out.as_str()), (Some(5), ""));
    assert!(error.starts_with("deltaq: broken on purpose, at ") && error.contains("broken.rs:"), "{error}");
    assert!(error.ends_with(": this is a fault of deltaq; please report it\n"), "{error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    // on other threads, with the scene that was read before
    let (code, out, error) = broken("thread", &["compare", "sledge", "--sweep", "k=0.5:1:2", "--threads", "2"]);
    assert_eq!((code, out.lines().count(), error.lines().count()), (Some(5), 1, 1), "{error}");
    assert!(
        error.starts_with("deltaq: broken on purpose, at ") && error.contains(", scene sledge, digest "),
        "{error}"
    );
}

/// The digest is that of the text and of the numbers that are set.
#[test]
fn the_scene_is_named_with_its_digest() {
    let digests = |set: &str| -> Vec<String> {
        let (_, out, _) = broken("row", &["compare", "sledge", "--sweep", "k=0.5:1:2", "--set", set]);
        let parts = out.split("scene sledge, digest ").skip(1);
        parts.map(|rest| rest.chars().take_while(char::is_ascii_hexdigit).collect()).collect()
    };
    let [found, again, other] = ["g=9", "g=9", "g=10"].map(digests);
    assert!(found.len() == 2 && found.iter().all(|digest| digest.len() == 16), "{found:?}");
    assert!(found == again && found != other, "{found:?} {other:?}");
}

#[test]
fn rows_that_break_have_their_cause_and_the_others_stay() {
    let cause = "broken on purpose, at ";
    let sweep = ["compare", "sledge", "--sweep", "k=0.5:1:2"];
    let (code, out, error) = broken("row", &sweep);
    assert_eq!((code, error.as_str()), (Some(0), ""));
    let rows: Vec<&str> = out.lines().skip(1).collect();
    assert!(rows.len() == 2 && rows.iter().all(|row| row.contains(cause) && row.contains("scene sledge")), "{out}");

    let ensemble = ["ensemble", "sledge", "-f", "chetaev", "--vary", "k=0.5..1:3", "--times", "0.1"];
    let (code, out, _) = broken("row", &ensemble);
    assert_eq!(code, Some(3));
    assert!(out.lines().skip(1).count() == 3 && out.lines().skip(1).all(|row| row.contains(cause)), "{out}");

    // of members that broke in company each is alone, and what it is without the others
    let whole = command(&ensemble).output().expect("the command runs");
    let (code, out, error) = broken("lanes", &ensemble);
    assert_eq!((code, error.as_str()), (Some(0), ""));
    let numbers = |out: &str| -> Vec<f64> {
        let cells = out.lines().skip(1).flat_map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        cells.filter_map(|cell| cell.parse().ok()).collect()
    };
    let (whole, alone) = (numbers(&text(&whole.stdout)), numbers(&out));
    assert_eq!((whole.len(), whole.len()), (alone.len(), 3 * 11));
    assert!(whole.iter().zip(&alone).all(|(one, two)| (one - two).abs() < 1e-9), "{out}");
}

/// As in all checks: nothing is caught.
#[test]
fn a_check_sees_a_panic() {
    let (code, _, _) = broken("through", &["check", "sledge"]);
    assert_eq!(code, Some(0));
}
