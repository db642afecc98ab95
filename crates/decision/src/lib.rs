//! # Is this motion a motion of the other formulation?
//!
//! A vakonomic motion depends on `(q₀, v₀)` and on free constants `μ₀`, a removed-constraint motion on `P(t₀)`. Given a curve `q(t)`, Chetaev's
//! motion say, is there a choice of the constants for which it is the motion? The question is linear: it is decided, not searched, and a no is proved.
//!
//! **The condition.** Along a curve with `f = 0` everything is known but the multipliers. Write `A = ∂f/∂v` (h×n), `Ȧ` for its rate along the curve,
//! the curve's own acceleration in it, `C = f_qᵀ − Ȧᵀ` (n×h), and `E = d/dt L_v − L_q − Q`. The curve is vakonomic iff there is a `μ(t)` with
//!
//! ```text
//! Aᵀ μ̇ = C μ − E .                     along Chetaev's motion E = Aᵀλ:   Aᵀ (μ̇ + λ) = C μ
//! ```
//!
//! **Forces** act in every formulation alike, by `∫ (δL + Q·δq) dt = 0` for the variations `δq` that its principle admits: so `E` has lost `Q`.
//!
//! **Any family.** Nothing of this is typed here. [`Family`] reads it from the derived equations of a formulation: their residuals `R` are affine in
//! its costates `η` (`μ`, or `P` and what goes with it) and in the unknowns `z` of one instant (`a` and `μ̇`, or `ü`), so that
//!
//! ```text
//! R = J z + R_η η + R₀ ,        J = ∂R/∂z ,    R_η = ∂R/∂η        (vakonomic: R_η = −C, J = [M Aᵀ; A 0] at μ = 0) .
//! ```
//!
//! With the curve's own accelerations in `R₀`, `J Δz = −(R_η η + R₀)` gives `η̇` where that is an unknown, and the difference `y` between the
//! acceleration that the family's equations ask for and that of the curve. Along Chetaev's motion `y = Π (Cμ − Aᵀλ)` with `Π` from the bordered matrix,
//! and `η̇ = XCη − λ`. The curve is in the family iff `y ≡ 0`. Equations of another formulation that are affine in their costates need no line here.
//!
//! **The set.** `η = Φ c + φ` for constants `c`, with `Φ` and `φ` integrated beside the curve; so `y = O(t) c + y₀(t)`, and
//! `{c : y ≡ 0}` is an affine space: empty, a point, …, everything. Its dimension is the number of independent abnormal lifts of the curve
//! (integrable `f`: h; a contact constraint: 0; a disc that rolls straight: 1).
//!
//! **Decided in floating point** ([`decide`]). The rows `√w √M [O | y₀]` at 256 Gauss nodes or more go into one triangular matrix: the least of `∫ |y|²_M dt`
//! is `ρ²`. The same from a looser run gives the noise, `‖difference of the rows‖ √(1 + |c*|²)`, and at least 1e-14 of all that was added up. `ρ` over ten
//! times the noise: *not contained*. Otherwise *contained*, of the dimension of the directions in which the rows are noise; *undecided* where the noise is
//! over 1e-6 of the curve's own acceleration, unless that is round-off of what balances at rest. This is judged up to ten times of the run: what no
//! constants can do up to one of these they cannot do at all, and otherwise the longest time that is not too loud counts ([`Decision::until`]).
//! The element of least norm is the first guess for whoever fits.
//!
//! **Proved over a finite field** ([`Question::prove`]). The Taylor coefficients `y_k = O_k c + y₀_k` at the start are algebraic in the numbers of the scene. With
//! fractions for these, and sines, cosines and exponentials of fractions, they lie in `Q(i)(T, S)`, `T = e^{i/N}`, `S = e^{1/N}` independent
//! (Lindemann, Weierstrass); `T ↦ τ`, `S ↦ σ`, `i ↦ √−1` into the field of `p ≈ 2^60` elements is a homomorphism where nothing divided by is 0. A minor of `[O | y₀]` that is not zero
//! there is not zero. So rank `[O | y₀]` = h + 1 at some order proves that *this very start* has no constants, and, the minor being analytic on `f = 0`,
//! that *almost no* start has. [`Question::certificate`] writes down what others need to check that. Where at a random start the rank of both stays from one order to the next, all later coefficients follow from
//! the earlier ones, and almost every start *has* constants; so has this one, if its own rank is that one. At rest, where time stands nowhere, `η̇` is linear
//! in `η` with constant coefficients: coefficients of `y` follow from as many as there are costates, and one. Square roots of products of small primes
//! have images, too, and multiples of π/2 inside of sines and cosines; logarithms, other roots and π elsewhere have none: no proof, and
//! [`Finding::NotApplicable`] says why. Numbers are the decimals that they are written as; one that is π/2 or a multiple to all its digits is read as that.
//!
//! **Shown as an identity** ([`Question::section`]). `c = φ(q, v)`, sought among combinations of momenta, constants and velocities over random points of
//! the field, and verified at others: `μ = −L_ṡ` and the like. It holds at every start on the constraint.
//!
//! **The first difference** ([`Question::leading_difference`]), for any constants: the first `y_k ≠ 0` gives
//!
//! ```text
//! q_family − q_curve = y_k (t − t₀)^{k+2} / ((k+1)(k+2)) + …
//! ```
//!
//! Sources: A. D. Lewis, *Nonholonomic and constrained variational mechanics*, J. Geom. Mech. 12 (2020) 165; J. Cortés, M. de León, D. Martín de
//! Diego, S. Martínez 2003; O. Fernandez, A. Bloch 2008; M. Crampin, T. Mestdag 2010; M. Jóźwikowski, W. Respondek 2019.

mod certificate;
mod curve;
mod decide;
mod error;
mod exact;
mod family;
mod leading;
mod lift;
mod program;
mod proof;
mod section;
mod series;
mod start;
mod transport;

pub use certificate::Certificate;
pub use curve::{Curve, Flow, Known, Point};
pub use decide::{AffineSet, Decision, DecisionSettings, Verdict, decide, decide_flow};
pub use error::DecisionError;
pub use exact::Flaw;
pub use family::Family;
pub use leading::LeadingDifference;
pub use proof::{Finding, NoConstants, Proof, Question};
pub use section::Section;
pub use start::{ExactStart, NoExactStart};
