//! # deltaq: the competing equations of motion of nonholonomic systems
//!
//! A system is a Lagrangian `L(q, v, t)`, `q ∈ Rⁿ`, with constraints `f(q, v, t) = 0 ∈ Rʰ` and forces `Q`.
//! Its equations of motion depend on what a virtual displacement may be: d'Alembert and Lagrange's rule
//! (Chetaev's, where `f` is nonlinear in `v`), stationary action among the curves with `f = 0` (vakonomic),
//! or Gao's removal of the constraint. deltaq derives them, integrates them with error estimates, and decides
//! whether they agree.
//!
//! These are the names met first. The crates they come from stand beside them, with everything else:
//! [`scene`] (systems as text), [`mechanics`] and [`symbolic`] (systems as expressions), [`motion`]
//! (formulations, trajectories, ensembles, two-point problems), [`comparison`] (gaps, verdicts, proofs).
//!
//! ```
//! use deltaq::scene::Scene;
//! use deltaq::{CHETAEV, Settings, choices, error_estimate, setting, solve_choice};
//!
//! let scene = Scene::parse("skate", r#"
//! title = "Skate on level ice, at 1 m/s and turning at 1 rad/s"
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
//! "#)?;
//! let chetaev = choices(&scene).into_iter().find(|choice| choice.formulation == CHETAEV).ok_or("none")?;
//! let mut motion = solve_choice(&scene, &chetaev, &Settings::default())?;
//! let error = error_estimate(&mut motion, setting(&scene))?.coordinates[0];
//! // a circle of radius 1
//! assert!((motion.at(2.0)?.coordinates[0] - f64::sin(2.0)).abs() < 10.0 * error.max(1e-12));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The feature `program`, on by default, builds the command `deltaq` and brings `integrals` (measures,
//! integrals, certificates as JSON); a library does without: `default-features = false`.

#[cfg(feature = "program")]
pub use integrals;
pub use {comparison, mechanics, motion, scene, symbolic};

pub use comparison::{Comparison, Gap, Membership, Verdict, compare, compare_motions, compare_unfitted, membership};
pub use motion::{
    CHETAEV, Choice, Ending, Ensemble, ErrorEstimate, FORMULATIONS, Metric, Model, Motion, REMOVED_CONSTRAINT,
    Settings, SolveError, VAKONOMIC, choices, code, connect, derive, equations_of, error_estimate, setting, solve,
    solve_choice,
};
