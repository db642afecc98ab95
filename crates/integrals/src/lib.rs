//! # First integrals and invariant measures of nonholonomic systems: printed, counted, or proved not to exist
//!
//! There are two methods, both linear algebra over a finite field, on the numbers as they are written
//! ([`decision`] has the fields and says which numbers have images there).
//!
//! **Without an ansatz** ([`reversible`]): `L = ½ vᵀM(q)v − V(q)`, `A(q)v = 0`, no time, no forces. With a
//! basis `N` of `ker A`, `v = N s`, everything is a power series at a random point `q₀`: `N` by Gauss'
//! elimination of series, `M`, `V` from their values along curves.
//!
//! - *Measures* `e^{σ(q)} dq dp` need `X_b σ = −θ_b`. Brackets of the `X_b` determine further derivatives of
//!   `σ`; where brackets are linearly dependent, and these derivatives do not satisfy the same relation,
//!   there is no `σ`. With brackets in all directions that is one minor that is not zero mod p, so not zero
//!   at the point, so, analytic, at almost every point: [`Measure::None`], *proved*. Where brackets close
//!   without that, with ranks that two random points of two fields share, there is a `σ` near almost every
//!   point (Frobenius). [`Density`] gives it as a formula, if it is a product of powers of `det g`, sines and
//!   cosines. With `V = 0`, every smooth positive density near rest has such a `σ` in its first order; with a
//!   potential there may be others: on a spiral spring `V = kφ` the sleigh passes `ω = 0` once on every
//!   motion, and what that section carries is invariant. The equations without cyclic coordinates may have no
//!   measure where there is a `σ`: [`Cyclic`]. Where constraints are integrable in part, all this is said of
//!   almost every leaf, that of the start not always among them; constraints on positions `g(q) = 0` hold at
//!   the random points, and all is said of that leaf.
//! - *Multipliers* `f(r)` that make a reduced motion Hamilton's in a time with `dτ = f dt` ([`Multiplier`]).
//! - *Integrals* that are polynomials in the velocities: kernels of equations of Killing's kind on weighted
//!   Taylor coefficients. Every kernel bounds their number from above, as ranks mod p are lower bounds;
//!   [`Found::none_proved`] is where what is trivial (energy, constants, products) reaches it. The number
//!   itself is a matter of ranks at random points.
//!
//! *Near almost every point*: `σ` and coefficients are smooth there, may have periods round angles and be
//! singular elsewhere; the sleigh has two integrals linear in its velocities with coefficients like `cos(k
//! φ)`, `k` no integer. A measure here is `e^{σ(q)} dq dp`. Without a potential every measure that is smooth
//! and positive near rest is one; with a potential a density may depend on `p`, and where the motion does
//! not rest some always does nearby. For weaker ones see García-Naranjo, Ortega, Ureña 2024. Where something
//! varies under a root, all this is said of the branch of the start.
//!
//! **In an ansatz** ([`ansatz`]): any equations, affine, nonlinear, with forces and time. Which
//! combinations of given functions are constant on `{f = 0}`? Solutions are written in fractions, and
//! verified in another field.
//!
//! Sources: Y. Fedorov, L. García-Naranjo, J. Marrero, arXiv:1304.1788 (measures); A. Bellaïche, in
//! *Sub-Riemannian geometry*, 1996 (privileged coordinates); L. García-Naranjo, R. Ortega, A. Ureña,
//! arXiv:2404.14156.

mod ansatz;
mod answer;
mod certificate;
mod certified;
mod density;
mod flag;
mod functions;
mod json;
mod killing;
mod local;
mod multiplier;
mod open;
mod reversible;
mod ring;
mod words;

pub use ansatz::{Ansatz, Printed, ansatz, constants};
pub use answer::{Integrals, NoAnswer, watched};
pub use certificate::Certificate;
pub use certified::{Certified, NoMultipliers};
pub use density::Density;
pub use json::Answer;
pub use multiplier::{Multiplier, Reduction};
pub use open::Open;
pub use reversible::{Cyclic, Found, Measure, Reversed, reversible, reversible_scene};
