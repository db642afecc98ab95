//! The bodies of a scene along its motions: what [`mechanics::View`] says is drawn, as a [`MovingPicture`].
//!
//! A body is where its pose at `(t, q)` puts it; a motion is whatever gives `q` at `t`. The path is that of
//! the first body that moves, at its first contact or else at its origin.
//!
//! ```
//! # let text = include_str!("../scenes/sledge.toml");
//! let scene = scene::Scene::parse("sledge", text)?;
//! let (start, rate) = (scene.start.q.clone(), scene.start.v[2]);
//! // the sledge turns on the spot
//! let turning = scene::scenery::Drawn {
//!     label: "turning".into(),
//!     style: picture::Style::Chetaev,
//!     at: Box::new(|t| Ok::<_, std::convert::Infallible>(vec![start[0], start[1], start[2] + rate * t])),
//! };
//! let picture = scene::scenery::moving(&scene, vec![turning])?.expect("the sledge has a view");
//! assert!(picture.to_svg().is_some_and(|svg| svg.contains("<animate")));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! It knows no formulation and integrates nothing. It refuses what the caller's motion refuses, and an
//! expression of the view that cannot be evaluated ([`Unseen`]).

use std::fmt;

use crate::Scene;
use mechanics::{Body, Place, Pose, Poses};
use picture::{Bodies, MovingPicture, Placement, Solid, Style};
use symbolic::CompileError;

/// A motion that is drawn.
pub struct Drawn<'a, E> {
    /// Label in the legend.
    pub label: String,
    /// Colour, and how the path is dashed.
    pub style: Style,
    /// Coordinates at a time between start and end of the scene; behind the end of a motion its last ones.
    pub at: Box<dyn FnMut(f64) -> Result<Vec<f64>, E> + 'a>,
}

/// Why there is no picture.
#[derive(Debug)]
pub enum Unseen<E> {
    /// A motion cannot be read off.
    Motion(E),
    /// The view cannot be compiled.
    View(CompileError),
}

impl<E: fmt::Display> fmt::Display for Unseen<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Unseen::Motion(error) => error.fmt(f),
            Unseen::View(error) => error.fmt(f),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> std::error::Error for Unseen<E> {}

/// Steps of a motion: a number with many divisors, as pictures take every second, third, … of them.
pub const STEPS: usize = 240;
/// Points of the path a step.
pub const FINER: usize = 4;

/// The bodies of `[view]` along motions, from the start of the scene to its end, in the unit of time of the
/// scene; none for a scene in which nothing is seen to move.
///
/// # Errors
/// [`Unseen`].
pub fn moving<E>(scene: &Scene, motions: Vec<Drawn<'_, E>>) -> Result<Option<MovingPicture>, Unseen<E>> {
    let bodies = &scene.view.bodies;
    let is_moved = |body: &Body| scene.view.is_moved(&scene.system, body);
    let Some(followed) = bodies.iter().position(is_moved) else { return Ok(None) };
    let mut poses = scene.view.poses(&scene.system).map_err(Unseen::View)?;
    let (from, to) = (scene.start.t, scene.start.t + scene.duration);
    let grid = |steps: usize| (0..=steps).map(move |i| from + (to - from) * i as f64 / steps as f64);
    let mut drawn = Vec::new();
    for Drawn { label, style, mut at } in motions {
        let states = grid(STEPS * FINER).map(|t| Ok((t, at(t)?))).collect::<Result<Vec<_>, E>>();
        let states = states.map_err(Unseen::Motion)?;
        let path = states.iter().map(|(t, q)| poses.at(*t, q)[followed].marked()).collect();
        let solids = sample(&mut poses, bodies, is_moved, states.into_iter().step_by(FINER));
        drawn.push(Bodies { label, style, solids, path });
    }
    let states = grid(STEPS).map(|t| (t, scene.start.q.clone()));
    let ground = sample(&mut poses, bodies, |body| !is_moved(body), states);
    let title = format!("{}: bodies in motion", scene.title);
    let metres = scene.system.coordinates.iter().any(|c| c.unit == "m");
    let (unit, down) = (if metres { "m" } else { "" }.into(), down(&ground));
    Ok(Some(MovingPicture { title, time: (from, to, "s".into()), ground, motions: drawn, unit, down }))
}

/// The steepest descent on the first body of the ground if its plane is inclined, else straight down.
fn down(ground: &[Solid]) -> ([f64; 3], String) {
    let normal = ground.iter().filter_map(|solid| solid.poses.first()).map(|pose| pose.rotation.map(|row| row[2]));
    let descent = normal.map(|n| [n[2] * n[0], n[2] * n[1], n[2] * n[2] - 1.0]).next();
    match descent.filter(|d| d[2] < -1e-6 && d[2] > -0.999) {
        Some(along) => (along, "downhill".into()),
        None => ([0.0, 0.0, -1.0], "down".into()),
    }
}

/// Those of the bodies that are wanted, along `(t, q)`.
fn sample(
    poses: &mut Poses,
    bodies: &[Body],
    wanted: impl Fn(&Body) -> bool,
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
