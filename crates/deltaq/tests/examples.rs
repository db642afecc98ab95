//! The README's system and its Rust program: the files are what the README prints, and the program runs.

use comparison::compare_unfitted;
use motion::{Settings, choices, solve_choice};
use scene::Scene;

#[allow(dead_code)]
#[path = "../examples/own_system.rs"]
mod own_system;

const README: &str = include_str!("../../../README.md");

/// The first block of the README in this language.
fn block(language: &str) -> &'static str {
    let start = README.find(&format!("```{language}\n")).expect("a block of this language") + language.len() + 4;
    let length = README[start..].find("```").expect("the end of the block");
    &README[start..start + length]
}

#[test]
fn the_readme_prints_the_example() {
    assert_eq!(block("toml"), include_str!("../examples/disc-on-slope.toml"));
    assert!(include_str!("../examples/own_system.rs").ends_with(block("rust")));
}

/// What the README says that a line of its program prints, in the place of the names.
fn printed(line: &str) -> &'static str {
    let line = block("rust").lines().find(|found| found.contains(line)).expect("a line");
    line.split_once("// ").expect("what it prints").1
}

#[test]
fn the_example_prints_what_the_readme_says() {
    let scene = Scene::parse("disc-on-slope", block("toml")).expect("the README's scene");
    let (settings, choices) = (Settings::default(), choices(&scene));
    let mut chetaev = solve_choice(&scene, &choices[0], &settings).expect("a motion");
    let x = chetaev.at(2.0).expect("in range").coordinates[0];
    assert_eq!(format!("{}: {x:.6}", choices[0].label), printed("motion.at(2.0)?"));
    let steps = chetaev.step_times();
    assert_eq!((steps[0], steps[steps.len() - 1], steps.len()), (0.0, 5.0, chetaev.work.steps + 1));
    assert!(steps.windows(2).all(|pair| pair[0] < pair[1]));
    let gap = &compare_unfitted(scene, choices, Vec::new(), &settings).expect("compared").pairs[0].gap;
    assert_eq!(format!("{:.2}", gap.largest), printed(".gap.largest"));
}

#[test]
fn the_example_runs() {
    std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).expect("the folder of the examples");
    own_system::main().expect("the README's program");
}
