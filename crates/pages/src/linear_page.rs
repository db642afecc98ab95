//! Eigenvalues of steady motions: tables and pictures.

use std::fmt::Write;

use anyhow::Result;
use linear::{Chain, Eigenvalue, Sweep, SweepPoint};
use nalgebra::Complex;
use scene::Scene;

use crate::markdown::inert;
use crate::table::Table;
use comparison::words::{enumerate, precise, short};
use picture::{Axis, Curve, Panel, Picture, Style};

/// What was linearized, a table with one line per value, the states that were `found`, what first order
/// leaves open, and where stability changes.
pub fn sweep_text(scene: &Scene, sweep: &Sweep, found: bool) -> String {
    let mut text = format!("# {}\n\n", inert(&scene.title));
    let Some(SweepPoint { linearization, part, .. }) = sweep.points.first() else { return text };
    let kind = if linearization.is_steady { "A steady motion" } else { "**Frozen at an instant of a motion**" };
    let _ =
        writeln!(text, "{kind}, by the equations of {}. Eigenvalues of {}", linearization.form, told(&sweep.points[0]));
    let mut others: Vec<&SweepPoint> =
        sweep.points.iter().filter(|point| names(point) != names(&sweep.points[0])).collect();
    while let Some(&first) = others.first() {
        let (same, rest): (Vec<_>, Vec<_>) = others.into_iter().partition(|point| names(point) == names(first));
        let at: Vec<String> = same.iter().map(|point| short(point.asked)).collect();
        let _ = writeln!(text, "With {} = {}, of {}", sweep.name, at.join(", "), told(first));
        others = rest;
    }
    let cells: Vec<Vec<String>> = sweep.points.iter().map(|point| pairs(&point.part.eigenvalues)).collect();
    let width = cells.iter().map(Vec::len).max().unwrap_or(0);
    let columns = (1..=width).map(|i| format!(">s{i}")).chain([">error".into(), ">zeros".into(), ">growing".into()]);
    let mut table = Table::new([format!(">{}", sweep.name)].into_iter().chain(columns));
    for (point, cells) in sweep.points.iter().zip(cells) {
        let error = point.part.eigenvalues.iter().fold(0.0_f64, |a, e| a.max(e.error));
        let padded = cells.into_iter().chain(std::iter::repeat(String::new())).take(width);
        let rest = [short(error), point.part.zeros.to_string(), point.part.growth().to_string()];
        let value = if found { precise(point.value) } else { short(point.value) };
        table.cells([value].into_iter().chain(padded).chain(rest));
    }
    let _ = write!(text, "\n{table}");
    if found {
        let _ = write!(text, "\nSteady motions that were found:\n\n{}", states(scene, sweep));
    }
    let vectors = linearization.spectrum.zero_vectors;
    if part.states.len() == linearization.states.len() && part.zeros > vectors {
        let _ = writeln!(
            text,
            "\nThe {} zeros, within {}, have {vectors} eigenvectors.",
            part.zeros,
            short(part.zero_error)
        );
    }
    text + &left_open(sweep) + &changes(scene, sweep, found)
}

/// The states whose eigenvalues are asked for, and those that are carried along.
fn names(SweepPoint { linearization, part, .. }: &SweepPoint) -> [Vec<&str>; 2] {
    let carried = linearization.carried.iter().map(|c| &c.name[..]).collect();
    [part.states.iter().map(|&i| &linearization.states[i][..]).collect(), carried]
}

/// The same in words.
fn told(point: &SweepPoint) -> String {
    let states: Vec<String> = names(point)[0].iter().map(ToString::to_string).collect();
    let carried: Vec<String> =
        point.linearization.carried.iter().map(|c| format!("{}' = {}", c.name, precise(c.rate))).collect();
    match carried.is_empty() {
        true => format!("{}.", enumerate(&states)),
        false => {
            format!("{}.\nCarried along, because no rate depends on them: {}.", enumerate(&states), carried.join(", "))
        }
    }
}

