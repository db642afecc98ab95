//! Derivatives of motions against differences of references in double-double arithmetic, which share with
//! them the derivation of the equations and neither the tangents, nor the start, nor the time loop.
//!
//! How far numbers are moved is decided without a look at the derivatives that are judged.
//!
//! `SENSITIVITIES=all cargo test --release --package tests -- sensitivities:: --nocapture` takes every
//! built-in scene, formulation and number (`SENSITIVITIES=sledge,disc` those of these scenes), with what
//! was found; otherwise a part of them is taken.

use motion::{Choice, Sensitivities, Settings, choices, derive, prepare, sensitivities, setting};
use reference::{DoubleDouble, Entry, Question, reference};
use scene::Scene;

use super::support::scene;

/// Asked of each reference, in the kinetic metric.
const ACCURACY: f64 = 1e-16;
/// Distances that numbers are moved by, over their sizes.
const DISTANCES: [f64; 4] = [0.00390625, 0.0009765625, 0.015625, 0.000244140625];
/// Weights of differences of order 8 and of order 6.
const ORDER_8: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
const ORDER_6: [f64; 4] = [3.0 / 4.0, -3.0 / 20.0, 1.0 / 60.0, 0.0];
/// What a difference may be unsure of, over the largest derivative, and what a derivative may be away.
const SURE: f64 = 1e-12;
const LIMIT: f64 = 1e-10;

/// Coordinates, velocities and multipliers at `t`, of a scene in which one number has another value.
fn outputs(name: &str, label: &str, number: &str, value: f64, t: f64) -> Option<Vec<DoubleDouble>> {
    let scene = scene(name, &[(number, value)]);
    let choice = choices(&scene).into_iter().find(|choice| choice.label == label)?;
    let equations = derive(&scene.system, &choice).ok()?;
    let ready = prepare(setting(&scene), equations, &choice.constants, &Settings::default()).ok()?;
    let (system, start) = (&scene.system, &scene.start);
    let question = Question { system, start, equations: &ready.equations, constants: &ready.constants };
    let mut found = reference(&question, &[t], ACCURACY).ok()?;
    let point = found.points.swap_remove(0);
    Some([point.coordinates, point.velocities, point.multipliers].concat())
}

