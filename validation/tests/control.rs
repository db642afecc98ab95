//! The control is flagged on scenes where Maggi's equations say that it is wrong, and nowhere else.

use comparison::{Comparison, Extent, Run};
use motion::{Settings, choices, solve_choice};
use random::{FoundOut, Word};
use scene::Scene;
use validation::report::control::{Control, sentence};
use validation::report::overview;

/// Chetaev's motion of `scene` and the control, or `forged` in the place of one of them.
fn compared(name: &str, forged: fn(&mut Run, &mut Run)) -> Comparison {
    let scene = scene::catalogue::find(name, &[("duration".into(), 0.5.into())]).expect("built in");
    let settings = Settings::default();
    let choices = choices(&scene);
    let mut control = review::substitution::run(&scene, &choices, &settings).expect("a removal");
    let choice = choices.into_iter().next().expect("Chetaev's");
    let mut chetaev = Run { outcome: solve_choice(&scene, &choice, &settings), choice };
    forged(&mut chetaev, &mut control);
    let mut comparison = Comparison::new(scene, Extent::Answer, &settings).expect("compared");
    comparison.add(chetaev).expect("a motion");
    comparison.add(control).expect("a motion");
    comparison
}

fn motion(run: &Run) -> motion::Motion {
    run.outcome.clone().expect("a motion")
}

#[track_caller]
fn said(comparisons: &[Comparison], words: &[&str]) {
    let text = overview(comparisons, &[]);
    for words in words {
        assert!(text.contains(words), "`{words}` is not in\n{text}");
    }
}

#[test]
fn the_control_is_flagged_where_it_is_wrong_and_called_right_where_it_is_right() {
    let comparisons = ["sledge", "particle", "disc", "heisenberg"].map(|name| compared(name, |_, _| {}));
    let found = "violates Maggi's equations on 2 scenes";
    let flagged = " and is flagged on 2. It is called right on `disc` and `heisenberg`";
    said(&comparisons, &["**The negative control is detected.**", found, flagged, "| flagged |", "| right here |"]);
}

#[test]
fn a_wrong_control_that_is_not_flagged_is_a_fault_of_the_program() {
    let blind = compared("sledge", |chetaev, control| chetaev.outcome = Ok(motion(control)));
    let words = ["**The negative control is not detected.**", "On `sledge` Maggi's equations disagree"];
    said(&[blind], &[words[0], words[1], "| wrong, and not flagged |"]);
}

/// The disc's control is right; what it is compared with is the motion of a disc on a slope.
#[test]
fn a_right_control_that_is_flagged_is_a_fault_of_the_program() {
    let other = |chetaev: &mut Run, _: &mut Run| {
        let text = scene::catalogue::SCENES.iter().find(|scene| scene.0 == "disc").expect("built in").1;
        let text = format!("{text}\n[system]\nlagrangian = \"x/10\"\n");
        let scene = Scene::parse_with("disc", &text, &[("duration".to_owned(), 0.5)]).expect("a scene");
        chetaev.outcome = solve_choice(&scene, &chetaev.choice, &Settings::default());
    };
    let words = ["**The negative control is not detected.**", "On `disc` Maggi's equations disagree"];
    said(&[compared("disc", other)], &[words[0], words[1], "| flagged, though right |"]);
}

#[test]
fn residuals_are_those_of_controls_that_are_right() {
    let control = |name: &str, flagged: bool, residual: f64| {
        let found = FoundOut { residual, flagged, word: Some(Word::Holds), note: String::new() };
        Control { name: name.into(), is_same: !flagged, found: Some(found) }
    };
    let said = sentence(&[control("a", true, 0.3), control("b", false, 2e-14), control("c", false, 1e-15)]);
    assert!(said.contains(" on 1 scene and is flagged on 1. "), "{said}");
    assert!(said.ends_with("called right on b and c, with a residual of at most 2.0e-14."), "{said}");
}
