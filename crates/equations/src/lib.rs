//! # Equations of motion, and how they are evaluated
//!
//! Every formulation returns [`Equations`]: states `y ∈ Rᴺ`, unknowns `z ∈ Rᴷ` of one instant (accelerations,
//! multipliers or their rates), and in expressions
//!
//! ```text
//! ẏ = Y(t, y, z) ,        R(z; t, y) = 0 ∈ Rᴷ ,        y(t₀) = y₀(t₀, q₀, v₀; free constants).
//! ```
//!
//! They also contain outputs (`q`, `q̇`, multipliers), invariants, guards (expressions that must not vanish)
//! and the equations for the reader. A [`Formulation`] is a name and a pass from a system to such equations.
//!
//! **Left out** ([`Equations::leave_out_unneeded`]). `R` is split into independent blocks, equations for
//! single unknowns are solved symbolically, states on which nothing depends are dropped. The motion is the
//! same.
//!
//! **Compiled** ([`Compiled`]). `F(t, y) = Y(t, y, z(t, y))` as straight-line programs. `z` solves the
//! blocks: by LU factorization where they are linear, by Newton's method from the last accepted state where
//! they are not. From the same expressions come the Jacobian (N×N), by the implicit function theorem,
//!
//! ```text
//! ∂F/∂y = Y_y − Y_z R_z⁻¹ R_y ,
//! ```
//!
//! the Taylor coefficients of the motion, and the projection `v ← v + δv` onto a constraint with the smallest
//! `δvᵀ M δv`. [`LaneEquations`] do the same for eight motions at once.
//!
//! **Planned** ([`Plan`]). Linear blocks whose pivots are known beforehand are eliminated in expressions,
//! under a condition that every evaluation checks.
//!
//! ```
//! use equations::{Block, Compiled, Equations};
//! use mechanics::System;
//! use symbolic::Graph;
//!
//! // a mass of 2 kg on a spring of 8 N/m: z = x'', R = 2 x'' + 8 x
//! let system = System::new(Graph::new(), &[("x", "m")]);
//! let mut equations = Equations::new("by hand", &system);
//! equations.add_positions_and_velocities(&system);
//! let residuals = vec![system.expression("2*x'' + 8*x")?];
//! let unknowns = system.accelerations();
//! equations.blocks.push(Block { unknowns, residuals, guess: Vec::new(), regular: "the mass" });
//! equations.graph = system.graph;
//!
//! let mut compiled = Compiled::new(&equations)?.with_jacobian(&equations)?;
//! let (mut rates, mut jacobian) = ([0.0; 2], [0.0; 4]);
//! compiled.rates(0.0, &[3.0, 0.5], &mut rates)?;
//! compiled.jacobian(0.0, &[3.0, 0.5], &mut jacobian)?;
//! assert_eq!((rates, jacobian), ([0.5, -12.0], [0.0, 1.0, -4.0, 0.0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **What it refuses.** An instant whose `R_z` is singular or whose Newton iteration does not converge
//! ([`EvaluationFailure`]); a system that a formulation has no equations for ([`DerivationError`]). It knows
//! no formulation, no principle and no time step.
//!
//! Source of the projection: E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, IV.4.

mod adjoint_terms;
mod blocks;
mod chart;
mod code;
mod compiled;
mod definitions;
mod dynamics;
mod equations;
mod formulation;
mod jacobian;
mod lanes;
mod leave_out;
mod of_instant;
mod outputs;
mod parts;
mod plan;
mod planned;
mod programs;
mod projection;
mod recombination;
mod round_off;
mod rows;
mod series;
mod steep;
mod tangents;

pub use blocks::{EvaluationFailure, Real};
pub use chart::Chart;
pub use compiled::Compiled;
pub use definitions::Definitions;
pub use dynamics::Dynamics;
pub use equations::{
    Block, ConstraintProjection, ConstraintRows, Equations, FreeConstant, LeftOut, Named, Role, StateVariable,
    Statement,
};
pub use formulation::{Derivation, DerivationError, Formulation, Needs, parameter};
pub use lanes::LaneEquations;
pub use outputs::{Cost, Outputs};
pub use plan::{Collected, Plan};
pub use programs::Programs;
pub use series::Series;
pub use tangents::Tangents;

/// The choice of pivots, which is tested by itself: for `tests/` of this crate, and for nobody else.
#[doc(hidden)]
pub mod pivots {
    pub use crate::plan::{Entry, Order, POINTS, Pattern, Strategy};
}
