//! A formulation: a name and a pass from a system to equations.

use std::fmt;

use crate::Equations;
use mechanics::{Removal, RemovalError, State, System};
use symbolic::Symbol;

/// Inputs of a derivation besides the system.
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
#[non_exhaustive]
pub enum DerivationError {
    /// No parametrization was given.
    #[error("{formulation}: a parametrization that removes the constraints is needed")]
    RemovalMissing {
        /// Name of the formulation.
        formulation: &'static str,
    },
    /// A parameter of the formulation is not among those of the system, or is a number of the system itself.
    #[error(
        "{formulation}: a parameter `{parameter}` is needed that stands in none of L, f and Q; give it in the scene, or set \
         it: {parameter}=1"
    )]
    ParameterMissing {
        /// Name of the formulation.
        formulation: &'static str,
        /// Name of the parameter.
        parameter: &'static str,
    },
    /// The system says nothing of its virtual displacements.
    #[error(
        "{formulation}: conditions on virtual displacements are needed, as many as constraints; give `virtual` in `[system]`"
    )]
    VirtualConditionsMissing {
        /// Name of the formulation.
        formulation: &'static str,
    },
    /// There are not as many conditions on virtual displacements as constraints.
    #[error("{formulation}: {found} conditions on virtual displacements for {expected} constraints")]
    VirtualConditions {
        /// Name of the formulation.
        formulation: &'static str,
        /// Conditions found.
        found: usize,
        /// Constraints.
        expected: usize,
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

/// Requirements of a formulation on a system beyond `L`, `f` and `Q`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// Nothing.
    Nothing,
    /// A parametrization that removes the constraints: [`Derivation::removal`].
    Removal,
    /// One at least of these parameters, which are numbers of the law and stand in none of `L`, `f`, `Q`.
    Parameters(&'static [&'static str]),
    /// Conditions on virtual displacements: [`System::virtual_conditions`].
    VirtualConditions,
}

impl Needs {
    /// Whether `system` has it, removals aside, which are made.
    pub fn are_met_by(self, system: &System) -> bool {
        match self {
            Needs::Nothing | Needs::Removal => true,
            Needs::Parameters(names) => names.iter().any(|name| parameter(system, name).is_some()),
            Needs::VirtualConditions => !system.virtual_conditions.is_empty(),
        }
    }

    /// The names of parameters.
    pub fn parameters(self) -> &'static [&'static str] {
        if let Needs::Parameters(names) = self { names } else { &[] }
    }
}

/// The parameter of a law: one of `system` by that name, which stands in none of `L`, `f` and `Q`.
pub fn parameter(system: &System, name: &str) -> Option<Symbol> {
    let g = &system.graph;
    let symbol = system.parameters.iter().map(|p| p.symbol).find(|&symbol| g.name(symbol) == name)?;
    let mut expressions = std::iter::once(&system.lagrangian).chain(&system.constraints).chain(&system.forces);
    (!expressions.any(|&e| g.depends_on(e, symbol))).then_some(symbol)
}

/// One entry of the table of formulations; equal where the names are.
#[derive(Clone, Copy)]
pub struct Formulation {
    /// Name on the command line and in files.
    pub name: &'static str,
    /// Name for the reader.
    pub title: &'static str,
    /// Its requirements beyond `L`, `f` and `Q`. Systems that do not meet them are not compared in this
    /// formulation.
    pub needs: Needs,
    /// Whether its free constants are multipliers `μ₀` at the start, one per constraint.
    pub starts_multipliers: bool,
    /// The derivation.
    pub derive: fn(&System, &Derivation) -> Result<Equations, DerivationError>,
}

impl Formulation {
    /// Whether [`Derivation::removal`] is needed.
    pub fn needs_removal(&self) -> bool {
        self.needs == Needs::Removal
    }
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
