//! The pictures of one scene.

use std::path::PathBuf;

use anyhow::Result;
use comparison::words::enumerate;
use comparison::{Answer, Comparison, Gap, Run, Verdict};
use equations::Outputs;
use mechanics::Observables;
use motion::{CHETAEV, PRESCRIBED, REMOVED_CONSTRAINT, VAKONOMIC};
use scene::Scene;

use crate::family::family;
use picture::{Axis, Curve, Panel, Picture, Style};
use program::File;
use review::substitution::SUBSTITUTION;

/// Dots on a path, at most, and instants drawn from one to the next.
const DOTS: f64 = 12.0;
const INSTANTS: usize = 80;

/// The colour and dash of a formulation, the same in every picture.
pub(crate) fn style(run: &Run) -> Style {
    Style::of_formulation(run.choice.formulation.name).unwrap_or(Style::Vakonomic)
}

/// The runs drawn: the first of each formulation, without the costate form (the vakonomic motion again).
pub(crate) fn drawn(comparison: &Comparison) -> Vec<usize> {
    [CHETAEV, VAKONOMIC, REMOVED_CONSTRAINT, PRESCRIBED, &SUBSTITUTION]
        .iter()
        .filter_map(|own| comparison.run(own))
        .filter(|&i| comparison.runs[i].outcome.is_ok())
        .collect()
}

/// Coordinates and the scene's observables over time, the path in the plane where there is one, the gap to
/// Chetaev over time, where it is certain.
///
/// The moving bodies show a path, too: where all formulations have the same one, it is not drawn again.
///
/// # Errors
/// Where a motion cannot be read off or a picture cannot be drawn.
pub fn pictures(comparison: &mut Comparison) -> Result<Vec<File>> {
    let name = comparison.scene.name.clone();
    let moving = !comparison.scene.view.bodies.is_empty();
    let mut files = Vec::new();
    let mut add = |kind: &str, text: String| {
        files.push(File { path: PathBuf::from(format!("scenes/{name}-{kind}.svg")), text });
    };
    let (beat, times) = beats(&comparison.scene);
    let motions = sample(comparison, &times)?;
    let coordinates = &comparison.scene.system.coordinates;
    let curves = |value: &dyn Fn(&Instant) -> (f64, f64)| -> Vec<Curve> {
        let curve =
            |m: &Drawn| Curve { label: m.label.clone(), style: m.style, points: m.points.iter().map(value).collect() };
        motions.iter().map(curve).collect()
    };
    let panels = most_telling(comparison).into_iter().map(|i| {
        let c = &coordinates[i];
        Panel::new(Axis::linear(format!("{} ({})", c.name, c.unit)), curves(&|now| (now.t, now.q[i])))
    });
    let title = |what: &str| format!("{}: {what}", comparison.scene.title);
    let columns = if coordinates.len() > 1 { 2 } else { 1 };
    let (said, time) = (title(&differences(comparison)), Axis::linear("t (s)"));
    let over_time = Picture::panels(said, time, panels.collect(), columns);
    add("coordinates", over_time.to_svg()?);
    let observables = Observables::of(&comparison.scene.system)?;
    if !observables.names().is_empty() {
        let panels = observables
            .names()
            .iter()
            .enumerate()
            .map(|(i, name)| Panel::new(Axis::linear(name), curves(&|now| (now.t, now.observed[i]))));
        let columns = if panels.len() > 1 { 2 } else { 1 };
        let over_time = Picture::panels(title("observables"), Axis::linear("t (s)"), panels.collect(), columns);
        add("observables", over_time.to_svg()?);
    }

    let place = |name: &str| coordinates.iter().position(|c| c.name == name);
    if let (Some(x), Some(y), true) = (place("x"), place("y"), differ(comparison) || !moving) {
        let axes = [x, y].map(|i| format!("{} ({})", coordinates[i].name, coordinates[i].unit));
        let mut curves = curves(&|now| (now.q[x], now.q[y]));
        curves.extend(family(comparison, &times, |q| (q[x], q[y]))?);
        let title = title(&format!("{}; from the ring, a dot every {beat} s", about_paths(comparison)));
        add("path", Picture::plane(title, [&axes[0], &axes[1]], curves, INSTANTS).to_svg()?);
    }
    let gaps = gap_curves(comparison);
    if !gaps.is_empty() {
        let (x, y) = (Axis::log("t − t₀ (s)"), Axis::log("gap in the kinetic metric (m √kg)"));
        add("gap", Picture::new(title(&about_gaps(comparison)), x, y, gaps).to_svg()?);
    }
    Ok(files)
}

