//! Stiff and extreme cases: is what comes back right, and where it is not, does it say so?
//!
//! A [`Question`] is one system at a point of a case in one formulation, with a [`Reference`] that does not
//! share the failure sought. All of [`diffsol_methods::EVERY`] answer, or structure-preserving steps of a
//! given length and every order; [`judge()`] says a word per [`Cell`]:
//!
//! ```text
//! accurate   complete;  error(t) ≤ max(10 e(t), b s(t), a s(t₁)) + u(t) at 201 times t, e ≤ 10⁻³ s at last
//! admitted   the same but for the last condition: the run says itself that it is not to be trusted
//! refused    a typed error; or stopped early with time and cause, and what comes before the stop is as above
//! wrong      anything else
//! ```
//!
//! `e(t)` is the largest difference of the motion's two runs up to `t`; `s(t)` the largest distance from the
//! start up to `t`, the first tenth of the run at least; `u(t)` what the reference itself may be off by; `b`
//! the larger of 10⁻⁷ and ten times the tolerance of the kept run, `a` the tolerance asked for; of a run that
//! stops at `t₂`, `a s(t₁)` is `a s(t₂) (t₁ − t₀)/(t₂ − t₀)`, as its tolerance was one for the whole, but no
//! more than `10⁻³ s(t₂)`. Lengths are in the kinetic metric, or, where a question asks for it
//! ([`Question::each`]), of each coordinate and multiplier by itself: the worst of them is the verdict. Where
//! 10 e(t) ≥ s(t) the motion does not claim a single digit, and nothing is asked of it.
//!
//! [`long_runs`] are judged likewise; beyond all references, by energy and constraint, not coordinates.

mod cases;
mod judge;
mod long_runs;
mod question;
mod reference;

pub use cases::CASES;
pub use judge::{Allowance, FLOOR, Verdict, judge};
pub use long_runs::{COMPARED, LONG, LONG_RUNS, Long, LongRun, long_runs};
pub use question::{Answering, Case, Cell, MAX_STEPS, Question, Stepped, Subject, Texts, run, tolerance};
pub use reference::{Known, MILLION, Reference};
