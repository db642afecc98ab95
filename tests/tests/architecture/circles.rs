//! No module of a crate is built, by way of others, on itself.
//!
//! A file and the files in its folder are one room: a child may name what its parent's file defines, and the
//! parent may call it. Such an arrow upwards does not count; all others do, so that rooms as a whole lie on
//! no circle either. A crate's root is no such room: what modules need of one another stands in modules.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::Value;

use super::arrows::{name, packages};
use super::modules::Modules;

type Arrows = BTreeMap<String, BTreeSet<String>>;
type Circle = BTreeSet<String>;

/// Circles that are left: crate, files, reason.
const EXCEPTIONS: [(&str, &[&str], &str); 1] =
    [("symbolic", &["store/faults", "store/graph"], "a fault is put into operations of the graph, which asks for it")];

/// Arrows without those from a child to the file of its own folder, where that is not the root.
fn between_rooms(mut arrows: Arrows) -> Arrows {
    for (from, to) in &mut arrows {
        to.retain(|to| !from.starts_with(&format!("{to}/")));
    }
    arrows
}

/// All that can be reached from `file` by one arrow or more.
fn reached<'a>(arrows: &'a Arrows, file: &'a str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut next = vec![file];
    while let Some(to) = next.pop().and_then(|file| arrows.get(file)) {
        next.extend(to.iter().map(String::as_str).filter(|file| reached.insert(*file)));
    }
    reached
}

/// The largest sets of files that are each built on all others.
fn circles(arrows: &Arrows) -> BTreeSet<Circle> {
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|file| (&file[..], self::reached(arrows, file))).collect();
    let circle = |&file: &&str| -> Option<Circle> {
        let back = |other: &&&str| reached.get(**other).is_some_and(|reached| reached.contains(file));
        let circle: Circle = reached[file].iter().filter(back).map(|other| other.to_string()).collect();
        (!circle.is_empty()).then_some(circle)
    };
    reached.keys().filter_map(circle).collect()
}

fn words(circle: &Circle, arrows: &Arrows) -> String {
    let within = |file: &String| circle.intersection(&arrows[file]).cloned().collect::<Vec<_>>().join(", ");
    circle.iter().map(|file| format!("\n  {file} names items of {}", within(file))).collect()
}

/// The arrows of every crate, by its short name; a program beside a library has its own.
fn workspace() -> Vec<(String, Arrows)> {
    let read = |path: &Path| std::fs::read_to_string(path).ok();
    let mut crates = Vec::new();
    for package in packages() {
        for target in package["targets"].as_array().expect("targets") {
            let kinds: Vec<&str> = target["kind"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
            if kinds.iter().any(|kind| ["lib", "cdylib", "bin"].contains(kind)) {
                let root = Path::new(target["src_path"].as_str().expect("a path"));
                crates.push((name(&package), between_rooms(Modules::of(root, &read).arrows())));
            }
        }
    }
    crates
}

#[test]
fn modules_form_no_circle() {
    let crates = workspace();
    let mut needed = BTreeSet::new();
    let mut offences = String::new();
    for (name, arrows) in &crates {
        for circle in circles(arrows) {
            let covers = |(of, files, _): &(&str, &[&str], &str)| {
                of == name && circle.iter().all(|file| files.contains(&file.as_str()))
            };
            match EXCEPTIONS.iter().position(covers) {
                Some(exception) => drop(needed.insert(exception)),
                None => offences += &format!("\na circle in {name}:{}", words(&circle, arrows)),
            }
        }
    }
    for (i, (name, files, _)) in EXCEPTIONS.iter().enumerate().filter(|(i, _)| !needed.contains(i)) {
        offences += &format!("\nexception {i} can be struck: {name} has no circle in {}", files.join(", "));
    }
    assert!(offences.is_empty(), "{offences}");
    // what is known to be there is found
    let motion = &crates.iter().find(|(name, _)| name == "motion").expect("a crate").1;
    assert!(motion["motion"].contains("error") && motion["ensemble/run"].contains("single_run"), "{motion:?}");
}

/// The arrows between made-up files, by path below the folder of the crate.
fn arrows(files: &[(&str, &str)]) -> Arrows {
    let read = |path: &Path| files.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| text.to_string());
    between_rooms(Modules::of(Path::new("lib.rs"), &read).arrows())
}

fn found(files: &[(&str, &str)]) -> Vec<String> {
    circles(&arrows(files)).iter().map(|circle| circle.iter().cloned().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn a_circle_is_found_by_way_of_a_re_export_and_of_a_macro() {
    let lib = ("lib.rs", "mod earth; mod moon; mod sun; pub use earth::Earth; pub use moon::{Moon, phase};");
    let earth = ("earth.rs", "use crate::Moon; pub struct Earth(Moon);");
    let sun = ("sun.rs", "use crate::{Earth, Moon}; pub struct Sun { earth: Earth, moon: Moon }");
    let moon = |text| ("moon.rs", text);
    let alone = "pub struct Moon; pub fn phase() {}";
    assert_eq!(found(&[lib, earth, sun, moon(alone)]), [""; 0]);
    for back in [
        "use crate::Earth; pub struct Moon; pub fn phase() -> Earth {}",
        "pub struct Moon; impl super::earth::Earth { fn rise() {} }",
        "pub struct Moon; pub fn phase() { println!(\"{}\", crate::Earth::DAY) }",
        "use crate::earth::*; pub struct Moon; pub fn phase() {}",
        "use crate::earth as planet; pub struct Moon; pub fn phase() { planet::Earth::turn() }",
        "pub mod inner { use super::super::Earth; } pub struct Moon;",
    ] {
        assert_eq!(found(&[lib, earth, sun, moon(back)]), ["earth moon"], "{back}");
    }
    for harmless in [
        "#[cfg(test)] mod tests { use crate::Earth; } pub struct Moon; pub fn phase() {}",
        "#[cfg(test)] use crate::Earth; pub struct Moon; pub fn phase() {}",
        "/// See [`crate::Earth`].\npub struct Moon; pub fn phase() {}",
        "use crate::earth; pub struct Moon; pub fn phase(earth: u8) -> u8 { earth }",
    ] {
        assert_eq!(found(&[lib, earth, sun, moon(harmless)]), [""; 0], "{harmless}");
    }
}

#[test]
fn a_child_may_name_what_its_parent_defines_and_nothing_built_on_that() {
    let lib = ("lib.rs", "mod house; mod street;");
    let house = ("house.rs", "mod door; pub struct House; pub fn enter() { door::open(House) }");
    let street = ("street.rs", "pub struct Street(crate::house::House);");
    let door = |text| ("house/door.rs", text);
    assert_eq!(found(&[lib, house, street, door("pub fn open(house: super::House) {}")]), [""; 0]);
    let on_street = door("pub fn open(house: super::House) -> crate::street::Street {}");
    assert_eq!(found(&[lib, house, street, on_street]), ["house house/door street"]);
}

#[test]
fn the_root_of_a_crate_is_a_file_like_others() {
    let root = ("lib.rs", "mod part; pub struct Whole(part::Part);");
    assert_eq!(found(&[root, ("part.rs", "pub struct Part;")]), [""; 0]);
    assert_eq!(found(&[root, ("part.rs", "pub struct Part; impl crate::Whole {}")]), ["lib part"]);
}