/// One line per state found: what was asked for, coordinates and velocities.
fn states(scene: &Scene, sweep: &Sweep) -> Table {
    let names = scene.system.coordinates.iter().map(|c| &c.name);
    let varied = (sweep.name != "t").then(|| format!(">start, {}", sweep.name));
    let columns = names.clone().map(|name| format!(">{name}")).chain(names.map(|name| format!(">{name}'")));
    let mut table = Table::new(varied.clone().into_iter().chain(columns));
    for point in &sweep.points {
        let asked = varied.as_ref().map(|_| short(point.asked));
        table.cells(asked.into_iter().chain(point.state.q.iter().chain(&point.state.v).map(|x| precise(*x))));
    }
    table
}

/// What eigenvalues on the imaginary axis do, each sentence once, and from which value on.
fn left_open(sweep: &Sweep) -> String {
    let mut said: Vec<(String, Vec<f64>)> = Vec::new();
    let mut say = |sentence: String, value: f64| match said.iter_mut().find(|(known, _)| *known == sentence) {
        Some((_, values)) => values.push(value),
        None => said.push((sentence, vec![value])),
    };
    for SweepPoint { value, part, .. } in &sweep.points {
        if part.eigenvalues.is_empty() && part.chains.is_empty() {
            say("Every eigenvalue is zero: to first order nothing is decided about stability.".into(), *value);
        }
        for chain in &part.chains {
            say(sentence(chain), *value);
        }
    }
    let all = sweep.points.len();
    let mut text = String::new();
    for (sentence, values) in said {
        let places = match &values[..] {
            _ if all == 1 => String::new(),
            [value] => format!("At {} = {}: ", sweep.name, short(*value)),
            [first, .., last] => {
                format!("At {} of {all} values, {} = {} … {}: ", values.len(), sweep.name, short(*first), short(*last))
            }
            [] => continue,
        };
        let _ = writeln!(text, "\n{places}{sentence}");
    }
    text
}

/// The effect of a chain on deviations.
fn sentence(chain: &Chain) -> String {
    let Chain { value, size, radius, power, is_exact, .. } = chain;
    let power = if *power == 1 { "t".into() } else { format!("t^{power}") };
    let place = match value.im {
        im if im.abs() <= *radius => "0".into(),
        im => format!("±{} i", precise(im)),
    };
    match (is_exact, chain.power) {
        (true, _) if chain.power + 1 == *size => {
            format!("{size} equal eigenvalues {place} have one eigenvector: deviations grow like {power}.")
        }
        (true, _) => {
            format!("{size} equal eigenvalues {place} lack eigenvectors: deviations grow like {power} or faster.")
        }
        (false, 0) => format!(
            "An error of {} leaves open on which side of the imaginary axis {size} of the eigenvalues at {place} are.",
            short(*radius)
        ),
        (false, _) => format!(
            "{size} eigenvalues within {} of {place} lack eigenvectors, or nearly: deviations grow like {power} until \
             about t = {}; then it is undecided.",
            short(*radius),
            short(1.0 / radius)
        ),
    }
}

/// Where stability changes.
fn changes(scene: &Scene, sweep: &Sweep, found: bool) -> String {
    let mut text = String::new();
    for change in &sweep.changes {
        let kind = if change.frequency == 0.0 {
            "a real eigenvalue".into()
        } else {
            format!("a pair at ±{} i", precise(change.frequency))
        };
        let have = |count: usize| match count {
            0 => "no eigenvalue has".into(),
            1 => "one has".into(),
            count => format!("{count} have"),
        };
        let [below, above] = change.unstable.map(have);
        let from = if found {
            let start = format!("{} = {}", sweep.name, sure(change.asked, change.width.max(1e-12)));
            let names = scene.system.coordinates.iter().map(|c| &c.name);
            let values = names.clone().cloned().zip(&change.state.q);
            let all = values.chain(names.map(|name| format!("{name}'")).zip(&change.state.v));
            let all: Vec<String> = all.map(|(name, x)| format!("{name} = {}", precise(*x))).collect();
            format!(" The motion there, found from a start with {start}: {}.", all.join(", "))
        } else {
            String::new()
        };
        let _ = writeln!(
            text,
            "\nLinear stability changes at {} = {}: {below} a positive real part below this value, {above} above; {kind} crosses.{from}",
            sweep.name,
            sure(change.value, change.width)
        );
    }
    text
}

