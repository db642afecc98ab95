//! Tail probabilities of the normal and the χ² distribution.

use symbolic::limits::ITERATIONS;

/// `P(X > x)` of a χ² distribution with `k > 0` degrees of freedom: the incomplete gamma function
/// `Q(k/2, x/2)`, by its series where that converges fast and by a continued fraction otherwise.
///
/// ```
/// assert!((fit::chi_squared_tail(3.841458820694124, 1.0) - 0.05).abs() < 1e-12);
/// ```
pub fn chi_squared_tail(x: f64, k: f64) -> f64 {
    let (a, x) = (0.5 * k, 0.5 * x);
    if x.is_nan() || x <= 0.0 {
        return if x.is_nan() { f64::NAN } else { 1.0 };
    }
    let front = (a * x.ln() - x - ln_gamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-17 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return (1.0 - front * sum).clamp(0.0, 1.0);
    }
    // Lentz: 1/(x + 1 − a − 1(1 − a)/(x + 3 − a − …))
    let mut b = x + 1.0 - a;
    let (mut c, mut d) = (f64::INFINITY, 1.0 / b);
    let mut value = d;
    for i in 1..100_000 {
        let step = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = 1.0 / (step * d + b);
        c = b + step / c;
        let factor = c * d;
        value *= factor;
        if (factor - 1.0).abs() < 1e-16 {
            break;
        }
    }
    (front * value).clamp(0.0, 1.0)
}

/// `P(|Z| > z)` of a normal distribution.
pub fn normal_tails(z: f64) -> f64 {
    chi_squared_tail(z * z, 1.0)
}

/// `ln Γ(a)`, a > 0: Stirling's series after a shift to a ≥ 15.
fn ln_gamma(a: f64) -> f64 {
    let (mut a, mut shift) = (a, 0.0);
    while a < 15.0 {
        shift += a.ln();
        a += 1.0;
    }
    let s = 1.0 / (a * a);
    let series = (1.0 / 12.0 - s * (1.0 / 360.0 - s * (1.0 / 1260.0 - s * (1.0 / 1680.0 - s / 1188.0)))) / a;
    (a - 0.5) * a.ln() - a + 0.5 * (2.0 * std::f64::consts::PI).ln() + series - shift
}

/// χ² by which a number of 95 % rises.
pub const RISE: f64 = 3.841_458_820_694_124;

/// A formulation with one unknown less than that of the least χ², or with as many, is excluded where its χ²
/// is this much above: by noise, where it is right, in one of 9,300 films.
pub const EXCLUDED: f64 = 15.0;

/// χ² by which a number of 95 % rises where it is at its bound: `½χ²₀ + ½χ²₁`.
pub(crate) fn rise_at_bound() -> f64 {
    exceeded(2.0 * chi_squared_tail(RISE, 1.0), 1.0)
}

/// What χ² has to be above the least for an exclusion at the same level, where the other has `more ≥ 1`
/// unknowns: noise lowers χ² by a χ² distribution with as many degrees of freedom.
pub fn threshold(more: usize) -> f64 {
    if more > 1 { exceeded(chi_squared_tail(EXCLUDED, 1.0), more as f64) } else { EXCLUDED }
}

/// What χ² of so many degrees of freedom exceeds at this probability, of one that [`EXCLUDED`] has or more.
fn exceeded(level: f64, freedom: f64) -> f64 {
    let (mut low, mut high) = (0.0, 4.0 * (EXCLUDED + freedom));
    for _ in 0..ITERATIONS {
        let middle = 0.5 * (low + high);
        if chi_squared_tail(middle, freedom) > level { low = middle } else { high = middle }
    }
    high
}

/// Standard deviations of a normal distribution whose tails are as rare as χ² this far `above` with `more`
/// unknowns; `√above` where that is rarer than numbers can say.
pub(crate) fn sigmas(above: f64, more: usize) -> f64 {
    let rare = chi_squared_tail(above, more.max(1) as f64);
    if rare < 1e-280 {
        return above.sqrt();
    }
    let (mut low, mut high) = (0.0, above.sqrt());
    for _ in 0..ITERATIONS {
        let middle = 0.5 * (low + high);
        if normal_tails(middle) > rare { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
