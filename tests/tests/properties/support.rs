//! Puts claims to the test on systems drawn by proptest.

use std::cell::RefCell;
use std::sync::OnceLock;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, FileFailurePersistence, RngSeed, TestCaseError, TestError, TestRunner};
use random::{CHECKS, Case, Findings, Kind, Recipe, Word, integrals_put_in, make, recipes_of};

/// Where the seeds of failures are kept.
const SEEDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/properties.seeds");

/// The seed, unless `PROPTEST_RNG_SEED` gives another.
const SEED: u64 = 1894;

/// The theorem on what constraints leave.
const INTEGRABILITY: u8 = 11;

/// The part of the systems on which a claim may be undecided.
const UNDECIDED: f64 = 0.02;

/// The theorem on the leading divergence: its gap has to stand out of round-off near the start.
const LEADING: u8 = 5;
const OPEN: f64 = 0.05;

/// How often proptest may try a simpler system, and for how long, in ms.
const SHRINKING: u32 = 2_000;
const SHRINKING_TIME: u32 = 10_000;

fn runner(cases: u32) -> TestRunner {
    let mut config = Config::default();
    if config.cases == Config::with_cases(256).cases {
        config.cases = cases; // no number was asked for
    }
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(SEED);
    }
    config.max_shrink_iters = SHRINKING;
    config.max_shrink_time = SHRINKING_TIME;
    config.failure_persistence = Some(Box::new(FileFailurePersistence::Direct(SEEDS)));
    TestRunner::new(config)
}

/// Runs `test` on values of `strategy`; a failure is reported with what it was shrunk to.
pub fn for_all<S: Strategy>(cases: u32, strategy: &S, test: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    match runner(cases).run(strategy, test) {
        Ok(()) => {}
        Err(TestError::Fail(reason, _)) => panic!("{reason}"),
        Err(TestError::Abort(reason)) => panic!("aborted: {reason}"),
    }
}

/// Theorems that are put to the test on the same systems, derived and integrated once for all of them.
pub struct Suite {
    kinds: Vec<Kind>,
    /// On how many systems each theorem is.
    theorems: Vec<(u8, u32)>,
    /// Of each system, what all checks found; or why it has no motions.
    found: OnceLock<Vec<Result<Findings, String>>>,
}

impl Suite {
    /// Nothing is computed yet.
    pub fn new(kinds: Vec<Kind>, theorems: &[(u8, u32)]) -> Self {
        Suite { kinds, theorems: theorems.to_vec(), found: OnceLock::new() }
    }

    /// A theorem's checks on its systems: no claim may fail, next to none be undecided.
    pub fn holds(&self, theorem: u8) -> Findings {
        let (_, cases) = self.theorems.iter().find(|(of, _)| *of == theorem).expect("a theorem of these systems");
        let count = drawn(&self.kinds, *cases).len();
        let (mut applied, mut undecided, mut sum) = (0_u32, 0_u32, Findings::default());
        for found in self.found.get_or_init(|| self.all()).iter().take(count) {
            match found {
                Ok(found) if found.failures().all(|f| f.theorem != theorem && self.has(f.theorem)) => {
                    match found.word(theorem) {
                        Some(Word::Undecided) => undecided += 1,
                        Some(_) => applied += 1,
                        None => {}
                    }
                    sum.findings.extend(found.findings.iter().filter(|f| f.theorem == theorem).cloned());
                    sum.observations.extend(found.observations.iter().filter(|o| o.theorem == theorem).cloned());
                }
                wrong => {
                    shrunk(theorem, &self.kinds, *cases);
                    panic!("T{theorem}, on motions that other checks have looked at, too: {wrong:?}");
                }
            }
        }
        println!("T{theorem}: holds on {applied} systems, undecided on {undecided}");
        for f in sum.findings.iter().filter(|f| f.word == Word::Undecided) {
            println!("   undecided: {}: {}", f.claim, f.note);
        }
        let open = if theorem == LEADING { OPEN } else { UNDECIDED };
        assert!(f64::from(undecided) <= open * f64::from(applied + undecided) + 1.0, "undecided on {undecided}");
        assert!(3 * applied >= *cases, "T{theorem} applied to {applied} of {cases} systems only");
        sum
    }

    fn has(&self, theorem: u8) -> bool {
        self.theorems.iter().any(|(of, _)| *of == theorem)
    }

    /// Over all processors: tests that wait for this leave them idle.
    fn all(&self) -> Vec<Result<Findings, String>> {
        let drawn: Vec<_> =
            self.theorems.iter().map(|&(theorem, cases)| (theorem, drawn(&self.kinds, cases))).collect();
        let most = drawn.iter().map(|(_, recipes)| recipes).max_by_key(|recipes| recipes.len()).expect("a theorem");
        assert!(drawn.iter().all(|(_, recipes)| most.starts_with(recipes)), "theorems have systems of their own");
        motion::over_threads(0, most.len(), |i| {
            checked(&most[i], |theorem| drawn.iter().any(|(of, recipes)| *of == theorem && i < recipes.len()))
        })
    }
}

/// The systems that proptest draws, those of kept seeds first.
fn drawn(kinds: &[Kind], cases: u32) -> Vec<Recipe> {
    let all = RefCell::new(Vec::new());
    for_all(cases, &recipes_of(kinds), |recipe: Recipe| {
        all.borrow_mut().push(recipe);
        Ok(())
    });
    all.into_inner()
}

/// What the checks of some theorems find of a system.
fn checked(recipe: &Recipe, theorems: impl Fn(u8) -> bool) -> Result<Findings, String> {
    // what is asked of most systems, and needs none of their motions
    if CHECKS.iter().all(|check| theorems(check.theorem) == (check.theorem == INTEGRABILITY)) {
        let mut found = Findings::default();
        if let Err(error) = integrals_put_in(recipe, &recipe.scene("counterexample"), &mut found) {
            found.undecided(INTEGRABILITY, "what constraints leave", error);
        }
        return Ok(found);
    }
    let mut case = Case::new(recipe.clone(), "counterexample").map_err(|error| error.to_string())?;
    for check in CHECKS.iter().filter(|check| theorems(check.theorem)) {
        make(check, &mut case);
    }
    Ok(case.found)
}

/// Shrinks a system on which a theorem fails, by the checks of this theorem alone, and panics with it.
fn shrunk(theorem: u8, kinds: &[Kind], cases: u32) {
    for_all(cases, &recipes_of(kinds), |recipe: Recipe| {
        let found = checked(&recipe, |of| of == theorem).map_err(TestCaseError::fail)?;
        let Some(f) = found.failures().next() else { return Ok(()) };
        let scene = recipe.scene("counterexample").to_toml();
        let (claim, figure, limit) = (f.claim, f.figure, f.limit);
        let words = format!("T{theorem} {claim}: {figure:.3e}, limit {limit:.3e} {}\n{scene}", f.note);
        Err(TestCaseError::fail(words))
    });
}

/// The fraction of the systems that have the property `what`, and the number of systems.
pub fn part(found: &Findings, what: &str) -> (f64, usize) {
    let values: Vec<f64> = found.observations.iter().filter(|o| o.what == what).map(|o| o.value).collect();
    println!("   {what}: {:.3} of {}", values.iter().sum::<f64>() / values.len() as f64, values.len());
    (values.iter().sum::<f64>() / values.len() as f64, values.len())
}
