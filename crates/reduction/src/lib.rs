//! # Equations of motion of nonholonomic systems in quasi-velocities (Maggi, Boltzmann–Hamel)
//!
//! For constraints linear in the velocities, `A(q, t) v + b(q, t) = 0`, every admissible velocity is
//!
//! ```text
//! v = S(q, t) w + s(q, t) ,      A S = 0 ,   A s + b = 0 ,
//! ```
//!
//! with n − h quasi-velocities `w`. This crate reformulates in `(q, w)`, or `(q, p)`, the equations that the
//! crates of the formulations derive with multipliers: fewer unknowns, no projection, and O(n) operations for
//! a chain of n bodies. The motions are the same: a test compares each form with the first one of its
//! formulation, and only speed depends on this crate.
//!
//! - [`QuasiVelocities`]: `S` and `s` as a recursion, by sparse elimination of the constraints.
//! - [`Frame`]: `u = U(q) v` with the kinetic energy squares of constant coefficients, and `dω` of its forms.
//! - Chains in few coordinates, by the velocities of their bodies, the first step of both (`chain`).
//! - [`REDUCED_CHETAEV`]: `Sᵀ (d/dt ∂L/∂v − ∂L/∂q − Q) = 0`.
//! - [`REDUCED_VAKONOMIC`]: `Sᵀ (p − L_v) = 0`, `ṗ = L_q − (∂v/∂q)ᵀ (p − L_v)`.
//! - [`cheapest`]: which of several ways to write the same motion takes the fewest operations.
//!
//! It does not treat nonlinear constraints, the removed-constraint equations, or time integration.

mod backwards;
mod chain;
mod cost;
mod drift;
mod expressions;
mod frame;
mod quasi_velocities;
mod reduced_chetaev;
mod reduced_vakonomic;

pub use cost::{cheapest, matrix_moves};
pub use frame::{Frame, FrameVelocity, Turning};
pub use quasi_velocities::{Columns, DependentVelocity, EliminatedConstraint, QuasiVelocities, QuasiVelocity, Single};
pub use reduced_chetaev::{REDUCED_CHETAEV, derive_chetaev};
pub use reduced_vakonomic::{REDUCED_VAKONOMIC, derive_vakonomic};
