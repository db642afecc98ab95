//! Every table of numbers by the names of its columns against the JSON of the same call.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::support::answer;

/// A disc that rolls upright: two multipliers, and two quantities of its own.
const DISC: &str = r#"
title = "A disc that rolls"
[parameters]
a = 0.5
g = 9.81
[coordinates]
y = { start = 0.3 }
x = { start = -0.2 }
yaw = { start = 0.4 }
roll = { start = 0.1 }
[system]
lagrangian = "(x'^2 + y'^2)/2 + yaw'^2/8 + roll'^2/16 - g*y/3"
constraints = ["x' - a*roll'*cos(yaw)", "y' - a*roll'*sin(yaw)"]
[observables]
speed = "sqrt(x'^2 + y'^2)"
height = "y - x/7"
[start.velocities]
"yaw'" = 0.7
"roll'" = 1.3
[vakonomic]
multipliers = [0.2, -0.1]
[run]
duration = 2
"#;

/// What a table says: cells by row, name by name.
type Rows = Vec<BTreeMap<String, String>>;

/// The rows of a table; a cause, which is quoted, stands last.
fn table(text: &str) -> Rows {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let row = |line: &str| {
        let cells: Vec<String> = line.splitn(names.len(), ',').map(String::from).collect();
        assert_eq!(cells.len(), names.len(), "{line}");
        names.iter().map(|name| name.to_string()).zip(cells).collect()
    };
    lines.map(row).collect()
}

/// A value of JSON as a cell: numbers with all their digits, causes in quotation marks.
fn cell(name: &str, value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if name == "cause" => format!("\"{}\"", text.replace('"', "\"\"")),
        Value::String(text) => text.clone(),
        Value::Number(number) if name != "member" => format!("{:?}", number.as_f64().expect("a number")),
        other => other.to_string(),
    }
}

/// Adds a group of columns, `{ name: [number, …] }`, to the rows.
fn add(rows: &mut Rows, group: &Value, name: impl Fn(&str) -> String) {
    for (key, column) in group.as_object().into_iter().flatten() {
        let (name, column) = (name(key), column.as_array().expect("a column"));
        assert_eq!(column.len(), rows.len(), "{name}");
        for (row, value) in rows.iter_mut().zip(column) {
            assert!(row.insert(name.clone(), cell(&name, value)).is_none(), "{name} twice");
        }
    }
}

/// Adds the error estimates of JSON.
fn add_errors(rows: &mut Rows, errors: &Value) {
    add(rows, &errors["coordinates"], |name| format!("error {name}"));
    add(rows, &errors["velocities"], |name| format!("error {name}'"));
    add(rows, &errors["multipliers"], |name| format!("error {name}"));
}

/// Times, coordinates, velocities and multipliers of JSON, one row per time.
fn motion(value: &Value) -> Rows {
    let times = value["times"].as_array().expect("times");
    let mut rows: Rows = times.iter().map(|t| BTreeMap::from([("t".into(), cell("t", t))])).collect();
    add(&mut rows, &value["coordinates"], |name| name.into());
    add(&mut rows, &value["velocities"], |name| format!("{name}'"));
    add(&mut rows, &value["multipliers"], |name| name.into());
    rows
}

/// Rows have the same names, and under them the same; of numbers, which come out of JSON rounded, up to that.
#[track_caller]
fn are_the_same(found: &Rows, expected: &Rows) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.keys().eq(expected.keys()), "{:?} and {:?}", found.keys(), expected.keys());
        for ((name, a), b) in found.iter().zip(expected.values()) {
            let numbers = a.parse::<f64>().ok().zip(b.parse::<f64>().ok());
            let rounded = numbers.is_some_and(|(a, b)| (a - b).abs() <= 2.0 * f64::EPSILON * b.abs());
            assert!(a == b || rounded, "{name}: {a} and {b} in {found:?}");
        }
    }
}

/// The table of a call and its JSON.
fn both(call: &[&str], code: i32) -> (Rows, Value) {
    let csv = answer(&[call, &["--format", "csv"]].concat(), code).0;
    let json = answer(&[call, &["--format", "json"]].concat(), code).0;
    (table(&csv), serde_json::from_str(&json).expect("JSON"))
}

fn with_disc(test: impl FnOnce(&str)) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("disc.toml");
    std::fs::write(&path, DISC).expect("a file");
    test(path.to_str().expect("UTF-8"));
}

