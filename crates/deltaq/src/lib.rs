//! One system with velocity constraints, several formulations of its motion: derive, integrate, compare.
//!
//! Given `L(q, v, t)` and `f(q, v, t) = 0`, what are the equations of motion? Three answers are in use, and they differ where `f` is not
//! integrable. Their derivations are the front pages of the crates `chetaev`, `vakonomic` and `removed_constraint`; this crate puts them
//! into one table, integrates them with one time loop, and says whether two motions are the same.
//!
//! - [`FORMULATIONS`]: the table.
//! - [`derive()`], [`solve`]: one motion, with its global error estimate.
//! - [`solve_by_steps`]: one motion by a discrete principle, in equal steps that keep its structure.
//! - [`prepare`]: the equations compiled and started, for single runs and for other integrators.
//! - [`Ensemble`]: many starts and parameters of one system at once.
//! - [`compare`]: a scene in every formulation, pair by pair, with the best fit of the free constants.

mod choice;
mod comparison;
mod constants;
mod discrete_run;
mod doubt;
mod ending;
mod ensemble;
mod equations_text;
mod error;
mod error_estimate;
mod fit;
mod fits;
mod gap;
mod growth;
mod integrability;
mod membership;
mod metric;
mod motion;
mod prepared;
mod runs;
mod settings;
mod single_run;
mod start_values;
mod steps;
mod table;
mod trajectory;

pub use choice::{
    Choice, choices, constants_of, default_constants, derive, derive_at, forms, removal, removal_names, removals,
    solve_choice,
};
pub use comparison::{Comparison, compare};
pub use constants::{constant_names, prepare};
pub use doubt::Doubt;
pub use ending::Ending;
pub use ensemble::{Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, MemberMotion, MemberRun, over_threads};
pub use equations_text::{EquationStyle, equations_text};
pub use error::SolveError;
pub use error_estimate::{ErrorEstimate, TRUSTED, error_estimate};
pub use fit::best_fit;
pub use fits::{Fit, FittedMotion};
pub use gap::{
    CERTAINTY, Gap, GapPoint, SAME_ESTIMATE, Sampling, THRESHOLDS, Verdict, compare_motions, compare_motions_by,
};
pub use growth::{Growth, LeadingTerm, growth};
pub use integrability::{integrability, integrals_by_ranks};
pub use membership::{Answer, Membership, Pairing, certificate, costates_of, membership, multipliers_of};
pub use metric::Metric;
pub use motion::{FormReport, Motion, Seconds, solve};
pub use prepared::Prepared;
pub use runs::{Decided, Pair, Run};
pub use settings::{Setting, Settings, TIGHTER, setting};
pub use single_run::SingleRun;
pub use steps::{STEP_LIMIT, Steps, discrete_of, solve_by_steps};
pub use table::{FORMS, FORMULATIONS, formulation};
