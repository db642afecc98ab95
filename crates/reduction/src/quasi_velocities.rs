//! Quasi-velocities: the velocities that linear constraints admit, a recursion as long as the constraints.
//!
//! With `f = A v + b`, the constraints are eliminated one by one, sparsely, and every dependent velocity
//! becomes a short combination of others:
//!
//! ```text
//! v_k = Σ S_kj v_j + s_k ,     v_j a quasi-velocity w or a velocity defined earlier;  S, s in (q, t).
//! ```
//!
//! What stands first is preferred as a pivot: constant coefficients (regular everywhere); a pair
//! `a v₁ + b v₂` with constant `a² + b²`, by way of a quasi-velocity `w` with `v₁ = b w + …`, `v₂ = −a w + …`
//! (the speed along a blade; regular everywhere); else a coefficient that is large at the start, which
//! becomes a guard. Among equals the pivot that fills least (Markowitz), then the latest coordinate.

mod columns;
mod elimination;
mod recursion;

pub use columns::{Columns, Single};
pub use recursion::{DependentVelocity, EliminatedConstraint, QuasiVelocities, QuasiVelocity};
