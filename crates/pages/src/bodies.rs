//! The bodies of a scene in motion.

use std::path::PathBuf;

use anyhow::Result;
use comparison::{Comparison, Verdict};
use motion::Ending;
use scenery::Drawn;

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
    let message = message(comparison, &shown);
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
    let svg = scenery::moving(&comparison.scene, motions)?.and_then(|mut picture| {
        picture.title = format!("{}: {message}", comparison.scene.title);
        picture.to_svg()
    });
    let path = PathBuf::from(format!("scenes/{}-bodies.svg", comparison.scene.name));
    Ok(svg.map(|text| File { path, text }))
}

/// What the picture shows: how many motions the formulations have from the start of the scene.
fn message(comparison: &Comparison, shown: &[usize]) -> String {
    let verdict = |a: usize, b: usize| comparison.pair(a, b).map(|pair| &pair.gap.verdict);
    let pairs =
        |run: usize| shown.iter().take_while(move |&&other| other != run).map(move |&other| verdict(other, run));
    let decided = |v: Option<&Verdict>| matches!(v, Some(Verdict::Same | Verdict::Different));
    if shown.len() < 2 || !shown.iter().all(|&run| pairs(run).all(decided)) {
        return "bodies in motion".into();
    }
    let motions = shown.iter().filter(|&&run| !pairs(run).any(|v| v == Some(&Verdict::Same))).count();
    let plural = if motions == 1 { "" } else { "s" };
    format!("{} formulations, {motions} motion{plural} from one start", shown.len())
}
