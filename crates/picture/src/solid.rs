//! Solids seen from one side.

use super::trace::Place;

/// Three numbers: a place or a direction in space.
pub type Space = [f64; 3];

/// Where the eye is: far away, so that parallels stay parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// What lies to the right in the picture; a unit vector.
    pub right: Space,
    /// What lies upwards in the picture; a unit vector.
    pub up: Space,
    /// From the picture to the eye; a unit vector.
    pub eye: Space,
}

/// How a solid lies: its point `p` is at `at + rotation p`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Where its origin is.
    pub at: Space,
    /// Rows of the matrix.
    pub rotation: [Space; 3],
}

/// A solid by lines in its own axes, which moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// What is drawn of it; where it is a sphere, lines on it.
    pub lines: Vec<Vec<Space>>,
    /// The radius, if it is a sphere about its origin. It hides the lines on its far side.
    pub sphere: Option<f64>,
    /// Where it is at equal steps of time; one where it does not move.
    pub poses: Vec<Placement>,
}

/// What is seen of a solid, to the right and upwards in units of length.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Lines, as many and of as many points at every time, and so are the spheres.
    pub lines: Vec<Vec<Place>>,
    /// Centre and radius of a circle.
    pub circle: Option<(Place, f64)>,
}

/// Points of the seen part of a line on a sphere.
const SEEN_POINTS: usize = 9;

fn dot(a: Space, b: Space) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Camera {
    /// From above: x to the right, y upwards.
    pub const ABOVE: Camera = Camera { right: [1.0, 0.0, 0.0], up: [0.0, 1.0, 0.0], eye: [0.0, 0.0, 1.0] };

    /// From `azimuth` about z and `elevation` above the plane z = 0, both in radians; z is upwards.
    pub fn oblique(azimuth: f64, elevation: f64) -> Camera {
        let ((s, c), (up, level)) = (azimuth.sin_cos(), elevation.sin_cos());
        Camera { right: [-s, c, 0.0], up: [-c * up, -s * up, level], eye: [c * level, s * level, up] }
    }

    /// To the right and upwards in the picture.
    pub fn project(&self, p: Space) -> Place {
        (dot(self.right, p), dot(self.up, p))
    }

    /// Towards the eye.
    fn depth(&self, p: Space) -> f64 {
        dot(self.eye, p)
    }
}

impl Placement {
    /// Where the solid's point `p` is.
    pub fn place(&self, p: Space) -> Space {
        [0, 1, 2].map(|i| self.at[i] + dot(self.rotation[i], p))
    }
}

impl Solid {
    /// The pose at a step; the last one holds on.
    pub fn pose(&self, step: usize) -> &Placement {
        &self.poses[step.min(self.poses.len() - 1)]
    }

    /// What is seen of it at a step.
    pub fn seen(&self, camera: &Camera, step: usize) -> Seen {
        let pose = self.pose(step);
        let line = |line: &Vec<Space>| {
            let line: Vec<Space> = line.iter().map(|&p| pose.place(p)).collect();
            let line = if self.sphere.is_some() { near_side(&line, camera, camera.depth(pose.at)) } else { line };
            line.iter().map(|&p| camera.project(p)).collect()
        };
        let circle = self.sphere.map(|radius| (camera.project(pose.at), radius));
        Seen { lines: self.lines.iter().map(line).collect(), circle }
    }
}

/// The part of a closed line on a sphere that is nearer than its centre, always in as many points.
fn near_side(line: &[Space], camera: &Camera, centre: f64) -> Vec<Space> {
    let steps = line.len() - 1;
    let depth = |i: usize| camera.depth(line[i % steps]) - centre;
    let Some(first) = (0..steps).find(|&i| depth(i) < 0.0 && depth(i + 1) >= 0.0) else {
        let seen = depth(0) >= 0.0;
        // the whole line, or none of it
        return (0..SEEN_POINTS).map(|k| line[if seen { k * steps / (SEEN_POINTS - 1) } else { 0 }]).collect();
    };
    let last = (first + 1..first + steps).find(|&i| depth(i) >= 0.0 && depth(i + 1) < 0.0).unwrap_or(first);
    // where depth is zero, as a number of steps
    let crossing = |i: usize| i as f64 + depth(i) / (depth(i) - depth(i + 1));
    let (from, to) = (crossing(first), crossing(last));
    let at = |k: usize| {
        let place = from + (to - from) * k as f64 / (SEEN_POINTS - 1) as f64;
        let (i, part) = (place.floor() as usize, place.fract());
        [0, 1, 2].map(|axis| line[i % steps][axis] * (1.0 - part) + line[(i + 1) % steps][axis] * part)
    };
    (0..SEEN_POINTS).map(at).collect()
}
