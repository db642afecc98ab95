//! One system in other writings: the same sentences, or *open*; `MUTATIONS=all` for all built-in scenes, or
//! names of some, with a comma between them.
//!
//! A sentence is about the motions of a scene, not about how it is written. Each writing here describes the
//! motions of the scene it is made from, possibly on one leaf or branch of a larger system. What is said of
//! both must not differ, the numbers that are measured must agree, and nothing may contradict anything else.

use std::collections::BTreeMap;

use motion::over_threads;
use random::writings::{WRITINGS, plain, written};
use random::{Said, sentences};
use scene::Scene;

/// Scenes and writings of the quick sample.
const QUICK: [(&str, &[&str]); 7] = [
    ("particle", &["signs", "roots", "slave", "invariants"]),
    ("disc", &["signs", "unit vectors", "formulas"]),
    ("heisenberg", &["signs", "slave", "time"]),
    ("planar-body", &["signs", "unit vectors"]),
    ("martinet", &["roots", "slave", "formulas"]),
    ("suslov", &["signs", "quaternions"]),
    ("bowl", &["slave", "time"]),
];

fn is_wanted(name: &str, writing: &str) -> bool {
    if let Ok(asked) = std::env::var("MUTATIONS") {
        return asked.split(',').any(|word| word == "all" || word == name);
    }
    QUICK.iter().any(|(own, writings)| *own == name && writings.contains(&writing))
}

#[test]
fn other_writings_of_a_scene_have_its_sentences() {
    let wanted: Vec<(&str, &str)> = scene::catalogue::built_in()
        .copied()
        .filter(|(name, _)| WRITINGS.iter().any(|w| is_wanted(name, w.name)))
        .collect();
    let asked = over_threads(0, wanted.len(), |i| of_scene(wanted[i].0, wanted[i].1));
    let (mut counts, mut wrong) = (BTreeMap::<String, usize>::new(), Vec::new());
    for (lines, faults) in asked {
        lines.into_iter().for_each(|line| *counts.entry(line).or_default() += 1);
        wrong.extend(faults);
    }
    println!("{counts:#?}");
    assert!(counts.values().sum::<usize>() > 0);
    assert!(wrong.is_empty(), "{} wrong\n{}", wrong.len(), wrong.join("\n"));
}

/// Without removals no rate of their parameters is known: velocities of coordinates instead.
fn with_velocities_of_coordinates(value: &mut toml::Table, scene: &Scene) {
    let start = value.get_mut("start").and_then(toml::Value::as_table_mut);
    let Some(start) = start else { return };
    let names: Vec<String> = scene.system.coordinates.iter().map(|c| format!("{}'", c.name)).collect();
    let velocities = start.get_mut("velocities").and_then(toml::Value::as_table_mut);
    if let Some(velocities) = velocities.filter(|given| given.keys().any(|name| !names.contains(name))) {
        *velocities = names.into_iter().zip(scene.start.v.iter().map(|&v| v.into())).collect();
        start.insert("project".into(), true.into());
    }
}

/// What became of each sentence in each writing, and what is wrong.
fn of_scene(name: &str, text: &str) -> (Vec<String>, Vec<String>) {
    let (mut lines, mut wrong) = (Vec::new(), Vec::new());
    let scene = Scene::parse(name, text).unwrap_or_else(|fault| panic!("{fault}"));
    let mut value: toml::Table = scene.without_bodies(text).parse().unwrap_or_else(|fault| panic!("{name}: {fault}"));
    with_velocities_of_coordinates(&mut value, &scene);
    let read = |value: &toml::Table| Scene::parse(name, &written(value));
    let plain = plain(&value);
    let own = match read(&plain).map_err(|fault| fault.to_string()).and_then(|scene| sentences(&scene, true)) {
        Ok(own) => own,
        Err(fault) => return (lines, vec![format!("{name}: {fault}")]),
    };
    for writing in WRITINGS.iter().filter(|writing| is_wanted(name, writing.name)) {
        let Some(other) = (writing.of)(&plain) else {
            lines.push(format!("{}: not possible", writing.name));
            continue;
        };
        let of = |fault: &dyn std::fmt::Display| format!("{name}, {}: {fault}\n{}", writing.name, written(&other));
        let found = match read(&other).map_err(|fault| fault.to_string()).and_then(|scene| sentences(&scene, true)) {
            Ok(found) => found,
            Err(fault) => {
                wrong.push(of(&fault));
                continue;
            }
        };
        for (about, said) in own.iter().filter(|(about, _)| writing.keeps(about)) {
            let now = found.get(about).unwrap_or(&Said::Open);
            let verdict = said.beside(now, writing.adds);
            lines.push(format!("{}: {}", writing.name, verdict.unwrap_or("another")));
            if verdict.is_none() {
                wrong.push(of(&format!("{about}: {said:?} is {now:?}")));
            }
        }
    }
    println!("{name}: {} sentences in other writings, {} wrong", lines.len(), wrong.len());
    (lines, wrong)
}
