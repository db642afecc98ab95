//! Eigenvalues of steady motions: tables and pictures.

use std::fmt::Write;

use anyhow::Result;
use linear::{Eigenvalue, Sweep, SweepPoint};
use nalgebra::Complex;

use crate::report::Table;
use deltaq::words::{enumerate, precise, short};
use picture::{Axis, Curve, Panel, Picture, Style};

/// What was linearized, a table with one line a value, and where stability changes.
pub fn sweep_text(title: &str, sweep: &Sweep) -> String {
    let mut text = format!("# {title}\n\n");
    let Some(SweepPoint { linearization, part, .. }) = sweep.points.first() else { return text };
    let names = |places: &[usize]| places.iter().map(|&i| linearization.states[i].clone()).collect::<Vec<_>>();
    let carried: Vec<String> =
        linearization.carried.iter().map(|c| format!("{}' = {}", c.name, precise(c.rate))).collect();
    let kind = if linearization.is_steady { "A steady motion" } else { "**Frozen at an instant of a motion**" };
    let _ = writeln!(
        text,
        "{kind}, by the equations of {}. Eigenvalues of {}.",
        linearization.form,
        enumerate(&names(&part.states))
    );
    if !carried.is_empty() {
        let _ = writeln!(text, "Carried along, because no rate depends on them: {}.", carried.join(", "));
    }
    let cells: Vec<Vec<String>> = sweep.points.iter().map(|point| pairs(&point.part.eigenvalues)).collect();
    let width = cells.iter().map(Vec::len).max().unwrap_or(0);
    let columns = (1..=width).map(|i| format!(">s{i}")).chain([">error".into(), ">zeros".into(), ">growing".into()]);
    let mut table = Table::new([format!(">{}", sweep.name)].into_iter().chain(columns));
    for (point, cells) in sweep.points.iter().zip(cells) {
        let error = point.part.eigenvalues.iter().fold(0.0_f64, |a, e| a.max(e.error));
        let padded = cells.into_iter().chain(std::iter::repeat(String::new())).take(width);
        let rest = [short(error), point.part.zeros.to_string(), point.part.growth().to_string()];
        table.cells([short(point.value)].into_iter().chain(padded).chain(rest));
    }
    let _ = write!(text, "\n{table}");
    let vectors = linearization.spectrum.zero_vectors;
    if part.states.len() == linearization.states.len() && part.zeros > vectors {
        let _ = writeln!(text, "\nThe zeros have {vectors} eigenvectors: some deviations grow as powers of time.");
    }
    for change in &sweep.changes {
        let [before, behind] = change.unstable;
        let kind = if change.frequency == 0.0 {
            "a real eigenvalue".into()
        } else {
            format!("a pair at ±{} i", precise(change.frequency))
        };
        let _ = writeln!(
            text,
            "\nStability changes at {} = {}: {before} deviations grow before, {behind} behind; {kind} crosses.",
            sweep.name,
            sure(change.value, change.width)
        );
    }
    text
}

/// Eigenvalues in the digits that are sure; conjugates are one entry.
pub(crate) fn pairs(eigenvalues: &[Eigenvalue]) -> Vec<String> {
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
pub fn sweep_picture(title: &str, sweep: &Sweep) -> Result<String> {
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
    Ok(Picture::panels(title, Axis::linear(&sweep.name), panels, 1).to_svg()?)
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
