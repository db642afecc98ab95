//! What is said first says no more than the table below it.

use comparison::{Comparison, Verdict, compare_motions, compare_unfitted};
use equations::DerivationError;
use mechanics::ConstantsRule;
use motion::{Metric, Settings, SolveError, choices, setting, solve};
use pages::Headline;
use scene::Scene;

fn compared(scene: Scene) -> Comparison {
    let choices = choices(&scene);
    compare_unfitted(scene, choices, Vec::new(), &Settings::default()).expect("compared")
}

fn read(name: &str, text: &str) -> Scene {
    Scene::parse(name, text).unwrap_or_else(|e| panic!("{e}"))
}

/// A point on a sphere, its constraint said by velocities; removals whose parameters are no coordinates have
/// other motions there.
const PENDULUM: &str = r#"
title = "pendulum"
[coordinates]
x = { start = 0.6 }
y = { start = 0 }
z = { start = -0.8 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2 - 9.81*z"
constraints = ["x*x' + y*y' + z*z'"]
[start.velocities]
"x'" = 0.3
"y'" = 0.5
[run]
duration = 1
"#;

#[test]
fn one_row_that_differs_is_enough() {
    let comparison = compared(read("pendulum", PENDULUM));
    let differ = comparison.pairs.iter().any(|p| p.gap.verdict == Verdict::Different);
    assert!(differ, "a scene where a row says different");
    let verdict = Headline::of(&comparison).verdict;
    println!("{verdict}");
    assert!(!verdict.contains("No formulation's"), "{verdict}");
    // every motion stands in one class, with those alone that its rows call the same
    let classes = verdict.split_once("different motions: ").expect("classes").1;
    let classes: Vec<Vec<&str>> = classes
        .split(". ")
        .next()
        .expect("one sentence")
        .split("; ")
        .map(|class| class.split(" ≈ ").collect())
        .collect();
    for pair in &comparison.pairs {
        let [a, b] = [pair.first, pair.second].map(|i| comparison.runs[i].choice.label.as_str());
        if [a, b].iter().any(|label| label.contains("costate")) {
            continue;
        }
        let together = classes.iter().any(|class| class.contains(&a) && class.contains(&b));
        assert_eq!(together, pair.gap.verdict == Verdict::Same, "{a} and {b} in {verdict}");
    }
}

#[test]
fn all_are_the_same_only_where_every_row_says_so() {
    let free = PENDULUM.replace("x*x' + y*y' + z*z'", "y' - 0.5").replace("\"y'\" = 0.5", "\"z'\" = 0.1");
    let mut comparison = compared(read("slide", &free));
    let nowhere = "No formulation's motion differs from another's by more than the error estimates";
    assert_eq!(Headline::of(&comparison).verdict, format!("{nowhere} up to 1 s."));
    // a formulation without a motion is named
    let refused = DerivationError::RemovalMissing { formulation: "vakonomic" };
    comparison.runs[1].outcome = Err(SolveError::Derivation(refused));
    comparison.pairs.retain(|p| p.first != 1 && p.second != 1);
    let verdict = Headline::of(&comparison).verdict;
    println!("{verdict}");
    assert!(!verdict.contains("No formulation's") && verdict.contains("vakonomic: no motion"), "{verdict}");
}

#[test]
fn with_forces_every_formulation_has_its_motion() {
    let text = PENDULUM.replace("[start.vel", "forces = { x = \"-0.1*x'\" }\n[start.vel");
    let verdict = Headline::of(&compared(read("pendulum", &text))).verdict;
    println!("{verdict}");
    // x² + y² + z² is constant
    assert!(verdict.contains("Chetaev ≈ vakonomic ≈ removed constraint (coordinates)"), "{verdict}");
    assert!(!verdict.contains("no motion"), "{verdict}");
}

#[test]
fn a_removal_without_costates_is_said_to_be_substitution() {
    let mut count = 0;
    for name in ["disc", "chaplygin-sphere", "veselova", "falling-disc", "sledge", "heisenberg"] {
        let scene = scene::catalogue::find(name, &[("duration".into(), 0.5.into())]).expect("built in");
        let mut metric = Metric::new(&scene.system).expect("a metric");
        let mut comparison = compared(scene);
        let why = Headline::of(&comparison).why;
        println!("{name}: {why}");
        for run in &mut comparison.runs {
            let (Some(removal), Ok(motion)) = (&run.choice.removal, &mut run.outcome) else { continue };
            let equations = review::substitution::derive(&comparison.scene.system, removal);
            let setting = setting(&comparison.scene);
            let Ok(mut wrong) = solve(setting, equations, &ConstantsRule::Zero, &Settings::default()) else { continue };
            let gap = compare_motions(motion, &mut wrong, &mut metric).expect("a gap");
            let said = why.contains("substitution") && why.contains(&run.choice.label);
            println!("  {}: {:?}, said: {said}", run.choice.label, gap.verdict);
            assert!(!said || gap.verdict == Verdict::Same, "{name}, {}: {:?}", run.choice.label, gap.verdict);
            count += usize::from(said);
        }
    }
    assert!(count >= 3, "{count}");
}
