//! What a scene file may say: the one table behind the reader's messages and the schema for editors.

/// What stands behind a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    /// Text.
    Text,
    /// A number, or an expression in parameters.
    Number,
    /// An expression for a number; a number, too.
    Expression,
    /// An expression for a number, a vector or a matrix; a number, too.
    Quantity,
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

use Content::{Constants, Expression, List, Named, Number, Quantity, Removals, Table, Text, Truth};

/// The whole file.
pub const SCENE: &[Key] = &[
    must("title", Text, "a name for people"),
    may("source", Text, "where the system comes from"),
    may("notes", Text, "what is known of it"),
    may("parameters", Named(&Number), "numbers, or expressions in other parameters, which follow these"),
    must("coordinates", Named(&Table(COORDINATE)), "the coordinates q, in their order"),
    may("definitions", Named(&Quantity), "numbers, vectors and matrices, in any order"),
    may("invariants", Named(&Quantity), "what is to stay constant along every motion, and is watched"),
    may("observables", Named(&Quantity), "what else is printed of a motion"),
    may("film", Named(&Table(FILMED)), "what columns of films show, by name"),
    must("system", Table(SYSTEM), "what moves"),
    may("start", Table(START), "where it starts"),
    may("removal", Removals, "parametrizations written by hand"),
    may("vakonomic", Table(VAKONOMIC), "free constants of the vakonomic motion"),
    must("run", Table(RUN), "how long"),
    may("view", Named(&Table(BODY)), "bodies that are drawn, by name"),
];

/// A coordinate.
pub const COORDINATE: &[Key] = &[
    may("unit", Text, "a label; angles are in radians"),
    must("start", Expression, "q at the start, in parameters, t and the coordinates above"),
];

/// `[film.NAME]`.
pub const FILMED: &[Key] = &[
    must("is", Expression, "the column, in coordinates, velocities, parameters and t"),
    may("sigma", Number, "standard deviation of its errors, above 0, in the unit of the column"),
];

/// `[system]`.
pub const SYSTEM: &[Key] = &[
    must("lagrangian", Expression, "L(q, q', t)"),
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
    may("start", Named(&Expression), "start values of parameters and memory variables that are no coordinates"),
    may("constants", Constants, "P at the start"),
];

/// `constants` of a removal.
pub const CONSTANTS: &[Key] = &[
    may("horizon", Number, "the time at which P = 0"),
    may("start", Named(&Number), "P at the start, by name of the memory variable"),
];
