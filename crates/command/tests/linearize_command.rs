//! `deltaq linearize`, as a user runs it.

use serde_json::Value;

use crate::support::{answer, refused};

/// Straight ahead, in a range in which it becomes stable.
const SWEEP: [&str; 5] = ["linearize", "bicycle", "--free=lean,steer", "--sweep", "v=4:5:2"];

#[test]
fn every_format_has_the_same_numbers() {
    let with = |format: &str| answer(&[&SWEEP[..], &["--format", format]].concat(), 0).0;
    let value: Value = serde_json::from_str(&with("json")).expect("JSON");
    let points = value["points"].as_array().expect("points");
    let listed = points.iter().flat_map(|point| {
        let eigenvalues = point["eigenvalues"].as_array().expect("eigenvalues").iter();
        eigenvalues.map(|e| ["real", "imaginary", "error"].map(|part| e[part].as_f64().expect("a number")))
    });
    let csv = with("csv");
    let rows = csv.lines().skip(1).map(|line| line.split(',').skip(1).map(|x| x.parse().expect("a number")).collect());
    let rows: Vec<Vec<f64>> = rows.collect();
    assert_eq!((csv.lines().next(), rows.len()), (Some("v,real,imaginary,error"), 8));
    // the reader of JSON may lose the last digit
    let same = |(row, e): (&Vec<f64>, [f64; 3])| row.iter().zip(e).all(|(a, b)| (a - b).abs() <= 1e-15 * a.abs());
    assert!(rows.iter().zip(listed).all(same), "{csv}");
    // m/s, the weave speed of the paper
    let weave = value["changes"][0]["value"].as_f64().expect("a change");
    assert!((weave - 4.292382536).abs() < 1e-9, "{weave}");
    assert!(with("table").contains("Stability changes at v = 4.292382536"));
}

#[test]
fn a_page_comes_with_its_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("text");
    answer(&[&SWEEP[..], &["--out", path]].concat(), 0);
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect(name);
    assert!(read("bicycle-eigenvalues.md").contains("(bicycle-eigenvalues.svg)"));
    assert!(roxmltree::Document::parse(&read("bicycle-eigenvalues.svg")).is_ok());
}

#[test]
fn what_is_not_steady_is_frozen_found_or_refused() {
    let disc = ["linearize", "falling-disc"];
    refused(&disc, &["is no steady motion of chetaev-reduced"]);
    assert!(answer(&[&disc[..], &["--find"]].concat(), 0).0.contains("A steady motion"));
    assert!(answer(&[&disc[..], &["--at", "0.5"]].concat(), 0).0.contains("**Frozen at an instant"));
    for (more, said) in [
        (&["--find", "--free", "psi"][..], "no rate depends on `psi`"),
        (&["--find", "--free", "lean"], "`lean` is no coordinate among the states"),
        (&["--sweep", "g=1:2"], "is not NAME=FROM:TO:COUNT"),
        (&["--sweep", "g=1:2:2", "--set", "g=3"], "`g` varies, and --set fixes it"),
        (&["--at", "-1"], "before the start"),
    ] {
        refused(&[&disc[..], more].concat(), &[said]);
    }
}
