//! Integrals and derivatives, against the library and against motions from other numbers.

use integrals::Integrals;
use motion::{Settings, choices, setting};
use scene::Scene;
use serde_json::{Value, json};

use super::{SLEDGE, ask, coordinates};

#[test]
fn integrals_are_those_of_the_library() {
    let question = json!({ "ask": "integrals", "name": "sledge", "text": SLEDGE, "set": { "k": 0.5 }, "degree": 1 });
    let (answer, _) = ask(question);
    let scene = Scene::parse_with("sledge", SLEDGE, &[("k".to_string(), 0.5)]).unwrap();
    let found = Integrals::find(&scene, &choices(&scene)[0], 1, &[]).unwrap();
    assert_eq!(answer["lines"], json!(found.lines()));
    assert!(answer["lines"].as_array().unwrap().iter().any(|line| line[0] == "integral"), "{answer}");
    let wrong = json!({ "ask": "integrals", "name": "sledge", "text": SLEDGE, "motions": ["none of these"] });
    assert_eq!(ask(wrong).0["refused"], "no motion is shown");
}

/// Where motions end, from numbers a little larger and smaller.
#[test]
fn derivatives_are_those_of_motions() {
    let labels = ["Chetaev", "vakonomic", "removed constraint (arc-length)"];
    let question = |ask: &str, set: Value| json!({ "ask": ask, "name": "sledge", "text": SLEDGE, "set": set, "motions": labels, "steps": 1 });
    let (found, _) = ask(question("derivatives", json!({ "duration": 2.0 })));
    for (i, label) in labels.iter().enumerate() {
        let motion = &found["motions"][i];
        assert_eq!(motion["end"], 2.0, "{label}");
        let rows = motion["rows"].as_array().unwrap();
        let has_multiplier = rows.iter().any(|row| row["name"] == "mu0_1");
        assert_eq!(has_multiplier, *label == "vakonomic", "{label}");
        assert!(rows.len() >= 8, "{label}: {motion}");
        for row in rows {
            let name = row["name"].as_str().unwrap();
            let (value, step) = (value_of(name), 1e-4);
            let ends = [-step, step].map(|by| {
                let (all, numbers) = ask(question("motions", json!({ "duration": 2.0, name: value + by })));
                coordinates(&all["motions"][i], &numbers, 1, 3).to_vec()
            });
            for (j, by) in row["by"].as_array().unwrap().iter().enumerate() {
                let (by, quotient) = (by.as_f64().unwrap(), (ends[1][j] - ends[0][j]) / (2.0 * step));
                assert!((by - quotient).abs() < 1e-5 * (1.0 + by.abs()), "{label}, {name}, {j}: {by} {quotient}");
                assert!(row["error"][j].as_f64().unwrap() < 1e-6, "{label}, {name}: {row}");
            }
        }
    }
}

/// What the sliders of the sledge say.
fn value_of(name: &str) -> f64 {
    let (scene, _) = ask(json!({ "ask": "scene", "name": "sledge", "text": SLEDGE }));
    let of = |control: &&Value| control["name"].as_str().unwrap().split('@').next() == Some(name);
    let control = scene["controls"].as_array().unwrap().iter().find(of).unwrap();
    control["value"].as_f64().unwrap_or(0.0)
}

#[test]
fn a_number_that_cannot_be_varied_is_named_and_the_others_have_their_derivatives() {
    let text = r#"
        title = "Thrown"
        parameters = { p = 0, g = 10 }
        [coordinates]
        x = { start = "sqrt(p^2)" }
        [system]
        lagrangian = "x'^2/2 - g*x"
        constraints = []
        [start]
        velocities = { "x'" = 1 }
        [run]
        duration = 2
    "#;
    let (found, _) = ask(json!({ "ask": "derivatives", "name": "own", "text": text }));
    let rows = found["motions"][0]["rows"].as_array().unwrap_or_else(|| panic!("{found}"));
    let of = |name: &str| rows.iter().find(|row| row["name"] == name).unwrap();
    assert!(of("p")["refused"].as_str().unwrap().contains("does not move smoothly with p"), "{found}");
    for (name, by) in [("x", 1.0), ("x'", 2.0), ("g", -2.0)] {
        assert!((of(name)["by"][0].as_f64().unwrap() - by).abs() < 1e-9, "{name}: {found}");
    }
}

/// Derivatives are carried in one chart, and the motion changes it.
#[test]
fn where_derivatives_end_before_the_motion_it_is_said_why() {
    let text = include_str!("../../scene/scenes/rudder-skate.toml");
    let (found, _) = ask(json!({ "ask": "derivatives", "name": "rudder-skate", "text": text }));
    let motions = found["motions"].as_array().unwrap();
    let of = |label: &str| motions.iter().find(|m| m["label"] == label).unwrap_or_else(|| panic!("{label}: {found}"));
    let refused = of("removed constraint (coordinates)")["refused"].as_str().unwrap();
    assert!(refused.contains("cos(phi) vanishes, by which the equations divide"), "{refused}");
    assert!(of("Chetaev")["rows"].is_array(), "{found}");
    // that is so by whatever number: the motion is not asked again by each alone
    let scene = Scene::parse("rudder-skate", text).unwrap();
    let all = choices(&scene);
    let choice = all.iter().find(|choice| choice.label == "removed constraint (coordinates)").unwrap();
    let derived = |work: &dyn Fn()| {
        let (_, asked) = symbolic::faults::chances(work);
        asked.iter().filter(|chance| chance.at.file().replace('\\', "/").contains("removed-constraint/")).count()
    };
    let by_one =
        derived(&|| drop(motion::sensitivities(&scene, choice, &["x"], &[setting(&scene).end], &Settings::default())));
    let by_all = derived(&|| {
        ask(json!({ "ask": "derivatives", "name": "rudder-skate", "text": text, "motions": [choice.label] }));
    });
    assert!(by_one > 0 && by_all < 3 * by_one, "{by_all} operations, by one number {by_one}");
}

/// Equations are right, or the wrong term is told with its place.
#[test]
fn the_wrong_term_is_told() {
    let review = |theirs: &str| ask(json!({ "ask": "review", "name": "sledge", "text": SLEDGE, "theirs": theirs })).0;
    let right = "x'' = g*sin(alpha) - l*sin(phi)\ny'' = l*cos(phi)\nphi'' = 0*t";
    assert_eq!(review(right)["verdict"], "right");
    for (from, to, line, column, message) in [
        ("= g", "= -g", 1, 8, "`g*sin(alpha)` has the wrong sign"),
        ("= g", "= 2*g", 1, 7, "`2*g*sin(alpha)` is twice as large as it should be"),
        ("= 0*t", "= 0.3*x' # drag", 3, 9, "`0.3*x'` does not belong there"),
        ("l*cos(phi)", "l*cos(phi)/2", 2, 7, "`l*cos(phi)/2` is half as large as it should be"),
    ] {
        let answer = review(&right.replace(from, to));
        let mends = answer["mends"].as_array().unwrap();
        let told = json!({ "line": line, "column": column, "length": message.split('`').nth(1).unwrap().len(), "message": message });
        assert!(answer["verdict"] == "wrong" && mends.contains(&told), "{to}: {answer}");
    }
    assert!(review("x'' = g*sin(")["refused"].as_str().unwrap().starts_with("yours:1:"), "{}", review("x'' = g*sin("));
}
