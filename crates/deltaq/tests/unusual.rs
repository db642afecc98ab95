//! Well-formed input that a user seldom writes: an answer, or a reason with its place.

use std::fs;
use std::path::Path;

use crate::support::{answer, refused};

/// A scene with one constraint.
fn scene(coordinates: &[(&str, f64)], system: &str, velocities: &str, duration: f64) -> String {
    let coordinates: String = coordinates.iter().map(|(q, start)| format!("{q} = {{ start = {start} }}\n")).collect();
    format!(
        "title = \"unusual\"\n[coordinates]\n{coordinates}[system]\n{system}\n[start.velocities]\n{velocities}\n\
         [run]\nduration = {duration}\n"
    )
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let file = folder.join(name);
    fs::write(&file, text).expect("written");
    file.display().to_string()
}

/// A sledge that slides down, and how it is seen at `count` times.
fn slope(folder: &Path) -> String {
    let system = "lagrangian = \"(x'^2 + y'^2 + phi'^2)/2 + x\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]";
    let text = scene(&[("x", 0.0), ("y", 0.0), ("phi", 0.3)], system, "\"phi'\" = 1\n\"x'\" = 0.5", 1.0);
    write(
        folder,
        "slope.toml",
        &text.replace("+ x\"", "+ g*x\"").replace("[coordinates]", "[parameters]\ng = 1\n[coordinates]"),
    )
}

#[test]
fn a_clock_alone_is_fitted() {
    let folder = tempfile::tempdir().expect("a folder");
    let film = write(folder.path(), "film.csv", "t,x\n0,0\n0.1,0.0508\n0.2,0.1035\n0.3,0.158\n");
    let (said, _) =
        answer(&["fit", "sledge", &film, "--free", "clock", "--sigma", "1e-1", "--formulations", "chetaev"], 0);
    assert!(said.contains("\n  clock "), "{said}");
}

#[test]
fn films_that_cannot_be_weighed_say_where() {
    let folder = tempfile::tempdir().expect("a folder");
    let slope = slope(folder.path());
    let (motion, _) = answer(&["solve", &slope, "-f", "chetaev", "--times", "0:1:21"], 0);
    let motion = write(folder.path(), "motion.csv", &motion);
    let fit = |film: &str, code: i32| {
        answer(&["fit", &slope, film, "--free", "g", "--sigma", "1e-6", "--formulations", "chetaev"], code).0
    };
    // without noise, and no worse for that
    assert!(fit(&motion, 0).contains("Chetaev: supported"));
    let distance: String = (0..7).map(|i| format!("{},{}\n", 0.1 * f64::from(i), 0.05 * f64::from(i))).collect();
    let distance = write(folder.path(), "distance.csv", &format!("t,sqrt(x^2+y^2)\n{distance}"));
    let said = fit(&distance, 3);
    assert!(said.contains("`sqrt(x^2+y^2)` has no derivative at t = 0, line 2 of the film"), "{said}");
    let far = write(folder.path(), "far.csv", "t,x\n0,0\n0.1,0.05\n0.2,1e300\n0.3,0.17\n");
    let said = fit(&far, 3);
    assert!(said.contains("standard deviations off; at most 1e100 are possible at t = 0.2, line 4"), "{said}");
    let design = [
        "design",
        &slope,
        "--estimate",
        "g",
        "--film",
        "20Hz,1mm,1s",
        "--columns",
        "sqrt(x-9)",
        "--over",
        "x'=0:1",
        "--free",
        "g",
    ];
    refused(&design, &["`sqrt(x-9)` has no value at t = 0.05"]);
}

#[test]
fn integrals_that_are_columns_are_shown_once() {
    let (said, _) = answer(&["solve", "sledge", "-f", "chetaev", "--integrals", "--times", "1"], 0);
    assert_eq!(said.lines().next().expect("names").matches("phi'").count(), 2, "{said}");
}

