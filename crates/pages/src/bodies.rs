//! The bodies of a scene in motion.

use std::path::PathBuf;

use anyhow::Result;
use comparison::{Comparison, Verdict};
use motion::Ending;
use picture::MovingPicture;
use scene::Scene;
use scene::scenery::Drawn;

use crate::pictures::{drawn, style};
use comparison::words::short;
use program::File;
use review::substitution::SUBSTITUTION;

/// The bodies of `[view]` under the formulations, but not under the control; none for a scene without bodies.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn bodies(comparison: &mut Comparison) -> Result<Option<File>> {
    let mut shown = drawn(comparison);
    shown.retain(|&run| comparison.runs[run].choice.formulation != &SUBSTITUTION);
    let motions_apart = motions(comparison, &shown);
    let mut motions = Vec::new();
    for (i, run) in comparison.runs.iter_mut().enumerate() {
        let (style, mut label) = (style(run), run.choice.label.clone());
        let (true, Ok(motion)) = (shown.contains(&i), &mut run.outcome) else { continue };
        if let Ending::Stopped { t, .. } = motion.ending {
            label += &format!("; stops at {} s", short(t));
        }
        let at = move |t: f64| Ok(motion.at(t.min(motion.end()))?.coordinates);
        motions.push(Drawn::<motion::SolveError> { label, style, at: Box::new(at) });
    }
    let svg = scene::scenery::moving(&comparison.scene, motions)?.and_then(|mut picture| {
        let message = message(&comparison.scene, motions_apart, &picture);
        picture.title = format!("{message}. {}, {} s", comparison.scene.title, short(comparison.scene.duration));
        picture.to_svg()
    });
    let path = PathBuf::from(format!("scenes/{}-bodies.svg", comparison.scene.name));
    Ok(svg.map(|text| File { path, text }))
}

/// How many motions the formulations have from the start of the scene; none where that is not decided.
fn motions(comparison: &Comparison, shown: &[usize]) -> Option<usize> {
    let verdict = |a: usize, b: usize| comparison.pair(a, b).map(|pair| &pair.gap.verdict);
    let pairs =
        |run: usize| shown.iter().take_while(move |&&other| other != run).map(move |&other| verdict(other, run));
    let decided = |v: Option<&Verdict>| matches!(v, Some(Verdict::Same | Verdict::Different));
    let all = shown.len() > 1 && shown.iter().all(|&run| pairs(run).all(decided));
    let different = |run: &&usize| !pairs(**run).any(|v| v == Some(&Verdict::Same));
    all.then(|| shown.iter().filter(different).count())
}

/// So many times as far as the first motion every other one has to fall for that to be said.
const FALLS: f64 = 3.0;

/// What the picture shows: that only the first motion stays up, or how far the body gets from itself.
fn message(scene: &Scene, motions: Option<usize>, picture: &MovingPicture) -> String {
    let moved = scene.view.bodies.iter().find(|body| scene.view.is_moved(&scene.system, body));
    let named = |body: &&mechanics::Body| scene.title.to_lowercase().contains(&body.name.to_lowercase());
    let body = moved.filter(named).map_or("body".to_owned(), |body| body.name.replace('-', " "));
    let count = match motions {
        None => return format!("The {body} under each formulation"),
        Some(1) => return format!("All formulations give the {body} one motion"),
        Some(count) => count,
    };
    let paths: Vec<_> = picture.motions.iter().map(|motion| &motion.path).collect();
    let fall = |path: &&Vec<[f64; 3]>| path.iter().fold(0.0_f64, |most, at| most.max(path[0][2] - at[2]));
    let falls: Vec<f64> = paths.iter().map(fall).collect();
    let (first, others) = falls.split_first().map_or((0.0, &[][..]), |(first, others)| (*first, others));
    if others.iter().all(|other| *other > FALLS * first && *other > 0.0) {
        return format!("Only {}'s {body} stays up", picture.motions[0].label);
    }
    let mut apart = 0.0_f64;
    for (i, one) in paths.iter().enumerate() {
        let places = paths[..i].iter().flat_map(|other| one.iter().zip(other.iter()));
        let distance = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt();
        apart = places.map(distance).filter(|d| d.is_finite()).fold(apart, f64::max);
    }
    let number = ["no", "one", "two", "three", "four", "five"].get(count).map_or(count.to_string(), |&n| n.into());
    match apart {
        0.0 => format!("The {body} has {number} motions from one start"),
        _ => format!("The {body} has {number} motions from one start, up to {} {} apart", short(apart), picture.unit),
    }
}
