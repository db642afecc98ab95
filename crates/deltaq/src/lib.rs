//! # One system, several formulations of its motion: derive, integrate, compare
//!
//! Given `L(q, v, t)`, `q ∈ Rⁿ`, and constraints `f(q, v, t) = 0 ∈ Rʰ`, what are the equations of motion?
//! Chetaev's, the vakonomic and the removed-constraint formulation answer differently where `f` cannot be
//! integrated; `kappa` is a family between the first two, `first-order` its end at Chetaev, with slip, and
//! `prescribed` has reactions of the user's own. Their derivations are the front pages of the crates. This
//! crate puts them into one table, integrates them with one time loop, and says whether two motions are the
//! same.
//!
//! - [`FORMULATIONS`]: the table: [`CHETAEV`], [`VAKONOMIC`], …; [`formulation`] reads a name.
//! - [`derive()`], [`solve`]: one motion, with its global error estimate `e(t)`, the difference of two runs.
//! - [`solve_by_steps`]: one motion by a discrete principle, in equal steps that keep its structure.
//! - [`prepare`]: the equations compiled and started, for other integrators; [`code()`]: as source text.
//! - [`Ensemble`]: many starts and parameters of one system at once.
//! - [`Model`]: a motion as a function of numbers, with derivatives, for fits.
//! - [`connect()`]: the motions from one point to another, with their conjugate times.
//! - [`compare`]: a scene in every formulation, pair by pair, with fits of the free constants.
//! - [`membership()`]: whether the motion of one formulation is one of another for *some* free constants.
//!
//! **When two motions differ.** Their gap is a length in the kinetic metric, `M = ∂²L/∂v²` (n×n), in `√E·T`
//! (metres where masses are 1):
//!
//! ```text
//! gap(t) = √(Δqᵀ M Δq) ,      different:  gap(t) > 10 (e₁(t) + e₂(t)) at some t.
//! ```
//!
//! *Same* also requires small estimates; everything else is *undecided* ([`Verdict`]).
//!
//! ```
//! use deltaq::{CHETAEV, Metric, Settings, VAKONOMIC, Verdict, choices, compare_motions, solve_choice};
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
//!
//! **What it refuses.** A motion that cannot be started is a [`SolveError`]. Once started, it ends with an
//! [`Ending`], and the part up to its end is valid. An error estimate that cannot be trusted carries a
//! [`Doubt`].

mod beyond;
mod by_name;
mod carried;
mod charts;
mod choice;
mod clock;
mod code;
mod comparison;
mod connect;
mod constants;
mod contradiction;
mod costates;
mod differences;
mod direction;
mod discrete_run;
mod disturbed;
mod doubt;
mod ending;
mod ensemble;
mod equations_text;
mod equidistant;
mod error;
mod error_estimate;
mod first_trace;
mod fit;
mod fits;
mod form;
mod gap;
mod grid;
mod growth;
mod integrability;
mod kinks;
mod last_digits;
mod later_chart;
mod lost_digits;
mod lost_rank;
mod membership;
mod method;
mod metric;
mod model;
mod motion;
#[doc(hidden)]
pub mod parts;
mod prepared;
mod round_off;
mod runs;
mod sensitivities;
mod sensitivity_start;
mod settings;
mod single_run;
mod sizes;
mod start_values;
mod steps;
mod sweep;
mod table;
mod trajectory;
mod trial;
mod variables;
mod varying;
mod wanted;
mod watch;
pub mod words;

pub use beyond::{Beyond, beyond_contacts};
pub use decision::{Finding, PlainScene, Section};
pub use symbolic::{Broken, Language, caught};

pub use by_name::ByName;
pub use charts::ChartChange;
pub use choice::{
    Choice, choices, choices_among, constants_of, default_constants, derive, derive_at, forms, removal, removal_names,
    removals,
};
pub use code::code;
pub use comparison::{Comparison, Extent, compare, compare_unfitted};
pub use connect::{Aim, CONNECT_STARTS, ConjugateTime, Connection, Connections, SecondVariation, connect};
pub use constants::{constant_names, prepare};
pub use contradiction::{Beside, Change, Contradicted, Contradiction, hold, holds_beside_numbers};
pub use costates::{costate_names, given_costates, is_costate};
pub use doubt::Doubt;
pub use ending::Ending;
pub use ensemble::{
    Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberMotion, MemberRun, number_of_threads, over_threads,
};
pub use equations_text::{EquationStyle, equations_text, shared_text, system_text};
pub use equidistant::{equidistant, equidistant_value};
pub use error::SolveError;
pub use error_estimate::{ErrorEstimate, TRUSTED, error_estimate, error_estimates};
pub use first_trace::{FirstTrace, first_trace};
pub use fit::best_fit;
pub use fits::{Fit, Fits, FittedMotion};
pub use form::{ChosenForm, FORM_WORDS, Form, derive_in_form, formulation_in};
pub use gap::{Gap, GapPoint, SAME_ESTIMATE, Sampling, THRESHOLDS, Verdict, compare_motions, compare_motions_by};
pub use growth::{Growth, LeadingTerm, growth};
pub use integrability::{integrability, integrals_by_ranks};
pub use membership::{Answer, Membership, Pairing, certificate, costates_of, membership, multipliers_of};
pub use method::Chosen;
pub use metric::Metric;
pub use model::{Model, Reading};
pub use motion::{FormReport, Motion, Seconds, solve, solve_choice, solve_from};
pub use prepared::Prepared;
pub use runs::{Decided, Pair, Run};
pub use sensitivities::{Sensitivities, sensitivities};
pub use settings::{CERTAINTY, Setting, Settings, TIGHTER, setting};
pub use single_run::SingleRun;
pub use steps::{STEP_LIMIT, Stepping, Steps, discrete_of, solve_by_steps};
pub use sweep::{Sweep, SweepPoint};
pub use table::{
    CHETAEV, FIRST_ORDER, FORMS, FORMULATIONS, KAPPA, PRESCRIBED, REDUCED_CHETAEV, REDUCED_VAKONOMIC,
    REMOVED_CONSTRAINT, UnknownFormulation, VAKONOMIC, VAKONOMIC_COSTATE, formulation,
};
pub use varying::Varying;
pub use watch::Breach;
