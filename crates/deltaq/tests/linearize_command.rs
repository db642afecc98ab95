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
    let said = "Linear stability changes at v = 4.292382536";
    let table = with("table");
    assert!(table.contains(said));
    assert!(table.contains("2 have a positive real part below this value, no eigenvalue has above"));
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
    refused(&disc, &["is not a steady motion of chetaev-reduced"]);
    assert!(answer(&[&disc[..], &["--find"]].concat(), 0).0.contains("A steady motion"));
    assert!(answer(&[&disc[..], &["--at", "0.5"]].concat(), 0).0.contains("**Frozen at an instant"));
    for (more, said) in [
        (&["--find", "--free", "psi"][..], "no rate depends on `psi`"),
        (&["--find", "--free", "lean"], "`lean` is not a coordinate among the states"),
        (&["--sweep", "g=1:2"], "is not NAME=FROM:TO:COUNT"),
        (&["--sweep", "g=1:2:2", "--set", "g=3"], "`g` varies, and --set fixes it"),
        (&["--at", "-1"], "before the start"),
    ] {
        refused(&[&disc[..], more].concat(), &[said]);
    }
}

/// The critical spin is that of the motion that was found, not that of the start.
#[test]
fn a_critical_value_is_that_of_the_motion_found() {
    let sweep = ["linearize", "falling-disc", "--find", "--free", "theta", "--sweep", "psi'=2:3:2"];
    let value: Value = serde_json::from_str(&answer(&[&sweep[..], &["--format", "json"]].concat(), 0).0).expect("JSON");
    let change = &value["changes"][0];
    let number = |name: &str| change[name].as_f64().expect("a number");
    assert!((number("asked") - 2.5372).abs() < 1e-4 && (number("value") - 2.5606).abs() < 1e-4, "{change}");
    let there = change["state"]["psi'"].as_f64().expect("a state");
    assert!((there - number("value")).abs() <= number("width").max(1e-9), "{change}");
    let page = answer(&sweep, 0).0;
    assert!(page.contains("Steady motions that were found:") && page.contains("psi' = 2.5606"), "{page}");
}

#[test]
fn what_first_order_leaves_open_is_said() {
    let flat = answer(&["linearize", "sledge", "--set", "g=0"], 0).0;
    assert!(flat.contains("Every eigenvalue is zero: to first order nothing is decided about stability."), "{flat}");
    assert!(flat.contains("| undecided |"), "{flat}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("resonance.toml");
    let scene = |feedback: &str| {
        let text = "title = \"Two pendulums, one driven by the other\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n\
                    [system]\nlagrangian = \"(x'^2 + y'^2)/2 - 1.1*(x^2 + y^2)\"\nforces = { x = \"D*y\", y = \"x\" }\n\
                    [start.velocities]\n\"x'\" = 0\n\"y'\" = 0\n[run]\nduration = 1\n";
        std::fs::write(&path, text.replace('D', feedback)).expect("written");
        answer(&["linearize", path.to_str().expect("text")], 0).0
    };
    assert!(scene("0").contains("2 equal eigenvalues ±1.4832 i have one eigenvector: deviations grow like t."));
    for feedback in ["1e-20", "(-1e-20)", "1e-14", "(-1e-14)"] {
        let page = scene(feedback);
        assert!(page.contains("| undecided |") && page.contains("then it is undecided"), "{feedback}: {page}");
    }
    // λ² = −2.2 ± √D: bounded, and growing
    assert!(scene("1e-6").contains("| 0 | 0 |") && scene("(-1e-6)").contains("| 0 | 2 |"));
}

/// `λ² = −2.2 ± √D`: with `D = 10⁻¹⁴` two eigenvalues are apart from `√2.2 i` by `½ √D/√2.2`, either way.
#[test]
fn a_chain_is_as_wide_in_json_as_on_the_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("nearly.toml");
    let text = "title = \"nearly\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2)/2 - 1.1*(x^2 + y^2)\"\nforces = { x = \"1e-14*y\", y = \"x\" }\n\
                [start.velocities]\n\"x'\" = 0\n\"y'\" = 0\n[run]\nduration = 1\n";
    std::fs::write(&path, text).expect("written");
    let asked = ["linearize", path.to_str().expect("text")];
    let value: Value = serde_json::from_str(&answer(&[&asked[..], &["--format", "json"]].concat(), 0).0).expect("JSON");
    let chain = &value["points"][0]["chains"][0];
    let number = |name: &str| chain[name].as_f64().expect("a number");
    let apart = 0.5 * 1e-7 / 2.2_f64.sqrt();
    assert!((number("imaginary") - 2.2_f64.sqrt()).abs() < 1e-7 && number("size") == 2.0, "{chain}");
    assert!((0.99 * apart..30.0 * apart).contains(&number("radius")), "{chain}, {apart:e}");
    let page = answer(&asked, 0).0;
    let said = format!("2 eigenvalues within {} of ±1.48", comparison::words::short(number("radius")));
    assert!(page.contains(&said), "{said}\n{page}");
}
