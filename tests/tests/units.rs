//! Units change no word: every contained scene again in other units of length, mass and time.

use std::collections::BTreeMap;

use deltaq::{Comparison, Extent, Settings, choices};
use random::Scaling;
use scene::Scene;
use symbolic::SplitMix;
use validation::catalogue;

/// Units in those of the scene, powers of ten.
const UNITS: [i32; 5] = [-9, -3, 0, 3, 9];
/// One choice of units in so many is drawn; `UNITS=1` takes all.
const ONE_IN: usize = 10;

/// The scene with metres, kilograms and seconds, as far as they are its own, replaced by others.
fn in_units(scene: &Scene, [length, mass, time]: [i32; 3]) -> Scene {
    let power = |k: i32| format!("1e{k}").parse::<f64>().expect("a number");
    let of = |c: &mechanics::Coordinate| if c.unit == "m" { power(length) } else { 1.0 };
    let lengths: Vec<f64> = scene.system.coordinates.iter().map(of).collect();
    let action = power(2 * time - mass - 2 * length);
    Scaling { lengths, time: power(time), action, constraint: 1.0 }.scene(scene)
}

/// What is said: kind of words and words.
fn words(scene: &Scene) -> Vec<(String, String)> {
    let settings = Settings::default();
    let mut comparison = match Comparison::new(scene.clone(), Extent::Answer, &settings) {
        Ok(comparison) => comparison,
        Err(error) => return vec![("refused".into(), error.to_string())],
    };
    let mut said = vec![("integrability".into(), comparison.integrability.to_string())];
    for choice in choices(scene) {
        if let Err(error) = comparison.solve(choice, &settings) {
            said.push(("solve".into(), error.to_string()));
        }
    }
    match comparison.membership() {
        None => {}
        Some(Err(error)) => said.push(("decision".into(), format!("undecided: {error}"))),
        Some(Ok(membership)) => {
            let answer = format!("{:?}", membership.answer());
            let answer = answer.split(" { unproved").next().unwrap_or_default().to_owned();
            said.push(("decision".into(), if answer == "Undecided" { "undecided".into() } else { answer }));
            let decision = &membership.decision;
            let floating = format!("{:?}", decision.verdict).to_lowercase();
            let dimension = if floating == "contained" { decision.set.dimension() } else { 0 };
            said.push(("floating".into(), floating));
            said.push(("dimension".into(), dimension.to_string()));
        }
    }
    for pair in &comparison.pairs {
        let [a, b] = [pair.first, pair.second].map(|i| comparison.runs[i].choice.label.clone());
        let word = match &pair.gap.verdict {
            deltaq::Verdict::Undecided { because } => format!("undecided: {because}"),
            verdict => format!("{verdict:?}"),
        };
        said.push((format!("verdict {a} - {b}"), word));
    }
    said
}

#[test]
fn units_change_no_word() {
    let one_in: usize = std::env::var("UNITS").ok().and_then(|n| n.parse().ok()).unwrap_or(ONE_IN);
    let only = std::env::var("SCENES").ok();
    let mut random = SplitMix::new(4);
    let mut counts: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    let mut wrong = Vec::new();
    for (name, text) in catalogue::built_in() {
        let scene = Scene::parse(name, text).unwrap_or_else(|e| panic!("{name}: {e}"));
        if only.as_ref().is_some_and(|only| !only.split(',').any(|o| o == *name)) {
            continue;
        }
        let own = words(&scene);
        for units in UNITS.iter().flat_map(|l| UNITS.iter().flat_map(move |m| UNITS.map(|t| [*l, *m, t]))) {
            if random.unit() * one_in as f64 >= 1.0 {
                continue;
            }
            let found = words(&in_units(&scene, units));
            for (what, word) in &own {
                let other = found.iter().find(|(of, _)| of == what).map_or("undecided: not said", |(_, word)| word);
                let kind = what.split(' ').next().unwrap_or_default();
                let count = counts
                    .entry(match kind {
                        "integrability" => "integrability",
                        "decision" => "decision",
                        "floating" => "floating",
                        "dimension" => "dimension",
                        _ => "verdict",
                    })
                    .or_default();
                let is_open = |word: &str| word.starts_with("undecided");
                if word == other || is_open(word) && is_open(other) {
                    count[0] += 1;
                } else if is_open(other) || is_open(word) {
                    count[1] += 1;
                    println!("{name} {units:?} {what}: {word} -> {other}");
                } else {
                    count[2] += 1;
                    wrong.push(format!("{name} {units:?} {what}: {word} -> {other}"));
                }
            }
        }
    }
    println!("same, undecided, other: {counts:?}");
    assert!(wrong.is_empty(), "{}\n{counts:?}", wrong.join("\n"));
}
