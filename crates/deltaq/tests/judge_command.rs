//! `deltaq judge`: a motion of the program's own is judged; what cannot be judged is refused with its place.

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_deltaq")).args(arguments).output().unwrap()
}

#[test]
fn motions_that_solve_writes_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for law in ["chetaev", "vakonomic"] {
        let solved = run(&["solve", "sledge", "-f", law, "--times", "0:2:401"]);
        let path = folder.path().join(law);
        fs::write(&path, solved.stdout).unwrap();
        let judged = run(&["judge", "sledge", path.to_str().unwrap(), "--format", "json"]);
        assert_eq!(judged.status.code(), Some(0), "{}", String::from_utf8_lossy(&judged.stderr));
        let answer: Value = serde_json::from_slice(&judged.stdout).unwrap();
        assert_eq!(answer["schema"], "deltaq/judge/1");
        assert_eq!(answer["motions"][0]["law"], law);
    }
    // a motion on another slope is one of no law
    let path = folder.path().join("chetaev");
    let judged = run(&["judge", "sledge", path.to_str().unwrap(), "--set", "g=4"]);
    assert_eq!(judged.status.code(), Some(3), "{}", String::from_utf8_lossy(&judged.stdout));
}

#[test]
fn what_cannot_be_read_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for (text, said) in [
        ("t,x,y\n0,1,2\n", "there is no column `phi`"),
        ("t,x,y,phi\n0,1,2,3\n0.1,1,2,nan\n", "motion.csv:3:9: column `phi`: `nan` is no finite number"),
        ("t,x,y,phi\n0,1,2,3\n0,1,2,3\n", "motion.csv:3:1: t = 0 is not later than t = 0 of the row before"),
        ("t,x,y,phi\n0,1,2,3\n1,1,2\n", "motion.csv:3:5: 3 cells, and the header has 4"),
        ("t,x,y,phi,x'\n0,1,2,3,4\n", "motion.csv:1:5: there are rates of 1 of 3 coordinates: column `y'` is missing"),
        ("t,x,y,phi\n0,1,2,3\n1,1,2,3\n", "there are 2 samples, and 20 are needed"),
    ] {
        let path = folder.path().join("motion.csv");
        fs::write(&path, text).unwrap();
        let judged = run(&["judge", "sledge", path.to_str().unwrap()]);
        let complaint = String::from_utf8_lossy(&judged.stderr).into_owned();
        assert!(complaint.contains(said) && judged.status.code() == Some(2), "{complaint}");
    }
}

/// Every law has a motion without forces and accelerations; one without accelerations is judged.
#[test]
fn where_nothing_happens_no_law_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (scene, motion) = (folder.path().join("blade.toml"), folder.path().join("motion.csv"));
    let rows: String = (0..40).map(|k| format!("{},0,0,0.3\n", 0.1 * f64::from(k))).collect();
    fs::write(&motion, format!("t,x,y,phi\n{rows}")).unwrap();
    let text = "title = \"blade\"\n[parameters]\ng = 0\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nphi = { start = 0.3 }\n\
                [system]\nlagrangian = \"(x'^2 + y'^2 + phi'^2)/2 + g*x\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n[start.velocities]\n\"x'\" = 0\n\"phi'\" = 0\n[run]\nduration = 1\n";
    fs::write(&scene, text).unwrap();
    let call = ["judge", scene.to_str().unwrap(), motion.to_str().unwrap()];
    let judged = run(&call);
    let complaint = String::from_utf8_lossy(&judged.stderr).into_owned();
    assert!(complaint.contains("every law has this motion") && judged.status.code() == Some(2), "{complaint}");
    // on a slope no blade stays where it is
    assert_eq!(run(&[&call[..], &["--set", "g=1"]].concat()).status.code(), Some(3));
}
