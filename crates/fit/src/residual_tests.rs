//! Tests whether residuals are independent, normal and of variance one, as they are for the right
//! formulation, numbers and standard deviations.

use schemars::JsonSchema;
use serde::Serialize;
use symbolic::SplitMix;

use crate::distribution::{chi_squared_tail, normal_tails};
use crate::problem::NOTHING;
use crate::{Film, Residual};

/// All tests together object to a right formulation in one of this many films.
const WRONGLY: f64 = 1000.0;
/// Residuals of a column that a test in time asks for.
const ENOUGH: usize = 12;
/// Lags of the test of whiteness, at most.
const LAGS: usize = 10;

/// Residuals of a column that are few, the probability that is looked at again for these, and the orders that
/// are drawn.
const MANY: usize = 100;
const DOUBTED: [f64; 2] = [1e-10, 1e-2];
const ORDERS: usize = 30_000;

/// A test and what it found.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ResidualTest {
    /// Its name: `chi squared`, `runs of x`, `whiteness of x`, `largest`.
    pub name: String,
    /// The value of the test statistic.
    pub found: f64,
    /// Its expected value.
    pub expected: f64,
    /// The probability of this value or of a rarer one.
    pub probability: f64,
    /// Whether the test rejects.
    pub objects: bool,
}

/// The name of the test of level.
const LEVEL: &str = "chi squared";

impl ResidualTest {
    /// Whether it finds residuals smaller than noise.
    pub fn is_too_small(&self) -> bool {
        self.name == LEVEL && self.found < self.expected
    }
}

/// The tests on residuals of films with `unknowns` fitted numbers; `robust` leaves out those that ask for
/// normal errors.
///
/// - *χ²* of all residuals, too large or too small, where no standard deviation is estimated;
/// - *runs* of one sign in each column (Wald and Wolfowitz);
/// - *whiteness* of each column: `n(n+2) Σ ρ_l²/(n−l)` over at most ten lags (Ljung and Box);
/// - the *largest* residual.
pub fn residual_tests(films: &[&Film], residuals: &[Residual], unknowns: usize, robust: bool) -> Vec<ResidualTest> {
    let mut tests = Vec::new();
    let mut add = |name: String, found: f64, expected: f64, probability: f64| {
        tests.push(ResidualTest { name, found, expected, probability, objects: false });
    };
    let count = residuals.len();
    let dof = count.saturating_sub(unknowns).max(1) as f64;
    if !robust {
        if !films.iter().any(|film| film.columns.iter().any(|column| column.estimated)) {
            let sum: f64 = residuals.iter().map(|r| r.value * r.value).sum();
            let tail = chi_squared_tail(sum, dof);
            add(LEVEL.into(), sum, dof, (2.0 * tail.min(1.0 - tail)).min(1.0));
        }
        let largest = residuals.iter().map(|r| r.value.abs()).fold(0.0, f64::max);
        let expected = (2.0 * (count as f64).ln()).sqrt();
        add("largest residual".into(), largest, expected, (count as f64 * normal_tails(largest)).min(1.0));
    }
    for (number, film) in films.iter().enumerate() {
        for (c, column) in film.columns.iter().enumerate() {
            let of = |r: &&Residual| r.film == number && r.column == c;
            let values: Vec<f64> = residuals.iter().filter(of).map(|r| r.value).collect();
            // what is no noise has no order, as in a column without any
            if values.len() < ENOUGH || values.iter().map(|r| r * r).sum::<f64>().sqrt() < NOTHING {
                continue;
            }
            let name = if films.len() > 1 { format!("{}@{}", column.name, number + 1) } else { column.name.clone() };
            let (found, expected, probability) = runs(&values);
            add(format!("runs of {name}"), found, expected, probability);
            let (found, expected, probability) = whiteness(&values);
            let probability = if values.len() < MANY { exchanged(&values, found, probability) } else { probability };
            add(format!("whiteness of {name}"), found, expected, probability);
        }
    }
    let limit = 1.0 / (WRONGLY * tests.len() as f64);
    tests.iter_mut().for_each(|test| test.objects = test.probability < limit);
    tests
}

/// The probability of Ljung's and Box's Q among few residuals, where that by χ² may be too small by far: the
/// part of random orders of the same residuals that have no less.
fn exchanged(values: &[f64], found: f64, probability: f64) -> f64 {
    if !(DOUBTED[0]..DOUBTED[1]).contains(&probability) {
        return probability;
    }
    let (mut random, mut order) = (SplitMix::new(values.len() as u64), values.to_vec());
    let mut as_large = 1_usize;
    for _ in 0..ORDERS {
        for i in (1..order.len()).rev() {
            order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
        as_large += usize::from(whiteness(&order).0 >= found);
        if as_large as f64 > DOUBTED[1] * ORDERS as f64 {
            break;
        }
    }
    (as_large as f64 / (ORDERS + 1) as f64).max(probability)
}

/// Runs of one sign, how many are expected, and the probability.
pub fn runs(values: &[f64]) -> (f64, f64, f64) {
    let n = values.len() as f64;
    let above = values.iter().filter(|x| **x > 0.0).count() as f64;
    let found = 1.0 + values.windows(2).filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0)).count() as f64;
    let expected = 2.0 * above * (n - above) / n + 1.0;
    let variance = (expected - 1.0) * (expected - 2.0) / (n - 1.0);
    if variance <= 0.0 {
        return (found, expected, 2.0 * 0.5_f64.powf(n));
    }
    (found, expected, normal_tails((found - expected) / variance.sqrt()))
}

/// Ljung's and Box's Q, its degrees of freedom, and the probability.
pub fn whiteness(values: &[f64]) -> (f64, f64, f64) {
    let n = values.len();
    let lags = LAGS.min(n / 4);
    let mean = values.iter().sum::<f64>() / n as f64;
    let deviations: Vec<f64> = values.iter().map(|x| x - mean).collect();
    let variance: f64 = deviations.iter().map(|x| x * x).sum();
    let correlation =
        |lag: usize| deviations.iter().zip(&deviations[lag..]).map(|(a, b)| a * b).sum::<f64>() / variance;
    let sum: f64 = (1..=lags).map(|lag| correlation(lag).powi(2) / (n - lag) as f64).sum();
    let found = n as f64 * (n as f64 + 2.0) * sum;
    (found, lags as f64, chi_squared_tail(found, lags as f64))
}
