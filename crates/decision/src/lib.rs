//! # Decides whether a trajectory solves the equations of another formulation
//!
//! A vakonomic motion depends on `(q₀, v₀)` and free constants `μ₀`, a removed-constraint motion on `P(t₀)`.
//! Whether a curve `q(t)` is such a motion is a linear problem in these constants: it is decided, and a no
//! proved.
//!
//! **The condition.** Along a curve with `f = 0` everything is known but the multipliers. Write `A = ∂f/∂v`
//! (h×n), `Ȧ` for its rate along the curve, with the curve's own acceleration, `C = f_qᵀ − Ȧᵀ` (n×h), and
//! `E = d/dt L_v − L_q − Q`. The curve is vakonomic iff there is a `μ(t)` with
//!
//! ```text
//! Aᵀ μ̇ = C μ − E .                     along Chetaev's motion E = Aᵀλ:   Aᵀ (μ̇ + λ) = C μ
//! ```
//!
//! **Forces**: `∫ (δL + Q·δq) dt = 0` in every formulation, for its variations `δq`; hence the `− Q` in `E`.
//!
//! **Any family.** None of these equations is written in this crate. [`Family`] extracts them from the
//! derived equations of a formulation: residuals `R` are affine in its costates `η` (`μ`, or `P` and what
//! goes with it) and in the unknowns `z` of one instant (`a` and `μ̇`, or `ü`), so that
//!
//! ```text
//! R = J z + R_η η + R₀ ,   J = ∂R/∂z ,   R_η = ∂R/∂η   (vakonomic: R_η = −C, J = [M Aᵀ; A 0] at μ = 0) .
//! ```
//!
//! With the curve's own accelerations in `R₀`, `J Δz = −(R_η η + R₀)` gives `η̇` where that is an unknown,
//! and the difference `y` between the acceleration required by the family's equations and that of the curve.
//! Along Chetaev's motion `y = Π (Cμ − Aᵀλ)` with `Π` from the bordered matrix, and `η̇ = XCη − λ`. The curve
//! is in the family iff `y ≡ 0`. Other formulations affine in their costates need no line here.
//!
//! **The set.** `η = Φ c + φ` for constants `c`, `Φ` and `φ` integrated beside the curve; so `y = O(t) c +
//! y₀(t)`, and `{c : y ≡ 0}` is an affine space: empty, a point, …, everything. Its dimension is the number
//! of independent abnormal lifts (integrable `f`: h; a contact constraint: 0; a disc that rolls straight: 1).
//!
//! **Decided in floating point** ([`decide`]). The rows `√w √M [O | y₀]` at 256 Gauss nodes or more go into
//! one triangular matrix: `ρ²` is the least `∫ |y|²_M dt`. A looser run gives the noise,
//! `‖difference of the rows‖ √(1 + |c*|²)`, at least 1e-14 of the sum of magnitudes. `ρ` over ten times the
//! noise: *not contained*. Else *contained*, of the dimension of the directions whose rows are noise;
//! *undecided* if the noise is over 1e-6 of the curve's own acceleration, unless that is round-off of what
//! balances at rest. This is judged up to several times within the run: if no constants fit up to one of
//! these, none fit at all; otherwise the longest time with low enough noise counts ([`Decision::until`]),
//! or that with the least where none is low enough. Noise is too high if some direction of the set is lost
//! in its own. `r` constants can make `r` derivatives of the mismatch zero, so that after a part `x` of
//! the run it may have grown to `x^r` of its size at the end: there, *contained* needs noise that much
//! lower. The least-norm element is the first guess for fits.
//!
//! **Proved over a finite field** ([`Question::prove`]). Taylor coefficients `y_k = O_k c + y₀_k` at the
//! start are algebraic in the scene's numbers. For fractions, roots of unity and sines, cosines, exponentials
//! of fractions they lie in `Q(ζ)(T, S)`, `T = e^{i/N}`, `S = e^{1/N}` independent (Lindemann, Weierstrass);
//! `T ↦ τ`, `S ↦ σ`, `ζ = e^{iπ/720720} ↦ z` into the field of `p ≈ 2^60` elements is a homomorphism where
//! nothing divided by is 0. A minor of `[O | y₀]` not zero there is not zero. So rank `[O | y₀]` = h + 1 at
//! some order proves that *this very start* has no constants and, as the minor is analytic on `f = 0`, that
//! *almost no* start of its branch has ([`Question::certificate`], for others to check). A zero in one field
//! is checked in a second one, and is still no proof: where both ranks stay the same from one order to the
//! next at random `(q, v, t)`, all later coefficients depend on them, and almost every start *has* constants;
//! so has this start, if its rank is the same. At rest, in an autonomous system, `η̇` is linear in `η` with
//! constant coefficients: for k costates the first k + 1 coefficients of `y` determine the others.
//!
//! **Numbers** are taken as written: decimals, formulas of them, multiples of π in sines and cosines, square
//! roots of products of small primes. Logarithms, other roots, π elsewhere and rounded numbers have no images
//! in a field: [`Finding::NotApplicable`] gives the reason.
//!
//! **An identity** ([`Question::section`]). `c = φ(q, v)`, for example `μ = −L_ṡ`, is searched for among
//! combinations of momenta, constants and velocities at random points of one field, and tested at points of a
//! second. It is proved if the equations along the curve, with it substituted, become the number zero
//! ([`Section::proved`]). It holds on `f = 0`.
//!
//! **The first difference** ([`Question::leading_difference`]), for any constants: the first `y_k ≠ 0` gives
//!
//! ```text
//! q_family − q_curve = y_k (t − t₀)^{k+2} / ((k+1)(k+2)) + …
//! ```
//!
//! Sources: A. D. Lewis, *Nonholonomic and constrained variational mechanics*, J. Geom. Mech. 12 (2020) 165;
//! J. Cortés, M. de León, D. Martín de Diego, S. Martínez 2003; O. Fernandez, A. Bloch 2008; M. Crampin, T.
//! Mestdag 2010; M. Jóźwikowski, W. Respondek 2019.

mod affine_set;
mod at_rest;
mod certificate;
mod curve;
mod decide;
mod error;
pub mod exact;
mod family;
mod flow;
mod identity;
mod leading;
mod leaf;
mod lift;
mod order_by_order;
mod plain_scene;
mod proof;
mod random_start;
mod scales;
mod section;
mod series;
mod sizes;
mod start;
mod transport;

pub use affine_set::AffineSet;
pub use certificate::{Certificate, Images, ImagesOfExponents};
pub use curve::{Curve, Dynamics, Flow, Known, Point};
pub use decide::{Decision, DecisionSettings, Verdict, decide, decide_flow};
pub use error::DecisionError;
pub use exact::Flaw;
pub use family::Family;
pub use leading::LeadingDifference;
pub use order_by_order::NoSeries;
pub use plain_scene::{Formulas, PlainScene};
pub use proof::{Finding, NoConstants, Proof, Question};
pub use random_start::{at_random, random_integer};
pub use section::Section;
pub use series::{CurveSeries, SeriesStart};
pub use sizes::CERTAINTY;
pub use start::{ExactStart, NoExactStart};
