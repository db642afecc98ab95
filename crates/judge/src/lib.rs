//! # Which law does the program that made this motion integrate?
//!
//! Given: a film, times and coordinates that some program wrote down, and the system that it claims to move:
//! `L`, constraints `f(q, v, t) = 0 ∈ Rʰ`, forces `Q`. Velocities and accelerations are those of polynomials
//! through nine samples; what polynomials through seven say otherwise is the *noise*.
//!
//! **The reaction.** `ρ = d/dt ∂L/∂v − ∂L/∂q − Q`, whatever the program did, in lengths by `M⁻¹`. With
//! `A = ∂f/∂v` and `C = (∂f/∂q)ᵀ − Ȧᵀ`, laws say of it
//!
//! ```text
//! Chetaev                          ρ = Aᵀ λ
//! first trace ε and drag c         ρ = Aᵀ λ − ε C λ − c M v
//! vakonomic                        ρ = −Aᵀ μ̇ + C μ ,         μ̇ follows from ρ, and μ(t₀) is free
//! constraint put into L            ρ = (∂f/∂q)ᵀ μ − d/dt (Aᵀ μ)   in the rows of the velocities that stay,
//!                                  Aᵀ μ = −∂L/∂v                   in those that were eliminated
//! ```
//!
//! `P` leaves of a vector what no `Aᵀ λ` gives. `ε` and `c` are those with the least sum of squares of
//! `P (ρ + ε C λ + c M v)`, `μ(t₀)` of `P (ρ − C μ)`. What remains, as a part of `ρ` and `M a` together, is
//! the *rest* of a law.
//!
//! **The constraint.** Of `f` itself: kept; creeping as `f = −λ/N`; or moved by what `d/dt f` is made of,
//! `df/dt = b (f_q v + f_t) − α f`: `b = 1` where a program lets `A v̇ = 0` and leaves `Ȧ v` out, `α` where it
//! pulls back. Again by least squares.
//!
//! **How sure.** A program's own error is no noise: it is smooth. Standard errors are those of a jackknife
//! over eight pieces of the film.
//!
//! Source: the laws as in the crates of formulations; the jackknife of M. H. Quenouille, 1956.

mod film;
mod fits;
mod frame;
mod judgement;

pub use film::{Film, orders};
pub use judgement::{Constraint, Judgement, Law, Number, Rest, judge};

/// Why a film is not judged.
#[derive(Debug, thiserror::Error)]
pub enum JudgeError {
    /// The file is no film of this system.
    #[error("line {line}: {reason}")]
    Film {
        /// Line, from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// There is no constraint, and so no law.
    #[error("the system has no constraint: there is no law to tell from another")]
    Unconstrained,
    /// The equations do not compile.
    #[error("{0}")]
    Compile(String),
    /// The kinetic metric has no root.
    #[error("at t = {t} the mass matrix is not positive definite: lengths by its inverse are asked for")]
    Indefinite {
        /// Time.
        t: f64,
    },
    /// The rows of `∂f/∂v` depend on each other.
    #[error("at t = {t} the constraints are dependent")]
    Dependent {
        /// Time.
        t: f64,
    },
    /// Something has no value.
    #[error("at t = {t} the equations have no finite value")]
    NotFinite {
        /// Time.
        t: f64,
    },
}