#[test]
fn derivatives_have_in_their_columns_what_the_json_has_under_their_names() {
    with_disc(|disc| {
        let call = ["solve", disc, "-f", "vakonomic", "--times", "0,1", "--sensitivities", "a,mu0_1,yaw'"];
        let (found, json) = both(&call, 0);
        let mut expected = motion(&json);
        add_errors(&mut expected, &json["error_estimates"]);
        add(&mut expected, &json["observables"], |name| name.into());
        for by in ["a", "mu0_1", "yaw'"] {
            let derivatives = &json["sensitivities"][by];
            for (of, kind) in [(derivatives, ""), (&derivatives["error_estimates"], "error ")] {
                add(&mut expected, &of["coordinates"], |name| format!("{kind}d{name}/d{by}"));
                add(&mut expected, &of["velocities"], |name| format!("{kind}d{name}'/d{by}"));
                add(&mut expected, &of["multipliers"], |name| format!("{kind}d{name}/d{by}"));
            }
        }
        are_the_same(&found, &expected);
        // the start of the multiplier is one number of its own, the constraints supply y' = a roll' sin(yaw)
        let x = |name: &str| found[0][name].parse::<f64>().expect("a number");
        assert!((x("dmu_1/dmu0_1") - 1.0).abs() < 1e-13 && x("dmu_2/dmu0_1").abs() < 1e-13);
        assert!((x("dy'/da") - 1.3 * 0.4_f64.sin()).abs() < 1e-12, "{}", x("dy'/da"));
        let refused = answer(&["solve", disc, "-f", "chetaev", "--sensitivities", "mass"], 2).1;
        assert!(refused.contains("`mass` is not a parameter"), "{refused}");
    });
}

#[test]
fn motions_have_in_their_columns_what_the_json_has_under_their_names() {
    with_disc(|disc| {
        for formulation in ["chetaev", "vakonomic", "removed-constraint"] {
            // a tolerance at which errors are not round-off
            let call = ["solve", disc, "-f", formulation, "--times", "0:2:5", "--tolerance", "1e-7"];
            let (found, json) = both(&[&call[..], &["--method", "dop853"]].concat(), 0);
            let mut expected = motion(&json);
            add_errors(&mut expected, &json["error_estimates"]);
            add(&mut expected, &json["observables"], |name| name.into());
            are_the_same(&found, &expected);
            // and the JSON is of the scene: observables of these places, a constraint that holds
            for row in &found {
                let x = |name: &str| row[name].parse::<f64>().expect("a number");
                assert!((x("speed") - x("x'").hypot(x("y'"))).abs() < 1e-12, "{row:?}");
                assert!((x("height") - (x("y") - x("x") / 7.0)).abs() < 1e-12, "{row:?}");
                assert!((x("y'") - 0.5 * x("roll'") * x("yaw").sin()).abs() < 1e-9, "{row:?}");
            }
            // the estimate of the whole is at least that of any coordinate, by its mass: 1, 1, 1/4, 1/8
            let last = found.last().expect("rows");
            let error = |name: &str| last[&format!("error {name}")].parse::<f64>().expect("a number");
            let largest = ["x", "y"].map(error).into_iter().chain([error("yaw") / 2.0, error("roll") / 8_f64.sqrt()]);
            let (largest, whole) = (largest.fold(0.0, f64::max), json["error_estimate"].as_f64().expect("a number"));
            assert!(whole >= 0.9 * largest && whole <= 4.0 * largest, "{whole:e}, {largest:e}: {last:?}");
        }
    });
}

#[test]
fn members_have_in_their_columns_what_the_json_has_under_their_names() {
    with_disc(|disc| {
        let vary = ["--vary", "yaw=0.1..0.9:2", "--vary", "g=5..9:2", "--times", "0.5,2", "--tolerance", "1e-6"];
        let (found, json) = both(&[&["ensemble", disc, "-f", "vakonomic"], &vary[..]].concat(), 0);
        let (broken, refused) = both(&["ensemble", "ball-in-cone", "-f", "chetaev", "--vary", "theta=-0.4..0.4:3"], 3);
        for (found, json, count) in [(found, json, 8), (broken, refused, 3)] {
            let mut expected = Vec::new();
            for (member, value) in json["members"].as_array().expect("members").iter().zip(1..) {
                let mut rows = motion(member);
                if rows.is_empty() {
                    // one without numbers
                    rows.push(found[0].keys().map(|name| (name.clone(), String::new())).collect());
                }
                for row in &mut rows {
                    row.insert("member".into(), value.to_string());
                    for name in ["status", "cause", "error_estimate"] {
                        row.insert(name.into(), cell(name, &member[name]));
                    }
                    for (name, x) in member["set"].as_object().expect("an object") {
                        row.insert(format!("set {name}"), cell(name, x));
                    }
                }
                expected.extend(rows);
            }
            are_the_same(&found, &expected);
            assert_eq!(found.len(), count);
            let members = json["members"].as_array().expect("members");
            for (status, counted) in json["count"].as_object().expect("counts") {
                let so = members.iter().filter(|member| member["status"] == status.as_str()).count();
                assert_eq!(*counted, so, "{status}");
            }
        }
    });
}

