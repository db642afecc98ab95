//! # Fits of nonholonomic models to recordings (films): estimates, intervals, the formulation supported
//!
//! Given: a scene, films, and unknowns of the scene. A film is a table of times `t_k` and columns
//! `c(t, q, v, p)` with standard deviations σ; unknown numbers θ are parameters, start values, multipliers
//! `μ₀` or costates `P₀`, and those of the constraint law: ε, 1/N. In each formulation that is asked for,
//!
//! ```text
//! χ²(θ) = Σ ((c(t_k, q(t_k; θ), v(t_k; θ), θ) − seen_k)/σ)² + Σ ((θ_j − mean_j)/deviation_j)²
//! ```
//!
//! is minimised by Levenberg and Marquardt's method, with exact derivatives of the motions, from several
//! starts, and over beginnings of the films that become longer ([`search()`]).
//!
//! - [`Film::read`]: a film from CSV; errors name the line.
//! - [`Problem`]: residuals of several films in one formulation, with shared unknowns and others of their
//!   own.
//! - [`fit()`]: estimates, intervals of 95 %, tests on residuals ([`residual_tests`]).
//! - [`Identifiability`]: which unknowns films of some columns can show at all, by ranks over finite fields.
//! - [`standard_errors`]: accuracy expected of films that are not yet made; [`Design`]: the best film.
//! - [`fit_formulations`]: formulations side by side, and the verdict ([`Verdict`]).
//!
//! **Intervals.** `± 1.96` standard errors where χ² rises by 3.84 there, to 5 %, all others fitted again;
//! elsewhere by the profile. An unknown with a bound that is within reach, as ε ≥ 0, has an interval that
//! ends there if χ² at the bound is above the least by no more than 2.71: the difference is `½χ²₀ + ½χ²₁`
//! where the bound is the truth.
//!
//! **What films do not show.** Combinations of unknowns that change no residual are named ([`Fit::hidden`]),
//! and the intervals of these unknowns are infinite.
//!
//! **What it refuses.** Films that cannot be read, with the place ([`FitError`]). No verdict is given where
//! residuals of the best formulation fail their tests.

mod answer;
mod choose;
mod creep;
mod design;
mod distribution;
mod error;
mod explain;
mod film;
mod fit;
mod identifiability;
mod json;
mod known;
mod least;
mod minimum;
mod observation;
mod part;
mod planned;
mod problem;
mod profile;
mod quantity;
mod question;
mod residual_tests;
mod search;
mod settled;
mod shown;
mod unknown;
mod verdict;

pub use answer::fit_formulations;
pub use choose::Best;
pub use design::{Aim, Chosen, Design, Point, Range};
pub use distribution::{EXCLUDED, RISE, chi_squared_tail, normal_tails, threshold};
pub use error::FitError;
pub use film::{Column, Deviations, Film};
pub use fit::{Estimate, Fit, fit, profile};
pub use identifiability::Identifiability;
pub use json::{Designed, Fitted};
pub use planned::Sampling;
pub use problem::{Problem, Residual};
pub use quantity::{quantity, unit};
pub use question::{Question, ROBUST, formulations};
pub use residual_tests::{ResidualTest, residual_tests, runs, whiteness};
pub use search::{Excluding, Found, search};
pub use shown::{Shown, standard_errors};
pub use unknown::{Prior, Unknown};
pub use verdict::{Row, Verdict, significance, verdicts};