#[test]
fn tables_of_others_are_not_replaced_by_members() {
    let folder = tempfile::tempdir().expect("a folder");
    let (own, members) = (write(folder.path(), "members.csv", ""), "member,name,age\n1,bob,5\n");
    let club = write(folder.path(), "club.csv", members);
    let ensemble = |out: &str, code: i32| {
        answer(&["ensemble", "sledge", "-f", "chetaev", "--vary", "g=1:2:2", "--times", "1", "--out", out], code)
    };
    ensemble(&club, 2);
    assert_eq!(fs::read_to_string(&club).expect("there"), members);
    ensemble(&own, 0);
    ensemble(&own, 0);
}

#[test]
fn names_that_mean_something_else_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(slope(folder.path())).expect("there");
    let removal =
        "[removal.coordinates]\nparameters = [\"u\", \"phi\"]\nrates = { x = \"u'*cos(phi)\", y = \"u'*sin(phi)\" }\n";
    let removal = write(folder.path(), "removal.toml", &(text + removal));
    refused(&["check", &removal], &["`coordinates` cannot be a name", ":16:"]);
}

#[test]
fn a_velocity_beside_round_off_is_not_determined() {
    let folder = tempfile::tempdir().expect("a folder");
    let slope = slope(folder.path());
    // x' = 0, whatever the cosine of a number beside π/2 is
    refused(&["check", &slope, "--set", "phi=pi/2"], &["`y'` not determined"]);
    for at_rest in [["phi=pi/2.01", "phi'=1"], ["phi=pi/2", "x'=0"]] {
        answer(&["check", &slope, "--set", at_rest[0], "--set", at_rest[1]], 0);
    }
}

#[test]
fn a_velocity_without_a_square_of_its_own_is_derived() {
    let folder = tempfile::tempdir().expect("a folder");
    for (lagrangian, constraint) in [("x'^2/2 + x*x'*z'", "z'"), ("(x'^2 + y'^2)/2 + z'*y*x'", "z' - y*x'")] {
        let system = format!("lagrangian = \"{lagrangian}\"\nconstraints = [\"{constraint}\"]");
        let coordinates = [("x", 0.6), ("y", 0.3), ("z", -0.8)];
        let (used, given) = if lagrangian.contains('y') {
            (&coordinates[..], "\"x'\" = 0.5\n\"y'\" = 0.2")
        } else {
            (&[coordinates[0], coordinates[2]][..], "\"x'\" = 0.5")
        };
        let file = write(folder.path(), "cross.toml", &scene(used, &system, given, 1.0));
        let end = |form: &str| {
            let (said, _) = answer(&["solve", &file, "-f", "chetaev", "--form", form, "--times", "1"], 0);
            let row = said.lines().last().expect("a row").split(',').take(1 + 2 * used.len());
            row.map(|x| x.parse::<f64>().expect("a number")).collect::<Vec<_>>()
        };
        let (own, multipliers) = (end("auto"), end("multipliers"));
        assert!(own.iter().zip(&multipliers).all(|(a, b)| (a - b).abs() < 1e-9), "{own:?}, {multipliers:?}");
    }
}

#[test]
fn pulses_keep_their_place_in_quasi_velocities() {
    let folder = tempfile::tempdir().expect("a folder");
    let (p, w) = (777.0_f64, 0.01_f64);
    let system = format!(
        "lagrangian = \"(x'^2 + y'^2)/2\"\nconstraints = [\"y'\"]\nforces = {{ x = \"1/(1 + ((t - {p})/{w})^2)\" }}"
    );
    let file = write(folder.path(), "pulse.toml", &scene(&[("x", 0.0), ("y", 0.0)], &system, "\"x'\" = 0", 1000.0));
    let (said, _) = answer(&["solve", &file, "-f", "chetaev", "--times", "1000"], 0);
    let x: f64 = said.lines().last().and_then(|row| row.split(',').nth(1)?.parse().ok()).expect("x");
    // x(T) = ∫ (T − t) F dt
    let (a, b) = (-p / w, (1000.0 - p) / w);
    let right = (1000.0 - p) * w * (b.atan() - a.atan()) - 0.5 * w * w * ((1.0 + b * b).ln() - (1.0 + a * a).ln());
    assert!((x - right).abs() < 1e-8, "{x}, not {right}");
}

