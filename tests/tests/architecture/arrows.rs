//! The arrows between the crates of the workspace: the wall, what is never to be built on what, and the
//! table of them in `ARCHITECTURE.md`, which is written here.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// A dependency of one member of the workspace on another: `from` is built on `to`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Arrow {
    from: String,
    to: String,
    /// For its tests only.
    of_tests: bool,
}

/// Members that are built on none of these names; `*`: on no member at all.
const NEVER: [(&str, &str, &str); 17] = [
    ("symbolic integrate picture xtask", "*", "each is of use alone"),
    ("mechanics", "scene equations", "a system is not a file and has no equations of motion yet"),
    ("scene equations", "chetaev vakonomic removed-constraint kappa integrate", "they know no formulation"),
    ("discrete", "chetaev vakonomic removed-constraint kappa equations", "it judges what is derived"),
    ("chetaev", "vakonomic removed-constraint kappa reduction integrate scene", "formulations do not see one another"),
    ("vakonomic", "chetaev removed-constraint kappa reduction integrate scene", "formulations do not see one another"),
    ("removed-constraint", "chetaev vakonomic kappa reduction integrate scene", "formulations do not see one another"),
    ("kappa", "chetaev vakonomic removed-constraint reduction integrate scene", "formulations do not see one another"),
    ("reduction", "chetaev removed-constraint kappa motion integrate", "it only makes things faster"),
    ("decision", "motion reduction", "a decision reads equations and knows no formulation"),
    ("referees", "motion chetaev vakonomic removed-constraint kappa equations reduction", "a judge shares nothing"),
    ("reference", "integrate motion", "it measures the errors of `integrate`"),
    ("motion comparison", "program pages", "the library knows no files, pictures or command line"),
    ("motion linear judge", "comparison", "one formulation has its motions before they are compared"),
    ("linear explore", "program pages", "the library knows no files, pictures or command line"),
    ("random", "validation", "claims know no pages"),
    ("tests", "deltaq engine", "programs are tested where they are"),
];

/// The wall: what is in `crates` is built on nothing in these folders.
const EVIDENCE: [&str; 2] = ["validation", "tests"];

/// The members of the workspace, as `cargo metadata` describes them.
pub fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo).args(["metadata", "--no-deps", "--format-version", "1"]).output();
    let metadata: Value = serde_json::from_slice(&output.expect("cargo runs").stdout).expect("cargo metadata is JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// The folder of a member.
pub fn folder(package: &Value) -> &Path {
    Path::new(package["manifest_path"].as_str().expect("a path")).parent().expect("a folder")
}

/// The short name of a member, that of its folder.
pub fn name(package: &Value) -> String {
    folder(package).file_name().expect("a name").to_string_lossy().into_owned()
}

/// Every arrow between members, dependencies for tests and builds included.
fn arrows(packages: &[Value]) -> BTreeSet<Arrow> {
    // A dependency on a member is one with a path: other crates may bear the same name.
    let member = |path: &str| packages.iter().find(|package| folder(package) == Path::new(path)).map(name);
    let of = |package: &Value| {
        let from = name(package);
        let dependencies = package["dependencies"].as_array().cloned().unwrap_or_default().into_iter();
        let members = dependencies.filter_map(|dependency| {
            Some((member(dependency["path"].as_str()?)?, dependency["kind"].as_str() == Some("dev")))
        });
        // a package may ask for itself: with other features, for its tests
        let others = members.filter(|(to, _)| *to != from);
        others.map(|(to, of_tests)| Arrow { from: from.clone(), to, of_tests }).collect::<Vec<_>>()
    };
    packages.iter().flat_map(of).collect()
}

/// Names of the members within the top-level folder of evidence.
fn evidence(packages: &[Value]) -> BTreeSet<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the root");
    let is_evidence = |package: &&Value| EVIDENCE.iter().any(|top| folder(package).starts_with(root.join(top)));
    packages.iter().filter(is_evidence).map(name).collect()
}

/// The arrows that there are never to be, each with why.
fn offences(arrows: &BTreeSet<Arrow>, evidence: &BTreeSet<String>) -> Vec<String> {
    let mut offences = Vec::new();
    for Arrow { from, to, of_tests } in arrows {
        // what a judge or a formulation needs for its own tests is no part of it
        let broken = NEVER.iter().find(|(of, never, _)| {
            !of_tests && of.split(' ').any(|of| of == from) && never.split(' ').any(|never| never == "*" || never == to)
        });
        offences.extend(broken.map(|(_, _, why)| format!("{from} is built on {to}, but {why}")));
        if evidence.contains(to) && !evidence.contains(from) {
            offences.push(format!("{from} is built on {to}, but the tool does not stand on its evidence"));
        }
    }
    offences
}

