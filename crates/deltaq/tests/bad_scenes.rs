//! Wrong scene files through the command: a clear error with its place, exit code 2, no standard output.

use std::io::Write;
use std::process::Output;
use std::time::Instant;

use crate::support::{self, run};

const GOOD: &str = include_str!("good.toml");

const LAGRANGIAN: &str = "m*(x'^2 + y'^2 + z'^2)/2";

struct Answer {
    output: Output,
    path: String,
    seconds: f64,
}

fn solve(bytes: &[u8]) -> Answer {
    let mut file = tempfile::Builder::new().suffix(".toml").tempfile().expect("a file");
    file.write_all(bytes).expect("written");
    let path = file.path().to_str().expect("UTF-8").to_string();
    let clock = Instant::now();
    let arguments = ["solve", &path, "-f", "chetaev"];
    let output = run(&arguments);
    Answer { output, path, seconds: clock.elapsed().as_secs_f64() }
}

/// The file must be refused with all these words; returns the error, with `FILE` for the name of the file.
#[track_caller]
fn refused_bytes(bytes: &[u8], words: &[&str]) -> String {
    let Answer { output, path, seconds } = solve(bytes);
    let stderr = String::from_utf8_lossy(&output.stderr).replace(&path, "FILE");
    let short: String = stderr.chars().take(600).collect();
    println!("{short}    exit {:?} after {seconds:.2} s", output.status.code());
    assert_eq!(output.status.code(), Some(2), "{short}");
    assert!(!stderr.contains("panicked"), "{short}");
    assert!(output.stdout.is_empty(), "a partial answer");
    assert!(stderr.contains("FILE"), "the file is not named: {short}");
    assert!(stderr.len() < 4000, "{} characters of error: {short}", stderr.len());
    assert!(seconds < 10.0, "{seconds} s");
    for word in words {
        assert!(stderr.contains(word), "`{word}` is not in: {short}");
    }
    stderr
}

/// The good scene with one replacement must be refused at this line and column.
#[track_caller]
fn refused(old: &str, new: &str, place: &str, words: &[&str]) {
    assert!(GOOD.contains(old), "`{old}` is not in the scene");
    let stderr = refused_bytes(GOOD.replacen(old, new, 1).as_bytes(), words);
    assert!(stderr.contains(&format!("FILE:{place}")), "not at {place}: {stderr}");
}

#[track_caller]
fn accepted(text: &str) {
    let Answer { output, .. } = solve(text.as_bytes());
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(!output.stdout.is_empty());
}

#[test]
fn the_scene_behind_these_tests_is_good() {
    accepted(GOOD);
}

#[test]
fn misspelt_and_undefined_names_are_pointed_at() {
    refused("lagrangian ", "lagrangain ", "12:1", &["lagrangain", "lagrangian"]);
    refused("[parameters]", "[parametres]", "3:2", &["parametres", "parameters"]);
    refused("m*(x'^2", "n*(x'^2", "12:16", &["undefined name `n`"]);
    refused("y*x'\"]", "w*x'\"]", "13:22", &["undefined name `w`"]);
    refused("\"y'\" = 0.5", "\"q'\" = 0.5", "17:1", &["q'"]);
    refused("m*(x'^2", "sine(x)*(x'^2", "12:16", &["sine"]);
    refused("rates = { z", "rates = { zz", "21:11", &["zz"]);
    refused("duration = 2", "duratoin = 2", "24:1", &["duratoin", "duration"]);
    refused("x'^2 + y'^2", "x'^2 + + *y'^2", "12:", &[]);
    refused("z'^2)/2", "z'^2/2", "12:", &[]);
}

#[test]
fn starts_that_are_missing_or_contradictory_are_refused() {
    refused("start = 0 }\ny", "strt = 0 }\ny", "7:", &["strt"]);
    refused(", start = -1", "", "8:1", &["`start` is missing in [coordinates.y]"]);
    refused("\"y'\" = 0.5\n", "", "15:", &["y'"]);
    refused("\"y'\" = 0.5", "\"y'\" = 0.5\n\"z'\" = 4.0", "15:", &["constraint"]);
    refused("start = -1", "start = \"x'\"", "8:", &[]);
    let without = GOOD.replace("[start.velocities]\n\"x'\" = 1.0\n\"y'\" = 0.5\n", "");
    refused_bytes(without.as_bytes(), &["x'"]);
}

#[test]
fn dependent_constraints_are_refused() {
    let (start, end) = (GOOD.find("[removal").expect("there"), GOOD.find("[run]").expect("there"));
    let good = GOOD.replace(&GOOD[start..end], "");
    accepted(&good);
    // twice the same, which follows from the other; as much at the start only, no velocity at all, positions
    // on which the start is not
    accepted(&good.replacen("\"z' - y*x'\"", "\"z' - y*x'\", \"2*z' - 2*y*x'\"", 1));
    for (bad, words) in [
        ("\"z' - y*x'\", \"z' - y*x' + x*y'\"", "dependent"),
        ("\"z' - y*x'\", \"0*x'\"", ""),
        ("\"z - y*x - 1\"", "positions"),
    ] {
        let stderr = refused_bytes(good.replacen("\"z' - y*x'\"", bad, 1).as_bytes(), &[words]);
        assert!(stderr.contains("FILE:13:"), "not in line 13: {stderr}");
    }
}