struct Drawn {
    label: String,
    style: Style,
    points: Vec<Instant>,
}

/// Where a motion is at one time.
struct Instant {
    t: f64,
    q: Vec<f64>,
    observed: Vec<f64>,
}

/// Is one motion not another's, those of the control left out?
fn differ(comparison: &Comparison) -> bool {
    let control = |i: usize| comparison.runs[i].choice.formulation == &SUBSTITUTION;
    let drawn: Vec<usize> = drawn(comparison).into_iter().filter(|&i| !control(i)).collect();
    let pairs = comparison.pairs.iter().filter(|p| drawn.contains(&p.first) && drawn.contains(&p.second));
    pairs.into_iter().any(|pair| pair.gap.verdict != Verdict::Same)
}

/// Round seconds from dot to dot, and times with [`INSTANTS`] to each.
fn beats(scene: &Scene) -> (f64, Vec<f64>) {
    let least = scene.duration / DOTS;
    let power = 10f64.powf(least.log10().floor());
    let beat = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|beat| *beat >= least);
    let beat = beat.unwrap_or(10.0 * power);
    let most = DOTS as usize * INSTANTS;
    let count = ((scene.duration / beat * INSTANTS as f64 + 1e-9) as usize).min(most);
    let times = (0..=count).map(|i| scene.start.t + beat * i as f64 / INSTANTS as f64);
    let end = scene.start.t + scene.duration;
    (beat, times.map(|t| t.min(end)).collect())
}

fn sample(comparison: &mut Comparison, times: &[f64]) -> Result<Vec<Drawn>> {
    let mut motions = Vec::new();
    let mut observables = Observables::of(&comparison.scene.system)?;
    for i in drawn(comparison) {
        let run = &mut comparison.runs[i];
        let (label, style) = (run.choice.label.clone(), style(run));
        let Ok(motion) = &mut run.outcome else { continue };
        let mut points = Vec::new();
        let end = motion.end();
        for t in times.iter().copied().filter(|t| *t < end).chain([end]) {
            let Outputs { coordinates: q, velocities, .. } = motion.at(t)?;
            points.push(Instant { t, observed: observables.at(t, &q, &velocities).to_vec(), q });
        }
        motions.push(Drawn { label, style, points });
    }
    Ok(motions)
}

/// Panels of coordinates, at most.
const PANELS: usize = 4;

/// Lengths first; where there are two and many coordinates, no angles: those of a rolling body say little.
fn most_telling(comparison: &Comparison) -> Vec<usize> {
    let coordinates = &comparison.scene.system.coordinates;
    let mut order: Vec<usize> = (0..coordinates.len()).collect();
    order.sort_by_key(|&i| coordinates[i].unit != "m");
    let lengths = coordinates.iter().filter(|c| c.unit == "m").count();
    order.truncate(if order.len() > PANELS && lengths > 1 { lengths.min(PANELS) } else { PANELS });
    order.sort_unstable();
    order
}

/// In which coordinates the vakonomic motion, or else that of removal, differs from Chetaev's.
fn differences(comparison: &Comparison) -> String {
    let gap = |other| Some(&comparison.pair(comparison.run(CHETAEV)?, comparison.run(other)?)?.gap);
    let differs = |gap: &&Gap| gap.verdict != Verdict::Same;
    let found = [(VAKONOMIC, "vakonomic"), (REMOVED_CONSTRAINT, "removed-constraint")];
    let found = found.into_iter().find_map(|(other, name)| Some((gap(other).filter(differs)?, name)));
    let Some((gap, name)) = found else { return "all formulations give the same motion".into() };
    let coordinates = comparison.scene.system.coordinates.iter().zip(&gap.certain_by_coordinate);
    let certain: Vec<String> = coordinates.filter(|(_, from)| from.is_some()).map(|(c, _)| c.name.clone()).collect();
    match certain.len() {
        0 => format!("Chetaev's and the {name} motion"),
        _ => format!("Chetaev's and the {name} motion differ in {}", enumerate(&certain)),
    }
}

