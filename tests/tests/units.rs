//! Units change no word: every contained scene again in other units of length, mass and time.

use std::collections::BTreeMap;

use deltaq::{Comparison, Extent, Settings, SolveError, Verdict, choices, membership};
use random::Scaling;
use scene::Scene;
use symbolic::SplitMix;
use validation::catalogue;

/// Units in those of the scene, powers of ten.
const UNITS: [i32; 5] = [-9, -3, 0, 3, 9];
/// One choice of units in so many is drawn; `UNITS=1` takes all.
const ONE_IN: usize = 10;
/// Likewise of choices in which the motions are compared.
const MOTIONS_ONE_IN: usize = 200;

/// The scene with metres, kilograms and seconds, as far as they are its own, replaced by others.
fn in_units(scene: &Scene, [length, mass, time]: [i32; 3]) -> Scene {
    let power = |k: i32| format!("1e{k}").parse::<f64>().expect("a number");
    let of = |c: &mechanics::Coordinate| if c.unit == "m" { power(length) } else { 1.0 };
    let lengths: Vec<f64> = scene.system.coordinates.iter().map(of).collect();
    let action = power(2 * time - mass - 2 * length);
    Scaling { lengths, time: power(time), action, constraint: 1.0 }.scene(scene)
}

/// What is said of a scene: kind of words and words.
fn words(scene: &Scene) -> Vec<(String, String)> {
    let text = |e: SolveError| format!("undecided: {e}");
    let integrability = deltaq::integrability(scene).map_or_else(text, |found| found.to_string());
    let mut said = vec![("integrability".into(), integrability)];
    match membership(scene, scene.start.t + scene.duration) {
        Ok(None) => {}
        Err(error) => said.push(("proof".into(), text(error))),
        Ok(Some(membership)) => {
            let decision = &membership.decision;
            let floating = format!("{:?}", decision.verdict).to_lowercase();
            let dimension = if floating == "contained" { decision.set.dimension() } else { 0 };
            said.push(("decision".into(), format!("{floating} {dimension}")));
            let answer = format!("{:?}", membership.answer()).to_lowercase();
            said.push(("proof".into(), answer.split(" { unproved").next().unwrap_or_default().into()));
        }
    }
    said
}

/// What is said of its motions, in pairs.
fn verdicts(scene: &Scene) -> Vec<(String, String)> {
    let (settings, choices) = (Settings::default(), choices(scene));
    let mut comparison = Comparison::new(scene.clone(), Extent::Answer, &settings).expect("it has a comparison");
    for choice in choices {
        comparison.solve(choice, &settings).expect("it is compared");
    }
    let name = |i: usize| comparison.runs[i].choice.label.clone();
    let motions = comparison.runs.iter().map(|run| {
        let word = run.outcome.as_ref().map_or_else(|error| format!("undecided: {error}"), |_| "runs".into());
        (format!("motion: {}", run.choice.label), word)
    });
    let pairs = comparison.pairs.iter().map(|pair| {
        let word = match &pair.gap.verdict {
            Verdict::Undecided { because } => format!("undecided: {because}"),
            verdict => verdict.word().into(),
        };
        (format!("verdict: {}, {}", name(pair.first), name(pair.second)), word)
    });
    motions.chain(pairs).collect()
}

/// Counts of words that are the same, that became or were undecided, and that are others.
#[derive(Default)]
struct Count(BTreeMap<String, [usize; 3]>, Vec<String>);

impl Count {
    fn add(&mut self, place: &str, own: &[(String, String)], found: &[(String, String)]) {
        let is_open = |word: &str| word.starts_with("undecided");
        for (what, word) in own {
            let other = found.iter().find(|(of, _)| of == what).map_or("undecided: nothing is said", |(_, word)| word);
            let kind = what.split(':').next().unwrap_or_default();
            let count = self.0.entry(kind.into()).or_default();
            if word == other || is_open(word) && is_open(other) {
                count[0] += 1;
                continue;
            }
            let line = format!("{place} {what}: {word} -> {other}");
            println!("{line}");
            if is_open(other) || is_open(word) {
                count[1] += 1;
            } else {
                count[2] += 1;
                self.1.push(line);
            }
        }
    }
}

/// All units of length, mass and time, one in so many of them.
fn drawn(random: &mut SplitMix, one_in: usize) -> Vec<[i32; 3]> {
    let all = UNITS.iter().flat_map(|l| UNITS.iter().flat_map(move |m| UNITS.map(|t| [*l, *m, t])));
    all.filter(|_| random.unit() * (one_in as f64) < 1.0).collect()
}

#[test]
fn units_change_no_word() {
    let number = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<usize>().ok());
    let only = std::env::var("UNITS_OF").ok();
    let mut random = SplitMix::new(4);
    let (mut count, start) = (Count::default(), std::time::Instant::now());
    for (name, text) in catalogue::built_in() {
        if only.as_ref().is_some_and(|only| !only.split(',').any(|o| o == *name)) {
            continue;
        }
        let scene = Scene::parse(name, text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for (one_in, said) in [
            (number("UNITS").unwrap_or(ONE_IN), words as fn(&Scene) -> _),
            (number("UNITS_OF_MOTIONS").unwrap_or(MOTIONS_ONE_IN), verdicts),
        ] {
            let units = drawn(&mut random, one_in);
            let own = if units.is_empty() { Vec::new() } else { said(&scene) };
            for units in units {
                count.add(&format!("{name} {units:?}"), &own, &said(&in_units(&scene, units)));
            }
        }
        println!("{name}: {:.1} s so far", start.elapsed().as_secs_f64());
    }
    println!("same, undecided, other: {:?}", count.0);
    assert!(count.1.is_empty(), "{}\n{:?}", count.1.join("\n"), count.0);
}
