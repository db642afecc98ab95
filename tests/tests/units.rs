//! Units change no word: every contained scene again in other units of length, mass and time.

use std::collections::BTreeMap;

use comparison::{Answer, Comparison, Extent, Finding, Verdict, membership};
use mechanics::Integrability;
use motion::{Settings, SolveError, choices};
use random::Scaling;
use scene::Scene;
use symbolic::SplitMix;

/// Units in those of the scene, powers of ten.
const UNITS: [i32; 5] = [-9, -3, 0, 3, 9];
/// One choice of units in this number is drawn; `UNITS=1` takes all, `UNITS_OF_MOTIONS=1` for verdicts on
/// motions.
const ONE_IN: usize = 60;
/// The answer of one scene takes a second: its brackets are too long.
const LONG: (&str, usize) = ("bicycle", 240);
/// Number of words among which one may become undecided.
const OPEN: usize = 50;

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
    let integrability = comparison::integrability(scene).map_or_else(text, |found| found.to_string());
    let mut said = vec![("integrability".into(), integrability)];
    match membership(scene, scene.start.t + scene.duration) {
        Ok(None) => {}
        Err(error) => said.push(("proof".into(), text(error))),
        Ok(Some(membership)) => {
            let decision = &membership.decision;
            let floating = format!("{:?}", decision.verdict).to_lowercase();
            let dimension = if floating == "contained" { decision.set.dimension() } else { 0 };
            said.push(("decision".into(), format!("{floating} {dimension}")));
            let proof = match (&membership.proof.this_start, membership.answer()) {
                (Finding::NotApplicable(reason), _) => format!("undecided: {reason}"),
                (_, Answer::NoneProved { order }) => format!("none, order {order}"),
                (_, Answer::SomeProved) => "some".into(),
                (_, answer) => format!("undecided: {answer:?}"),
            };
            said.push(("proof".into(), proof));
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

/// One in `one_in` of all units of length, mass and time; none for zero.
fn drawn(random: &mut SplitMix, one_in: usize) -> Vec<[i32; 3]> {
    let all = UNITS.iter().flat_map(|l| UNITS.iter().flat_map(move |m| UNITS.map(|t| [*l, *m, t])));
    all.filter(|_| random.unit() * (one_in as f64) < 1.0 && one_in > 0).collect()
}

#[test]
fn units_change_no_word() {
    let number = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<usize>().ok());
    let only = std::env::var("UNITS_OF").ok();
    let mut random = SplitMix::new(4);
    let (mut count, start) = (Count::default(), std::time::Instant::now());
    for (name, text) in scene::catalogue::built_in() {
        if only.as_ref().is_some_and(|only| !only.split(',').any(|o| o == *name)) {
            continue;
        }
        let scene = Scene::parse(name, text).unwrap_or_else(|e| panic!("{name}: {e}"));
        let one_in = if *name == LONG.0 { LONG.1 } else { ONE_IN };
        for (one_in, said) in [
            (number("UNITS").unwrap_or(one_in), words as fn(&Scene) -> _),
            (number("UNITS_OF_MOTIONS").unwrap_or(one_in), verdicts),
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
    let verdicts = count.0.get("verdict").copied().unwrap_or_default();
    assert!(OPEN * verdicts[1] <= verdicts.iter().sum(), "{:?}", count.0);
}

/// A blade that slides and turns on a slope, everything times a mass and a length.
fn skate(mass: &str, length: &str) -> Scene {
    let text = format!(
        r#"
        title = "skate"
        [coordinates]
        x   = {{ unit = "m", start = 0 }}
        y   = {{ unit = "m", start = 0 }}
        phi = {{ unit = "rad", start = 0.3 }}
        [system]
        lagrangian  = "{mass}*(x'^2 + y'^2 + 0.2*{length}^2*phi'^2)/2 + {mass}*4.9*{length}*x"
        constraints = ["y'*cos(phi) - x'*sin(phi)"]
        [start.velocities]
        "phi'" = 1.1
        "x'"   = "0.5*{length}"
        [run]
        duration = 3
        "#
    );
    Scene::parse("skate", &text).expect("a scene")
}

/// The verdict of the numbers, the dimension, the order that is proved.
fn decided(scene: &Scene) -> (String, usize, Option<usize>) {
    let found = membership(scene, scene.start.t + scene.duration).expect("decided").expect("constrained");
    let order = if let Answer::NoneProved { order } = found.answer() { Some(order) } else { None };
    let verdict = format!("{:?}", found.decision.verdict);
    let dimension = if verdict == "Contained" { found.decision.set.dimension() } else { 0 };
    (verdict, dimension, order)
}

#[test]
fn a_light_and_short_skate_moves_as_another() {
    let usual = decided(&skate("1", "1"));
    assert_eq!(usual, ("NotContained".into(), 0, Some(1)));
    for (mass, length) in [("1e-12", "1e-3"), ("1e-12", "1"), ("1e-3", "1e-9"), ("1e15", "1e9")] {
        assert_eq!(decided(&skate(mass, length)), usual, "{mass} kg, {length} m");
    }
}

#[test]
fn the_unit_of_the_lagrangian_is_no_matter() {
    for (name, text) in scene::catalogue::SCENES {
        let scene = Scene::parse(name, text).expect("a scene");
        if scene.system.constraints.is_empty() {
            continue;
        }
        let usual = decided(&scene);
        for action in [1e-30, 1e-16, 1e-15, 1e16] {
            let lengths = vec![1.0; scene.system.dimension()];
            let other = decided(&Scaling { lengths, time: 1.0, action, constraint: 1.0 }.scene(&scene));
            assert_eq!(other, usual, "{name}, L * {action:e}");
        }
    }
}

#[test]
fn constraints_that_outweigh_the_masses_choose_no_pivots() {
    let scene = scene::catalogue::find("three-cylinders", &[]).expect("a scene");
    for units in [[9, 0, -9], [9, 3, -9], [9, 9, -9], [9, 9, 0]] {
        assert_eq!(decided(&in_units(&scene, units)), decided(&scene), "{units:?}");
    }
}

#[test]
fn a_large_disc_and_a_short_hitch() {
    let set = |name: &str, key: &str, value: f64| {
        scene::catalogue::find(name, &[(key.into(), value.into())]).expect("a scene")
    };
    for (name, key, values, depth) in [("disc", "R", [5e8, 5e-8], 2), ("trailer", "d", [1e-7, 1e7], 4)] {
        for value in values {
            let scene = set(name, key, value);
            let found = comparison::integrability(&scene).expect("linear");
            let as_deep = matches!(found, Integrability::Nonintegrable { depth: found, .. } if found == depth);
            assert!(as_deep, "{name}, {key} = {value}: {found}");
            let usual = decided(&scene::catalogue::find(name, &[]).expect("a scene"));
            let found = decided(&scene);
            // what is proved has the last word
            let same = found == usual || found.0 == "Undecided" || found.2.is_some();
            assert!(same && found.2 == usual.2, "{name}, {key} = {value}: {found:?}, {usual:?}");
        }
    }
}