#[test]
fn estimates_of_members_are_those_of_single_motions() {
    // the way is a hundred times as long as 1
    let common = ["sledge", "-f", "vakonomic", "--times", "2,4,6,8,10", "--tolerance", "1e-7", "--format", "json"];
    let json = |call: &[&str]| -> Value {
        serde_json::from_str(&answer(&[&call[..1], &common, &call[1..]].concat(), 0).0).expect("JSON")
    };
    let members = json(&["ensemble", "--vary", "g=9..10:2"]);
    for (member, g) in members["members"].as_array().expect("members").iter().zip(["g=9", "g=10"]) {
        let single = json(&["solve", "--method", "taylor", "--set", g]);
        let [one, other] = [member, &single].map(|value| value["error_estimate"].as_f64().expect("a number"));
        assert!((0.2..5.0).contains(&(one / other)), "{one:e} in company, {other:e} alone");
    }
}

#[test]
fn a_motion_in_json_has_its_own_projections_and_drifts() {
    with_disc(|disc| {
        let call =
            ["solve", disc, "-f", "chetaev", "--form", "multipliers", "--tolerance", "1e-5", "--method", "dop853"];
        let json = |more: &[&str]| -> Value {
            let told = answer(&[&call[..], &["--times", "0:2:201", "--format", "json"], more].concat(), 0).0;
            serde_json::from_str(&told).expect("JSON")
        };
        let (with, without) = (json(&[]), json(&["--no-projection"]));
        let projection =
            |value: &Value| ["count", "largest"].map(|name| value["projection"][name].as_f64().expect("a number"));
        let ([count, largest], none) = (projection(&with), projection(&without));
        assert!(count > 3.0 && (1e-12..1e-3).contains(&largest) && none == [0.0; 2], "{count}, {largest:e}, {none:?}");
        for (value, least) in [(with, 0.0), (without, 1e-10)] {
            let column = |group: &str, name: &str, i: usize| value[group][name][i].as_f64().expect("a number");
            let energy = |i: usize| {
                let rate = |name: &str, mass: f64| 0.5 * mass * column("velocities", name, i).powi(2);
                rate("x", 1.0)
                    + rate("y", 1.0)
                    + rate("yaw", 0.25)
                    + rate("roll", 0.125)
                    + 3.27 * column("coordinates", "y", i)
            };
            let drift = (0..201).map(|i| (energy(i) - energy(0)).abs()).fold(0.0, f64::max);
            let told = &value["invariants"]["energy"];
            let [start, told] = ["start", "drift"].map(|name| told[name].as_f64().expect("a number"));
            assert!(
                (start - energy(0)).abs() < 1e-12 && (told - drift).abs() < 1e-2 * drift + 1e-13,
                "{told:e}, {drift:e}"
            );
            assert!(drift > least, "{drift:e}");
        }
    });
}

#[test]
fn the_table_of_eigenvalues_has_the_largest_error_of_each_line() {
    let sweep = ["linearize", "bicycle", "--free=lean,steer", "--sweep", "v=4:6:3", "--format"];
    let page = answer(&[&sweep[..], &["table"]].concat(), 0).0;
    let json: Value = serde_json::from_str(&answer(&[&sweep[..], &["json"]].concat(), 0).0).expect("JSON");
    let lines: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with('|'))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let place = lines[0].iter().position(|name| *name == "error").expect("a column");
    let points = json["points"].as_array().expect("points");
    assert_eq!(lines.len(), 2 + points.len());
    for (line, point) in lines[2..].iter().zip(points) {
        let errors = point["eigenvalues"]
            .as_array()
            .expect("eigenvalues")
            .iter()
            .map(|e| e["error"].as_f64().expect("a number"));
        let (largest, told) = (errors.fold(0.0, f64::max), line[place].parse::<f64>().expect("a number"));
        assert!((told / largest - 1.0).abs() < 0.06, "{told:e}, {largest:e}");
        // growing ones are counted by their real parts
        let growing = point["eigenvalues"].as_array().expect("eigenvalues").iter();
        let growing = growing.filter(|e| e["real"].as_f64() > e["error"].as_f64()).count();
        assert_eq!(line[place + 2].split(' ').next(), Some(&growing.to_string()[..]), "{line:?}");
    }
}