fn largest(x: impl IntoIterator<Item = f64>) -> f64 {
    x.into_iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

/// The derivative by a number, and what it is unsure of over its largest part.
fn difference(name: &str, label: &str, (number, value): (&str, f64), t: f64) -> Option<(Vec<f64>, f64)> {
    let size = if value == 0.0 { 1.0 } else { value.abs() };
    let mut best: Option<(Vec<f64>, f64)> = None;
    for distance in DISTANCES {
        let mut sums: [Vec<f64>; 2] = Default::default();
        let mut outermost = 0.0;
        let pairs: Option<Vec<_>> = (1..=4)
            .map(|j| {
                let step = distance * size * f64::from(j);
                let [after, before] = [value + step, value - step];
                let pair = [after, before].map(|x| outputs(name, label, number, x, t));
                let [Some(above), Some(below)] = pair else { return None };
                outermost = f64::max(outermost, largest(above.iter().map(|x| x.to_f64())));
                let quotient = |(a, b): (&DoubleDouble, &DoubleDouble)| (*a - *b).to_f64() / (after - before);
                Some(above.iter().zip(&below).map(quotient).collect::<Vec<f64>>())
            })
            .collect();
        let Some(pairs) = pairs else { continue };
        for (sum, weights) in sums.iter_mut().zip([ORDER_8, ORDER_6]) {
            // w (a − b)/h is 2 j w times the quotient of the pair
            let part = |i: usize| (0..4).map(|j| 2.0 * (j + 1) as f64 * weights[j] * pairs[j][i]).sum();
            *sum = (0..pairs[0].len()).map(part).collect();
        }
        let [found, lower] = sums;
        let apart = largest(found.iter().zip(&lower).map(|(a, b)| a - b));
        // starts are rounded to numbers of 53 bits
        let unsure = apart + f64::EPSILON * outermost / (distance * size);
        let relative = unsure / largest(found.iter().copied()).max(outermost / size);
        if best.as_ref().is_none_or(|(_, least)| relative < *least) {
            best = Some((found, relative));
        }
        if relative < SURE {
            break;
        }
    }
    best
}

/// What moves by itself: parameters, coordinates, velocities that are given, free constants.
fn numbers(scene: &Scene, choice: &Choice) -> Vec<(String, f64)> {
    let system = &scene.system;
    let g = &system.graph;
    let mut numbers: Vec<(String, f64)> = system.parameters.iter().map(|p| (g.name(p.symbol), p.value)).collect();
    numbers.extend(system.coordinates.iter().zip(&scene.start.q).map(|(c, q)| (c.name.clone(), *q)));
    let given = &scene.completion.given;
    let velocities = system.velocities().into_iter().zip(&scene.start.v).map(|(s, v)| (g.name(s), *v));
    numbers.extend(velocities.filter(|(name, _)| given.contains(name)));
    if choice.formulation.starts_multipliers {
        numbers.extend(scene.multiplier_names().into_iter().zip(scene.multipliers.iter().copied()));
    }
    numbers
}

/// Counts of derivatives that were judged, that were not, and the largest distance, over the largest part.
#[derive(Default)]
struct Judged {
    judged: usize,
    open: usize,
    largest: f64,
    /// How many are over the limit, and said so: their estimates are over a tenth of their distances.
    said: usize,
    /// Distances over their estimates: how many are over one, and over ten.
    over: [usize; 2],
}

impl Judged {
    fn add(&mut self, name: &str, label: &str, number: (&str, f64), ours: &Sensitivities, k: usize) {
        let t = ours.times[0];
        let Some((expected, unsure)) = difference(name, label, number, t) else {
            println!("{name}, {label}, {}: no reference", number.0);
            self.open += 1;
            return;
        };
        let parts = |x: &equations::Outputs| [&x.coordinates[..], &x.velocities, &x.multipliers].concat();
        let (found, errors) = (parts(&ours.derivatives[0][k]), parts(&ours.errors[0][k]));
        let size = if number.1 == 0.0 { 1.0 } else { number.1.abs() };
        let scale = largest(expected.iter().copied()).max(largest(parts(&ours.outputs[0])) / size);
        let distances: Vec<f64> = expected.iter().zip(&found).map(|(a, b)| (a - b).abs()).collect();
        let distance = largest(distances.iter().copied()) / scale;
        let estimate = largest(errors) / scale;
        println!("{name}, {label}, {}: {distance:.1e}; sure to {unsure:.1e}; estimate {estimate:.1e}", number.0);
        if unsure > LIMIT / 10.0 {
            self.open += 1;
            return;
        }
        self.judged += 1;
        if distance > LIMIT && 10.0 * estimate > distance {
            self.said += 1;
        } else {
            self.largest = self.largest.max(distance);
        }
        let floor = (10.0 * unsure).max(1e-13);
        self.over[0] += usize::from(distance > estimate + floor);
        self.over[1] += usize::from(distance > 10.0 * estimate + floor);
    }

    fn merge(&mut self, other: Judged) {
        self.judged += other.judged;
        self.open += other.open;
        self.largest = self.largest.max(other.largest);
        self.said += other.said;
        (0..2).for_each(|i| self.over[i] += other.over[i]);
    }
}

fn judge(name: &str, wanted: impl Fn(&str, &str) -> bool) -> Judged {
    let own = scene(name, &[]);
    let t = own.start.t + (0.5 * (setting(&own).end - own.start.t)).min(1.0);
    let mut all = Judged::default();
    for choice in choices(&own) {
        let mut numbers = numbers(&own, &choice);
        numbers.retain(|(number, _)| wanted(&choice.label, number));
        let found = |numbers: &[(String, f64)]| {
            let names: Vec<&str> = numbers.iter().map(|(name, _)| &name[..]).collect();
            sensitivities(&own, &choice, &names, &[t], &Settings::default())
        };
        // where the constraints let some numbers of a start not move alone, the others are judged
        if !numbers.is_empty() && found(&numbers).is_err() {
            numbers.retain(|number| {
                let refused = found(std::slice::from_ref(number)).err();
                refused.iter().for_each(|error| println!("{name}, {}, {}: {error}", choice.label, number.0));
                refused.is_none()
            });
        }
        if numbers.is_empty() {
            continue;
        }
        match found(&numbers) {
            Ok(ours) if !ours.times.is_empty() => {
                for (k, (number, value)) in numbers.iter().enumerate() {
                    all.add(name, &choice.label, (number, *value), &ours, k);
                }
            }
            Ok(ours) => println!("{name}, {}: {:?}", choice.label, ours.ending),
            Err(error) => println!("{name}, {}: {error}", choice.label),
        }
    }
    println!(
        "{name}: {} derivatives judged, {} not, largest distance {:.1e}; over the estimate {:?}",
        all.judged, all.open, all.largest, all.over
    );
    all
}

#[test]
fn derivatives_are_those_of_references() {
    if let Ok(wanted) = std::env::var("SENSITIVITIES") {
        let mut all = Judged::default();
        for (name, _) in
            scene::catalogue::built_in().filter(|(name, _)| wanted == "all" || wanted.split(',').any(|n| n == *name))
        {
            all.merge(judge(name, |_, _| true));
        }
        println!("{} judged, {} not, largest {:.1e}; over {:?}", all.judged, all.open, all.largest, all.over);
        println!("{} over {LIMIT:e}, which their estimates say", all.said);
        assert!(all.largest < LIMIT, "{:.1e}", all.largest);
        return;
    }
    let found = judge("sledge", |_, number| ["g", "phi", "x'", "mu0_1"].contains(&number));
    assert!(found.judged >= 13 && found.open == 0 && found.said == 0, "{} {}", found.judged, found.said);
    assert!(found.largest < LIMIT, "{}", found.largest);
    let found = judge("disc", |label, number| label == "vakonomic" && number.len() < 4);
    assert!(found.judged >= 4 && found.largest < LIMIT && found.said == 0, "{} {}", found.judged, found.largest);
}
