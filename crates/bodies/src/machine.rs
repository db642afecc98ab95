//! What is given, and what follows.

use std::collections::HashMap;
use std::ops::Range;

/// A formula and where it stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Written {
    /// It.
    pub text: String,
    /// The bytes of the file that it stands in.
    pub place: Range<usize>,
}

/// All that is given.
#[derive(Clone, Debug, Default)]
pub struct Machine {
    /// The acceleration of free fall, a vector in space.
    pub gravity: Option<Written>,
    /// Bodies by name, in the order of the file.
    pub bodies: Vec<Body>,
    /// Contacts by name.
    pub contacts: Vec<Contact>,
    /// Springs, dampers, motors and loops.
    pub links: Vec<Link>,
    /// Definitions of the scene, by name.
    pub definitions: HashMap<String, String>,
    /// Names of coordinates, and of time.
    pub moving: Vec<String>,
    /// Names that are taken.
    pub taken: Vec<String>,
    /// Names of what is drawn beside bodies.
    pub drawn: Vec<String>,
}

/// A body; a body without mass and moments is a picture, or something to stand on.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// Its name and place.
    pub name: Written,
    /// The word for its shape, and sizes.
    pub shape: Option<(Written, Vec<Written>)>,
    /// `m`.
    pub mass: Option<Written>,
    /// `J`, about the mass centre, along the body's axes.
    pub inertia: Option<Inertia>,
    /// `s`.
    pub centre: Option<Written>,
    /// The body that it is joined to.
    pub on: Option<Written>,
    /// How it moves against that body, or in space.
    pub joint: Joint,
}

/// Moments of inertia.
#[derive(Clone, Debug, PartialEq)]
pub enum Inertia {
    /// Principal moments along x, y and z.
    Diagonal([Written; 3]),
    /// Rows of the matrix.
    Full(Box<[[Written; 3]; 3]>),
}

/// How a body is joined.
#[derive(Clone, Debug, Default)]
pub struct Joint {
    /// Where it is, for messages.
    pub place: Range<usize>,
    /// The point of the joint in the parent.
    pub at: Option<Written>,
    /// The same in the body.
    pub own: Option<Written>,
    /// Axes of the joint, a rotation against the parent.
    pub axes: Option<Written>,
    /// What moves.
    pub motion: Motion,
}

/// What moves at a joint.
#[derive(Clone, Debug, Default)]
pub enum Motion {
    /// Nothing.
    #[default]
    Fixed,
    /// A turn by the angle about the axis.
    Hinge(Written, Written),
    /// A shift along the axis.
    Slider(Written, Written),
    /// x, y and a turn about z.
    Plane([Written; 3]),
    /// A rotation as written.
    Turned(Written),
    /// Parameters of the cone or cylinder that it is on, and its rotation in space.
    Surface(Box<[Written; 2]>, Option<Written>),
}

/// A contact.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Its name and place.
    pub name: Written,
    /// The body.
    pub of: Written,
    /// What it stands on; the ground if left out.
    pub on: Option<Written>,
    /// What does not slip.
    pub law: Law,
    /// The point of the body that touches, where its shape does not say.
    pub at: Option<Written>,
    /// The first direction of its rows; the body's heading if left out.
    pub along: Option<Written>,
}

/// What does not slip at a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// `s = 0`.
    Rolls,
    /// `s` across the heading is zero.
    Blade,
    /// It stays on the surface.
    Slides,
    /// It rolls, and does not turn about the normal.
    Rubber,
}

/// Something between two bodies.
#[derive(Clone, Debug)]
pub struct Link {
    /// Its name and place.
    pub name: Written,
    /// Where: a joint, by the body that it carries, or two points.
    pub between: Between,
    /// What.
    pub kind: LinkKind,
}

/// Where something is.
#[derive(Clone, Debug)]
pub enum Between {
    /// At the joint of that body.
    Joint(Written),
    /// Between points of two bodies; the body `space` is none.
    Points([(Written, Written); 2]),
}

/// What is between two bodies.
#[derive(Clone, Debug)]
pub enum LinkKind {
    /// `V = k (ℓ − rest)²/2`.
    Spring(Written, Option<Written>),
    /// A force `−c ℓ'` along `ℓ`.
    Damper(Written),
    /// A force along `ℓ`.
    Motor(Written),
    /// The points coincide.
    Loop,
}

/// A formula that follows, under a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Made {
    /// The name.
    pub name: String,
    /// The formula.
    pub text: String,
    /// What it follows from.
    pub place: Range<usize>,
}

/// A constraint: on positions if it is without velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The formula.
    pub text: String,
    /// What stays zero with it: the length that it is the rate of, or a polynomial that vanishes where
    /// it does.
    pub height: Option<String>,
    /// What it says.
    pub says: String,
    /// What it follows from.
    pub place: Range<usize>,
}

/// A force `force` along `along`: `Qᵢ = force ∂along/∂qᵢ`.
#[derive(Clone, Debug, PartialEq)]
pub struct Work {
    /// A length or an angle.
    pub along: String,
    /// The force or torque.
    pub force: String,
    /// What it follows from.
    pub place: Range<usize>,
}

/// A body that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its name.
    pub name: String,
    /// The word for its shape.
    pub shape: String,
    /// Its sizes.
    pub size: Vec<String>,
    /// Where its origin is in space.
    pub at: String,
    /// From its axes to those of space; empty for none.
    pub rotation: String,
    /// By name of what it touches, where.
    pub touches: Vec<(String, String)>,
    /// What it follows from.
    pub place: Range<usize>,
}

/// What follows from bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Formulas {
    /// Definitions, each after what it uses.
    pub definitions: Vec<Made>,
    /// Terms of `L`, to be added.
    pub energies: Vec<String>,
    /// Constraints; those that vanish identically are not constraints.
    pub rows: Vec<Row>,
    /// Slips at all contacts along, across and along the normal, or the height that it is the rate of.
    pub slips: Vec<Made>,
    /// Generalized forces.
    pub works: Vec<Work>,
    /// The picture.
    pub pictures: Vec<Picture>,
}
