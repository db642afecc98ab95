//! What is compiled a second time, as a program of its own tests, has tests; and who has tests is.

use std::path::Path;

use super::arrows::{folder, name, packages};

/// The number of unit tests in the sources of a folder.
fn unit_tests(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let of = |path: &Path| match path.extension() {
        _ if path.is_dir() => unit_tests(path),
        Some(ending) if ending == "rs" => {
            let text = std::fs::read_to_string(path).expect("a source");
            text.lines().filter(|line| line.trim() == "#[test]").count()
        }
        _ => 0,
    };
    entries.map(|entry| of(&entry.expect("a file").path())).sum()
}

#[test]
fn a_harness_is_compiled_where_there_are_unit_tests_only() {
    let mut wrong = String::new();
    for package in packages() {
        let sources = folder(&package).join("src");
        if !sources.exists() {
            continue;
        }
        let targets = package["targets"].as_array().expect("targets");
        let of_sources =
            |target: &&serde_json::Value| Path::new(target["src_path"].as_str().expect("a path")).starts_with(&sources);
        let harness = targets.iter().filter(of_sources).any(|target| target["test"] == true);
        let tests = unit_tests(&sources);
        if harness != (tests > 0) {
            wrong += &format!("{}: {tests} unit tests, test = {harness}\n", name(&package));
        }
        // for benches cargo compiles the same program, unless it is told not to
        let manifest = std::fs::read_to_string(folder(&package).join("Cargo.toml")).expect("a manifest");
        let [test, bench] =
            ["test = false", "bench = false"].map(|word| manifest.lines().filter(|l| *l == word).count());
        if test != bench {
            wrong += &format!("{}: {test} times test = false, {bench} times bench = false\n", name(&package));
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
