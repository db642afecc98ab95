//! A system that falls into a singularity: runs stop, soon, and say where and of what.

use serde_json::Value;

use crate::support::answer;

/// A bicycle that falls flat; its pitch and its yaw are then turns about one axis.
const BICYCLE: [&str; 5] = ["bicycle", "--set", "lean'=0.5", "--set", "yaw=0.3"];

const NAMES: [&str; 6] = ["yaw", "lean", "pitch", "steer", "rear", "front"];

/// Steps, those rejected too, that a run may make on its way into a singularity.
const SOON: u64 = 20_000;

fn json(arguments: &[&str], code: i32) -> Value {
    let (stdout, stderr) = answer(&[arguments, &["--format", "json"]].concat(), code);
    println!("{}", stderr.trim());
    serde_json::from_str(&stdout).expect("JSON")
}

/// That a cause has a name of the bicycle, and none of ours (`c_16`).
#[track_caller]
fn has_names(cause: &str) {
    assert!(NAMES.iter().any(|name| cause.contains(name)), "no name in {cause}");
    let ours = |word: &str| word.split_once('_').is_some_and(|(_, rest)| rest.parse::<u32>().is_ok());
    let words = cause.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.starts_with("lambda"));
    assert!(!words.clone().any(ours), "a name of ours in {cause}");
}

#[test]
fn a_bicycle_that_falls_flat_stops_soon_and_in_its_own_names() {
    let falling = [&["solve"], &BICYCLE[..], &["--times", "0", "-f"]].concat();
    for formulation in [vec!["chetaev"], vec!["chetaev", "--method", "dop853"], vec!["chetaev-reduced"]] {
        let value = json(&[&falling[..], &formulation].concat(), 3);
        let cause = value["cause"].as_str().expect("a cause");
        assert!(cause.contains("stopped at t = ") && value["end"].as_f64().is_some_and(|t| t > 0.1), "{cause}");
        has_names(cause);
        let work = |name: &str| value["work"][name].as_u64().expect("a count");
        assert!(work("steps") + work("rejected") < SOON, "{formulation:?}: {}", value["work"]);
    }
}

/// Wheels on the ground are a constraint on positions: the pitch of a steered start follows from it.
#[test]
fn a_removal_by_coordinates_stops_where_the_front_wheel_is_flat() {
    let removed = ["--times", "0", "-f", "removed-constraint", "--removal", "coordinates"];
    let by = [&["solve"], &BICYCLE[..], &removed].concat();
    for steered in [vec![], vec!["--set", "lean=0.1", "--set", "steer=0.05"]] {
        let value = json(&[&by[..], &steered].concat(), 3);
        let cause = value["cause"].as_str().expect("a cause");
        assert!(cause.contains("the rank of ∂f/∂v falls there") && value["end"].as_f64().is_some_and(|t| t > 2.0));
        has_names(cause);
        assert_eq!(value["charts"].as_array().map(Vec::len), Some(1));
        assert!(value["work"]["steps"].as_u64().is_some_and(|steps| steps < SOON));
    }
}

#[test]
fn of_bicycles_those_that_fall_stop_and_the_others_go_on() {
    let both = ["-f", "chetaev", "--vary", "v=2..5:2"];
    let value = json(&[&["ensemble"], &BICYCLE[..], &both].concat(), 3);
    let [falls, rolls] = [&value["members"][0], &value["members"][1]];
    assert_eq!((&falls["status"], &rolls["status"]), (&"stopped".into(), &"completed".into()));
    has_names(falls["cause"].as_str().expect("a cause"));
    // series of the motion itself, not of round-off
    assert!(falls["steps"].as_u64().is_some_and(|steps| steps < 500));
}

/// What is ever faster asks for ever shorter steps, and nothing by which the equations divide vanishes.
#[test]
fn steps_that_became_too_short_are_told_as_steps() {
    let stopped = |arguments: &[&str]| {
        let value = json(arguments, 3);
        value["cause"].as_str().expect("a cause").to_owned()
    };
    let fast = tempfile::NamedTempFile::with_suffix(".toml").expect("a file");
    let text = "title = \"ever faster\"\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"x'^2/2\"\n\
                forces.x = \"sin(exp(t))\"\n[start.velocities]\n\"x'\" = 1\n[run]\nduration = 40\n";
    std::fs::write(fast.path(), text).expect("written");
    let file = fast.path().to_str().expect("UTF-8");
    let sledge = ["sledge", "-f", "vakonomic", "--set", "duration=1e6", "--max-steps", "200000"];
    for scene in [&[file, "-f", "chetaev"][..], &sledge] {
        let cause = stopped(&[&["solve"], scene, &["--times", "0"]].concat());
        assert!(!cause.contains("singularity"), "{cause}");
        for words in ["steps became too short", "changes fastest", "`breakpoints`", "--max-steps"] {
            assert!(cause.contains(words), "`{words}` is not in {cause}");
        }
    }
}
