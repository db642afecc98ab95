//! Claims T1–T18, each a check of one random system. Reports say what they say, checks what they assume.

mod agreement;
mod control;
mod dependence;
mod fairness;
mod growth;
mod invariance;
mod invariants;
mod kick;
mod natural;
mod null_tests;
mod realization;
mod within;
mod writings;

use motion::SolveError;
use symbolic::CompileError;

use super::{Case, Unjudged};
use referees::maggi::MaggiError;

pub use agreement::{DIVERGES, Divergence, integrals_put_in, solution};
pub use fairness::{denied, visible};
pub use growth::judge as judge_growth;
pub use null_tests::{NullTest, broken_null_test, null_test};
pub use realization::{VISIBLE, judge as judge_rate, shows_two_terms};

/// Why a check could not be made.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// A motion could not be computed.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The referee for Chetaev gave up.
    #[error("Maggi's equations: {0}")]
    Maggi(#[from] MaggiError),
    /// An expression of the check itself has no value.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The control could not be judged.
    #[error(transparent)]
    Unjudged(#[from] Unjudged),
}

/// One claim, or a group of them that shares its motions.
pub struct Check {
    /// Number of the theorem; 0 for what must hold within one formulation.
    pub theorem: u8,
    /// The claim in one line.
    pub title: &'static str,
    /// Whether it takes long and is run on a part of the systems only.
    pub thorough: bool,
    /// Puts it to the test.
    pub run: fn(&mut Case) -> Result<(), CheckError>,
}

/// Every check that is made on a random system. T13 has systems of its own: [`null_test`].
pub const CHECKS: &[Check] = &[
    check(0, "two derivations of each formulation give one motion, which keeps the constraint", within::check),
    check(0, "two derivations of each formulation give one motion, which keeps the constraint", natural::check),
    check(1, "integrable constraints: Chetaev, vakonomic and coordinate removal agree", agreement::integrable),
    check(2, "removed constraint is vakonomic motion of the augmented system", agreement::bridge),
    check(3, "coordinate removal and vakonomic are one family", agreement::bijection),
    check(4, "Chetaev and vakonomic do not depend on how constraints and coordinates are written", invariance::writing),
    check(4, "Chetaev and vakonomic do not depend on how constraints and coordinates are written", writings::check),
    check(5, "the leading divergence of vakonomic from Chetaev is the predicted one", growth::check),
    check(6, "energy is constant where it should be", invariants::energy),
    check(7, "vakonomic momenta of cyclic coordinates are constant", invariants::momentum),
    thorough(
        8,
        "viscosity leads to Chetaev for definite M, added mass to vakonomic, both at rate 1/N or faster",
        realization::check,
    ),
    check(9, "decision, proof and fit agree on whether Chetaev's motion is vakonomic", fairness::check),
    thorough(9, "decision, proof and fit agree on whether Chetaev's motion is vakonomic", fairness::fit),
    check(10, "time reversal and units change nothing", invariance::reversal_and_units),
    check(11, "Frobenius' test finds what the construction put in", agreement::frobenius),
    check(12, "the wrong formulation is flagged where it is wrong, and only there", control::check),
    check(14, "removal of nothing is Newton's motion where p_u = 0", agreement::sanity),
    thorough(15, "vakonomic and removal see L on f = 0 only", dependence::values_on_the_constraint),
    thorough(16, "L + dF/dt has the motions of L, and removal's constants are shifted", dependence::gauge),
    thorough(17, "kappa does not depend on how constraints are written", dependence::writing_of_the_family),
    thorough(18, "from a fixed mu0 the first-order law has to start with a kick", kick::check),
];

const fn check(theorem: u8, title: &'static str, run: fn(&mut Case) -> Result<(), CheckError>) -> Check {
    Check { theorem, title, thorough: false, run }
}

const fn thorough(theorem: u8, title: &'static str, run: fn(&mut Case) -> Result<(), CheckError>) -> Check {
    Check { theorem, title, thorough: true, run }
}

/// What a theorem says, in a line; T13, whose systems are not random ones, included.
pub fn theorem_title(theorem: u8) -> &'static str {
    if theorem == 13 {
        return "null tests: Appell–Hamel, Heisenberg and rolling disc, with random numbers";
    }
    CHECKS.iter().find(|check| check.theorem == theorem).map_or("", |check| check.title)
}

/// Makes one check; a motion that cannot be computed leaves it undecided.
pub fn make(check: &Check, case: &mut Case) {
    if let Err(error) = (check.run)(case) {
        case.found.undecided(check.theorem, check.title, error);
    }
}
