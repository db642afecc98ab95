//! # Equations of motion, and how they are evaluated
//!
//! What every formulation hands over is one thing, [`Equations`]: states `y`, unknowns `z` of one instant,
//! and
//!
//! ```text
//! ẏ = Y(t, y, z) ,        R(z; t, y) = 0 ,        y(t₀) = y₀(t₀, q₀, v₀; free constants),
//! ```
//!
//! in expressions, with outputs (`q`, `q̇`, multipliers), what stays constant, what must not vanish (guards)
//! and the equations as a reader wants to see them. A [`Formulation`] is a name and a pass from a system to
//! such equations.
//!
//! **Left out** ([`Equations::leave_out_unneeded`]). Blocks of `R` fall apart into independent ones, single
//! unknowns are solved on the spot, states on which nothing depends are dropped. The motion is the same.
//!
//! **Compiled** ([`Compiled`]). `F(t, y) = Y(t, y, z(t, y))` as straight-line programs. `z` solves the
//! blocks, by LU factorization where they are linear and by Newton's method from the last accepted state
//! where they are not. From the same expressions come `∂F/∂y` by the implicit function theorem,
//!
//! ```text
//! ∂F/∂y = Y_y − Y_z R_z⁻¹ R_y ,
//! ```
//!
//! the Taylor coefficients of the motion, and the return `v ← v + δv` onto a constraint with the smallest
//! `δvᵀ M δv`. [`LaneEquations`] do the same for eight motions at once.
//!
//! **Planned** ([`Plan`]). Linear blocks whose pivots are known beforehand are eliminated in expressions,
//! under a condition that is watched.
//!
//! What it does not know: any formulation, any principle, how time advances.

mod blocks;
mod compiled;
mod definitions;
mod equations;
mod formulation;
mod jacobian;
mod lanes;
mod leave_out;
mod plan;
mod planned;
mod projection;
mod recombination;
mod series;

pub use blocks::EvaluationFailure;
pub use compiled::{Compiled, Cost, Outputs};
pub use definitions::Definitions;
pub use equations::{
    Block, ConstraintProjection, Equations, FreeConstant, LeftOut, Named, Role, StateVariable, Statement,
};
pub use formulation::{Derivation, DerivationError, Formulation, refuse_forces};
pub use lanes::LaneEquations;
pub use plan::{Collected, Plan};
