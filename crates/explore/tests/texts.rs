//! What a text is answered: gaps in metres, notes; and what the editor of the page knows.

use scene::Scene;
use serde_json::json;

use super::{SLEDGE, ask, place};

/// Gaps are in metres: four times the mass does not change them.
#[test]
fn gaps_do_not_depend_on_the_unit_of_mass() {
    let heavy = SLEDGE.replace("mass = 1\ninertia = [0, 0, \"k^2\"]", "mass = 4\ninertia = [0, 0, \"4*k^2\"]");
    let gaps = |text: &str| {
        let question =
            json!({ "ask": "motions", "name": "a", "text": text, "motions": ["Chetaev", "vakonomic"], "steps": 20 });
        let (answer, numbers) = ask(question);
        let gap = &answer["gaps"][0];
        assert_eq!(gap["unit"], "m", "{answer}");
        let [from, rows] = ["from", "rows"].map(|name| place(gap, name));
        [numbers[from + 3 * (rows / 2) + 1], gap["largest"].as_f64().unwrap()]
    };
    let (one, four) = (gaps(SLEDGE), gaps(&heavy));
    assert_ne!(SLEDGE, heavy);
    assert!(one[0] > 1e-3, "{one:?}");
    assert!(one.iter().zip(four).all(|(a, b)| (a / b - 1.0).abs() < 1e-6), "{one:?}, of four times the mass {four:?}");
}

/// Notes on a text are those of `deltaq check`, with their places.
#[test]
fn notes_are_those_of_the_check() {
    let odd = SLEDGE.replace("[coordinates]", "unused = 2.0\n[coordinates]");
    let (answer, _) = ask(json!({ "ask": "check", "name": "a", "text": odd }));
    let set: &[(String, f64)] = &[];
    let (_, remarks) = Scene::remarks("a", &odd, set).unwrap();
    assert_eq!(answer["remarks"].as_array().map(Vec::len), Some(remarks.len()));
    let line = odd.lines().position(|line| line.starts_with("unused")).unwrap() + 1;
    assert_eq!(
        (&answer["remarks"][0]["line"], &answer["remarks"][0]["message"]),
        (&json!(line), &json!(remarks[0].kind.to_string()))
    );
}

/// The page lists and completes every function that a formula can call.
#[test]
fn the_page_lists_the_functions() {
    let listed = include_str!("../page/functions.js");
    for name in symbolic::callable() {
        assert!(listed.contains(&format!("\"{name}(")), "{name} is not in functions.js");
    }
}
