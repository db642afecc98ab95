//! Members of ensembles against motions derived and solved one by one, in every formulation of every scene;
//! their starts against those of the text with other numbers in it.

use equations::Equations;
use integrate::Method;
use motion::{
    Choice, Ending, Ensemble, EnsembleOptions, EnsembleStart, Settings, choices, constants_of, error_estimate, forms,
    setting, solve_choice,
};
use scene::Scene;
use scene::catalogue::{CLASSICS, SCENES, find};

/// Not divisible by the number of lanes.
const MEMBERS: usize = 11;
/// One member in so many is solved alone, too: of each motion others, so that of three all are.
const ONE_IN: usize = 3;

/// What became of the members of all ensembles.
#[derive(Default, Debug)]
struct Count {
    motions: usize,
    completed: usize,
    stopped: usize,
    refused: usize,
    other_pivots: usize,
    alone: Vec<String>,
}

fn guards(equations: &Equations) -> Vec<String> {
    equations.guards.iter().map(|&guard| equations.graph.plain(guard)).collect()
}

fn written(overrides: &[(String, f64)]) -> Vec<(String, scene::Number)> {
    overrides.iter().map(|(name, x)| (name.clone(), (*x).into())).collect()
}

/// The scene with other values of a parameter and of a coordinate at the start, as far as it allows that.
fn members(name: &str, base: &Scene, parameter: Option<&str>) -> Vec<Scene> {
    let value = |name: &str| {
        let mut parameters = base.system.parameters.iter();
        parameters.find(|p| base.system.graph.name(p.symbol) == name).map_or(0.0, |p| p.value)
    };
    let member = |i: usize| {
        let mut overrides = vec![("duration".to_string(), 0.3 * base.duration * (1.0 + 0.1 * i as f64))];
        overrides.extend(parameter.map(|name| (name.to_string(), value(name) * (1.0 + 0.03 * i as f64))));
        let place = i % base.system.dimension();
        let moved = (base.system.coordinates[place].name.clone(), base.start.q[place] + 0.04 * i as f64);
        let with = [&overrides[..], &[moved]].concat();
        let read = |overrides: &[(String, f64)]| find(name, &written(overrides));
        read(&with).or_else(|_| read(&overrides)).ok()
    };
    (0..MEMBERS).filter_map(member).collect()
}

fn compare(name: &str, base: &Scene, choice: &Choice, count: &mut Count) {
    let settings = Settings { method: Some(Method::Taylor), tolerance: 1e-9, ..Settings::default() };
    let parameter = base.system.parameters.first().map(|p| base.system.graph.name(p.symbol));
    let what = format!("{name}, {}", choice.label);
    count.motions += 1;
    let Ok(mut ensemble) = Ensemble::new(base, choice, parameter.as_deref().as_slice(), &settings) else {
        assert!(solve_choice(base, choice, &settings).is_err(), "{what}: no ensemble where there is a motion");
        return;
    };
    let scenes = members(name, base, parameter.as_deref());
    let mut ready = Vec::new();
    for scene in &scenes {
        let start = EnsembleStart::of(scene, parameter.as_deref().as_slice(), constants_of(choice, scene));
        ready.push(ensemble.member_at(&start));
    }
    let members: Vec<_> = ready.iter().flatten().cloned().collect();
    let (start, length) = (base.start.t, base.duration);
    let times: Vec<f64> = [0.0, 0.01, 0.1, 0.25, 0.3, 0.4, 0.5].map(|part| start + part * length).to_vec();
    let mut motions = ensemble.motions(&members, &times, &EnsembleOptions::default()).into_iter();
    for (place, (scene, member)) in scenes.iter().zip(ready).enumerate() {
        let here = member.and_then(|_| motions.next().expect("an answer for every member"));
        if !(place + count.motions).is_multiple_of(ONE_IN) {
            continue;
        }
        // a removal is made of expressions of its own scene
        let mut own = choices(scene).into_iter().chain(forms(scene));
        let own = own.find(|own| own.label == choice.label).expect("the same choice");
        let choice = Choice { constants: constants_of(choice, scene), ..own };
        let single = solve_choice(scene, &choice, &settings);
        let (mut single, here) = match (single, here) {
            (Ok(single), Ok(here)) => (single, here),
            (Err(_), Err(_)) => {
                count.refused += 1;
                continue;
            }
            (single, here) => panic!("{what}: {:?} alone, {:?} in an ensemble", single.err(), here.err()),
        };
        let there = error_estimate(&mut single, setting(scene)).expect("a motion that can be read off");
        let estimate = here.estimate.expect("an estimate").absolute + there.absolute;
        // pivots depend on the start (ensemble's or member's): forms with other pivots end elsewhere, and a
        // motion that changes them goes on where members, which keep theirs, stop
        let same = single.charts.is_empty() && guards(ensemble.equations()) == guards(&single.equations);
        match (&here.run.ending, &single.ending) {
            _ if !same => count.other_pivots += 1,
            (Ending::Completed, Ending::Completed) => count.completed += 1,
            (Ending::Stopped { t: a, .. }, Ending::Stopped { t: b, .. }) => {
                assert!((a - b).abs() < 1e-3 * length, "{what}: stopped at {a} and {b}");
                count.stopped += 1;
            }
            (a, b) => panic!("{what}: {a:?} in an ensemble, {b:?} alone"),
        }
        if let Some(why) = &here.run.alone
            && !count.alone.contains(why)
        {
            count.alone.push(why.clone());
        }
        let reached = times.iter().filter(|&&t| t <= single.end()).count();
        let differ = here.outputs.len().abs_diff(reached);
        assert!(differ <= 1 || !same, "{what}: {} and {reached} times", here.outputs.len());
        for (&t, outputs) in times.iter().zip(&here.outputs).take(reached) {
            let expected = single.at(t).expect("a time that was reached");
            let size = expected.coordinates.iter().fold(1.0_f64, |a, x| a.max(x.abs()));
            for (a, b) in outputs.coordinates.iter().zip(&expected.coordinates) {
                // an estimate in the kinetic metric is 100 times smaller than this in every coordinate here
                let limit = 1e-9 * size + 1e2 * estimate;
                assert!((a - b).abs() <= limit, "{what} at {t}: {a} and {b}, limit {limit:.1e}");
            }
        }
    }
}

