//! `deltaq connect`, as a user runs it.

use serde_json::Value;

use crate::support::{answer, refused};

const GEODESICS: [&str; 6] = ["connect", "heisenberg", "--to", "x=0.2,y=0.5,z=1.2", "--at", "8"];

#[test]
fn text_and_json_have_the_same_motions() {
    let text = answer(&GEODESICS, 0).0;
    let json = answer(&[&GEODESICS[..], &["--format", "json"]].concat(), 0).0;
    let value: Value = serde_json::from_str(&json).expect("JSON");
    let motions = value["motions"].as_array().expect("motions");
    assert!(motions.len() >= 3 && text.contains(&format!("led to {} motions", motions.len())), "{text}");
    for motion in motions {
        let [mu, action] = [&motion["unknowns"]["mu0_1"], &motion["action"]].map(|x| x.as_f64().expect("a number"));
        assert!(text.contains(&format!("{mu:.12}")) && text.contains(&format!("action {action:.9}")), "{text}");
        // geodesics of the Heisenberg group are conjugate first where their velocity has turned once
        let turn = std::f64::consts::TAU / mu.abs();
        let first = motion["conjugate_times"][0]["t"].as_f64();
        assert_eq!(first.is_some(), turn < 8.0);
        assert!(first.is_none_or(|first| (first - turn).abs() < 1e-9));
        assert_eq!(motion["minimum"], turn >= 8.0);
    }
    assert!(motions.iter().all(|motion| motion["isolated"] == true) && !text.contains("not isolated"), "{text}");
    assert!(text.contains("a local minimum of the action") && text.contains("conjugate times: "), "{text}");
    // no result depends on threads
    assert_eq!(answer(&[&GEODESICS[..], &["--threads", "2", "--format", "json"]].concat(), 0).0, json);
}

#[test]
fn what_is_not_found_is_said_and_ends_with_three() {
    let scene = "title = \"Bead\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y' - x'\"]\n[start.velocities]\n\"x'\" = 1\n\
                 [run]\nduration = 1\n";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bead.toml");
    std::fs::write(&path, scene).expect("a file");
    let path = path.to_str().expect("text");
    // y − x is constant: every end beside it is on another leaf
    let (text, _) = answer(&["connect", path, "--to", "x=1,y=2", "--starts", "3"], 0);
    assert!(text.contains("there is none: `y' - x'` is the rate of a function of the position"), "{text}");
    let (text, complaint) = answer(&["connect", "heisenberg", "--to", "x=0,y=0,z=1e9", "--starts", "1"], 3);
    assert!(text.contains("0 of 1 starts led to 0 motions"), "{text}");
    assert!(complaint.contains("no vakonomic motion found from 1 starts"), "{complaint}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    for (more, said) in [
        (&["--to", "x=1,y=1"][..], "vakonomic has 3 unknowns (x', y', mu0_1), and 2 coordinates are given at the end"),
        (&["--to", "x=1,y=1,z=0", "-f", "chetaev"], "chetaev has 2 unknowns (x', y'), and 3 coordinates"),
        (&["--to", "w=1"], "no coordinate `w`; there are x, y, z"),
        (&["--to", "x"], "`x` is not NAME=VALUE"),
        (&["--to", "x=1,y=1,z=1", "--at", "-1"], "the end -1.0 is not after the start 0.0"),
        (&["--to", "x=1,y=1,z=1", "--starts", "0"], "0 is not in 1..=100000"),
        (&["--to", "x=1,y=1,z=nan"], "z is NaN at the end; it must be finite"),
        (&[], "--to"),
    ] {
        refused(&[&["connect", "heisenberg"][..], more].concat(), &[said]);
    }
}
