//! Scales change no motion: every built-in scene with other units of action, length and time.
//!
//! Asked are motions (in every formulation and removal, with natural constants, too), equations to first
//! order at the start, and ensembles. A part is drawn; `SCALES=all` takes all, `SCALES_OF=disc,bowl` these
//! scenes, `SCALES_ASK=FirstOrder` this question.

use std::collections::BTreeMap;
use std::time::Instant;

use linear::{LinearError, linearize, linearize_at};
use mechanics::ConstantsRule;
use motion::{
    Choice, Ensemble, EnsembleOptions, ErrorEstimate, Settings, choices, error_estimate, setting, solve_choice,
};
use random::Scaling;
use scene::Scene;
use symbolic::SplitMix;

/// Factors of `L`, of lengths and of times.
const ACTIONS: [f64; 3] = [1e-13, 1.0, 1e13];
const LENGTHS: [f64; 3] = [1e-9, 1.0, 1e9];
const TIMES: [f64; 3] = [1e-6, 1.0, 1e6];
/// One question out of this number is asked, in one scale; `SCALES=all` asks all questions in all scales.
const ONE_IN: f64 = 12.0;
/// Factor by which the error estimates of two results may be wrong, and allowed relative error of numbers.
const FACTOR: f64 = 100.0;
const ALLOWED: f64 = 1e-11;
/// Other words to first order, as a part of all: scales of states not coupled both ways are not known.
const KNOWN: f64 = 0.01;

/// Units in those of the scene.
#[derive(Clone, Copy)]
struct Scale {
    action: f64,
    length: f64,
    time: f64,
}

/// What stands behind it says in which states a system is taken: quasi-velocities are chosen by coefficients
/// of constraints, which units change, and eigenvalues of an instant depend on that. Of members, how they
/// ended.
const CHART: &str = " in ";

const OWN: Scale = Scale { action: 1.0, length: 1.0, time: 1.0 };

impl Scale {
    /// The unit of each coordinate: angles have none.
    fn lengths(&self, scene: &Scene) -> Vec<f64> {
        let of = |c: &mechanics::Coordinate| match c.unit.as_str() {
            "m" => self.length,
            "m^2" => self.length.powi(2),
            "rad" => 1.0,
            other => panic!("{}: the unit `{other}`", scene.name),
        };
        scene.system.coordinates.iter().map(of).collect()
    }

