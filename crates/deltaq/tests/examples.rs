//! The README's system and its Rust program: the files are what the README prints, and the program runs.

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

#[test]
fn the_example_runs() {
    std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).expect("the folder of the examples");
    own_system::main().expect("the README's program");
}
