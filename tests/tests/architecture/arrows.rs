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

/// What each member may be built on. A member that is not named here may be built on none.
const ALLOWED: [(&str, &[&str]); 22] = [
    ("symbolic", &[]),
    ("mechanics", &["symbolic"]),
    ("scene", &["symbolic", "mechanics"]),
    // discrete principles start from L, f and Q, so that they may judge what is derived
    ("discrete", &["symbolic", "mechanics", "scene"]),
    ("integrate", &[]),
    ("equations", &["symbolic", "mechanics"]),
    ("chetaev", &["symbolic", "mechanics", "equations"]),
    ("vakonomic", &["symbolic", "mechanics", "equations"]),
    ("removed-constraint", &["symbolic", "mechanics", "equations"]),
    // it reads equations and decides; that it can tell one formulation from another, its tests say
    (
        "decision",
        &["symbolic", "mechanics", "scene", "equations", "integrate", "chetaev", "vakonomic", "removed-constraint"],
    ),
    // what only makes motions faster: no principle is built on it; its vakonomic form starts from the same augmented Lagrangian
    ("reduction", &["symbolic", "mechanics", "equations", "vakonomic"]),
    (
        "deltaq",
        &[
            "symbolic",
            "mechanics",
            "scene",
            "discrete",
            "integrate",
            "decision",
            "equations",
            "chetaev",
            "vakonomic",
            "removed-constraint",
            "reduction",
        ],
    ),
    // a referee never sees what it judges
    ("referees", &["symbolic", "mechanics", "scene", "integrate", "discrete"]),
    // its time stepping is its own: it judges that of `integrate`
    ("reference", &["symbolic", "mechanics", "equations"]),
    ("random", &["symbolic", "mechanics", "scene", "equations", "integrate", "decision", "deltaq", "referees"]),
    ("picture", &[]),
    (
        "validation",
        &[
            "symbolic",
            "mechanics",
            "scene",
            "equations",
            "integrate",
            "discrete",
            "deltaq",
            "referees",
            "reference",
            "random",
            "picture",
        ],
    ),
    ("command", &["mechanics", "scene", "equations", "integrate", "discrete", "deltaq", "random", "validation"]),
    (
        "tests",
        &[
            "symbolic",
            "mechanics",
            "scene",
            "equations",
            "reduction",
            "integrate",
            "discrete",
            "deltaq",
            "referees",
            "reference",
            "random",
            "validation",
        ],
    ),
    ("engine", &["symbolic", "scene", "deltaq", "picture", "validation"]),
    ("python", &["symbolic", "mechanics", "scene", "equations", "integrate", "deltaq"]),
    ("xtask", &[]),
];

/// The arrows that the house does not have, each with what its tail may be built on.
fn offences(arrows: &BTreeSet<Arrow>) -> Vec<String> {
    let allowed = |from: &str| ALLOWED.iter().find(|(name, _)| *name == from).map_or(&[][..], |(_, to)| *to);
    arrows
        .iter()
        .filter(|arrow| !allowed(&arrow.from).contains(&arrow.to.as_str()))
        .map(|Arrow { from, to }| match allowed(from) {
            [] => format!("{from} depends on {to}, but may depend on no member of the workspace"),
            some => format!("{from} depends on {to}, but may depend only on {}", some.join(", ")),
        })
        .collect()
}

/// The members of the workspace, as `cargo metadata` describes them.
pub fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo).args(["metadata", "--no-deps", "--format-version", "1"]).output();
    let metadata: Value = serde_json::from_slice(&output.expect("cargo runs").stdout).expect("cargo metadata is JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// Every arrow between members, dependencies for tests and builds included.
fn arrows() -> BTreeSet<Arrow> {
    let packages = packages();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    // A dependency on a member is one with a path: other crates may bear the same name.
    let member = |path: &str| {
        let manifest = Path::new(path).join("Cargo.toml");
        let package =
            packages.iter().find(|package| package["manifest_path"].as_str().map(Path::new) == Some(&manifest));
        package.map(|package| text(&package["name"]))
    };
    let of = |package: &Value| {
        let from = text(&package["name"]);
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
    let offences = offences(&arrows);
    assert!(offences.is_empty(), "{}", offences.join("\n"));
}

#[test]
fn a_wrong_arrow_is_named() {
    let sound: BTreeSet<Arrow> = ALLOWED.iter().flat_map(|(from, to)| to.iter().map(|to| arrow(from, to))).collect();
    assert_eq!(offences(&sound), Vec::<String>::new());
    for (from, to) in [
        ("chetaev", "vakonomic"),
        ("vakonomic", "removed-constraint"),
        ("removed-constraint", "chetaev"),
        ("chetaev", "reduction"),
        ("vakonomic", "reduction"),
        ("mechanics", "chetaev"),
        ("mechanics", "scene"),
        ("equations", "scene"),
        ("chetaev", "scene"),
        ("equations", "chetaev"),
        ("symbolic", "mechanics"),
        ("integrate", "mechanics"),
        ("chetaev", "integrate"),
        ("discrete", "chetaev"),
        ("discrete", "equations"),
        ("vakonomic", "discrete"),
        ("deltaq", "random"),
        ("random", "validation"),
        ("picture", "deltaq"),
        ("validation", "command"),
        ("tests", "command"),
        ("validation", "vakonomic"),
        ("referees", "deltaq"),
        ("referees", "chetaev"),
        ("referees", "equations"),
        ("reference", "integrate"),
        ("validation", "engine"),
        ("deltaq", "engine"),
        ("engine", "chetaev"),
        ("python", "validation"),
        ("xtask", "symbolic"),
        ("newcomer", "symbolic"),
        ("tests", "tests"),
    ] {
        let mut arrows = sound.clone();
        arrows.insert(arrow(from, to));
        let offences = offences(&arrows);
        assert_eq!(offences.len(), 1, "{from} -> {to}");
        assert!(offences[0].starts_with(&format!("{from} depends on {to}, ")), "{}", offences[0]);
    }
}

#[test]
fn arrows_form_no_circle() {
    // Every member is built only on members that stand before it in the table, so that the table is one road.
    for (at, (name, allowed)) in ALLOWED.iter().enumerate() {
        for to in *allowed {
            assert!(ALLOWED[..at].iter().any(|(before, _)| before == to), "{name} stands before {to}");
        }
    }
}
