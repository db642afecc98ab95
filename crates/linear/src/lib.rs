//! # Linear (spectral) stability of steady motions of nonholonomic systems
//!
//! Equations of motion `ẏ = F(t, y)` of any formulation, a motion, and a deviation `δ` from it:
//!
//! ```text
//! δ̇ = J δ ,      J = ∂F/∂y ,      exact ([`equations::Compiled::jacobian`]).
//! ```
//!
//! **States.** Constraints linear in the velocities are taken in quasi-velocities, `y = (q, w)`, or `(q, p)`
//! in the vakonomic formulation: every state is on the constraint, without multipliers. Others
//! keep the states of their formulation; `f` is an integral then, which is zero on the motion.
//!
//! **Carried coordinates.** Coordinates on which no rate depends but those of other such coordinates are
//! carried along. They may move in a steady motion, as the place of a bicycle does; their eigenvalues are
//! zero. `J` is that of the other states.
//!
//! **Steady** ([`linearize`]). The rates of the other states vanish, and `J` is constant. Otherwise
//! ([`linearize_at`]) its eigenvalues are frozen: those of an instant, which need not decide on stability.
//!
//! **Integrals.** Where the motion is steady, an integral `c(y)` has `∂c/∂y J = 0`. So it brings a zero, and
//! the eigenvectors of all other eigenvalues lie along `c = const`: to first order they stay on position
//! constraints that `f` keeps, on `f = 0` and on the energy, which nothing has to enforce. Such zeros are
//! split off and counted ([`Spectrum`]).
//!
//! **Subsystems** ([`Linearization::part`]). `J` falls apart into blocks that are coupled in one direction
//! only. The eigenvalues of some coordinates are those of their blocks, whatever the others do.
//!
//! ```
//! use motion::{choices, setting};
//! // a pendulum of 1 m that hangs, at 9 m/s²: frequency 3 rad/s
//! let text = r#"
//! title = "Pendulum"
//! [coordinates]
//! angle = { unit = "rad", start = 0 }
//! [system]
//! lagrangian = "angle'^2/2 + 9*cos(angle)"
//! [start.velocities]
//! "angle'" = 0
//! [run]
//! duration = 1
//! "#;
//! let scene = scene::Scene::parse("pendulum", text)?;
//! let found = linear::linearize(setting(&scene), &choices(&scene)[0])?.part(&[])?;
//! assert!((found.eigenvalues[0].value.im - 3.0).abs() < 1e-14);
//! assert_eq!(found.unstable(), 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **What it refuses.** A start that is not steady, with the state that moves, its rate and the limit
//! ([`LinearError`]). It knows no formulation: a new one is linearized without a line here.

#[doc(hidden)]
pub mod core;
mod discs;
mod error;
mod find;
mod limits;
mod linearization;
mod matrix;
mod point;
mod scales;
mod spectrum;
mod sweep;
mod weyl;

pub use error::LinearError;
pub use find::find_steady;
pub use linearization::{Carried, Growth, Linearization, Part, linearize, linearize_at};
pub use spectrum::{Block, Chain, Eigenvalue, Spectrum};
pub use sweep::{Change, Sweep, SweepPoint, sweep};
