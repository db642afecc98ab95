//! Why a name cannot stand where it stands.

/// Why something cannot be a name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum NameFault {
    /// Not a letter followed by letters, digits and underscores.
    #[error("a name is a letter followed by letters, digits and underscores")]
    NotIdentifier,
    /// What a program for tables takes for a formula, or more than a line.
    #[error("a name begins with none of = + - @, which tables take for formulas, and stands in one line")]
    Formula,
    /// With primes.
    #[error("primes are time derivatives and are not part of a name")]
    Primed,
    /// Time, a constant or a function.
    #[error("it is {0}")]
    Reserved(&'static str),
    /// What `--set` calls something else.
    #[error("`--set` means {0} by it")]
    Overriding(&'static str),
    /// Used twice.
    #[error("it is already {by}")]
    Taken { by: String },
}

/// Why a defined name cannot be used at some place.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum Unavailable {
    /// A start value that is not known yet.
    #[error("it has no value yet; known are {known}")]
    NotYetKnown { known: &'static str },
    /// A time derivative written with `dot`.
    #[error("a time derivative is {0}'")]
    Dot(String),
    /// A derivative of something that is not a coordinate.
    #[error("{0} does not change with time")]
    NoDerivative(&'static str),
    /// A derivative of too high an order.
    #[error(
        "derivatives of this order do not enter: a system contains coordinates and velocities, a parametrization the first two rates of its parameters"
    )]
    Acceleration,
    /// The velocity of a removed coordinate, in the parametrization that is to give it.
    #[error(
        "it is the velocity of a removed coordinate, which the parametrization is to give; use parameters and their rates"
    )]
    RemovedVelocity,
    /// A coordinate that is given directly.
    #[error("this coordinate is given directly by the parametrization; use parameters and memory variables")]
    DirectCoordinate,
    /// A velocity in what is drawn.
    #[error("it is a velocity, and what is drawn depends on coordinates, t and parameters only")]
    Velocity,
    /// `ü` in a coordinate.
    #[error("a coordinate given directly may contain parameters and their first rates only")]
    SecondRate,
}

/// What a reviewer would ask about a scene that can be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what variants and fields are")]
pub enum Remark {
    #[error("`{name}` is used by nothing")]
    Unused { name: String },
    #[error("{what} is {value}, below zero")]
    Negative { what: String, value: f64 },
    #[error("no body has the moments {moments:?}: the largest is at most the sum of the other two")]
    Moments { moments: [f64; 3] },
    #[error(
        "the kinetic energy is negative at the start: wᵀ M w = {value:.3e} for a velocity w of length 1 that the constraints admit"
    )]
    KineticEnergy { value: f64 },
    #[error(
        "what g gives to L grows with the height of {bodies}: the weight of a mass m at the height h is -m*g*h in L"
    )]
    Weight { bodies: String },
    #[error(
        "forces that depend on velocities drive whichever way the system moves: their power is {value:.3e} at a velocity and at its opposite"
    )]
    Driving { value: f64 },
    #[error(
        "the contact of `{body}` slips on `{on}` by {slip:.3e} at a velocity that the constraints admit: they contradict the picture"
    )]
    Slips { body: String, on: String, slip: f64 },
}
