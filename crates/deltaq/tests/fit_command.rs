//! `deltaq fit`: films are read, fitted and judged; what makes no sense is refused with its place.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;

/// Chetaev's sledge by its closed form, g = 9.81, with noise of 1 mm.
const FILM: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/film.csv");
const FREE: &str = "x,y,phi,x',phi',g~9";

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_deltaq")).args(arguments).output().unwrap()
}

#[test]
fn a_sledge_is_chetaevs() {
    let fit = ["fit", "sledge", FILM, "--free", FREE, "--sigma", "1e-3"];
    let found = run(&[&fit[..], &["--law", "eps", "--format", "json"]].concat());
    assert_eq!(found.status.code(), Some(0), "{}", String::from_utf8_lossy(&found.stderr));
    let answer: Value = serde_json::from_slice(&found.stdout).unwrap();
    assert_eq!(answer["schema"], "deltaq/fit/2");
    assert_eq!((&answer["films"][0]["samples"], &answer["films"][0]["numbers"]), (&60.into(), &120.into()));
    let verdicts: Vec<&Value> = answer["formulations"].as_array().unwrap().iter().map(|row| &row["verdict"]).collect();
    assert_eq!(verdicts, ["supported", "excluded", "supported"]);
    let estimates = answer["formulations"][0]["fit"]["estimates"].as_array().unwrap();
    let g = estimates.iter().find(|e| e["name"] == "g").unwrap();
    let [low, high] = ["low", "high"].map(|end| g[end].as_f64().unwrap());
    assert!(low < 9.83 && high > 9.79 && high - low < 0.2, "{g}");
    let text = String::from_utf8(run(&fit).stdout).unwrap();
    for said in ["Chetaev: supported", "vakonomic: excluded at", "residuals are those of noise", "one minimum"] {
        assert!(text.contains(said), "{text}");
    }
    // a third of the deviation that the film has
    let found = run(&["fit", "sledge", FILM, "--free", FREE, "--sigma", "3e-4", "--starts", "1"]);
    assert_eq!(found.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&found.stderr).contains("no verdict"));
    // one that is too large makes an exclusion weaker, and one that is not known is estimated
    let text = String::from_utf8(run(&["fit", "sledge", FILM, "--free", FREE, "--sigma", "2e-3"]).stdout).unwrap();
    assert!(text.contains("Chetaev: supported") && text.contains("vakonomic: excluded at over"), "{text}");
    let text = String::from_utf8(run(&["fit", "sledge", FILM, "--free", FREE, "--sigma", "free"]).stdout).unwrap();
    assert!(text.contains("as the best formulation leaves") && text.contains("Chetaev: supported"), "{text}");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.csv");
    let path = path.to_str().unwrap();
    let refused = |text: &str, more: &[&str], said: &str| {
        fs::write(path, text).unwrap();
        let found = run(&[&["fit", "sledge", path, "--free", "x,y"], more].concat());
        let complaint = String::from_utf8_lossy(&found.stderr).into_owned();
        assert!(complaint.contains(said) && found.status.code() == Some(2), "{said}: {complaint}");
    };
    let good = "t,x\n0.1,0\n0.2,0\n0.3,0\n";
    refused("t,x\n0.1,0\n0.1,0\n", &["--sigma", "1mm"], "film.csv:3:1: t = 0.1 is not later");
    refused("t,z\n0.1,0\n", &["--sigma", "1mm"], "no expression belongs to the column `z`");
    refused(good, &["--sigma", "0"], "the standard deviation of `x` is 0");
    refused(good, &[], "the column `x` has no standard deviation");
    refused(good, &["--sigma", "1inch"], "`1inch` is not a number with a unit");
    refused(good, &["--sigma", "1mm", "--known", "g=3"], "`g=3` is not NAME@FILM=VALUE");
    refused(good, &["--sigma", "1mm", "--known", "g@2=3"], "is none of the 1 films");
    refused(good, &["--sigma", "1mm", "--formulations", "chetayev"], "did you mean `chetaev`?");
    refused(good, &["--sigma", "1mm", "--tolerance", "2"], "the tolerance is 2.0");
    refused(good, &["--sigma", "1mm", "--formulations", "prescribed"], "the scene has none of these formulations");
    refused(good, &["--sigma", "1mm", "--law", "kappa"], "`kappa` is not an unknown: it is not a number of the law");
    // a film shorter than its unknowns is fitted by no formulation
    fs::write(path, "t,x\n0.1,0\n0.2,0\n").unwrap();
    let found = run(&["fit", "sledge", path, "--free", "x,y", "--sigma", "1mm"]);
    assert_eq!(found.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&found.stdout).contains("the films have 2 numbers, and there are 2 unknowns"));
}
