//! Bodies that are drawn.

use mechanics::{Body, Kind, Pose, Poses, Shape, View};
use scene::Scene;
use serde_json::{Value, json};
use symbolic::{CompileError, Matrix};

/// The bodies of a scene, compiled.
pub(crate) struct Bodies {
    view: View,
    poses: Poses,
    /// Which move with the coordinates.
    moved: Vec<bool>,
}

impl Bodies {
    /// Those that [`shown`] has.
    pub(crate) fn of(scene: &Scene) -> Result<Bodies, CompileError> {
        let view = shown(scene);
        let poses = view.poses(&scene.system)?;
        let moved = view.bodies.iter().map(|body| view.is_moved(&scene.system, body)).collect();
        Ok(Bodies { view, poses, moved })
    }

    /// Lines, and the radius of what is a sphere, in the axes of each body, as a list of objects.
    pub(crate) fn described(&self) -> Value {
        let body = |(body, moved): (&Body, &bool)| {
            json!({ "name": body.name, "kind": body.shape.kind.word(), "lines": body.shape.lines(),
                    "sphere": body.shape.sphere(), "moved": moved })
        };
        self.view.bodies.iter().zip(&self.moved).map(body).collect()
    }

    /// Whether the bodies that do not move with the coordinates do not move with time either.
    pub(crate) fn is_still(&self, scene: &Scene) -> bool {
        let ground = self.view.bodies.iter().zip(&self.moved).filter(|(_, moved)| !**moved);
        let mut expressions = ground.flat_map(|(body, _)| body.expressions());
        expressions.all(|e| !self.view.graph.depends_on(e, scene.system.time))
    }

    /// Appends the place whose path is of interest, and places and rotations of the bodies that move with
    /// the coordinates.
    pub(crate) fn put_moved(&mut self, t: f64, q: &[f64], numbers: &mut Vec<f64>) {
        let poses = self.poses.at(t, q);
        let mut moved = poses.iter().zip(&self.moved).filter(|(_, moved)| **moved).map(|(pose, _)| pose).peekable();
        let place = moved.peek().map_or([0.0; 3], |pose| pose.marked());
        numbers.extend(place);
        moved.for_each(|pose| put(pose, numbers));
    }

    /// Appends places and rotations of the other bodies, which are the same in every motion.
    pub(crate) fn put_ground(&mut self, t: f64, q: &[f64], numbers: &mut Vec<f64>) {
        let poses = self.poses.at(t, q);
        poses.iter().zip(&self.moved).filter(|(_, moved)| !**moved).for_each(|(pose, _)| put(pose, numbers));
    }
}

/// `[view]`; without one a point in the plane of the first two coordinates.
pub(crate) fn shown(scene: &Scene) -> View {
    if scene.view.bodies.is_empty() { point(scene) } else { scene.view.clone() }
}

fn put(pose: &Pose, numbers: &mut Vec<f64>) {
    numbers.extend(pose.at);
    numbers.extend(pose.rotation.as_flattened());
}

fn point(scene: &Scene) -> View {
    let graph = scene.system.graph.clone();
    let place = |i: usize| scene.system.coordinates.get(i).map_or(graph.zero(), |c| graph.variable(c.position));
    let at = [place(0), place(1), graph.zero()];
    let rotation = Matrix::from_fn(3, 3, |i, j| if i == j { graph.one() } else { graph.zero() });
    let shape = Shape { kind: Kind::Point, size: vec![0.0] };
    let bodies = vec![Body { name: "point".into(), shape, at, rotation, touches: Vec::new() }];
    View { graph, bodies }
}
