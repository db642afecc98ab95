//! Why a question stays open.

use decision::exact::Flaw;
use symbolic::{Stopped, question};

/// Most coefficients at once: 400 MB.
const ROOM: usize = 50_000_000;

/// What keeps an answer from being given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum Open {
    /// A number has no image in the finite field.
    #[error("{0}")]
    Flaw(#[from] Flaw),
    /// Forces act that are not a gradient of a potential as far as is known.
    #[error("generalized forces act; only a potential in L is taken")]
    Forces,
    /// The scene has reactions of its own.
    #[error("the scene has reactions of its own")]
    OwnReactions,
    /// Time stands in `L` or in the constraints.
    #[error("time stands in L or in the constraints")]
    Time,
    /// `L` is not `½ vᵀM(q)v − V(q)`.
    #[error("L is not quadratic in the velocities with a potential beside it")]
    NotQuadratic,
    /// The constraints are not `A(q)v = 0`.
    #[error("the constraints are not linear and homogeneous in the velocities")]
    NotHomogeneous,
    /// The constraints are dependent at some points and not at others.
    #[error("the constraints are dependent at a random point, and not near it")]
    Rank,
    /// The kinetic energy is degenerate on the constraints.
    #[error("the kinetic energy is degenerate on the constraints")]
    Singular,
    /// Series would have too many coefficients.
    #[error("series to order {order} have more than {most} coefficients")]
    Size { order: usize, most: usize },
    /// The ansatz would be too large.
    #[error(
        "an ansatz would have {found} monomials in the velocities, and at most {most} are taken: a lower --degree has fewer"
    )]
    Functions { found: usize, most: usize },
    /// The memory would not do.
    #[error(
        "{found} numbers would be needed at once, and at most {most} are taken: fewer coordinates, or a lower --degree, need less"
    )]
    Room { found: usize, most: usize },
    /// There are many ways to solve the constraints.
    #[error("the constraints can be solved for {found} sets of velocities; at most {most} are tried")]
    Choices {
        /// Sets of as many coordinates as there are constraints.
        found: usize,
        most: usize,
    },
    /// Brackets of the constraints' kernel do not span all directions.
    #[error("the constraints are integrable in part: brackets span {rank} of {dimension} directions")]
    Integrable { rank: usize, dimension: usize },
    /// A name that is not a coordinate.
    #[error("`{name}` is not a coordinate: there are {all}")]
    Name { name: String, all: String },
    /// Two fields disagree, or random numbers are dependent.
    #[error("random points of two fields do not agree")]
    Accident,
    /// A step would have too many unknowns.
    #[error("the equations of order {order} have more than {most} unknowns")]
    Columns { order: usize, most: usize },
    /// Coefficients are free at the last weight: what is left bounds nothing.
    #[error("{free} coefficients are still free at order {order}, the highest one tried: no bound follows")]
    Free { order: usize, free: usize },
    /// It takes longer than a question may.
    #[error("{0}; fewer coordinates in L and f, or a lower --degree, need less")]
    Stopped(#[from] Stopped),
    /// Two methods do not agree: a fault of the program.
    #[error("a contradiction, please report it: {0}")]
    Contradiction(String),
    /// Something else, in words.
    #[error("{0}")]
    Other(String),
}

impl Open {
    /// Why two fields agree on nothing.
    pub(crate) fn or_accident(fault: Option<Open>) -> Open {
        fault.unwrap_or(Open::Accident)
    }

    /// There is room for so many coefficients at once.
    pub(crate) fn room(found: usize) -> Result<(), Open> {
        if found > ROOM { Err(Open::Room { found, most: ROOM }) } else { Ok(()) }
    }

    /// The answer of `work`, if there is time for it.
    pub(crate) fn unless<T>(work: impl FnOnce() -> Result<T, Open>) -> Result<T, Open> {
        question(work)?
    }
}
