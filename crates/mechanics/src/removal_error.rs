//! Errors of removals, and of constraints that are to be removed.

/// A parametrization that does not remove the constraints.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum RemovalError {
    /// The number of parameters is not `n − h`.
    #[error("removal `{removal}` has {found} parameters; n − h = {expected} are needed")]
    WrongCount { removal: String, found: usize, expected: usize },
    /// A constraint does not vanish identically.
    #[error(
        "removal `{removal}` does not satisfy constraint {constraint} ({text}): residual {residual:.3e} where round-off allows {limit:.1e}"
    )]
    ConstraintRemains {
        removal: String,
        /// Number of the constraint, from 1.
        constraint: usize,
        text: String,
        /// Residual at a random point.
        residual: f64,
        limit: f64,
    },
    /// Automatic removal needs constraints linear in the velocities.
    #[error(
        "constraint {constraint} ({text}) is not linear in the velocities; it can only be removed by a parametrization written by hand"
    )]
    NotLinear {
        /// Number of the constraint, from 1.
        constraint: usize,
        text: String,
    },
    /// The constraint Jacobian has no full row rank at the start.
    #[error("the constraints are dependent at the start: largest remaining pivot {pivot:.1e}, limit {limit:.0e}")]
    Dependent {
        /// Largest pivot that was left, rows scaled to 1.
        pivot: f64,
        limit: f64,
    },
    /// Solving the constraints for velocities takes longer than a question may.
    #[error("the constraints are not solved for velocities: {0}")]
    Stopped(#[from] symbolic::Stopped),
    /// A constraint with the parametrization put in has a finite value at too few of the points tried.
    #[error(
        "removal `{removal}`: constraint {constraint} ({text}) is finite at too few of the points tried, so it cannot be checked"
    )]
    NotCheckable {
        removal: String,
        /// Number of the constraint, from 1.
        constraint: usize,
        text: String,
    },
}
