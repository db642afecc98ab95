//! One system with velocity constraints, several formulations of its motion: derive, integrate, compare.
//!
//! Given `L(q, v, t)` and `f(q, v, t) = 0`, what are the equations of motion? Three answers are in use, and they differ where `f` is not
//! integrable. Their derivations are the front pages of the crates `chetaev`, `vakonomic` and `removed_constraint`; this crate puts them
//! into one table, integrates them with one time loop, and says whether two motions are the same.
//!
//! - [`FORMULATIONS`]: the table.
//! - [`derive()`], [`solve`]: one motion, with its global error estimate.
//! - [`solve_by_steps`]: one motion by a discrete principle, in equal steps that keep its structure.
//! - [`ready()`]: the equations compiled, for single runs and for other integrators.
//! - [`Ensemble`]: many starts and parameters of one system at once.
//! - [`compare`]: a scene in every formulation, pair by pair, with the best fit of the free constants.

mod comparison;
mod doubt;
mod ensemble;
mod equations_text;
mod error;
mod estimate;
mod fit;
mod gap;
mod growth;
mod horizon;
mod metric;
mod motion;
mod nodes;
mod ready;
mod removals;
mod run;
mod steps;
mod table;

pub use comparison::{
    Choice, Comparison, Fit, FittedMotion, Pair, Run, choices, compare, default_constants, derive, derive_at, forms,
    setting, solve_choice,
};
pub use doubt::Doubt;
pub use ensemble::{
    Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberMotion, MemberRun, constants_of, over_threads,
};
pub use equations_text::{EquationStyle, equations_text};
pub use error::SolveError;
pub use estimate::{ErrorEstimate, TRUSTED, error_estimate};
pub use fit::best_fit;
pub use gap::{
    CERTAINTY, Gap, GapPoint, SAME_ESTIMATE, Sampling, THRESHOLDS, Verdict, compare_motions, compare_motions_by,
};
pub use growth::{Growth, LeadingTerm, growth, leading_term};
pub use metric::Metric;
pub use motion::{Ending, FormReport, Motion, Seconds, Setting, Settings, TIGHTER, constant_names, solve};
pub use ready::{Ready, SingleRun, ready, ready_to_run};
pub use removals::{removal, removal_names, removals};
pub use steps::{STEP_LIMIT, Steps, discrete_of, solve_by_steps};
pub use table::{FORMS, FORMULATIONS, formulation};
