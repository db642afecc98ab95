//! Shapes of bodies, as lines in the body's own axes.

use std::f64::consts::TAU;

/// The shape of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A small sphere without a mark.
    Point,
    /// From the origin along x.
    Rod,
    /// Along x, sharp in front.
    Blade,
    /// About the origin.
    Box,
    /// Two wheels on an axle along y through the origin, a bar forward to the hitch.
    Cart,
    /// A wheel about y, with a spoke.
    Disc,
    /// About the origin, with two great circles.
    Ball,
    /// About the origin, its axes along x, y and z.
    Ellipsoid,
    /// About x, its middle at the origin.
    Cylinder,
    /// Opens along z, its apex at the origin.
    Cone,
    /// z = (a x² + b y²)/2.
    Bowl,
    /// A rectangle in z = 0.
    Plane,
    /// A circle in z = 0.
    Table,
}

impl Kind {
    /// All, each with its word in scenes and its sizes.
    pub const ALL: &[(Kind, &str, &[&str])] = &[
        (Kind::Point, "point", &["radius"]),
        (Kind::Rod, "rod", &["length"]),
        (Kind::Blade, "blade", &["length", "width"]),
        (Kind::Box, "box", &["length", "width", "height"]),
        (Kind::Cart, "cart", &["length", "width", "bar"]),
        (Kind::Disc, "disc", &["radius"]),
        (Kind::Ball, "ball", &["radius"]),
        (Kind::Ellipsoid, "ellipsoid", &["half axis x", "half axis y", "half axis z"]),
        (Kind::Cylinder, "cylinder", &["radius", "length"]),
        (Kind::Cone, "cone", &["half-angle", "length"]),
        (Kind::Bowl, "bowl", &["curvature along x", "curvature along y", "radius"]),
        (Kind::Plane, "plane", &["length", "width"]),
        (Kind::Table, "table", &["radius"]),
    ];

    /// Its word in scenes.
    pub fn word(self) -> &'static str {
        Kind::ALL.iter().find(|(kind, ..)| *kind == self).map_or("", |(_, word, _)| word)
    }
}

/// A shape of some size.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// What it looks like.
    pub kind: Kind,
    /// Its sizes, positive, as many as [`Kind::ALL`] says, in the unit of length; angles in radians.
    pub size: Vec<f64>,
}

/// A place in the axes of a body or of space.
pub type Place = [f64; 3];

/// Steps round a circle that moves, and round one that is large.
const ROUND: usize = 20;
const LARGE: usize = 48;

impl Shape {
    /// The radius, if it is a sphere: its outline is a circle from every side, and hides half of its lines.
    pub fn sphere(&self) -> Option<f64> {
        matches!(self.kind, Kind::Point | Kind::Ball).then_some(self.size[0])
    }

    /// The lines that are drawn. Where a sphere is, they lie on it.
    ///
    /// ```
    /// use mechanics::{Kind, Shape};
    /// let rod = Shape { kind: Kind::Rod, size: vec![2.0] };
    /// assert_eq!(rod.lines(), [[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]]);
    /// ```
    ///
    /// # Panics
    /// With fewer sizes than [`Kind::ALL`] says.
    pub fn lines(&self) -> Vec<Vec<Place>> {
        let s = &self.size;
        match self.kind {
            Kind::Point => Vec::new(),
            Kind::Rod => vec![vec![[0.0; 3], [s[0], 0.0, 0.0]]],
            Kind::Blade => blade(s[0] / 2.0, s[1] / 2.0),
            Kind::Box => cuboid([s[0] / 2.0, s[1] / 2.0, s[2] / 2.0]),
            Kind::Cart => cart(s[0], s[1] / 2.0, s[2]),
            Kind::Disc => {
                let rim = circle(ROUND, |c, d| [s[0] * d, 0.0, s[0] * c]);
                vec![rim, vec![[0.0; 3], [0.0, 0.0, s[0]]]]
            }
            Kind::Ball => {
                vec![circle(LARGE, |c, d| [s[0] * c, s[0] * d, 0.0]), circle(LARGE, |c, d| [s[0] * c, 0.0, s[0] * d])]
            }
            Kind::Ellipsoid => ellipsoid([s[0], s[1], s[2]]),
            Kind::Cylinder => cylinder(s[0], s[1] / 2.0),
            Kind::Cone => cone(s[0], s[1]),
            Kind::Bowl => bowl(s[0], s[1], s[2]),
            Kind::Plane => plane(s[0] / 2.0, s[1] / 2.0),
            Kind::Table => {
                let across = |angle: f64| {
                    let (y, x) = angle.sin_cos();
                    vec![[-s[0] * x, -s[0] * y, 0.0], [s[0] * x, s[0] * y, 0.0]]
                };
                let rim = circle(2 * ROUND, |c, d| [s[0] * c, s[0] * d, 0.0]);
                vec![rim, across(0.0), across(TAU / 6.0), across(TAU / 3.0)]
            }
        }
    }
}

