//! Puts claims to the test on systems drawn by proptest.

use std::cell::RefCell;

use proptest::strategy::Strategy;
use proptest::test_runner::{Config, FileFailurePersistence, RngSeed, TestCaseError, TestError, TestRunner};
use random::{CHECKS, Case, Findings, Kind, Recipe, Word, make, recipes_of};

/// Where the seeds of failures are kept.
const SEEDS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/properties.seeds");

/// The seed, unless `PROPTEST_RNG_SEED` gives another.
const SEED: u64 = 1894;

/// The part of the systems on which a claim may be undecided.
const UNDECIDED: f64 = 0.02;

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

/// A theorem's checks on `cases` systems of `kinds`: no claim may fail, next to none be undecided.
pub fn holds(theorem: u8, kinds: &[Kind], cases: u32) -> Findings {
    let all = RefCell::new((0_u32, 0_u32, Findings::default()));
    for_all(cases, &recipes_of(kinds), |recipe: Recipe| {
        let mut case = Case::new(recipe.clone(), "counterexample").map_err(|e| TestCaseError::fail(e.to_string()))?;
        for check in CHECKS.iter().filter(|check| check.theorem == theorem) {
            make(check, &mut case);
        }
        if let Some(f) = case.found.failures().next() {
            let scene = recipe.scene("counterexample").to_toml();
            let (claim, figure, limit) = (f.claim, f.figure, f.limit);
            return Err(TestCaseError::fail(format!(
                "T{theorem} {claim}: {figure:.3e}, limit {limit:.3e} {}\n{scene}",
                f.note
            )));
        }
        let (applied, undecided, sum) = &mut *all.borrow_mut();
        match case.found.word(theorem) {
            Some(Word::Undecided) => *undecided += 1,
            Some(_) => *applied += 1,
            None => {}
        }
        sum.join(case.found);
        Ok(())
    });
    let (applied, undecided, found) = all.into_inner();
    println!("T{theorem}: holds on {applied} systems, undecided on {undecided}");
    for f in found.findings.iter().filter(|f| f.word == Word::Undecided) {
        println!("   undecided: {}: {}", f.claim, f.note);
    }
    assert!(f64::from(undecided) <= UNDECIDED * f64::from(applied + undecided) + 1.0, "undecided on {undecided}");
    assert!(3 * applied >= cases, "T{theorem} applied to {applied} of {cases} systems only");
    found
}

/// The part of the systems of which something that is counted is so, and how many they were.
pub fn part(found: &Findings, what: &str) -> (f64, usize) {
    let values: Vec<f64> = found.observations.iter().filter(|o| o.what == what).map(|o| o.value).collect();
    println!("   {what}: {:.3} of {}", values.iter().sum::<f64>() / values.len() as f64, values.len());
    (values.iter().sum::<f64>() / values.len() as f64, values.len())
}