    fn scene(&self, scene: &Scene) -> Scene {
        let Scale { action, time, .. } = *self;
        Scaling { lengths: self.lengths(scene), time, action, constraint: 1.0 }.scene(scene)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Question {
    Motion,
    NaturalConstants,
    FirstOrder,
    Members,
}

/// A number, complex, how far it may be off, and its size, in units of the scene.
#[derive(Clone, Copy, Debug)]
struct Number {
    value: [f64; 2],
    error: f64,
    size: f64,
}

/// Numbers and what is said beside them; or why there are none.
type Found = Result<(String, Vec<Number>), String>;

/// `choice` of a scene in these units, with numbers in its own.
fn ask(question: Question, scene: &Scene, choice: &Choice, scale: &Scale) -> Found {
    match question {
        Question::Motion | Question::NaturalConstants => motion(scene, choice, scale),
        Question::FirstOrder => first_order(scene, choice, scale),
        Question::Members => members(scene, choice, scale),
    }
}

/// Coordinates at some times, in the scene's own units; the size is the largest of those of one unit.
fn numbers(scene: &Scene, scale: &Scale, coordinates: &[Vec<f64>], estimate: &ErrorEstimate) -> Vec<Number> {
    let (lengths, units) = (scale.lengths(scene), scene.system.coordinates.iter().map(|c| &c.unit));
    let units: Vec<_> = units.collect();
    let size = |i: usize| {
        let alike = || (0..lengths.len()).filter(|&j| units[j] == units[i]);
        let all = coordinates.iter().chain([&scene.start.q]);
        all.flat_map(|q| alike().map(|j| (q[j] * lengths[j]).abs())).fold(0.0, f64::max)
    };
    let sizes: Vec<f64> = (0..lengths.len()).map(size).collect();
    let number = |(i, x): (usize, &f64)| Number {
        value: [x * lengths[i], 0.0],
        error: estimate.coordinates[i] * lengths[i],
        size: sizes[i],
    };
    coordinates.iter().flat_map(|q| q.iter().enumerate().map(number)).collect()
}

/// Where it has come in half of its time and at its end.
fn motion(scene: &Scene, choice: &Choice, scale: &Scale) -> Found {
    let mut motion = solve_choice(scene, choice, &Settings::default()).map_err(|error| error.to_string())?;
    let estimate = error_estimate(&mut motion, setting(scene)).map_err(|error| error.to_string())?;
    if let (status, Some(cause)) = estimate.status(&motion) {
        return Err(format!("{status}: {cause}"));
    }
    let times = [(motion.start() + motion.end()) / 2.0, motion.end()];
    let at: Result<Vec<_>, _> = times.iter().map(|&t| motion.at(t).map(|now| now.coordinates)).collect();
    Ok((String::new(), numbers(scene, scale, &at.map_err(|error| error.to_string())?, &estimate)))
}

/// Eigenvalues at the start, and whether that is a steady motion.
fn first_order(scene: &Scene, choice: &Choice, scale: &Scale) -> Found {
    let word = match linearize(setting(scene), choice) {
        Ok(_) => "steady",
        Err(LinearError::NotSteady { .. }) => "moves",
        Err(LinearError::TimeDependent { .. }) => "contains the time",
        Err(error) => return Err(error.to_string()),
    };
    let found = linearize_at(setting(scene), choice, scene.start.t, &Settings::default());
    let found = found.map_err(|error| error.to_string())?;
    let part = found.part(&[]).map_err(|error| error.to_string())?;
    let mut states = [&found.states[..], &found.carried.iter().map(|c| c.name.clone()).collect::<Vec<_>>()].concat();
    states.sort();
    let size = part.eigenvalues.iter().map(|e| e.value.norm() / scale.time).fold(0.0, f64::max);
    let number = |e: &linear::Eigenvalue| Number {
        value: [e.value.re / scale.time, e.value.im / scale.time],
        error: e.error / scale.time,
        size,
    };
    Ok((
        format!("{word}, {} zeros{CHART}{}", part.zeros, states.join(" ")),
        part.eigenvalues.iter().map(number).collect(),
    ))
}

/// Four members that differ by the last coordinate at the start and by the first parameter, at their end.
fn members(scene: &Scene, choice: &Choice, scale: &Scale) -> Found {
    let (system, last) = (&scene.system, scene.system.dimension() - 1);
    let parameter = system.parameters.first();
    let mut names = vec![system.coordinates[last].name.clone()];
    names.extend(parameter.map(|p| system.graph.name(p.symbol)));
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let unit = scale.lengths(scene)[last];
    let rows: Vec<Vec<f64>> = [(0.0, 1.0), (0.05, 1.0), (0.0, 1.02), (0.05, 1.02)]
        .iter()
        .map(|(shift, factor)| {
            [scene.start.q[last] + shift / unit].into_iter().chain(parameter.map(|p| p.value * factor)).collect()
        })
        .collect();
    let ensemble = Ensemble::new(scene, choice, &names, &Settings::default()).map_err(|error| error.to_string())?;
    let (options, end) = (EnsembleOptions { threads: 1, estimate: true }, setting(scene).end);
    let (mut said, mut found, mut why) = (String::new(), Vec::new(), None);
    for member in ensemble.answers(ensemble.members(&rows, 1), &[end], &options) {
        let (status, read) = match &member {
            Ok(member) => (member.status().0, (member.status().0 == "completed").then_some(member)),
            Err(cause) => {
                why.get_or_insert(cause.clone());
                ("refused", None)
            }
        };
        said += &format!("{CHART}{status}");
        if let Some((member, estimate)) = read.and_then(|member| Some((member, member.estimate.as_ref()?))) {
            let at: Vec<_> = member.outputs.iter().map(|now| now.coordinates.clone()).collect();
            found.extend(numbers(scene, scale, &at, estimate));
        }
    }
    if found.is_empty() { Err(why.unwrap_or(said)) } else { Ok((said, found)) }
}

/// What is another number, or word, beyond the errors; eigenvalues come in any order.
fn differing(question: Question, here: &(String, Vec<Number>), there: &(String, Vec<Number>)) -> Option<String> {
    if (&here.0, here.1.len()) != (&there.0, there.1.len()) {
        return Some(format!("{} ({}) -> {} ({})", here.0, here.1.len(), there.0, there.1.len()));
    }
    let apart = |a: &Number, b: &Number| {
        let apart = (a.value[0] - b.value[0]).hypot(a.value[1] - b.value[1]);
        let limit = FACTOR * (a.error + b.error) + ALLOWED * a.size;
        // NaN is apart
        if apart <= limit { 0.0 } else { apart / limit }
    };
    let mut left = there.1.clone();
    for number in &here.1 {
        let places = 0..if question == Question::FirstOrder { left.len() } else { 1 };
        let nearest = places.min_by(|&i, &j| apart(number, &left[i]).total_cmp(&apart(number, &left[j])))?;
        let other = left.remove(nearest);
        if apart(number, &other) != 0.0 {
            return Some(format!(
                "{:?} ± {:.1e} -> {:?} ± {:.1e}",
                number.value, number.error, other.value, other.error
            ));
        }
    }
    None
}

/// What is asked of a scene: each of its choices, those of removals with natural constants, too.
fn questions(scene: &Scene) -> Vec<(Question, usize)> {
    let all = choices(scene);
    let of = |(i, choice): (usize, &Choice)| {
        let natural = choice.removal.is_some().then_some((Question::NaturalConstants, i));
        [(Question::Motion, i), (Question::FirstOrder, i), (Question::Members, i)].into_iter().chain(natural)
    };
    all.iter().enumerate().flat_map(of).collect()
}

fn choice(scene: &Scene, (question, place): (Question, usize)) -> Choice {
    let choice = choices(scene).swap_remove(place);
    match question {
        Question::NaturalConstants => {
            let constants = ConstantsRule::Natural { horizon: setting(scene).end };
            Choice { constants, ..choice }
        }
        _ => choice,
    }
}

#[test]
fn scales_change_no_motion() {
    let all = std::env::var("SCALES").is_ok_and(|word| word == "all");
    let [only, kind] = ["SCALES_OF", "SCALES_ASK"].map(|name| std::env::var(name).ok());
    let mut random = SplitMix::new(36);
    let (mut count, mut refused) = (BTreeMap::<Question, [usize; 3]>::new(), BTreeMap::<String, usize>::new());
    let (mut others, begun) = (Vec::new(), Instant::now());
    let units = ACTIONS
        .iter()
        .flat_map(|&action| LENGTHS.iter().flat_map(move |&length| TIMES.map(|time| Scale { action, length, time })));
    let units: Vec<Scale> = units.collect();
    for (name, text) in scene::catalogue::built_in() {
        if only.as_ref().is_some_and(|only| only.split(',').all(|o| o != *name)) {
            continue;
        }
        let scene = Scene::parse(name, text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for asked in questions(&scene) {
            if kind.as_ref().is_some_and(|kind| *kind != format!("{:?}", asked.0)) {
                continue;
            }
            if !all && random.unit() * ONE_IN > 1.0 {
                continue;
            }
            let begun = Instant::now();
            let Ok(here) = ask(asked.0, &scene, &choice(&scene, asked), &OWN) else { continue };
            let drawn = [units[(random.unit() * units.len() as f64) as usize % units.len()]];
            for scale in if all { &units[..] } else { &drawn[..] } {
                let scaled = scale.scene(&scene);
                let choice = choice(&scaled, asked);
                let Scale { action, length, time } = scale;
                let place = format!("{name}, {:?}, {}: {action:e} {length:e} {time:e}", asked.0, choice.label);
                let count = count.entry(asked.0).or_default();
                let chart = |said: &str| said.split_once(CHART).map_or(String::new(), |(_, states)| states.into());
                let there = ask(asked.0, &scaled, &choice, scale).and_then(|there| match chart(&there.0) {
                    states if states == chart(&here.0) => Ok(there),
                    _ if asked.0 == Question::FirstOrder => Err("other quasi-velocities".into()),
                    states => Err(format!("members: {} -> {states}", chart(&here.0))),
                });
                match there.map(|there| differing(asked.0, &here, &there)) {
                    Ok(None) => count[0] += 1,
                    Err(cause) => {
                        println!("{place}: refused: {cause}");
                        count[1] += 1;
                        *refused.entry(cause).or_default() += 1;
                    }
                    Ok(Some(how)) => {
                        println!("{place}: OTHER {how}");
                        count[2] += 1;
                        others.push(format!("{place}: {how}"));
                    }
                }
            }
            if begun.elapsed().as_secs_f64() > 5.0 {
                println!("{name} {asked:?}: {:.1} s", begun.elapsed().as_secs_f64());
            }
        }
        println!("{name}: {:.1} s so far", begun.elapsed().as_secs_f64());
    }
    println!("same, refused, other: {count:?}\nrefused: {refused:#?}");
    let known = |question: Question| if question == Question::FirstOrder { KNOWN } else { 0.0 };
    for (question, [same, refused, other]) in count {
        let said = format!("{question:?}: {same} the same, {refused} refused, {other} others:\n{}", others.join("\n"));
        assert!(other as f64 <= known(question) * same as f64 && 5 * refused <= same, "{said}");
    }
}