#[test]
fn mass_matrix_has_to_be_regular_on_the_kernel_only() {
    // no y' in L, and the constraint leaves y free
    refused("x'^2 + y'^2 + z'^2", "x'^2 + z'^2", "12:1", &["mass matrix"]);
    // no z' in L: the constraint supplies it
    accepted(&GOOD.replace("x'^2 + y'^2 + z'^2", "x'^2 + y'^2"));
}

#[test]
fn a_wrong_removal_is_refused_with_its_residual() {
    refused("z = \"y*x'\"", "z = \"-y*x'\"", "19:", &["along-x", "constraint 1", "residual"]);
    refused("parameters = [\"x\", \"y\"]", "parameters = [\"x\"]", "", &[]);
}

#[test]
fn numbers_that_are_none_are_refused() {
    for bad in ["nan", "inf", "-inf", "+nan"] {
        refused("m = 1.0", &format!("m = {bad}"), "4:", &["finite"]);
        refused("start = -1", &format!("start = {bad}"), "8:", &["finite"]);
        refused("\"x'\" = 1.0", &format!("\"x'\" = {bad}"), "16:", &["finite"]);
        refused("duration = 2", &format!("duration = {bad}"), "24:", &["finite"]);
    }
    refused("m = 1.0", "m = 1e999", "4:", &[]);
    refused("m = 1.0", "m = 0.0", "12:1", &["mass matrix"]);
    refused("m = 1.0", "m = \"1/0\"", "4:", &[]);
    refused("start = -1", "start = \"1/x\"", "8:", &[]);
    for bad in ["0", "-1", "-0.0"] {
        refused("duration = 2", &format!("duration = {bad}"), "24:", &["duration"]);
    }
}

#[test]
fn empty_files_and_nonsense_are_refused() {
    refused_bytes(b"", &["empty"]);
    refused_bytes(b"\n\n  \n", &["empty"]);
    refused_bytes(b"# nothing but a remark\n", &["empty"]);
    refused_bytes(b"\xff\xfe\x00bad", &["UTF-8"]);
    refused_bytes(b"\0\0\0\0", &[]);
    refused_bytes(b"[a]\n[a]\n", &["2"]);
    refused_bytes(b"title = \"never closed", &["1:"]);
}

#[test]
fn ten_megabytes_of_nonsense_are_refused_unread() {
    // a small generator, so that nothing repeats
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let nonsense: Vec<u8> = (0..10_000_000)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            b" \n=[]{}\"'.,#abcxyz0123456789"[(state % 28) as usize]
        })
        .collect();
    refused_bytes(&nonsense, &["bytes"]);
    refused_bytes(&nonsense[..900_000], &[]);
    // one line
    let line: Vec<u8> = nonsense[..900_000].iter().map(|&b| if b == b'\n' { b' ' } else { b }).collect();
    refused_bytes(&line, &[]);
}

#[test]
fn nested_formulas_are_refused_and_overflow_no_stack() {
    for (open, close) in [("(", ")"), ("-(", ")"), ("sin(", ")"), ("-", ""), ("x^", ""), ("x*-", "")] {
        let depth = 880_000 / (open.len() + close.len());
        let formula = format!("{}x{}", open.repeat(depth), close.repeat(depth));
        let stderr = refused_bytes(GOOD.replacen(LAGRANGIAN, &formula, 1).as_bytes(), &[]);
        assert!(stderr.contains("FILE:12:"), "not in line 12: {stderr}");
    }
}

#[test]
fn nested_tables_are_refused_and_overflow_no_stack() {
    let depth = 450_000;
    refused_bytes(format!("title = {}{}", "[".repeat(depth), "]".repeat(depth)).as_bytes(), &["FILE:1:"]);
    refused_bytes("[".repeat(900_000).as_bytes(), &["FILE:1:"]);
    refused_bytes(format!("title = {}", "{a=".repeat(300_000)).as_bytes(), &["FILE:1:"]);
    refused_bytes(format!("a{} = 1", ".a".repeat(depth)).as_bytes(), &[]);
}

#[test]
fn a_long_flat_sum_is_no_nesting() {
    let sum = format!("{LAGRANGIAN}{}", " + 0*x".repeat(2_000));
    accepted(&GOOD.replacen(LAGRANGIAN, &sum, 1));
}

#[test]
fn faults_of_all_files_are_counted() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str, before: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("{before}{GOOD}")).expect("written");
        path.to_str().expect("UTF-8").to_string()
    };
    let (good, one, two) = (path("good", ""), path("one", "colour = 1\n"), path("two", "colour = 1\nshade = 2\n"));
    support::refused(&["check", &one], &["1 fault"]);
    support::refused(&["check", &one, &good, &two], &["3 faults", "`colour`", "`shade`"]);
}

/// Names of the user's own have tables or numbers of a kind, as the reader says.
#[test]
fn the_schema_says_what_stands_under_names_of_ones_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    support::answer(&["new", "--schema", path.to_str().expect("UTF-8")], 0);
    let schema = std::fs::read_to_string(path).expect("a schema");
    let schema: serde_json::Value = serde_json::from_str(&schema).expect("JSON");
    let under = |key: &str| &schema["properties"][key]["additionalProperties"];
    assert_eq!(under("parameters"), &serde_json::json!({ "type": ["number", "string"] }));
    assert!(under("coordinates")["properties"]["start"].is_object(), "{schema}");
    assert_eq!(schema["additionalProperties"], false);
}
