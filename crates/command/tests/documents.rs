//! What README and guide print after a `$` is what the program prints.

use std::fs;
use std::path::Path;

/// The file that the README tells its reader to write.
const SYSTEM: &str = include_str!("../../deltaq/examples/disc-on-slope.toml");

fn runs_as_printed(name: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = tempfile::tempdir().expect("a folder");
    let page = folder.path().join("page.md");
    fs::copy(root.join(name), &page).expect("the page");
    let inputs = folder.path().join("page.in");
    fs::create_dir(&inputs).expect("the folder in which commands run");
    fs::write(inputs.join("disc-on-slope.toml"), SYSTEM).expect("the scene");
    trycmd::TestCases::new().case(&page).run();
}

#[test]
fn the_readme_is_true() {
    runs_as_printed("README.md");
}

#[test]
fn the_guide_is_true() {
    runs_as_printed("docs/guide.md");
}
