//! The bodies of a scene in motion.

use std::path::PathBuf;

use anyhow::Result;
use deltaq::{Comparison, Ending};
use scenery::Drawn;

use crate::pictures::{drawn, style};
use deltaq::words::short;
use program::File;
use substitution::SUBSTITUTION;

/// The bodies of `[view]` under the formulations, but not under the control; none for a scene without bodies.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn bodies(comparison: &mut Comparison) -> Result<Option<File>> {
    let shown = drawn(comparison);
    let mut motions = Vec::new();
    for (i, run) in comparison.runs.iter_mut().enumerate() {
        let (style, mut label) = (style(run), run.choice.label.clone());
        let is_shown = shown.contains(&i) && run.choice.formulation != &SUBSTITUTION;
        let (true, Ok(motion)) = (is_shown, &mut run.outcome) else { continue };
        if let Ending::Stopped { t, .. } = motion.ending {
            label += &format!("; stops at {} s", short(t));
        }
        let at = move |t: f64| Ok(motion.at(t.min(motion.end()))?.coordinates);
        motions.push(Drawn::<deltaq::SolveError> { label, style, at: Box::new(at) });
    }
    let svg = scenery::moving(&comparison.scene, motions)?.and_then(|picture| picture.to_svg());
    let path = PathBuf::from(format!("scenes/{}-bodies.svg", comparison.scene.name));
    Ok(svg.map(|text| File { path, text }))
}