/// The members, each behind all that it is built on, and of equal ones the first by name.
fn in_order(packages: &[Value], arrows: &BTreeSet<Arrow>) -> Vec<String> {
    let mut left: BTreeSet<String> = packages.iter().map(name).collect();
    let mut order = Vec::new();
    while !left.is_empty() {
        let is_ready = |name: &&String| {
            !arrows.iter().any(|arrow| arrow.from == **name && !arrow.of_tests && left.contains(&arrow.to))
        };
        let ready: Vec<String> = left.iter().filter(is_ready).cloned().collect();
        assert!(!ready.is_empty(), "a circle in {left:?}");
        left.retain(|name| !ready.contains(name));
        order.extend(ready);
    }
    order
}

/// The table of `ARCHITECTURE.md`: a line for each member, but for arrows that follow from others.
fn table(packages: &[Value]) -> String {
    let arrows = arrows(packages);
    let mut table = String::from("| crate | is built on | and so on | for its tests |\n|---|---|---|---|\n");
    let mut all: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for from in in_order(packages, &arrows) {
        let to = |of_tests: bool| -> BTreeSet<String> {
            let mine = arrows.iter().filter(|arrow| arrow.from == from && arrow.of_tests == of_tests);
            mine.map(|arrow| arrow.to.clone()).collect()
        };
        let (direct, tests) = (to(false), to(true));
        let behind: BTreeSet<String> = direct.iter().filter_map(|to| all.get(to)).flatten().cloned().collect();
        let names = |names: Vec<&String>| names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let first = names(direct.difference(&behind).collect());
        let further = names(direct.intersection(&behind).collect());
        let tests = names(tests.difference(&direct).collect());
        table += &format!("| `{from}` | {first} | {further} | {tests} |\n");
        all.insert(from.clone(), behind.union(&direct).cloned().collect());
    }
    table
}

#[test]
fn no_member_is_built_on_what_it_is_not_to_know() {
    let packages = packages();
    let arrows = arrows(&packages);
    let is = |from: &str, to: &str| arrows.iter().any(|arrow| arrow.from == from && arrow.to == to);
    assert!(is("chetaev", "mechanics") && is("validation", "random"), "the reading of arrows misses {arrows:?}");
    let evidence = evidence(&packages);
    assert!(evidence.contains("random") && !evidence.contains("deltaq"), "{evidence:?}");
    assert_eq!(offences(&arrows, &evidence), Vec::<String>::new());
}

#[test]
fn a_wrong_arrow_is_named() {
    let packages = packages();
    let (sound, evidence) = (arrows(&packages), evidence(&packages));
    let names: BTreeSet<String> = packages.iter().map(name).collect();
    let known = |name: &&str| *name == "*" || names.contains(*name);
    let wrong = NEVER
        .iter()
        .flat_map(|(of, never, _)| of.split(' ').flat_map(move |from| never.split(' ').map(move |to| (from, to))));
    for (from, to) in wrong.chain([("deltaq", "random"), ("pages", "validation"), ("motion", "referees")]) {
        assert!(known(&from) && known(&to), "{from} -> {to}: no such member");
        let to = if to == "*" { "mechanics" } else { to };
        let mut arrows = sound.clone();
        arrows.insert(Arrow { from: from.into(), to: to.into(), of_tests: false });
        let offences = offences(&arrows, &evidence);
        assert_eq!(offences.len(), 1, "{from} -> {to}");
        assert!(offences[0].starts_with(&format!("{from} is built on {to}, ")), "{}", offences[0]);
    }
}

/// `ARROWS=write cargo test --release --package tests arrows::` writes the table.
#[test]
fn the_table_of_arrows_is_that_of_the_manifests() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../ARCHITECTURE.md");
    let text = std::fs::read_to_string(&path).expect("the page");
    let start = text.find("| crate | is built on |").expect("a table");
    let end = start + text[start..].find("\n\n").expect("its end") + 1;
    let table = table(&packages());
    if std::env::var("ARROWS").is_ok_and(|asked| asked == "write") {
        std::fs::write(&path, format!("{}{table}{}", &text[..start], &text[end..])).expect("written");
        return;
    }
    assert_eq!(&text[start..end], table, "ARROWS=write writes it anew");
}
