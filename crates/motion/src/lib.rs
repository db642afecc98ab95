//! # Trajectories of nonholonomic systems, in several formulations
//!
//! Given are `L(q, v, t)`, `q ∈ Rⁿ`, and constraints `f(q, v, t) = 0 ∈ Rʰ`. The d'Alembert–Lagrange
//! (Chetaev), vakonomic and removed-constraint equations have different solutions if `f` is nonholonomic.
//! `kappa` is a family between the first two, `first-order` its expansion at Chetaev with slip, and
//! `prescribed` is for servo constraints. The front page of each formulation's crate is its derivation. This
//! crate puts them into one table and integrates them with one time loop. The crate `comparison` decides
//! whether two motions agree.
//!
//! - [`FORMULATIONS`]: the table: [`CHETAEV`], [`VAKONOMIC`], …; [`formulation`] reads a name.
//! - [`equations_of`]: the equations of `L`, `f` and `q`, without a scene.
//! - [`derive()`], [`solve`]: one motion, with its global error estimate `e(t)`, the difference of two runs.
//! - [`solve_by_steps`]: one motion by a discrete principle, in equal steps that keep its structure.
//! - [`prepare`]: the equations compiled and started, for other integrators; [`code()`]: as source text.
//! - [`Ensemble`]: many starts and parameters of one system at once.
//! - [`Model`]: a motion as a function of numbers, with derivatives, for fits.
//! - [`connect()`]: the motions from one point to another, with their conjugate times.
//!
//! ```
//! use motion::{CHETAEV, Settings, choices, solve_choice};
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
//! let chetaev = choices(&scene).into_iter().find(|choice| choice.formulation == CHETAEV).unwrap();
//! // Chetaev's skate runs on a circle of radius 1
//! let q = solve_choice(&scene, &chetaev, &Settings::default())?.at(2.0)?.coordinates;
//! assert!((q[0] - f64::sin(2.0)).abs() < 1e-9 && (q[1] - 1.0 + f64::cos(2.0)).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! **What it refuses.** A motion that cannot be started is a [`SolveError`]. Once started, it ends with an
//! [`Ending`], and the part up to its end is valid. An error estimate that cannot be trusted carries a
//! [`Doubt`]. How errors are found and what they decide stands in [`band`].

pub mod band;
mod by_name;
mod chart_transition;
mod charts;
mod choice;
mod clock;
mod code;
mod connect;
mod constants;
mod costates;
mod differences;
mod direction;
mod discrete_run;
mod ending;
mod ensemble;
mod equations_text;
mod equidistant;
mod error;
mod form;
mod grid;
mod kinks;
mod lost_rank;
mod method;
mod metric;
mod model;
mod motion;
pub mod numbers;
#[doc(hidden)]
pub mod parts;
mod prepared;
mod sensitivities;
mod sensitivity_start;
mod settings;
pub mod shooting;
mod single_run;
mod start_values;
mod state_scales;
mod steps;
mod stiffness_probe;
mod table;
mod trajectory;
mod variables;
mod variational;
mod varying;
mod wanted;

pub use band::{Breach, CERTAINTY, Doubt, ErrorEstimate, TRUSTED, error_estimate, error_estimates};
pub use by_name::ByName;
pub use charts::ChartChange;
pub use choice::{
    Choice, choices, choices_among, constants_of, default_constants, derive, derive_at, equations_of, forms, removal,
    removal_names, removals,
};
pub use code::code;
pub use connect::{Aim, CONNECT_STARTS, ConjugateTime, Connection, Connections, SecondVariation, connect};
pub use constants::{constant_names, prepare};
pub use costates::{Costates, costate_names, given_costates, is_costate};
pub use direction::Direction;
pub use ending::Ending;
pub use ensemble::{
    Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberMotion, MemberRun, number_of_threads, over_threads,
};
pub use equations_text::{EquationStyle, equations_text, shared_text, system_text};
pub use equidistant::{equidistant, equidistant_value};
pub use error::SolveError;
pub use form::{ChosenForm, FORM_WORDS, Form, derive_in_form, formulation_in};
pub use method::Chosen;
pub use metric::{Metric, larger, subtract};
pub use model::{Model, Reading};
pub use motion::{FormReport, Motion, Seconds, solve, solve_choice, solve_from};
pub use prepared::Prepared;
pub use sensitivities::{Sensitivities, sensitivities};
pub use settings::{Setting, Settings, TIGHTER, setting};
pub use single_run::{SingleRun, outputs};
pub use steps::{STEP_LIMIT, Stepping, Steps, discrete_of, solve_by_steps};
pub use symbolic::{Broken, Language, caught};
pub use table::{
    CHETAEV, FIRST_ORDER, FORMS, FORMULATIONS, KAPPA, PRESCRIBED, REDUCED_CHETAEV, REDUCED_VAKONOMIC,
    REMOVED_CONSTRAINT, UnknownFormulation, VAKONOMIC, VAKONOMIC_COSTATE, formulation, is_in_table,
};
pub use variational::{VariationalRun, Which};
pub use varying::Varying;