/// Whether some `μ₀` makes the vakonomic path Chetaev's.
fn about_paths(comparison: &Comparison) -> &'static str {
    let answer = comparison.membership().and_then(|found| found.as_ref().ok()).map(|found| found.answer());
    match answer {
        Some(Answer::NoneProved { .. }) => "no μ₀ makes the vakonomic path Chetaev's",
        Some(Answer::SomeProved | Answer::Some { .. }) => "one μ₀ makes the vakonomic path Chetaev's",
        _ => "paths of the formulations",
    }
}

/// The power of time as which the gap of a run to Chetaev's motion begins.
fn power(comparison: &Comparison, run: usize) -> Option<String> {
    let growth = comparison.pair(comparison.run(CHETAEV)?, run)?.growth.as_ref()?;
    let whole = growth.exponent.round();
    let superscript = ["⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"].get(whole as usize)?;
    ((growth.exponent - whole).abs() < 0.05).then(|| format!("t{superscript}"))
}

/// How the gaps begin.
fn about_gaps(comparison: &Comparison) -> String {
    let of = |other, name: &str| Some(format!("{} ({name})", power(comparison, comparison.run(other)?)?));
    let known = [of(VAKONOMIC, "vakonomic"), of(REMOVED_CONSTRAINT, "removed constraint")];
    let known: Vec<String> = known.into_iter().flatten().collect();
    match known.len() {
        0 => "gap to Chetaev's motion".into(),
        _ => format!("the gap to Chetaev's motion grows as {}", enumerate(&known)),
    }
}

/// The gaps as far as they pass the limit, which at every time is the largest of any pair up to then.
fn gap_curves(comparison: &Comparison) -> Vec<Curve> {
    let start = comparison.scene.start.t;
    let Some(chetaev) = comparison.run(CHETAEV) else { return Vec::new() };
    let others = drawn(comparison).into_iter().filter(|&i| i != chetaev);
    let pairs: Vec<_> = others.filter_map(|i| Some((i, comparison.pair(chetaev, i)?))).collect();
    let points = pairs.iter().enumerate().flat_map(|(n, (_, pair))| pair.gap.points.iter().map(move |p| (n, p)));
    let mut points: Vec<_> = points.collect();
    points.sort_by(|(_, a), (_, b)| a.t.total_cmp(&b.t));
    let mut limit = vec![(0.0, 0.0)];
    let mut lines: Vec<Vec<Vec<(f64, f64)>>> = vec![vec![Vec::new()]; pairs.len()];
    for (n, p) in points {
        let highest = p.limit.max(limit[limit.len() - 1].1);
        limit.push((p.t - start, highest));
        match lines[n].last_mut() {
            Some(line) if p.gap > highest => line.push((p.t - start, p.gap)),
            Some(line) if !line.is_empty() => lines[n].push(Vec::new()),
            _ => {}
        }
    }
    let control = |i: usize| comparison.runs[i].choice.formulation == &SUBSTITUTION;
    // the control alone says nothing about the formulations
    if pairs.iter().zip(&lines).all(|(&(i, _), lines)| control(i) || lines.iter().all(Vec::is_empty)) {
        return Vec::new();
    }
    limit.retain(|(_, limit)| *limit > 0.0 && limit.is_finite());
    let curves = pairs.iter().zip(lines).flat_map(|(&(i, _), lines)| {
        let run = &comparison.runs[i];
        let label = power(comparison, i).map_or(String::new(), |power| format!(", ∝ {power}"));
        let curve = move |points| Curve { label: run.choice.label.clone() + &label, style: style(run), points };
        lines.into_iter().filter(|points| !points.is_empty()).map(curve)
    });
    let limit = Curve { label: "certainty limit".into(), style: Style::Threshold, points: limit };
    curves.chain([limit]).collect()
}
