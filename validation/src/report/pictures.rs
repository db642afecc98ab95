//! The pictures of one scene.

use std::path::PathBuf;

use anyhow::Result;
use deltaq::{Comparison, Run};
use equations::Outputs;
use mechanics::Observables;

use crate::report::File;
use picture::{Axis, Curve, Panel, Picture, Style};
use random::substitution;

/// Instants drawn of a motion.
const INSTANTS: usize = 400;

/// The colour and dash of a formulation, the same in every picture.
pub(crate) fn style(run: &Run) -> Style {
    Style::of_formulation(run.choice.formulation).unwrap_or(Style::Vakonomic)
}

/// The runs drawn: the first of each formulation, without the costate form (the vakonomic motion again).
pub(crate) fn drawn(comparison: &Comparison) -> Vec<usize> {
    ["chetaev", "vakonomic", "removed-constraint", substitution::NAME]
        .iter()
        .filter_map(|name| comparison.run(name))
        .filter(|&i| comparison.runs[i].outcome.is_ok())
        .collect()
}

/// Coordinates and the scene's observables over time, the path in the plane where there is one, the gap to
/// Chetaev over time.
///
/// # Errors
/// Where a motion cannot be read off or a picture cannot be drawn.
pub fn pictures(comparison: &mut Comparison) -> Result<Vec<File>> {
    let name = comparison.scene.name.clone();
    let mut files = Vec::new();
    let mut add = |kind: &str, text: String| {
        files.push(File { path: PathBuf::from(format!("scenes/{name}-{kind}.svg")), text });
    };
    let motions = sample(comparison)?;
    let coordinates = &comparison.scene.system.coordinates;
    let curves = |value: &dyn Fn(&Instant) -> (f64, f64)| -> Vec<Curve> {
        let curve =
            |m: &Drawn| Curve { label: m.label.clone(), style: m.style, points: m.points.iter().map(value).collect() };
        motions.iter().map(curve).collect()
    };
    let panels = coordinates.iter().enumerate().map(|(i, c)| Panel {
        y: Axis::linear(format!("{} ({})", c.name, c.unit)),
        curves: curves(&|now| (now.t, now.q[i])),
    });
    let title = |what: &str| format!("{}: {what}", comparison.scene.title);
    let columns = if coordinates.len() > 1 { 2 } else { 1 };
    let over_time = Picture::panels(title("coordinates over time"), Axis::linear("t (s)"), panels.collect(), columns);
    add("coordinates", over_time.to_svg()?);
    let observables = Observables::of(&comparison.scene.system)?;
    if !observables.names().is_empty() {
        let panels = observables
            .names()
            .iter()
            .enumerate()
            .map(|(i, name)| Panel { y: Axis::linear(name.clone()), curves: curves(&|now| (now.t, now.observed[i])) });
        let columns = if panels.len() > 1 { 2 } else { 1 };
        let over_time = Picture::panels(title("observables"), Axis::linear("t (s)"), panels.collect(), columns);
        add("observables", over_time.to_svg()?);
    }

    let place = |name: &str| coordinates.iter().position(|c| c.name == name);
    if let (Some(x), Some(y)) = (place("x"), place("y")) {
        let axes = [x, y].map(|i| format!("{} ({})", coordinates[i].name, coordinates[i].unit));
        let curves = curves(&|now| (now.q[x], now.q[y]));
        add("path", Picture::plane(title("path in the plane"), [&axes[0], &axes[1]], curves).to_svg()?);
    }
    let gaps = gap_curves(comparison);
    if !gaps.is_empty() {
        let (x, y) = (Axis::log("t − t₀ (s)"), Axis::log("gap, kinetic metric"));
        add("gap", Picture::new(title("gap to the Chetaev motion"), x, y, gaps).to_svg()?);
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

fn sample(comparison: &mut Comparison) -> Result<Vec<Drawn>> {
    let mut motions = Vec::new();
    let mut observables = Observables::of(&comparison.scene.system)?;
    for i in drawn(comparison) {
        let run = &mut comparison.runs[i];
        let (label, style) = (run.choice.label.clone(), style(run));
        let Ok(motion) = &mut run.outcome else { continue };
        let mut points = Vec::new();
        for t in motion.grid(INSTANTS) {
            let Outputs { coordinates: q, velocities, .. } = motion.at(t)?;
            points.push(Instant { t, observed: observables.at(t, &q, &velocities).to_vec(), q });
        }
        motions.push(Drawn { label, style, points });
    }
    Ok(motions)
}

fn gap_curves(comparison: &Comparison) -> Vec<Curve> {
    let start = comparison.scene.start.t;
    let Some(chetaev) = comparison.run("chetaev") else { return Vec::new() };
    let mut curves = Vec::new();
    let mut limit: Vec<(f64, f64)> = Vec::new();
    for i in drawn(comparison).into_iter().filter(|&i| i != chetaev) {
        let Some(pair) = comparison.pair(chetaev, i) else { continue };
        let run = &comparison.runs[i];
        let points = pair.gap.points.iter().filter(|p| p.gap > 0.0).map(|p| (p.t - start, p.gap));
        curves.push(Curve { label: run.choice.label.clone(), style: style(run), points: points.collect() });
        if limit.is_empty() {
            limit = pair
                .gap
                .points
                .iter()
                .filter(|p| p.limit > 0.0 && p.limit.is_finite())
                .map(|p| (p.t - start, p.limit))
                .collect();
        }
    }
    curves.retain(|c| !c.points.is_empty());
    if !curves.is_empty() && !limit.is_empty() {
        curves.push(Curve { label: "certainty limit".into(), style: Style::Threshold, points: limit });
    }
    curves
}
