//! Frames: velocities `u = U(q) v` with the kinetic energy a sum of squares of constant coefficients.
//!
//! For `L` quadratic in the velocities, eliminating its mass matrix writes the kinetic energy as squares,
//!
//! ```text
//! ½ vᵀM(q) v = ½ Σ c_k u_k² ,      u_k = s_k (v_k + Σ l_kj v_j) ,
//! ```
//!
//! and where all `c_k` are constant, its equations of motion contain coordinates only through the structure
//! coefficients of the frame: with `ω^k = u_k` as a form, `e_k` the vector with `ω^j(e_k) = δ_jk`, and
//! `P_k = c_k u_k`,
//!
//! ```text
//! Ṗ_k + Σ_c P_c dω^c(q̇, e_k) = e_k · (force on the coordinates)       on every virtual displacement.
//! ```
//!
//! For a rigid body these are Euler's equations: `u` is its angular velocity, and `dω^c(e_a, e_b)` are
//! numbers where Euler angles stood. Two velocities of equal inertia are rotated (Givens) if a constraint
//! then contains only one of them. The constraints to be eliminated next then have constant coefficients, and
//! no mass matrix has to be eliminated during integration.
//!
//! The frame is singular where an `s_k` vanishes: `M` is singular there. It is used only if constraints do
//! not contain `1/s_k`: then the mass matrix of the admissible velocities is singular there in any variables.
//!
//! Sources: G. Hamel 1904; Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, chapter III.

mod builder;
mod parts;
mod search;
mod squares;

pub use parts::{Frame, FrameVelocity, Turning};
