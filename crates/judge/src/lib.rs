//! # Identification of the constraint law that a program integrates, from its trajectories
//!
//! Given: a scene, `L(q, v, t)`, `f(q, v, t) = 0`, `Q`, and samples `(t, q)` or `(t, q, v)` of a motion
//! computed by any program. `A = ∂f/∂v` (h×n), `M = ∂²L/∂v²`, `C = (∂f/∂q)ᵀ − Ȧᵀ`, and at each sample
//!
//! ```text
//! E = d/dt ∂L/∂v − ∂L/∂q ,       a from differences of the samples.
//! ```
//!
//! **Chetaev's law with three numbers**, each zero where the law holds exactly:
//!
//! ```text
//! E − Q = Aᵀλ − ε C λ − γ M v ,        f = −λ/N .
//! ```
//!
//! `λ` is free at each sample, `ε` (in `T`) and the drag `γ` (in `1/T`) minimize the residual in the metric
//! `M⁻¹`; then the slip `1/N` follows from the observed `f`. Nothing is integrated: errors do not grow,
//! and a start value is not needed.
//!
//! They are given where what is left is noise, or where much more would be left without them. Elsewhere a
//! number of the scene that is off, or a force that it lacks, may leave far less: then that is named.
//!
//! **Other laws.** Vakonomic: `E − Q = C μ − Aᵀ μ̇` for some `μ₀`; along a motion `μ` is affine in `μ₀`.
//! The rate of the rows left out: `A a = 0` instead of `ḟ = 0`. The constraint put into `L`: Lindelöf's
//! error.
//!
//! **Errors** are those of least squares with residuals that depend on their neighbours, and what differences
//! of the next lower order would have changed. They speak of the samples: what the step of the program
//! does to its motion is part of the numbers, and goes with the step.
//!
//! **What it refuses.** Tables that cannot be read, too few samples, dependent constraints, and mass
//! matrices that are not positive definite ([`JudgeError`]).

mod balance;
mod differences;
mod error;
mod judgement;
mod laws;
mod order;
mod regression;
mod samples;
mod substituted;

pub use balance::{Balance, Instant, inputs};
pub use differences::{derivative, halfway};
pub use error::JudgeError;
pub use judgement::{Drift, Judgement, Left, Residual, judge};
pub use laws::Misfit;
pub use order::{Order, order};
pub use regression::Number;
pub use review::Law;
pub use samples::Samples;
