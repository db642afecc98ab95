//! The Rust programs of the tutorials are what their pages print, and run.

use std::path::Path;

#[path = "tutorials/compare.rs"]
mod compare;
#[path = "tutorials/derive.rs"]
mod derive;
#[path = "tutorials/ensemble.rs"]
mod ensemble;
#[path = "tutorials/fit.rs"]
mod fit;
#[path = "tutorials/prove.rs"]
mod prove;

/// A program of a tutorial, by the name of its page.
type Program = (&'static str, &'static str, fn() -> Result<(), Box<dyn std::error::Error>>);

const PROGRAMS: [Program; 5] = [
    ("derive", include_str!("tutorials/derive.rs"), derive::main),
    ("compare", include_str!("tutorials/compare.rs"), compare::main),
    ("prove", include_str!("tutorials/prove.rs"), prove::main),
    ("fit", include_str!("tutorials/fit.rs"), fit::main),
    ("ensemble", include_str!("tutorials/ensemble.rs"), ensemble::main),
];

#[test]
fn programs_of_tutorials_are_those_of_the_pages_and_run() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    // that of the README's program, which runs beside this one
    std::env::set_current_dir(root.join("crates/deltaq/examples")).expect("the folder of the examples");
    for (name, program, main) in PROGRAMS {
        let page = std::fs::read_to_string(root.join(format!("docs/tutorials/{name}.md"))).expect("the page");
        let block = page.split("```rust\n").nth(1).and_then(|rest| rest.split("```").next()).expect("a program");
        assert!(program.ends_with(block), "{name}: the page prints another program");
        assert!(block.lines().count() <= 21, "{name} has {} lines", block.lines().count());
        main().unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
