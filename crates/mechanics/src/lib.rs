//! # Mechanical systems with velocity constraints
//!
//! Properties of a system that do not depend on the choice of a principle of mechanics. A [`System`] has
//! coordinates `q ∈ Rⁿ`, a Lagrangian `L(q, v, t)` with `v = q̇`, constraints `f(q, v, t) = 0 ∈ Rʰ` and
//! generalized forces `Q(q, v, t) ∈ Rⁿ`, on the side of `∂L/∂q`. Write `A = ∂f/∂v` (h×n) and `M = ∂²L/∂v²`
//! (n×n).
//!
//! **The start** ([`complete_start`], [`project_velocity`], [`check_regularity`]). Some velocities are given;
//! the constraints supply the others, `f(q₀, v, t₀) = 0`, by one Gauss–Newton iteration ([`newton`]).
//!
//! A motion starts only where `A` has full row rank and `M` is regular on its kernel; `M` itself may be
//! singular. Constraints that are nearly dependent there are replaced by `T f` with a constant, regular `T`
//! (h×h), which have the same motion ([`Recombination`]).
//!
//! **Removing the constraints** ([`Removal`]). With displacement parameters `u ∈ Rⁿ⁻ʰ` and memory variables
//! `w ∈ Rᵏ`
//!
//! ```text
//! q = q(u̇, u, w, t) ,   ẇ = B(ü, u̇, u, w, t)      make      f(q, q̇, t) = 0   hold identically.
//! ```
//!
//! A removal is written by hand and verified, or found where `f = A v + b` by elimination of the dependent
//! velocities, `v_d = K v_i + c` ([`Removal::by_coordinates`], [`Removal::by_quasi_velocities`]).
//!
//! **What is drawn** ([`View`]). Bodies, each a [`Shape`] in its own axes, whose point `p` is at
//! `c(q, t) + R(q, t) p`, and where they touch. No equation depends on them.
//!
//! **Integrability** ([`integrability()`]). The fields that span the kernel of `A`, in the space of `(q, t)`,
//! are closed under brackets just where the constraints can be integrated (Frobenius). Then Chetaev's and the
//! vakonomic motion agree.
//!
//! ```
//! use mechanics::{Integrability, Removal, State, System, integrability};
//! use symbolic::Graph;
//!
//! // an ice sledge: no velocity across the blade
//! let mut sledge = System::new(Graph::new(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
//! sledge.lagrangian = sledge.expression("(x'^2 + y'^2 + phi'^2)/2")?;
//! sledge.constraints = vec![sledge.expression("y'*cos(phi) - x'*sin(phi)")?];
//! let start = State { t: 0.0, q: vec![0.0; 3], v: vec![1.0, 0.0, 0.5] };
//!
//! assert!(matches!(integrability(&sledge, &start, 10.0)?, Integrability::Nonintegrable { depth: 1, .. }));
//! // u is the distance run along the blade
//! let removal = Removal::by_quasi_velocities(&sledge, &start)?;
//! assert_eq!(sledge.graph.plain(removal.memory[1].rate), "u_x'*sin(phi)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **What it refuses.** Starts that are open, contradictory, ambiguous or singular ([`StartError`]), and
//! removals that do not remove ([`RemovalError`]), each with what was measured and the limit. It knows no
//! file, no equation of motion and no time step.
//!
//! Sources: Ju. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems*, 1972; of removals P. Y. Gao
//! 2017.

mod automatic_removal;
mod domain;
pub mod elimination;
mod exact_constraints;
mod integrability;
mod integrable_alone;
mod leaf;
pub mod linear;
pub mod newton;
mod observables;
mod rank;
mod redundant;
mod removal;
mod removal_error;
mod shape;
mod singular_values;
mod solved_constraints;
mod speeds;
mod start;
mod system;
mod view;

pub use domain::Domain;
pub use integrability::{ExactRank, Growth, Integrability, Undecided, integrability, integrability_with};
pub use observables::Observables;
pub use rank::{Surroundings, generic_rank};
pub use removal::{ConstantsRule, DisplacementParameter, MemoryVariable, Removal};
pub use removal_error::RemovalError;
pub use shape::{Kind, Place, Shape};
pub use singular_values::SingularValues;
pub use start::{
    Completion, Configurations, Quantity, Recombination, RemovalProgram, RemovalStart, StartData, StartError,
    StartNumbers, StartProgram, StartShape, check_reactions, check_regularity, complete_removal_start, complete_start,
    project_velocity,
};
pub use system::{Constancy, Coordinate, Parameter, State, System, Watched, fresh_symbol};
pub use view::{Body, Pose, Poses, Touch, View};