#[test]
fn members_are_single_motions_in_every_formulation_of_every_scene() {
    let mut count = Count::default();
    for (name, _) in SCENES {
        let base = find(name, &[]).expect("a scene");
        for choice in choices(&base).iter().chain(&forms(&base)) {
            compare(name, &base, choice, &mut count);
        }
    }
    println!("{count:?}");
    assert!(count.completed > 170, "{count:?}");
    assert!(count.stopped > 7, "members that stop: {count:?}");
    for why in ["an event on the way", "not in lanes", "not to be trusted"] {
        assert!(count.alone.iter().any(|words| words.contains(why)), "no member left for `{why}`: {count:?}");
    }
}

/// Names of what can vary in a scene, with values there and nearby.
fn variations(base: &Scene) -> Vec<(String, f64)> {
    let system = &base.system;
    let parameters = system.parameters.iter().map(|p| (system.graph.name(p.symbol), p.value));
    let coordinates = system.coordinates.iter().zip(&base.start.q).map(|(c, &q)| (c.name.clone(), q));
    let velocities = system.coordinates.iter().zip(&base.start.v).map(|(c, &v)| (format!("{}'", c.name), v));
    let multipliers = base.multiplier_names().into_iter().zip(base.multipliers.iter().copied());
    let all: Vec<_> = parameters.chain(coordinates).chain(velocities).chain(multipliers).collect();
    let nearby = |(name, x): &(String, f64)| [0.0, 0.07, -0.5].map(|part| (name.clone(), x + part * (1.0 + x.abs())));
    all.iter().flat_map(nearby).collect()
}

#[test]
fn starts_from_compiled_expressions_are_those_of_the_text_in_every_scene() {
    let (mut agree, mut refused) = (0, 0);
    for (name, _) in SCENES.iter().chain(CLASSICS) {
        let base = find(name, &[]).expect("a scene");
        let last = base.system.coordinates.last().expect("a coordinate").name.clone();
        for (varied, value) in variations(&base) {
            // alone, and beside another coordinate
            for beside in
                [&[][..], &[(last.clone(), 0.3)]].into_iter().filter(|b| b.first().is_none_or(|b| b.0 != varied))
            {
                let row = [&[(varied.clone(), value)], beside].concat();
                let (names, numbers): (Vec<&str>, Vec<f64>) = row.iter().map(|(name, x)| (name.as_str(), *x)).unzip();
                let read = find(name, &written(&row));
                let here = base.starts(&names).map_err(|error| error.to_string());
                let here = here.and_then(|mut starts| starts.at(&numbers).map_err(|fault| fault.to_string()));
                match (read, here) {
                    (Ok(read), Ok(here)) => {
                        let [q, v] = [(&here.state.q, &read.start.q), (&here.state.v, &read.start.v)];
                        let size = |x: &[f64]| x.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
                        for (a, b) in [q, v] {
                            let off = a.iter().zip(b).fold(0.0_f64, |off, (a, b)| off.max((a - b).abs()));
                            assert!(off <= 1e-14 * size(b), "{name}, {row:?}: {a:?} and {b:?}");
                        }
                        assert_eq!(
                            (here.state.t, here.multipliers),
                            (read.start.t, read.multipliers),
                            "{name}, {row:?}"
                        );
                        agree += 1;
                    }
                    (Err(_), Err(_)) => refused += 1,
                    (read, here) => panic!("{name}, {row:?}: {:?} of the text, {:?} here", read.err(), here.err()),
                }
            }
        }
    }
    println!("{agree} starts agree, {refused} are refused");
    assert!(agree > 1000 && refused > 100, "{agree} agree, {refused} refused");
}
