//! The bodies of a scene in motion.

use std::path::PathBuf;

use anyhow::Result;
use deltaq::{Comparison, Ending};
use mechanics::{Body, Place, Pose, Poses};
use picture::{Bodies, MovingPicture, Placement, Solid};

use crate::report::File;
use crate::report::pictures::{drawn, style};
use deltaq::words::short;
use random::substitution;

/// Steps of a motion: a number with many divisors, as pictures take every second, third, … of them.
const STEPS: usize = 240;
/// Points of the path a step.
const FINER: usize = 4;

/// The bodies of `[view]` under the formulations, but not under the control; none for a scene without bodies.
///
/// # Errors
/// Where a motion cannot be read off.
pub fn bodies(comparison: &mut Comparison) -> Result<Option<File>> {
    let scene = comparison.scene.clone();
    let bodies = &scene.view.bodies;
    let Some(followed) = bodies.iter().position(|body| scene.view.is_moved(&scene.system, body)) else {
        return Ok(None);
    };
    let mut poses = scene.view.poses(&scene.system)?;
    let (from, to) = (scene.start.t, scene.start.t + scene.duration);
    let grid = |steps: usize| (0..=steps).map(move |i| from + (to - from) * i as f64 / steps as f64);
    let mut motions = Vec::new();
    for i in drawn(comparison) {
        let run = &mut comparison.runs[i];
        let (style, mut label) = (style(run), run.choice.label.clone());
        let Ok(motion) = &mut run.outcome else { continue };
        if run.choice.formulation == substitution::NAME {
            continue;
        }
        if let Ending::Stopped { t, .. } = motion.ending {
            label += &format!("; stops at {} s", short(t));
        }
        let mut states = Vec::new();
        for t in grid(STEPS * FINER) {
            let t = t.min(motion.end());
            states.push((t, motion.at(t)?.coordinates));
        }
        let path = states.iter().map(|(t, q)| {
            let pose = &poses.at(*t, q)[followed];
            pose.touches.first().copied().unwrap_or(pose.at)
        });
        let path = path.collect();
        let moved = |body: &&Body| scene.view.is_moved(&scene.system, body);
        let solids = sample(&mut poses, bodies, moved, states.into_iter().step_by(FINER));
        motions.push(Bodies { label, style, solids, path });
    }
    let states = grid(STEPS).map(|t| (t, scene.start.q.clone()));
    let ground = sample(&mut poses, bodies, |body| !scene.view.is_moved(&scene.system, body), states);
    let title = format!("{}: bodies in motion", scene.title);
    let svg = MovingPicture { title, time: (from, to, "s".into()), ground, motions }.to_svg();
    Ok(svg.map(|text| File { path: PathBuf::from(format!("scenes/{}-bodies.svg", scene.name)), text }))
}

/// Those of the bodies that are wanted, along `(t, q)`.
fn sample(
    poses: &mut Poses,
    bodies: &[Body],
    wanted: impl Fn(&&Body) -> bool,
    states: impl Iterator<Item = (f64, Vec<f64>)>,
) -> Vec<Solid> {
    let instants: Vec<Vec<Pose>> = states.map(|(t, q)| poses.at(t, &q)).collect();
    let solid = |(i, body): (usize, &Body)| {
        let at = |poses: &Vec<Pose>| Placement { at: poses[i].at, rotation: poses[i].rotation };
        let mut poses: Vec<Placement> = instants.iter().map(at).collect();
        if poses.iter().all(|pose| *pose == poses[0]) {
            poses.truncate(1);
        }
        let lines: Vec<Vec<Place>> = body.shape.lines();
        Solid { lines, sphere: body.shape.sphere(), poses }
    };
    bodies.iter().enumerate().filter(|(_, body)| wanted(body)).map(solid).collect()
}
