//! Members of an ensemble, from a file, from ranges, or from both.

use serde_json::Value;

use crate::support::{command, text};

/// What the program says of `m.csv` with this text: exit code, standard output, standard error.
fn said(file: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("m.csv"), file).expect("a file");
    let ensemble = ["ensemble", "sledge", "-f", "chetaev", "--set", "duration=0.1", "--members", "m.csv"];
    let all = [&ensemble[..], arguments].concat();
    let output = command(&all).current_dir(&folder).output().expect("the command runs");
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

/// The fault that is found in `m.csv` with this text.
#[track_caller]
fn fault(file: &str, arguments: &[&str]) -> String {
    let (code, stdout, stderr) = said(file, arguments);
    assert_eq!((code, stdout.as_str()), (Some(2), ""), "{stderr}");
    stderr.trim_end().strip_prefix("deltaq: ").unwrap_or_else(|| panic!("{stderr}")).to_owned()
}

/// What is set of every member, in the order of its names.
fn members(file: &str, arguments: &[&str]) -> Vec<Vec<(String, f64)>> {
    let (code, stdout, stderr) = said(file, &[arguments, &["--format", "json"]].concat());
    assert_eq!(code, Some(0), "{stderr}");
    let all: Value = serde_json::from_str(&stdout).expect("JSON");
    let set = |member: &Value| -> Vec<(String, f64)> {
        let set = member["set"].as_object().expect("names").iter();
        set.map(|(name, value)| (name.clone(), value.as_f64().expect("a number"))).collect()
    };
    all["members"].as_array().expect("members").iter().map(set).collect()
}

fn row(names: &[&str], values: &[f64]) -> Vec<(String, f64)> {
    names.iter().map(|name| name.to_string()).zip(values.iter().copied()).collect()
}

#[test]
fn a_file_is_read_with_its_marks_and_blanks() {
    let file = "\u{feff}# slopes\n\n \"x'\" , g\r\n1, 2e0\r\n# no\r\n-3,4\n";
    let names = ["x'", "g"];
    assert_eq!(members(file, &[]), [row(&names, &[1.0, 2.0]), row(&names, &[-3.0, 4.0])]);
    for (name, place) in [("x'", "m.csv:3:2"), ("g", "m.csv:3:9")] {
        let told = fault(file, &["--vary", &format!("{name}=0..1:2")]);
        assert_eq!(told, format!("--vary {name}=0..1:2: `{name}` varies already: {place}"));
    }
}

#[test]
fn faults_have_their_place() {
    let fault = |file: &str| fault(file, &[]);
    assert_eq!(fault("g, g\n1,2\n"), "m.csv:1:4: the column `g` is there already, at m.csv:1:1");
    assert_eq!(fault("g,,k\n"), "m.csv:1:3: a name is missing between the commas");
    assert_eq!(fault("g,k\n1,2\n\n3,  ä\n"), "m.csv:4:5: column `k`: `ä` is no finite number");
    assert_eq!(fault("g,k\n1,inf\n"), "m.csv:2:3: column `k`: `inf` is no finite number");
    assert_eq!(fault("g,k\n1\n"), "m.csv:2:1: 1 cells, and the header has 2");
    assert_eq!(fault("g,k\n1,2,3\n"), "m.csv:2:5: 3 cells, and the header has 2");
    assert_eq!(fault("g,k\n"), "m.csv:1:1: no members below the names");
    assert_eq!(fault("\n"), "m.csv: no line that names what varies");
}

#[test]
fn ranges_are_combined_and_end_where_they_should() {
    let (file, names) = ("g\n1\n2\n", ["g", "k", "phi"]);
    let vary = ["--vary", "k=0.1..0.7:3"];
    let both = members(file, &vary);
    assert_eq!(both.len(), 6);
    assert_eq!((&both[2], &both[3]), (&row(&names[..2], &[1.0, 0.7]), &row(&names[..2], &[2.0, 0.1])));
    let vary = [&vary[..], &["--vary", "phi=3..5:1"]].concat();
    let all = members(file, &vary);
    assert!(all.len() == 6 && all.iter().all(|member| member[2] == ("phi".into(), 3.0)), "{all:?}");
    let told = fault(file, &[&vary[..], &["--vary", "g=0..1:2"]].concat());
    assert_eq!(told, "--vary g=0..1:2: `g` varies already: m.csv:1:1");
    let told = fault(file, &[&vary[..], &["--vary", "x=0..1:999999"]].concat());
    assert!(told.contains("5999994 members; at most 1000000"), "{told}");
}
