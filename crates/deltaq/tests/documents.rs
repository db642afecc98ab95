//! What README and documents print after a `$` is what the program prints.

use std::fs;
use std::path::Path;

use scene::format::{
    BODY, CONTACT, COORDINATE, DAMPER, JOINT, LOOP, MACHINE, MOTOR, REMOVAL, RUN, SCENE, SPRING, START, SYSTEM,
    VAKONOMIC,
};

use crate::support;

/// The file that the README tells its reader to write.
const DISC: &str = include_str!("../../deltaq/examples/disc-on-slope.toml");

fn runs_as_printed(name: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("page.md");
    fs::copy(root.join(name), &page).expect("the page");
    let inputs = folder.path().join("page.in");
    fs::create_dir(&inputs).expect("the folder in which commands run");
    fs::write(inputs.join("disc-on-slope.toml"), DISC).expect("the scene");
    fs::copy(root.join("docs/robot-film.csv"), inputs.join("robot-film.csv")).expect("the film");
    fs::write(inputs.join("disc-film.csv"), include_str!("../examples/disc-film.csv")).expect("the film");
    for theirs in fs::read_dir(root.join("docs/derivations")).expect("equations").flatten() {
        fs::copy(theirs.path(), inputs.join(theirs.file_name())).expect("equations");
    }
    trycmd::TestCases::new().case(&page).run();
}

#[test]
fn the_readme_is_true() {
    runs_as_printed("README.md");
    runs_as_printed("crates/deltaq/README.md");
}

/// Every page that shows commands with what they print.
#[test]
fn the_pages_are_true() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let mut run = 0;
    for page in fs::read_dir(docs).expect("documents").flatten().map(|entry| entry.path()) {
        let is_page = page.extension().is_some_and(|extension| extension == "md");
        if is_page && fs::read_to_string(&page).expect("a page").contains("```console\n$ deltaq") {
            runs_as_printed(&format!("docs/{}", page.file_name().and_then(|name| name.to_str()).expect("UTF-8")));
            run += 1;
        }
    }
    assert!(run >= 10, "only {run} pages show commands");
}

#[test]
fn the_tutorials_are_true() {
    for name in ["derive", "compare", "prove", "fit", "ensemble"] {
        runs_as_printed(&format!("docs/tutorials/{name}.md"));
    }
}

/// Keys are those of the reader, and the pieces of scenes are pieces of scenes that are read by other tests.
#[test]
fn the_page_of_the_scene_format_is_true() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let read = |path: &str| fs::read_to_string(root.join(path)).expect("a file");
    let page = read("docs/scenes.md") + &read("docs/bodies.md");
    let keys = [SCENE, COORDINATE, SYSTEM, START, VAKONOMIC, RUN, REMOVAL, BODY].concat();
    let bodies = [MACHINE, JOINT, CONTACT, SPRING, DAMPER, MOTOR, LOOP].concat();
    let keys = [keys, bodies].concat();
    for key in keys {
        let name = key.name;
        let written = [format!("`{name}`"), format!("`[{name}]`"), format!("`[{name}.NAME]`"), format!(" {name} = ")];
        assert!(written.iter().any(|written| page.contains(written)), "{name} is not on the page");
    }
    let whole = [
        "tests/tests/scenes/rattleback-by-vectors.toml",
        "tests/tests/scenes/ball-by-spin.toml",
        "crates/scene/scenes/sledge.toml",
        "crates/scene/classics/sledge-with-friction.toml",
        "crates/deltaq/src/robot.toml",
    ]
    .map(read);
    let flat = |line: &str| line.split(" #").next().unwrap_or(line).split_whitespace().collect::<String>();
    let known: Vec<String> = whole.iter().flat_map(|text| text.lines()).map(flat).collect();
    let blocks: Vec<&str> = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 5);
    for line in blocks.iter().flat_map(|block| block.lines()).filter(|line| !line.is_empty()) {
        assert!(known.contains(&flat(line)), "{line}");
    }
}

#[test]
fn the_template_is_sound_and_rolls() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("own.toml");
    let path = path.to_str().expect("UTF-8");
    let run = |words: &[&str]| {
        let output = support::run(words);
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stdout).into_owned(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    assert_eq!(run(&["new", path]).0, Some(0));
    let (code, _, error) = run(&["new", path]);
    assert!(code == Some(2) && error.contains("own.toml"), "an own file would be lost: {error}");
    let (code, checked, _) = run(&["check", path]);
    assert!(code == Some(0) && checked.starts_with("own: 5 coordinates, 2 constraints"), "{checked}");
    let (code, motion, _) = run(&["solve", path, "-f", "chetaev", "--times", "0,2"]);
    let rows: Vec<Vec<&str>> = motion.lines().map(|line| line.split(',').collect()).collect();
    let column = |name: &str, row: usize| -> f64 {
        let place = rows[0].iter().position(|known| *known == name).expect(name);
        rows[row][place].parse().expect("a number")
    };
    assert_eq!(code, Some(0));
    for row in [1, 2] {
        // the observable is that of the motion: degrees; and the disc rolls, x' = a roll' cos yaw
        assert!((column("tilt", row) - column("lean", row).to_degrees()).abs() < 1e-12);
        assert!((column("x'", row) - 0.5 * column("roll'", row) * column("yaw", row).cos()).abs() < 1e-10);
    }
    for source in ["sledge", "n-trailer-2", "rattleback"] {
        let shown = run(&["show", source, "--source"]);
        assert!(shown.0 == Some(0) && shown.1 == run(&["new", "--from", source]).1, "{source}");
    }
    fs::write(path, "title = 1\n[coordinates]\nx = { start = \"pi/\" }\n[run]\nduration = \"2*pi\"\n")
        .expect("written");
    let (code, _, error) = run(&["check", path, "sledge"]);
    assert!(code == Some(2) && error.ends_with("deltaq: 3 faults\n"), "{error}");
}
