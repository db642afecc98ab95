//! What a formulation is to the rest of the program: a name and a pass from a system to equations.

use std::fmt;

use crate::Equations;
use mechanics::{Removal, RemovalError, State, System};

/// What a derivation may depend on besides the system.
#[derive(Clone, Copy, Debug, Default)]
pub struct Derivation<'a> {
    /// The parametrization that removes the constraints, for formulations that need one.
    pub removal: Option<&'a Removal>,
    /// The start of the motion, for forms that choose pivots by their size there.
    pub start: Option<&'a State>,
    /// Whether to keep costates that never move, with free constants. "zero" and "natural" make them zero.
    pub all_costates: bool,
}

/// A system for which a formulation has no equations.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DerivationError {
    /// No parametrization was given.
    #[error("{formulation}: a parametrization that removes the constraints is needed")]
    RemovalMissing {
        /// Name of the formulation.
        formulation: &'static str,
    },
    /// A parameter of the formulation is not among those of the system.
    #[error("{formulation}: a parameter `{parameter}` is needed; give it in the scene, or set it: {parameter}=1")]
    ParameterMissing {
        /// Name of the formulation.
        formulation: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
    },
    /// The constraints cannot be solved for the velocities.
    #[error("{formulation}: {error}")]
    Reduction {
        /// Name of the formulation.
        formulation: &'static str,
        /// Why not.
        error: RemovalError,
    },
    /// `∂²G/∂ü²` is singular although `L`, or the work of the forces, contains `ü`.
    #[error(
        "{formulation}, removal `{removal}`: L or the virtual work of forces contains second rates {second_rates}, and the \
         Hessian of G with respect to the highest rates has rank {rank} of {size}; choose parameters in which L is of \
         first order"
    )]
    SingularHighestHessian {
        /// Name of the formulation.
        formulation: &'static str,
        /// Name of the removal.
        removal: String,
        /// The second rates that `L` or the work of the forces contains.
        second_rates: String,
        /// Rank found.
        rank: usize,
        /// Rank needed.
        size: usize,
    },
}

/// One entry of the table of formulations; equal where the names are.
#[derive(Clone, Copy)]
pub struct Formulation {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Name for the reader.
    pub title: &'static str,
    /// Whether [`Derivation::removal`] is needed.
    pub needs_removal: bool,
    /// Whether its free constants are multipliers `μ₀` at the start, one per constraint.
    pub starts_multipliers: bool,
    /// The parameter needed beyond `L`, `f` and `Q`. Systems without it are not compared in this formulation.
    pub parameter: Option<&'static str>,
    /// The derivation.
    pub derive: fn(&System, &Derivation) -> Result<Equations, DerivationError>,
}

impl PartialEq for Formulation {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Formulation {}

impl fmt::Debug for Formulation {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}
