//! # Mechanical systems with velocity constraints
//!
//! Given are coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)` with `v = q̇`, constraints `f(q, v, t) = 0 ∈ Rʰ`
//! and generalized forces `Q(q, v, t)`: a [`System`]. Write `A = ∂f/∂v` (h×n) and `M = ∂²L/∂v²` (n×n). This
//! crate knows what can be said about a system before any principle of mechanics is chosen.
//!
//! **The start** ([`complete_start`], [`project_velocity`], [`check_regularity`]). Of `v₀` as many entries
//! are given as the constraints leave open; the others solve
//!
//! ```text
//! f(q₀, v, t₀) = 0
//! ```
//!
//! by one Gauss–Newton iteration ([`newton`]), and a motion starts there only if `A` has full row rank and
//! `M` is regular on its kernel. Constraints that are nearly dependent there have the same motion as
//! `T f = 0` with a constant, regular `T` ([`Recombination`]).
//!
//! **Removing the constraints** ([`Removal`]). New displacement parameters `u ∈ Rⁿ⁻ʰ` and memory variables
//! `w` such that
//!
//! ```text
//! q = q(u̇, u, w, t) ,   ẇ = B(ü, u̇, u, w, t)      make      f(q, q̇, t) = 0   hold identically.
//! ```
//!
//! A removal is written by hand, or found where `f = A v + b` is linear in `v`, by one elimination of the
//! dependent velocities in expressions: `v_d = K v_i + c` ([`Removal::by_coordinates`],
//! [`Removal::by_quasi_velocities`]).
//!
//! **Integrability** ([`integrability()`]). The fields that span the kernel of `A`, in the space of `(q, t)`,
//! span an involutive distribution just where the constraints can be integrated (Frobenius); then all
//! formulations agree, otherwise they need not.
//!
//! What it does not know: how a system is written in a file, what the equations of motion are, how time
//! advances.

mod automatic_removal;
pub mod elimination;
mod integrability;
pub mod linear;
pub mod newton;
mod rank;
mod removal;
mod removal_error;
mod singular_values;
mod solved_constraints;
mod start;
mod system;

pub use integrability::{Integrability, integrability};
pub use rank::generic_rank;
pub use removal::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
pub use removal_error::RemovalError;
pub use singular_values::SingularValues;
pub use start::{
    Completion, Quantity, Recombination, RemovalStart, StartData, StartError, check_regularity, complete_removal_start,
    complete_start, project_velocity,
};
pub use system::{Coordinate, Parameter, State, System, fresh_symbol};
