//! The command line, run as a user runs it: fields, options, exit codes, files whole or not at all.

use std::process::Output;

use serde_json::Value;

use crate::support::{all_refused, answer, refused, run, text};

#[track_caller]
fn exit(output: &Output, code: i32) {
    let stderr = text(&output.stderr);
    assert_eq!(output.status.code(), Some(code), "stderr: {stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
}

/// What `deltaq solve … --format json` prints.
#[track_caller]
fn json(arguments: &[&str]) -> Value {
    let output = run(&[&["solve"], arguments, &["--format", "json"]].concat());
    exit(&output, 0);
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn column(value: &Value, group: &str, name: &str) -> Vec<f64> {
    let column = value[group][name].as_array().unwrap_or_else(|| panic!("no {group}.{name} in {value}"));
    column.iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[test]
fn json_has_every_field() {
    let value = json(&["sledge", "-f", "chetaev"]);
    assert_eq!(value["scene"], "sledge");
    assert_eq!(value["formulation"], "chetaev");
    assert_eq!(value["status"], "completed");
    let times = value["times"].as_array().expect("times");
    assert_eq!(times.len(), 101);
    for group in ["coordinates", "velocities"] {
        assert_eq!(keys(&value[group]).len(), 3);
        for name in ["x", "y", "phi"] {
            assert_eq!(column(&value, group, name).len(), times.len());
        }
    }
    assert_eq!(column(&value, "multipliers", "lambda_1").len(), times.len());
    let estimate = value["error_estimate"].as_f64().expect("a number");
    assert!(estimate > 0.0 && estimate < 1e-8, "{estimate}");
    let energy = &value["invariants"]["energy"];
    assert!(energy["start"].is_f64() && energy["drift"].as_f64().is_some_and(|d| d < 1e-10), "{energy}");
    for field in ["steps", "rejected", "evaluations"] {
        assert!(value["work"][field].is_u64(), "work.{field}");
    }
    assert!(value["work"]["evaluations"].as_u64() > value["work"]["steps"].as_u64());
    for field in ["derive", "compile", "integrate"] {
        assert!(value["seconds"][field].as_f64().is_some_and(|s| s >= 0.0), "seconds.{field}");
    }
}

#[test]
fn csv_has_the_same_numbers() {
    let arguments = ["sledge", "-f", "chetaev", "--times", "0,2.5,10"];
    let value = json(&arguments);
    let output = run(&[&["solve"], &arguments[..]].concat());
    exit(&output, 0);
    let text = text(&output.stdout);
    let mut lines = text.lines();
    let errors = "error x,error y,error phi,error lambda_1";
    assert_eq!(lines.next(), Some(&format!("t,x,y,phi,x',y',phi',lambda_1,{errors}")[..]));
    let rows: Vec<Vec<f64>> = lines.map(|l| l.split(',').map(|x| x.parse().expect("a number")).collect()).collect();
    assert_eq!(rows.iter().map(|r| r[0]).collect::<Vec<_>>(), [0.0, 2.5, 10.0]);
    // the reader of JSON may lose the last digit
    let same =
        |place: usize, of: Vec<f64>| rows.iter().zip(of).all(|(row, x)| (row[place] - x).abs() <= 1e-15 * x.abs());
    assert!(same(2, column(&value, "coordinates", "y")) && same(7, column(&value, "multipliers", "lambda_1")));
    let errors = &value["error_estimates"];
    for (group, name, place) in [("coordinates", "y", 9), ("multipliers", "lambda_1", 11)] {
        let of = column(errors, group, name);
        assert!(rows.iter().zip(&of).all(|(row, e)| (row[place] - e).abs() <= 1e-14 * e), "{name}: {rows:?}, {of:?}");
        assert!(of[0] < of[2] && of[1] <= of[2] && of[2] < 1e-8, "{name}: {of:?}");
    }
}

#[test]
fn times_are_a_list_or_a_range() {
    let times = |text: &str| -> Vec<f64> {
        let value = json(&["disc", "-f", "chetaev", "--times", text]);
        value["times"].as_array().expect("times").iter().map(|t| t.as_f64().expect("a number")).collect()
    };
    assert_eq!(times("0,1.5,10"), [0.0, 1.5, 10.0]);
    assert_eq!(times("1:3:5"), [1.0, 1.5, 2.0, 2.5, 3.0]);
    assert_eq!(times("4"), [4.0]);
}

#[test]
fn multipliers_and_constants_choose_the_motion() {
    let end = |arguments: &[&str]| column(&json(&[arguments, &["--times", "3"]].concat()), "coordinates", "x")[0];
    let vakonomic = ["sledge", "-f", "vakonomic"];
    let zero = end(&vakonomic);
    assert_eq!(end(&[&vakonomic[..], &["--mu0", "0"]].concat()), zero);
    let negative = end(&[&vakonomic[..], &["--mu0", "-0.2"]].concat());
    assert!((negative - zero).abs() > 1e-3);
    assert_eq!(end(&[&vakonomic[..], &["--set", "mu0_1=-0.2"]].concat()), negative);
    let start = column(&json(&["sledge", "-f", "vakonomic", "--mu0", "-0.2", "--times", "0"]), "multipliers", "mu_1");
    assert!((start[0] + 0.2).abs() < 1e-15, "{start:?}");
    // the costate form is another way to the same motion
    assert!((end(&["sledge", "-f", "vakonomic-costate", "--mu0", "-0.2"]) - negative).abs() < 1e-8);

    let removed = ["sledge", "-f", "removed-constraint", "--removal", "arc-length"];
    let with = |rule: &str| end(&[&removed[..], &["--constants", rule]].concat());
    let horizon = with("horizon=10");
    assert_eq!(end(&removed), horizon, "the scene's own constants");
    // P_x = g sin(alpha) (10 - t)
    let start = 9.81 * 0.4_f64.sin() * 10.0;
    assert!((with(&format!("start={start},0")) - horizon).abs() < 1e-7);
    assert!((with(&format!("start={start}")) - horizon).abs() < 1e-7);
    assert!((with("zero") - with("start=0")).abs() < 1e-12);
    assert!((with("zero") - horizon).abs() > 1e-3);
    assert!((with("start=-1") - with("start=1")).abs() > 1e-3);
    let natural = json(&[&removed[..], &["--constants", "horizon=10", "--times", "10"]].concat());
    let at_horizon = column(&natural, "multipliers", "P_x")[0];
    assert!(at_horizon.abs() < 1e-7, "P_x = {at_horizon} at the horizon");
    for name in ["coordinates", "quasi-velocities"] {
        let value = json(&["disc", "-f", "removed-constraint", "--removal", name, "--times", "0"]);
        assert_eq!(value["removal"], name);
    }
}

#[test]
fn options_of_the_integration_are_heard() {
    let reference = column(&json(&["sledge", "-f", "chetaev", "--times", "10"]), "coordinates", "y")[0];
    let own = [("dop853", "1e-8"), ("radau5", "1e-7")];
    let of_diffsol = [("tsit45", "1e-8"), ("bdf", "1e-7"), ("tr-bdf2", "1e-6"), ("esdirk34", "1e-7")];
    let linked = if cfg!(feature = "diffsol") { &of_diffsol[..] } else { &[] };
    for &(method, tolerance) in own.iter().chain(linked) {
        let value = json(&["sledge", "-f", "chetaev", "--times", "10", "--method", method, "--tolerance", tolerance]);
        let error = (column(&value, "coordinates", "y")[0] - reference).abs();
        let estimate = value["error_estimate"].as_f64().expect("a number");
        println!("sledge, {method} at {tolerance}: error {error:.1e}, estimate {estimate:.1e}, {}", value["work"]);
        assert!(error < 1e3 * tolerance.parse::<f64>().expect("a number"), "{method}: {error:e}");
        assert!(error < 10.0 * estimate + 1e-11, "{method}: error {error:e}, estimate {estimate:e}");
    }
    let steps = |tolerance: &str| {
        json(&["sledge", "-f", "chetaev", "--method", "dop853", "--tolerance", tolerance])["work"]["steps"]
            .as_u64()
            .expect("a number")
    };
    assert!(steps("1e-12") > steps("1e-5"));
    let set = ["--set", "g=1.62", "--set", "x=2", "--set", "duration=20"];
    let moon = json(&[&["sledge", "-f", "chetaev", "--times", "0,20"], &set[..]].concat());
    assert_eq!(column(&moon, "coordinates", "x")[0], 2.0);
    let free = json(&["sledge", "-f", "chetaev", "--no-projection"]);
    assert_eq!(free["projection"]["count"], 0);
}

#[test]
fn equal_steps_keep_the_constraint_and_have_their_order() {
    // φ = 0.3 + 1.1 t; x = (c sin φ + k sin²φ/2)/ω − …: the step's error is measured against it
    let (omega, k) = (1.1_f64, 9.81 * 0.4_f64.sin() / 1.1);
    let x = |phi: f64| ((0.5 - k * 0.3_f64.sin()) * phi.sin() + k * phi.sin().powi(2) / 2.0) / omega;
    for (order, limit) in [("2", 2e-3), ("4", 2e-6), ("6", 2e-9), ("8", 1e-11)] {
        let leapfrog = ["--method", "leapfrog", "--step", "0.025", "--order", order];
        let value = json(&[&["sledge", "-f", "chetaev", "--times", "9.987,10"], &leapfrog[..]].concat());
        let error = (column(&value, "coordinates", "x")[1] - (x(11.3) - x(0.3))).abs();
        let estimate = value["error_estimate"].as_f64().expect("a number");
        println!("leapfrog of order {order}: error {error:.1e}, estimate {estimate:.1e}, {}", value["work"]);
        assert!(error < limit && error < estimate + 1e-12, "order {order}: {error:e}, estimate {estimate:e}");
        assert_eq!(value["work"]["steps"], 400);
        for i in 0..2 {
            let phi = column(&value, "coordinates", "phi")[i];
            let [vx, vy] = ["x", "y"].map(|name| column(&value, "velocities", name)[i]);
            assert!((vy * phi.cos() - vx * phi.sin()).abs() < 4e-14, "order {order}");
        }
    }
    for formulation in ["vakonomic", "vakonomic-costate", "removed-constraint"] {
        let leapfrog = ["--method", "leapfrog", "--step", "0.005", "--order", "6", "--times", "0,0.501,1"];
        let one = json(&[&["sledge", "-f", formulation], &leapfrog[..]].concat());
        let two = json(&["sledge", "-f", formulation, "--times", "0,0.501,1"]);
        for group in ["coordinates", "velocities", "multipliers"] {
            for name in keys(&two[group]) {
                for (a, b) in column(&one, group, name).iter().zip(column(&two, group, name)) {
                    assert!((a - b).abs() < 1e-8 * (1.0 + b.abs()), "{formulation}, {group}.{name}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn no_step_is_compared_with_itself() {
    // the truth at t = 10 is y = 17.9; one step over everything gave -122.9 with an estimate of 0
    for step in ["10", "6", "5", "4", "3", "1"] {
        let leapfrog = ["--method", "leapfrog", "--step", step, "--times", "10", "--format", "json"];
        let output = run(&[&["solve", "sledge", "-f", "chetaev"], &leapfrog[..]].concat());
        let value: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("--step {step}"));
        println!("--step {step}: {} {}, {}", value["status"], value["coordinates"]["y"], value["error_estimate"]);
        exit(&output, 3);
        assert_eq!(value["status"], "untrusted", "--step {step}");
        assert!(value["work"]["steps"].as_u64().is_some_and(|steps| steps >= 2));
    }
    refused(&["solve", "sledge", "-f", "chetaev", "--method", "leapfrog", "--step", "10.1"], &["10.1", "a time of 10"]);
}

#[test]
fn a_step_that_is_too_long_to_be_read_off_within_is_a_stop() {
    for call in ["trailer -f vakonomic --step 0.75", "bowl -f chetaev --step 0.25", "turntable -f chetaev --step 10"] {
        let call = format!("solve {call} --method leapfrog --format json");
        let (stdout, stderr) = answer(&call.split(' ').collect::<Vec<_>>(), 3);
        assert!(stderr.contains("stopped at t = ") && stderr.contains("is too long"), "{stderr}");
        let value: Value = serde_json::from_str(&stdout).expect("JSON");
        let (end, times) = (value["end"].as_f64().expect("a number"), value["times"].as_array().expect("times"));
        assert!(times.iter().all(|t| t.as_f64().is_some_and(|t| t <= end)) && !times.is_empty(), "{call}: {end}");
    }
}

#[test]
fn limits_end_a_run_with_what_was_reached() {
    let solve = |limits: &[&str]| {
        let (stdout, stderr) = answer(&[&["solve", "sledge", "-f", "chetaev", "--format", "json"], limits].concat(), 3);
        let value: Value = serde_json::from_str(&stdout).expect("JSON");
        assert_eq!(value["status"], "stopped", "{limits:?}");
        let cause = value["cause"].as_str().expect("a cause").to_string();
        assert!(stderr.contains(&cause), "{stderr}");
        (value, cause)
    };
    let (value, cause) = solve(&["--method", "dop853", "--max-steps", "10"]);
    assert!(cause.contains("more than 10 steps"), "{cause}");
    let end = value["end"].as_f64().expect("a number");
    let reached = column(&value, "coordinates", "phi");
    assert!(end > 0.1 && end < 9.0 && reached.len() == (end / 0.1) as usize + 1, "{end}, {reached:?}");
    assert!(reached.iter().zip(0..).all(|(phi, i)| (phi - (0.3 + 0.11 * f64::from(i))).abs() < 1e-9), "{reached:?}");
    let (value, cause) = solve(&["--method", "leapfrog", "--step", "0.1", "--max-steps", "42"]);
    assert!(cause.contains("more than 42 steps") && value["end"] == 4.2, "{cause}");
    // a limit that is over before the first step
    for method in [&["--method", "taylor"][..], &["--method", "leapfrog", "--step", "0.1"]] {
        let (value, cause) = solve(&[method, &["--time-limit", "1e-9"]].concat());
        assert!(cause.contains("the time limit of 1e-9 s is over") && value["end"] == 0.0, "{cause}");
    }
    let (value, _) = answer(&["solve", "sledge", "-f", "chetaev", "--max-step", "0.01", "--format", "json"], 0);
    let steps = serde_json::from_str::<Value>(&value).expect("JSON")["work"]["steps"].as_u64();
    assert!(steps.is_some_and(|steps| (2000..2200).contains(&steps)), "{steps:?}");
    let limited = ["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..1:3", "--time-limit", "1e-9"];
    let (members, _) = answer(&limited, 3);
    assert_eq!(members.matches("time limit of").count(), 3, "{members}");
    let (page, _) = answer(&["compare", "bowl", "--max-steps", "20", "--format", "json"], 0);
    assert!(page.contains("more than 20 steps"), "{page}");
}

#[test]
fn a_chart_that_ends_is_a_stop_with_time_and_cause() {
    let arguments = ["solve", "sledge", "-f", "removed-constraint", "--removal", "along-x", "--constants", "zero"];
    let output = run(&[&arguments[..], &["--format", "json"]].concat());
    exit(&output, 3);
    let stderr = text(&output.stderr);
    println!("{stderr}");
    assert!(stderr.contains("stopped at t = ") && stderr.contains("cos(phi)"), "{stderr}");
    // no tolerance leads on
    assert!(!stderr.contains("ask for a smaller"), "{stderr}");
    let value: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["status"], "stopped");
    assert!(value["cause"].as_str().is_some_and(|c| c.contains("cos(phi)")), "{}", value["cause"]);
    let end = value["end"].as_f64().expect("a number");
    // and that is where the blade points across the slope
    let times = format!("0,{}", end * (1.0 - 1e-9));
    let last = run(&[&arguments[..], &["--format", "json", "--times", &times]].concat());
    let value: Value = serde_json::from_slice(&last.stdout).expect("JSON");
    let phi = column(&value, "coordinates", "phi")[1];
    assert!((phi.abs() - std::f64::consts::FRAC_PI_2).abs() < 1e-5, "stopped at phi = {phi}");
}

#[test]
fn the_scenes_own_horizon_beyond_the_chart_is_no_success() {
    let output = run(&["solve", "sledge", "-f", "removed-constraint", "--removal", "along-x"]);
    let (code, stderr) = (output.status.code(), text(&output.stderr));
    println!("sledge --removal along-x: {code:?}, {stderr}");
    assert_eq!(code, Some(3), "{stderr}");
    assert!(!stderr.contains("panicked") && !stderr.is_empty(), "{stderr}");
}

#[test]
fn bad_input_is_refused_in_words() {
    all_refused(include_str!("refusals.txt"));
}

#[test]
fn list_and_show_answer() {
    let output = run(&["list"]);
    exit(&output, 0);
    assert!(text(&output.stdout).lines().count() >= 13);
    let output = run(&["show", "sledge"]);
    exit(&output, 0);
    let shown = text(&output.stdout);
    for word in ["Chetaev", "vakonomic", "arc-length", "L ="] {
        assert!(shown.contains(word), "{word} is not in {shown}");
    }
}

#[test]
fn show_writes_code() {
    let code = |language: &str| {
        let output = run(&["show", "disc", "-f", "vakonomic", "--code", language]);
        exit(&output, 0);
        text(&output.stdout).to_string()
    };
    assert!(code("c").contains("int disc_vakonomic_rates(double t, const double state[10],"));
    assert!(code("numpy").contains("def rates(t, state, parameters=PARAMETERS):"));
    assert!(code("sympy").contains("RATES = sp.Matrix(["));
    let output = run(&["show", "disc", "--code", "c"]);
    assert!(text(&output.stdout).contains("disc_chetaev_rates"));
    refused(&["show", "disc", "-f", "chetaev,vakonomic", "--code", "c"], &["--code takes one formulation"]);
    refused(&["show", "appell-hamel", "-f", "vakonomic-costate", "--code", "c"], &["are not linear in them"]);
}

#[test]
fn show_says_in_which_form_equations_are_evaluated() {
    let output = run(&["show", "trailer"]);
    exit(&output, 0);
    let shown = text(&output.stdout);
    for words in
        ["eliminated beforehand", "pivots are watched", "instructions; the plain form takes", "one unknown: a quotient"]
    {
        assert!(shown.contains(words), "`{words}` is not in {shown}");
    }
    // sine and cosine of a heading, each times its rate; the speed is constant
    let folder = tempfile::tempdir().expect("a folder");
    let blade = folder.path().join("blade.toml");
    let scene = "title = \"blade\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nphi = { start = 0 }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2 + phi'^2 - phi^2)/2\"\nconstraints = [\"y'*cos(phi) - x'*sin(phi)\"]\n\
                 [start.velocities]\n\"x'\" = 1\n\"phi'\" = 0.5\n[run]\nduration = 1\n";
    std::fs::write(&blade, scene).expect("a file");
    let shown = text(&run(&["show", blade.to_str().expect("UTF-8"), "-f", "chetaev-reduced"]).stdout);
    assert!(shown.contains("each order of a Taylor series in 2 products of series and"), "{shown}");
    // two roots: Newton's method, and one form only
    let shown = text(&run(&["show", "appell-hamel"]).stdout);
    assert!(
        shown.contains("do not enter linearly") && shown.contains("instructions and LU factorizations of"),
        "{shown}"
    );
    let value = json(&["trailer", "-f", "vakonomic"]);
    let evaluations = value["work"]["evaluations"].as_u64().expect("a count");
    assert!(value["form"]["fallbacks"].as_u64().is_some_and(|n| n < evaluations / 20), "{}", value["form"]);
}

#[test]
fn a_start_may_be_an_equation() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/tests/scenes/ball-by-spin.toml");
    let told = answer(&["check", file], 0).0;
    assert_eq!(told.matches("by constraints and start equations").count(), 3, "{told}");
    // a ball without torques keeps its spin; x' varies, and psi', which is given, leaves the equation behind
    let spin = |line: &str| -> f64 {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect();
        let [theta, by_psi, by_phi] = [7, 11, 13].map(|i| row[i]);
        by_psi + by_phi * f64::cos(theta)
    };
    let vary = ["--vary", "x'=0..1:3", "--vary", "psi=0..1:2"];
    let told = answer(&[&["ensemble", file, "-f", "chetaev"], &vary[..]].concat(), 0).0;
    let spins: Vec<f64> = told.lines().skip(1).map(spin).collect();
    assert!(spins.len() == 6 && spins.iter().all(|w| (w - 5.0).abs() < 1e-10), "{told}");
    refused(&["check", file, "--set", "psi'=1"], &["start equation 1 contradicts", "limit 1e-10", "leave it out"]);
    let complaint = answer(&["prove", file, "--out", "-"], 3).1;
    assert!(complaint.contains("start equations supply velocities"), "{complaint}");
}

#[test]
fn a_robot_of_bodies_is_checked_and_shown_in_formulas() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (robot, formulas, odd) = (path("robot.toml"), path("formulas.toml"), path("odd.toml"));
    answer(&["new", "--bodies", &robot], 0);
    let told = answer(&["check", "--strict", &robot], 0).0;
    assert!(told.contains("left out: contact left: no slip across, as contact right: no slip across says the same"));
    // the scene of formulas has the same motion, to the last digit
    let shown = answer(&["show", "--formulas", &robot], 0).0;
    assert!(!shown.contains("[body") && !shown.contains("[motor"), "{shown}");
    std::fs::write(&formulas, &shown).expect("written");
    let motion = |file: &str| answer(&["solve", file, "-f", "chetaev", "--times", "0,1"], 0).0;
    assert_eq!(motion(&formulas), motion(&robot));
    assert_eq!(answer(&["show", "--formulas", &formulas], 0).0, shown);
    let text = std::fs::read_to_string(&robot).expect("a scene").replace("mass = 3\n", "mass = -3\n");
    std::fs::write(&odd, text).expect("written");
    let told = answer(&["check", &odd], 0).0;
    assert!(told.contains("odd.toml:25:8: the mass of [body.robot] is -3, below zero"), "{told}");
    refused(&["check", "--strict", &odd], &["below zero", "and --strict takes them for faults"]);
}