#[test]
fn what_holds_on_a_branch_is_said_up_to_its_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let coordinates = [("x", 0.2), ("y", 0.3), ("z", 0.0)];
    for factor in ["(sqrt(t^2 - 2*t + 1) - 1 + t)*y", "(sqrt(1 - cos(y)^2) - sin(y))", "(acos(cos(y)) - y)"] {
        let system = format!("lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z' - {factor}*x'\"]");
        let file = write(folder.path(), "branch.toml", &scene(&coordinates, &system, "\"x'\" = 1\n\"y'\" = -0.5", 2.0));
        let (said, _) = answer(&["compare", &file, "-f", "chetaev,vakonomic"], 0);
        let every = said.split("With every μ₀ ").nth(1).and_then(|rest| rest.split(". ").next()).unwrap_or_default();
        assert!(said.contains("Different: Chetaev and vakonomic"), "{said}");
        assert!(every.contains(" up to 0.") && every.ends_with("later undecided"), "{said}");
    }
}

#[test]
fn integrals_without_velocities_hide_no_others() {
    let (said, _) = answer(&["integrals", "velocity-pendulum"], 0);
    assert!(said.contains("integral      x^2 + y^2 = const") && said.contains("energy        m*g*y"), "{said}");
    let (said, _) = answer(&["integrals", "servo-pendulum"], 0);
    assert!(["cos(b) = const", "sin(b) = const", "\nenergy "].iter().all(|word| said.contains(word)), "{said}");
}

#[test]
fn a_steady_motion_at_zero_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let system = "lagrangian = \"(x'^2 + y'^2)/2 - x^2/2\"\nconstraints = [\"y'\"]";
    let file = write(folder.path(), "oscillator.toml", &scene(&[("x", 0.3), ("y", 0.2)], system, "\"x'\" = 0", 2.0));
    let (said, _) = answer(&["linearize", &file, "--find"], 0);
    assert!(said.contains("1.00000000000000 i") && said.contains("| 0 | 0.20000 | 0 | 0 |"), "{said}");
}

#[test]
fn growth_vectors_do_not_fall() {
    let folder = tempfile::tempdir().expect("a folder");
    let system = "lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z' - (1 + tanh(1000*(x - pi)))*y*x'\"]";
    let coordinates = [("x", 0.2), ("y", 0.3), ("z", 0.0)];
    let file = write(folder.path(), "growth.toml", &scene(&coordinates, system, "\"x'\" = 1\n\"y'\" = -0.5", 0.1));
    let (said, _) = answer(&["show", &file], 0);
    assert!(said.contains("growth vector (2, 3)") && !said.contains(" 0, "), "{said}");
}

#[test]
fn sweeps_say_of_which_states_each_row_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let system = "lagrangian = \"(x'^2 + y'^2)/2 - (x^2 + a*y^2)/2\"\nconstraints = [\"z' - y*x'\", \"w' - x*y'\"]";
    let coordinates = [("x", 0.0), ("y", 0.0), ("z", 0.0), ("w", 0.0)];
    let text = scene(&coordinates, system, "\"x'\" = 0\n\"y'\" = 0", 2.0);
    let text = text.replace("[coordinates]", "[parameters]\na = 1\n[coordinates]");
    let file = write(folder.path(), "sweep.toml", &text);
    let (said, _) = answer(&["linearize", &file, "--sweep", "a=0:2:3"], 0);
    assert!(said.contains("With a = 1, 2, of x, y, x' and y'."), "{said}");
}
