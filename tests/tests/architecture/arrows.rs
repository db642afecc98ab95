//! The arrows between the crates of the workspace.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// One dependency of a member of the workspace on another: `from` is built on `to`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Arrow {
    from: String,
    to: String,
}

/// Arrows that there are never to be, whatever the table says.
const NEVER: [(&str, &str); 19] = [
    ("symbolic", "mechanics"),
    ("mechanics", "scene chetaev"),
    ("equations", "scene chetaev"),
    ("integrate", "mechanics"),
    ("chetaev", "scene vakonomic reduction integrate"),
    ("vakonomic", "removed-constraint reduction discrete"),
    ("removed-constraint", "chetaev"),
    ("discrete", "chetaev equations"),
    ("deltaq", "random engine"),
    ("referees", "deltaq chetaev equations"),
    ("reference", "integrate"),
    ("random", "validation"),
    ("picture", "deltaq"),
    ("validation", "command vakonomic engine"),
    ("engine", "chetaev"),
    ("tests", "command tests"),
    ("python", "validation"),
    ("xtask", "symbolic"),
    ("newcomer", "symbolic"),
];

/// What each member may be built on, by the table in `ARCHITECTURE.md`: names in backticks, up to a colon
/// with remarks behind it. A member that is not named there may be built on none.
fn table() -> Vec<(String, Vec<String>)> {
    let text = include_str!("../../../ARCHITECTURE.md");
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<String>>();
    let row = |line: &str| {
        let mut cells = line.split('|').skip(1).map(|cell| names(cell.split(':').next().unwrap_or_default()));
        cells.next().zip(cells.next())
    };
    let rows = text.lines().skip_while(|line| *line != "| crate | may be built on |").skip(2).map_while(row);
    rows.flat_map(|(from, to)| from.into_iter().map(move |from| (from, to.clone()))).collect()
}

/// The arrows that the house does not have, each with what its tail may be built on.
fn offences(table: &[(String, Vec<String>)], arrows: &BTreeSet<Arrow>) -> Vec<String> {
    let allowed = |from: &str| table.iter().find(|(name, _)| name == from).map_or(&[][..], |(_, to)| to);
    let words = |Arrow { from, to }: &Arrow| match allowed(from) {
        [] => format!("{from} depends on {to}, but may depend on no member of the workspace"),
        some => format!("{from} depends on {to}, but may depend only on {}", some.join(", ")),
    };
    arrows.iter().filter(|arrow| !allowed(&arrow.from).contains(&arrow.to)).map(words).collect()
}

/// The members of the workspace, as `cargo metadata` describes them.
pub fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo).args(["metadata", "--no-deps", "--format-version", "1"]).output();
    let metadata: Value = serde_json::from_slice(&output.expect("cargo runs").stdout).expect("cargo metadata is JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// The short name of a member, that of its folder.
pub fn name(package: &Value) -> String {
    let manifest = Path::new(package["manifest_path"].as_str().expect("a path"));
    let folder = manifest.parent().and_then(Path::file_name).expect("a folder");
    folder.to_string_lossy().into_owned()
}

/// Every arrow between members, dependencies for tests and builds included.
fn arrows() -> BTreeSet<Arrow> {
    let packages = packages();
    // A dependency on a member is one with a path: other crates may bear the same name.
    let member = |path: &str| {
        let manifest = Path::new(path).join("Cargo.toml");
        let package =
            packages.iter().find(|package| package["manifest_path"].as_str().map(Path::new) == Some(&manifest));
        package.map(name)
    };
    let of = |package: &Value| {
        let from = name(package);
        let dependencies = package["dependencies"].as_array().cloned().unwrap_or_default().into_iter();
        let members = dependencies.filter_map(|dependency| member(dependency["path"].as_str()?));
        // a package may ask for itself: with other features, for its tests
        members.map(|to| Arrow { from: from.clone(), to }).filter(|arrow| arrow.from != arrow.to).collect::<Vec<_>>()
    };
    packages.iter().flat_map(of).collect()
}

fn arrow(from: &str, to: &str) -> Arrow {
    Arrow { from: from.to_owned(), to: to.to_owned() }
}

#[test]
fn members_depend_only_where_arrows_are_drawn() {
    let arrows = arrows();
    assert!(arrows.contains(&arrow("chetaev", "mechanics")), "the reading of arrows misses {arrows:?}");
    let offences = offences(&table(), &arrows);
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn a_wrong_arrow_is_named() {
    let table = table();
    let sound: BTreeSet<Arrow> = table.iter().flat_map(|(from, to)| to.iter().map(|to| arrow(from, to))).collect();
    assert_eq!(offences(&table, &sound), Vec::<String>::new());
    for (from, to) in NEVER.iter().flat_map(|(from, to)| to.split(' ').map(move |to| (from, to))) {
        let mut arrows = sound.clone();
        arrows.insert(arrow(from, to));
        let offences = offences(&table, &arrows);
        assert_eq!(offences.len(), 1, "{from} -> {to}");
        assert!(offences[0].starts_with(&format!("{from} depends on {to}, ")), "{}", offences[0]);
    }
}

#[test]
fn arrows_form_no_circle() {
    // Every member is built only on members that stand before it in the table, so that the table is one road.
    let table = table();
    for (at, (name, allowed)) in table.iter().enumerate() {
        for to in allowed {
            assert!(table[..at].iter().any(|(before, _)| before == to), "{name} stands before {to}");
        }
    }
}
