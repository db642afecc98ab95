//! Why there is no start.

use symbolic::CompileError;
use symbolic::limits::SHOWN;

use crate::newton::NewtonError;
use crate::{State, System};

/// Something that is evaluated at the start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// `L`.
    Lagrangian,
    /// `f` with this number, from 1.
    Constraint(usize),
    /// `Q` of the coordinate with this name.
    Force(String),
    /// `A = ∂f/∂v`.
    ConstraintJacobian,
    /// `M = ∂²L/∂v²`.
    MassMatrix,
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Quantity::Lagrangian => write!(f, "the Lagrangian"),
            Quantity::Constraint(number) => write!(f, "constraint {number}"),
            Quantity::Force(name) => write!(f, "the force along `{name}`"),
            Quantity::ConstraintJacobian => write!(f, "the constraint Jacobian"),
            Quantity::MassMatrix => write!(f, "the mass matrix"),
        }
    }
}

/// Why there is no start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum StartError {
    /// The given velocities, constraints and start equations leave some velocities open.
    #[error("too few start velocities: {} not determined by the given ones and the constraints{}; give more under [start.velocities], as in {}", listed(.velocities), idle_equations(.idle), lines(.velocities))]
    Undetermined {
        velocities: Vec<String>,
        /// Numbers of start equations, from 1, that hold whenever all other conditions do.
        idle: Vec<usize>,
    },
    /// A start equation cannot hold beside constraints, given velocities and the equations before it.
    #[error(
        "start equation {equation} contradicts the given velocities, the constraints and the equations before it: its left side less its right side is {value:.4e} there, relative residual {residual:.3e}, limit {limit:.0e}; leave it out, or give fewer [start.velocities]"
    )]
    ContradictoryEquation {
        /// Its number, from 1.
        equation: usize,
        /// Its left side less its right side where all before it holds; at best, where it is not linear.
        value: f64,
        /// The same relative to the size of its terms.
        residual: f64,
        limit: f64,
    },
    /// No velocities satisfy the constraints together with the given ones.
    #[error(
        "start velocities contradict constraint {constraint}: relative residual {residual:.3e}, limit {limit:.0e}; give fewer, or set project = true"
    )]
    Contradictory {
        /// Number of the constraint with the largest residual, from 1.
        constraint: usize,
        /// Its residual at the least-squares point, relative to the size of its terms.
        residual: f64,
        limit: f64,
    },
    /// A constraint that is not linear has no real solution in the velocities that are left.
    #[error("no real {} satisfies constraint {constraint} with the given velocities: relative residual {residual:.3e} at best, limit {limit:.0e}", listed(.velocities))]
    NoRealSolution {
        velocities: Vec<String>,
        /// Number of the constraint with the largest residual, from 1.
        constraint: usize,
        /// Its residual at the least-squares point, relative to the size of its terms.
        residual: f64,
        limit: f64,
    },
    /// Start equations for velocities that are to be projected.
    #[error("project = true moves velocities, and start equations would no longer hold: leave out one of the two")]
    ProjectedEquations,
    /// Constraints or start equations nonlinear in the velocities have several solutions.
    #[error("the constraints leave a choice of {}: {} or {}; choose by a [start.guess]", listed(.velocities), values(.first), values(.second))]
    Ambiguous { velocities: Vec<String>, first: Vec<f64>, second: Vec<f64> },
    /// The equations for the start velocities are finite at none of the points tried.
    #[error("the equations for the start velocities are not finite at any of {points} points tried")]
    NotSolved { points: usize },
    /// `A` has no full row rank.
    #[error("the constraints are dependent at the start: smallest singular value of the scaled constraint Jacobian {ratio:.1e} of the largest, limit {limit:.0e} (singular values {}){}", values(.singular_values), redundant(.combination))]
    DependentConstraints {
        /// The combination of constraints whose derivatives by the velocities vanish: numbers of
        /// constraints, from 1, with their factors; empty where a constraint has none by itself.
        combination: Vec<(usize, f64)>,
        /// Singular values of the scaled `A`, falling.
        singular_values: Vec<f64>,
        /// Smallest over largest.
        ratio: f64,
        limit: f64,
    },
    /// `NᵀMN` is singular.
    #[error("the mass matrix is singular on the velocities that the constraints allow: ratio of singular values {ratio:.1e}, limit {limit:.0e} (singular values {})", values(.singular_values))]
    SingularMassMatrix {
        /// Singular values of the scaled `NᵀMN`, falling.
        singular_values: Vec<f64>,
        /// Smallest over largest.
        ratio: f64,
        limit: f64,
    },
    /// Reactions along prescribed rows `W` cannot keep the constraints.
    #[error("reactions as `virtual` prescribes them cannot keep the constraints at the start: W M⁻¹ Aᵀ is singular, W the derivatives of `virtual` by the velocities: ratio of singular values {ratio:.1e}, limit {limit:.0e} (singular values {})", values(.singular_values))]
    SingularReactions {
        /// Singular values of scaled `W`, where they tell, or of scaled `(N_W)ᵀ M N_A`, falling.
        singular_values: Vec<f64>,
        /// Smallest over largest.
        ratio: f64,
        limit: f64,
    },
    /// Something is not finite at the start.
    #[error("{quantity} is not finite at the start: {value}")]
    NotFinite { quantity: Quantity, value: f64 },
    /// A parametrization cannot represent the start.
    #[error("removal `{removal}` cannot represent the start: relative residual {residual:.3e}, limit {limit:.0e}")]
    RemovalStart {
        removal: String,
        /// Smallest residual found, infinite if nothing was finite.
        residual: f64,
        limit: f64,
    },
    /// A state of the wrong length.
    #[error("{found} positions or velocities for a system with {expected} coordinates")]
    WrongLength { found: usize, expected: usize },
    /// A velocity outside the constraint that cannot be moved onto it.
    #[error("the velocity cannot be projected onto the constraint: {0}")]
    Projection(NewtonError),
    /// A matrix could not be decomposed.
    #[error(transparent)]
    Decomposition(#[from] NewtonError),
    /// An expression could not be evaluated.
    #[error(transparent)]
    Evaluation(#[from] CompileError),
}

fn listed(names: &[String]) -> String {
    names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ")
}

fn values(numbers: &[f64]) -> String {
    let mut shown: Vec<String> = numbers.iter().take(SHOWN).map(|x| format!("{x:.4e}")).collect();
    if numbers.len() > SHOWN {
        shown.push(format!("… {} in all", numbers.len()));
    }
    shown.join(", ")
}

/// Positions and velocities are as many as coordinates.
pub(super) fn check_lengths(system: &System, state: &State) -> Result<(), StartError> {
    let expected = system.dimension();
    match [state.q.len(), state.v.len()].into_iter().find(|&found| found != expected) {
        Some(found) => Err(StartError::WrongLength { found, expected }),
        None => Ok(()),
    }
}

/// What start equations add to too few conditions, and what they could.
fn idle_equations(idle: &[usize]) -> String {
    if idle.is_empty() {
        return String::new();
    }
    let numbers: Vec<String> = idle.iter().map(usize::to_string).collect();
    let (word, follows) = if idle.len() == 1 { ("equation", "follows") } else { ("equations", "follow") };
    format!(" (start {word} {} {follows} from the others and tells nothing)", numbers.join(", "))
}

/// Lines that give velocities.
fn lines(velocities: &[String]) -> String {
    let line = |name: &String| format!("`\"{name}\" = 0`, or in [start], as in `equations = [\"{name} = 0\"]`");
    velocities.first().map_or_else(String::new, line)
}

/// A combination in words, and what to do about it.
fn redundant(combination: &[(usize, f64)]) -> String {
    match combination {
        [] => String::new(),
        [(only, _)] => format!("; constraint {only} does not depend on the velocities there"),
        several => {
            let term = |(number, factor): &(usize, f64)| format!("{factor:.3} × constraint {number}");
            let sum: Vec<String> = several.iter().map(term).collect();
            let numbers: Vec<String> = several.iter().map(|(number, _)| number.to_string()).collect();
            let sum = sum.join(" + ").replace("+ -", "− ");
            format!(
                "; there {sum} does not depend on the velocities: drop one of constraints {}, or replace them by independent combinations, such as their components along two directions",
                numbers.join(", ")
            )
        }
    }
}
