//! What a scene file may say: the one table behind the reader's messages and the schema for editors.

/// The format of scenes that is described here; a scene of a newer one is refused, older ones are read.
pub const FORMAT: u64 = 1;

/// What stands behind a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// The number of a format, from 1 to [`FORMAT`].
    Format,
    /// Text.
    Text,
    /// A number, or an expression in parameters.
    Number,
    /// An expression for a number; a number as well.
    Expression,
    /// An expression for a number, a vector or a matrix; a number as well.
    Quantity,
    /// A list of two or three numbers or expressions, or an expression for a vector.
    Vector,
    /// A list of numbers or expressions, or of such lists.
    Moments,
    /// True or false.
    Truth,
    /// A list.
    List(&'static Content),
    /// A table with these keys.
    Table(&'static [Key]),
    /// A table with names of the user's own.
    Named(&'static Content),
    /// `"zero"`, `{ horizon = 10 }` or `{ start = { x = 0.3 } }`.
    Constants,
    /// A removal, or removals by name.
    Removals,
}

/// A key of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// It.
    pub name: &'static str,
    /// What stands behind it.
    pub content: Content,
    /// Whether it has to be there.
    pub required: bool,
    /// What it means.
    pub about: &'static str,
}

const fn must(name: &'static str, content: Content, about: &'static str) -> Key {
    Key { name, content, required: true, about }
}

const fn may(name: &'static str, content: Content, about: &'static str) -> Key {
    Key { name, content, required: false, about }
}

use Content::{
    Constants, Expression, Format, List, Moments, Named, Number, Quantity, Removals, Table, Text, Truth, Vector,
};

/// The whole file.
pub const SCENE: &[Key] = &[
    may("format", Format, "of scene files; 1 if left out"),
    must("title", Text, "a name for people"),
    may("source", Text, "where the system comes from"),
    may("notes", Text, "what is known of it"),
    may("parameters", Named(&Number), "numbers, or expressions in other parameters, which follow these"),
    must("coordinates", Named(&Table(COORDINATE)), "the coordinates q, in their order"),
    may("definitions", Named(&Quantity), "numbers, vectors and matrices, in any order"),
    may("invariants", Named(&Quantity), "what is to stay constant along every motion, and is watched"),
    may("observables", Named(&Quantity), "what else is printed of a motion"),
    may("film", Named(&Table(FILMED)), "what columns of films show, by name"),
    may("system", Table(SYSTEM), "what moves, beside bodies"),
    may("gravity", Vector, "the acceleration of free fall, a vector in space; none if left out"),
    may("body", Named(&Table(MACHINE)), "bodies that move, by name: L, constraints and picture follow from them"),
    may("contact", Named(&Table(CONTACT)), "where bodies touch what they stand on, by name"),
    may("spring", Named(&Table(SPRING)), "springs, by name"),
    may("damper", Named(&Table(DAMPER)), "dampers, by name"),
    may("motor", Named(&Table(MOTOR)), "motors, by name"),
    may("loop", Named(&Table(LOOP)), "points of two bodies that coincide, by name"),
    may("start", Table(START), "where it starts"),
    may("removal", Removals, "parametrizations written by hand"),
    may("vakonomic", Table(VAKONOMIC), "free constants of the vakonomic motion"),
    must("run", Table(RUN), "how long"),
    may("view", Named(&Table(BODY)), "bodies that are drawn, by name"),
];

/// A coordinate.
pub const COORDINATE: &[Key] = &[
    may("unit", Text, "a label; angles are in radians"),
    may(
        "start",
        Expression,
        "q at the start, in parameters, t and the coordinates above; without it constraints supply it",
    ),
    may("guess", Number, "a number near q at the start, where constraints on positions leave a choice"),
];

/// `[film.NAME]`.
pub const FILMED: &[Key] = &[
    must("is", Expression, "the column, in coordinates, velocities, parameters and t"),
    may("sigma", Number, "standard deviation of its errors, above 0, in the unit of the column"),
];

/// `[system]`.
pub const SYSTEM: &[Key] = &[
    may("lagrangian", Expression, "L(q, q', t); what bodies give is added, and without bodies it has to be there"),
    may(
        "constraints",
        List(&Quantity),
        "f(q, q', t), zero along every motion; a vector is one per component; one without velocities is kept by its rate",
    ),
    may("forces", Named(&Expression), "Q along a coordinate; it acts by virtual work in every formulation"),
    may(
        "virtual",
        List(&Quantity),
        "what rates of virtual displacements satisfy where reactions are not those of Chetaev, one per constraint; for prescribed",
    ),
];

/// The words for what a body looks like.
pub const SHAPES: &str =
    "one of point, rod, blade, box, cart, disc, ball, ellipsoid, cylinder, cone, bowl, plane, table";

/// `[view.NAME]`.
pub const BODY: &[Key] = &[
    must("shape", Text, SHAPES),
    must("size", List(&Number), "its sizes, in the unit of length"),
    may("at", Quantity, "where its origin is, along the axes of space; 0 if left out"),
    may("rotation", Quantity, "from its axes to those of space, a matrix or an angle about z; none if left out"),
    may("touches", Named(&Quantity), "by name of another body, where it touches it"),
];

/// The words for how a contact holds.
pub const LAWS: &str = "one of rolls, blade, slides, rubber";

/// `[body.NAME]`.
pub const MACHINE: &[Key] = &[
    may("shape", Text, "point, rod, blade, box, cart, disc, wheel, ball, …: as in [view], a wheel about y"),
    may("size", List(&Expression), "its sizes, as in [view]; of a wheel the radius, then that of its tyre"),
    may("mass", Expression, "m; without it, the body has no weight and no kinetic energy of translation"),
    may(
        "inertia",
        Moments,
        "about the mass centre, along the body's axes: [A, B, C] or three rows; of shape and mass if left out",
    ),
    may("mass-centre", Vector, "from the body's origin, along its axes; the origin if left out, the middle of a rod"),
    may("at", Vector, "where its origin is, in space or, with `on`, along the axes of that body"),
    may("rotation", Text, "from its axes to those of space or, with `on`, of that body"),
    may("on", Text, "the body that it is joined to"),
    may("joint", Table(JOINT), "how it moves against that body, or in space"),
];

/// `joint` of a body.
pub const JOINT: &[Key] = &[
    may("hinge", Vector, "the axis that it turns about by `angle`"),
    may("angle", Expression, "the angle of the hinge"),
    may("slider", Vector, "the axis that it is shifted along by `shift`"),
    may("shift", Expression, "the shift of the slider"),
    may("plane", List(&Expression), "[x, y, angle]: a shift in the plane of x and y, and a turn about z"),
    may("ball", Text, "any rotation, as in \"rotation(zxz, psi, theta, phi)\""),
    may(
        "surface",
        List(&Expression),
        "[r, angle] on the cone that it is on, from the apex, or [x, angle] in a cylinder, from its lowest line",
    ),
    may("rotation", Text, "of a ball on a surface: from its axes to those of space"),
    may("fixed", Truth, "true: nothing moves"),
    may("at", Vector, "the point of the joint in the parent"),
    may("own", Vector, "the same point in this body; the two coincide"),
    may("axes", Text, "the rotation from the axes of the joint to those of the parent"),
];

/// `[contact.NAME]`.
pub const CONTACT: &[Key] = &[
    must("of", Text, "the body"),
    may(
        "on",
        Text,
        "what it stands on: the ground z = 0 if left out, a plane that carries the body, a table that turns, a cone, cylinder or bowl",
    ),
    must("law", Text, LAWS),
    may("at", Vector, "the point of the body that touches, where its shape does not say; the origin if left out"),
    may("along", Vector, "the direction of the first constraint; the wheel's heading if left out, x of a ball"),
];

/// `[spring.NAME]`.
pub const SPRING: &[Key] = &[
    may("joint", Text, "the body whose joint it is at"),
    may("between", Named(&Vector), "two bodies, or one and `space`, with a point of each"),
    must("stiffness", Expression, "k in V = k (l - rest)²/2"),
    may("rest", Expression, "angle, shift or length without force; 0 if left out"),
];

/// `[damper.NAME]`.
pub const DAMPER: &[Key] = &[
    may("joint", Text, "the body whose joint it is at"),
    may("between", Named(&Vector), "two bodies, or one and `space`, with a point of each"),
    must("damping", Expression, "c in the force -c l'"),
];

/// `[motor.NAME]`.
pub const MOTOR: &[Key] = &[
    may("joint", Text, "the body whose joint it is at"),
    may("between", Named(&Vector), "two bodies, or one and `space`, with a point of each"),
    must("force", Expression, "the force or torque that lengthens; it acts on both bodies by virtual work"),
];

/// `[loop.NAME]`.
pub const LOOP: &[Key] =
    &[must("between", Named(&Vector), "two bodies, or one and `space`, with the points that coincide")];

/// `[start]`.
pub const START: &[Key] = &[
    may("time", Number, "t at the start, 0 if left out"),
    may("project", Truth, "whether velocities that miss the constraint are moved onto it"),
    may("velocities", Named(&Expression), "velocities at the start; constraints and equations supply the others"),
    may(
        "equations",
        List(&Quantity),
        "what else velocities at the start satisfy, as in dot(W, n) = 5; a vector is one per component",
    ),
    may("guess", Named(&Expression), "velocities near those of the start, where there is a choice"),
];

/// `[vakonomic]`.
pub const VAKONOMIC: &[Key] =
    &[may("multipliers", List(&Number), "μ at the start, one per constraint; zero if left out")];

/// `[run]`.
pub const RUN: &[Key] = &[
    must("duration", Number, "in units of t"),
    may("breakpoints", List(&Number), "times at which a step ends, where something is switched"),
];

/// A removal.
pub const REMOVAL: &[Key] = &[
    must("parameters", List(&Text), "names of u: new ones, or coordinates that stay"),
    may("rates", Named(&Expression), "the rate of a coordinate that becomes memory"),
    may("direct", Named(&Expression), "a coordinate in u, w and t"),
    may("memory", Named(&Expression), "rates of further memory variables"),
    may("start", Named(&Expression), "start values of parameters and memory variables that are not coordinates"),
    may("constants", Constants, "P at the start"),
];

/// `constants` of a removal.
pub const CONSTANTS: &[Key] = &[
    may("horizon", Number, "the time at which P = 0"),
    may("start", Named(&Number), "P at the start, by name of the memory variable"),
];