/// A closed line through the places of cosine and sine.
fn circle(steps: usize, place: impl Fn(f64, f64) -> Place) -> Vec<Place> {
    (0..=steps).map(|i| (i % steps) as f64 * TAU / steps as f64).map(|angle| place(angle.cos(), angle.sin())).collect()
}

fn blade(l: f64, w: f64) -> Vec<Vec<Place>> {
    let flat = |(x, y): (f64, f64)| [x, y, 0.0];
    let hull = [(-l, -w), (l / 2.0, -w), (l, 0.0), (l / 2.0, w), (-l, w), (-l, -w)];
    vec![hull.map(flat).to_vec(), vec![flat((-l, 0.0)), flat((l, 0.0))]]
}

fn cuboid([l, w, h]: Place) -> Vec<Vec<Place>> {
    let corners = [(-l, -w), (l, -w), (l, w), (-l, w), (-l, -w)];
    let face = |z: f64| corners.map(|(x, y)| [x, y, z]).to_vec();
    let upright = |&(x, y): &(f64, f64)| vec![[x, y, -h], [x, y, h]];
    [face(-h), face(h)].into_iter().chain(corners[..4].iter().map(upright)).collect()
}

fn cart(length: f64, w: f64, bar: f64) -> Vec<Vec<Place>> {
    let (l, half) = (length / 2.0, 0.6 * w);
    let flat = |(x, y): (f64, f64)| [x, y, 0.0];
    let body = [(-l, -half), (l, -half), (l, half), (-l, half), (-l, -half)].map(flat);
    let wheel = |y: f64| vec![flat((-l / 2.0, y)), flat((l / 2.0, y))];
    vec![body.to_vec(), vec![flat((0.0, -w)), flat((0.0, w))], wheel(-w), wheel(w), vec![[0.0; 3], flat((bar, 0.0))]]
}

/// The ellipses in the three planes of symmetry, and two across x halfway to the ends.
fn ellipsoid([a, b, c]: Place) -> Vec<Vec<Place>> {
    let half = 0.75_f64.sqrt();
    let across = |x: f64, part: f64| circle(ROUND, move |cos, sin| [x * a, part * b * sin, part * c * cos]);
    vec![
        circle(LARGE, |cos, sin| [a * cos, b * sin, 0.0]),
        circle(LARGE, |cos, sin| [a * cos, 0.0, c * sin]),
        across(0.0, 1.0),
        across(0.5, half),
        across(-0.5, half),
    ]
}

fn cylinder(r: f64, l: f64) -> Vec<Vec<Place>> {
    let end = |x: f64| circle(ROUND * 4 / 5, |c, d| [x, r * d, r * c]);
    let along = |(y, z): (f64, f64)| vec![[-l, y, z], [l, y, z]];
    let sides = [(0.0, r), (r, 0.0), (0.0, -r), (-r, 0.0)].map(along);
    let spoke = vec![[l, 0.0, 0.0], [l, 0.0, r]];
    [end(-l), end(l), spoke].into_iter().chain(sides).collect()
}

fn cone(angle: f64, length: f64) -> Vec<Vec<Place>> {
    let (sin, cos) = angle.sin_cos();
    let at = |s: f64, (c, d): (f64, f64)| [s * sin * c, s * sin * d, s * cos];
    let level = |s: f64| circle(LARGE, |c, d| at(s, (c, d)));
    let side = |i: u32| {
        let (d, c) = (f64::from(i) * TAU / 12.0).sin_cos();
        vec![[0.0; 3], at(length, (c, d))]
    };
    [level(length), level(length / 2.0)].into_iter().chain((0..12).map(side)).collect()
}

fn bowl(a: f64, b: f64, radius: f64) -> Vec<Vec<Place>> {
    let on = |x: f64, y: f64| [x, y, (a * x * x + b * y * y) / 2.0];
    let level = |part: f64| circle(LARGE, |c, d| on(part * radius * c, part * radius * d));
    let across = |i: u32| {
        let (d, c) = (f64::from(i) * TAU / 8.0).sin_cos();
        (-12..=12).map(|k| f64::from(k) / 12.0 * radius).map(|s| on(s * c, s * d)).collect()
    };
    [level(1.0), level(0.5)].into_iter().chain((0..4).map(across)).collect()
}

fn plane(l: f64, w: f64) -> Vec<Vec<Place>> {
    let flat = |(x, y): (f64, f64)| [x, y, 0.0];
    let edge = [(-l, -w), (l, -w), (l, w), (-l, w), (-l, -w)].map(flat).to_vec();
    vec![edge, vec![flat((-l, 0.0)), flat((l, 0.0))], vec![flat((0.0, -w)), flat((0.0, w))]]
}
