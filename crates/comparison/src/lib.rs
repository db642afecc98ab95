//! # Decides whether the formulations of a nonholonomic system agree
//!
//! Two formulations of one system have the same trajectory or different ones. If a formulation has free
//! constants, such as the initial multipliers of vakonomic mechanics, the question is whether *some* of them
//! give the trajectory of the other.
//!
//! - [`compare`]: a scene in every formulation, pair by pair, with fits of the free constants.
//! - [`compare_motions`]: two motions.
//! - [`membership()`]: whether the motion of one formulation is one of another for *some* free constants.
//! - [`Sweep`]: such comparisons over a grid of parameters and starts.
//! - [`words`]: the sentences that the program, the pages and the Python module print.
//!
//! **When two motions differ.** Their gap is a length in the kinetic metric, `M = ∂²L/∂v²` (n×n), in `√E·T`
//! (metres where masses are 1):
//!
//! ```text
//! gap(t) = √(Δqᵀ M Δq) ,      different:  gap(t) > 10 (e₁(t) + e₂(t)) at some t,
//! ```
//!
//! with the error estimates `e(t)` of both. *Same* also requires small estimates; everything else is
//! *undecided* ([`Verdict`]).
//!
//! ```
//! use comparison::{Verdict, compare_motions};
//! use motion::{CHETAEV, Metric, Settings, VAKONOMIC, choices, solve_choice};
//!
//! // a skate on level ice, at 1 m/s and turning at 1 rad/s
//! let text = r#"
//! title = "Skate"
//! [coordinates]
//! x = { unit = "m", start = 0 }
//! y = { unit = "m", start = 0 }
//! phi = { unit = "rad", start = 0 }
//! [system]
//! lagrangian = "(x'^2 + y'^2 + phi'^2)/2"
//! constraints = ["y'*cos(phi) - x'*sin(phi)"]
//! [start]
//! velocities = { "x'" = 1, "phi'" = 1 }
//! [run]
//! duration = 2
//! "#;
//! let scene = scene::Scene::parse("skate", text)?;
//! let choice = |own| choices(&scene).into_iter().find(|c| c.formulation == own).unwrap();
//! let mut chetaev = solve_choice(&scene, &choice(CHETAEV), &Settings::default())?;
//! let mut vakonomic = solve_choice(&scene, &choice(VAKONOMIC), &Settings::default())?;
//! let gap = compare_motions(&mut chetaev, &mut vakonomic, &mut Metric::new(&scene.system)?)?;
//! assert_eq!(gap.verdict, Verdict::Different);
//! // Chetaev's skate runs on a circle of radius 1
//! let q = chetaev.at(2.0)?.coordinates;
//! assert!((q[0] - f64::sin(2.0)).abs() < 1e-9 && (q[1] - 1.0 + f64::cos(2.0)).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod beyond;
mod comparison;
mod contradiction;
mod epsilon_term;
mod fit;
mod fits;
mod gap;
mod growth;
mod integrability;
mod membership;
#[doc(hidden)]
pub mod parts;
mod runs;
mod sweep;
pub mod words;

pub use beyond::{Beyond, beyond_contacts};
pub use comparison::{Comparison, compare, compare_unfitted};
pub use contradiction::{Beside, Contradicted, Contradiction, hold, holds_beside_numbers};
pub use decision::{Finding, PlainScene, Section};
pub use epsilon_term::{EpsilonTerm, epsilon_term};
pub use fit::best_fit;
pub use fits::{Fit, Fits};
pub use gap::{Gap, GapPoint, Sampling, THRESHOLDS, Verdict, compare_motions, compare_motions_by};
pub use growth::{Growth, LeadingTerm, growth};
pub use integrability::{integrability, integrability_by_brackets, integrals_by_ranks};
pub use membership::{Answer, Membership, Pairing, certificate, costates_of, membership, multipliers_of};
pub use motion::band::SAME_ESTIMATE;
pub use runs::{Decided, Extent, FittedMotion, Pair, Run};
pub use sweep::{Sweep, SweepPoint};