#[test]
fn eigenvalues_have_in_their_columns_what_the_json_has_under_their_names() {
    let sweep = ["linearize", "bicycle", "--free=lean,steer", "--sweep", "v=4:5:2"];
    let (found, json) = both(&sweep, 0);
    let mut expected = Rows::new();
    for point in json["points"].as_array().expect("points") {
        for eigenvalue in point["eigenvalues"].as_array().expect("eigenvalues") {
            let mut row = BTreeMap::from([("v".to_string(), cell("v", &point["value"]))]);
            row.extend(["real", "imaginary", "error"].map(|name| (name.into(), cell(name, &eigenvalue[name]))));
            expected.push(row);
        }
    }
    are_the_same(&found, &expected);
    assert_eq!(found.len(), 8);
}

#[test]
fn points_of_a_sweep_are_what_compare_says_of_them() {
    let call = ["compare", "sledge", "--quiet", "--set", "time=1.5"];
    let rows = table(&answer(&[&call[..], &["--sweep", "g=0:9:2", "--sweep", "phi'=0:1:2"]].concat(), 0).0);
    assert_eq!(rows.len(), 4);
    let mut words = std::collections::BTreeSet::new();
    for row in &rows {
        let set = ["g", "phi'"].map(|name| format!("{name}={}", row[name]));
        let one = [&call[..], &["--set", &set[0], "--set", &set[1], "-f", "chetaev,vakonomic", "--without", "fits"]];
        let json = answer(&[&one.concat()[..], &["--format", "json"]].concat(), 0).0;
        let json: Value = serde_json::from_str(&json).expect("JSON");
        let scene = &json["scenes"]["sledge"];
        let (pair, decided) = (&scene["pairs"][0], &scene["decided"][0]);
        let number = |name: &str| row[name].parse::<f64>().ok();
        words.extend([row["verdict"].clone(), row["answer"].clone()]);
        assert_eq!(row["verdict"], pair["verdict"].as_str().expect("a word"));
        let largest = number("largest").zip(pair["largest"].as_f64());
        assert!(largest.is_some_and(|(a, b)| (a - b).abs() <= 2.0 * f64::EPSILON * b), "{row:?}: {largest:?}");
        // at the end a gap has to pass ten times the estimates of both, and ten times round-off
        let both: f64 = pair["estimates"].as_array().expect("two").iter().filter_map(Value::as_f64).sum();
        let round_off = number("limit").expect("a limit") / 10.0 - both;
        assert!(round_off > 0.0 && round_off < 1e-11, "{row:?}: {both:e}");
        // JSON has the time of the clock in four digits, a sweep that from the start
        let apart = pair["passes"][1].as_f64().map(|t| t - 1.5);
        assert_eq!(number("apart").is_some(), apart.is_some(), "{row:?}");
        assert!(number("apart").zip(apart).is_none_or(|(a, b)| (a - b).abs() < 1e-3), "{row:?}: {apart:?}");
        let proved = if decided["proved"] == true { " proved" } else { "" };
        assert_eq!(row["answer"], format!("{}{proved}", decided["answer"].as_str().expect("a word")));
        let order = decided["order"].as_f64().filter(|_| row["answer"] == "none proved");
        assert_eq!((number("order"), number("dimension")), (order, decided["dimension"].as_f64()), "{row:?}");
    }
    assert!(words.contains("same") && words.contains("different") && words.contains("none proved"), "{words:?}");
    assert!(words.iter().any(|word| word.starts_with("some")), "{words:?}");
}

#[test]
fn a_fit_in_json_is_that_of_the_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_str().expect("UTF-8");
    let call = ["compare", "sledge", "--set", "duration=1", "-f", "chetaev,vakonomic", "--with", "fits", "--quiet"];
    let json: Value = serde_json::from_str(&answer(&[&call[..], &["--format", "json"]].concat(), 0).0).expect("JSON");
    let fit = &json["scenes"]["sledge"]["fits"][0];
    answer(&[&call[..], &["--out", out]].concat(), 0);
    let table = std::fs::read_to_string(folder.path().join("data/scenes/sledge/fits.csv")).expect("a table");
    let cells: Vec<&str> = table.lines().nth(1).expect("a row").splitn(9, ',').collect();
    let number = |text: &str| text.trim().parse::<f64>().expect("a number");
    let near = |told: f64, value: &Value| (told / value.as_f64().expect("a number") - 1.0).abs() < 0.06;
    assert!(near(number(cells[6]), &fit["largest"]), "{cells:?}, {fit}");
    assert!(near(number(cells[7]), &fit["by half"]) && fit["settled"] == true, "{cells:?}, {fit}");
    assert!(near(number(cells[4].split_once(" = ").expect("a constant").1), &fit["constants"]["mu0_1"]), "{cells:?}");
    assert_eq!(cells[3], fit["starts"].to_string(), "{cells:?}, {fit}");
}