/// Eigenvalues in the digits that are sure; conjugates are one entry.
pub fn pairs(eigenvalues: &[Eigenvalue]) -> Vec<String> {
    let upper = eigenvalues.iter().filter(|e| e.value.im >= 0.0);
    upper
        .map(|e| match e.value.im {
            0.0 => sure(e.value.re, e.error),
            im => format!("{} ± {} i", sure(e.value.re, e.error), sure(im, e.error)),
        })
        .collect()
}

/// A number up to the last digit that its error leaves.
fn sure(x: f64, error: f64) -> String {
    let digits = if error > 0.0 { (-error.log10()).floor().clamp(0.0, 15.0) as usize } else { 15 };
    format!("{x:.digits$}")
}

/// Real and imaginary parts over what varies.
///
/// # Errors
/// Where it cannot be drawn.
pub fn sweep_picture(title: &str, axis: &str, sweep: &Sweep) -> Result<String> {
    let tracks = tracks(sweep);
    let panel = |label: &str, part: fn(Complex<f64>) -> f64| {
        let curve = |points: &Vec<(f64, Complex<f64>)>| Curve {
            label: "eigenvalues".into(),
            style: Style::Member(0),
            points: points.iter().map(|&(x, value)| (x, part(value))).collect(),
        };
        let change =
            |x: &f64| Curve { label: "stability changes".into(), style: Style::Member(1), points: vec![(*x, 0.0)] };
        let ends = [0, sweep.points.len() - 1].map(|i| (sweep.points[i].value, 0.0));
        let zero = Curve { label: "0".into(), style: Style::Threshold, points: ends.into() };
        let changes: Vec<f64> = sweep.changes.iter().map(|change| change.value).collect();
        let changes: Vec<Curve> = changes.iter().map(change).collect();
        let curves = tracks.iter().map(curve).chain(changes).chain([zero]).collect();
        Panel::new(Axis::linear(label), curves)
    };
    let panels = vec![panel("real part (1/s)", |z| z.re), panel("imaginary part (1/s)", |z| z.im)];
    Ok(Picture::panels(title, Axis::linear(axis), panels, 1).to_svg()?)
}

/// Eigenvalues from value to value, each continued by the nearest one.
fn tracks(sweep: &Sweep) -> Vec<Vec<(f64, Complex<f64>)>> {
    let mut tracks: Vec<Vec<(f64, Complex<f64>)>> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for point in &sweep.points {
        let mut left: Vec<Complex<f64>> = point.part.eigenvalues.iter().map(|e| e.value).collect();
        let mut next = Vec::new();
        while let Some((track, place)) = nearest(&tracks, &open, &left) {
            tracks[track].push((point.value, left.swap_remove(place)));
            open.retain(|&other| other != track);
            next.push(track);
        }
        for value in left {
            next.push(tracks.len());
            tracks.push(vec![(point.value, value)]);
        }
        open = next;
    }
    tracks
}

/// The open track and the place of the eigenvalue that are closest to each other.
fn nearest(tracks: &[Vec<(f64, Complex<f64>)>], open: &[usize], left: &[Complex<f64>]) -> Option<(usize, usize)> {
    let away = |&(track, place): &(usize, usize)| {
        tracks[track].last().map_or(f64::INFINITY, |(_, end)| (end - left[place]).norm())
    };
    let all = open.iter().flat_map(|&track| (0..left.len()).map(move |place| (track, place)));
    all.min_by(|a, b| away(a).total_cmp(&away(b)))
}
