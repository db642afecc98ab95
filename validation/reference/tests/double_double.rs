//! Accuracy of double-double arithmetic, measured against correctly rounded numbers of 300 bits.

use dashu_float::FBig;
use dashu_float::round::mode::HalfEven;
use mechanics::linear::Factors;
use reference::{DoubleDouble, Entry};
use symbolic::{Scalar, SplitMix};

type Exact = FBig<HalfEven, 2>;

const BITS: usize = 300;

fn exact(x: f64) -> Exact {
    Exact::try_from(x).unwrap().with_precision(BITS).value()
}

fn value(x: DoubleDouble) -> Exact {
    let (high, low) = x.parts();
    exact(high) + exact(low)
}

/// A random number of 106 bits between the bounds, on a logarithmic scale where they have one sign.
fn between(random: &mut SplitMix, low: f64, high: f64) -> DoubleDouble {
    let unit = random.unit();
    let x = if low > 0.0 { low * (high / low).powf(unit) } else { low + (high - low) * unit };
    DoubleDouble::sum(x, x * f64::EPSILON * (random.unit() - 0.5))
}

/// Largest relative error of `ours` against `theirs` over 300 pairs.
fn worst(
    ranges: [(f64, f64); 2],
    ours: impl Fn(DoubleDouble, DoubleDouble) -> DoubleDouble,
    theirs: impl Fn(&Exact, &Exact) -> Exact,
) -> f64 {
    let mut random = SplitMix::new(1);
    let mut worst = 0.0_f64;
    for _ in 0..300 {
        let [a, b] = ranges.map(|(low, high)| between(&mut random, low, high));
        let right = theirs(&value(a), &value(b));
        let difference = value(ours(a, b)) - &right;
        let relative = (difference.to_f64().value() / right.to_f64().value()).abs();
        worst = worst.max(relative);
        assert!(relative.is_finite(), "{a:?} {b:?} {:?}", ours(a, b));
    }
    worst
}

#[test]
fn arithmetic_has_107_bits() {
    let wide = [(1e-6, 1e6), (1e-6, 1e6)];
    let check = |name: &str, error: f64, limit: f64| {
        assert!(error < limit, "{name}: {error:.2e}");
    };
    check("a + b", worst(wide, |a, b| a + b, |a, b| a + b), 4e-32);
    check("a - b", worst([(0.5, 2.0), (0.5, 2.0)], |a, b| a - b, |a, b| a - b), 4e-32);
    check("a * b", worst(wide, |a, b| a * b, |a, b| a * b), 6.2e-32);
    check("a / b", worst(wide, |a, b| a / b, |a, b| a / b), 8e-32);
    check("sqrt", worst(wide, |a, _| a.sqrt(), |a, _| a.sqrt()), 8e-32);
    let ratio = DoubleDouble::from_ratio(981, 100);
    assert!((value(ratio) * exact(100.0) - exact(981.0)).to_f64().value().abs() < 1e-28);
    let large = i64::MAX - 1;
    let (high, low) = DoubleDouble::from_ratio(large, 1).parts();
    assert_eq!(high as i128 + low as i128, i128::from(large));
}

#[test]
fn functions_have_100_bits() {
    let one = (1.0, 1.0);
    type Ours = fn(DoubleDouble) -> DoubleDouble;
    type Theirs = fn(&Exact) -> Exact;
    let cases: [(&str, (f64, f64), Ours, Theirs); 25] = [
        ("sin", (-0.8, 0.8), |x| x.sin(), |x| x.sin()),
        ("sin", (1e-3, 3.0), |x| x.sin(), |x| x.sin()),
        ("sin", (-1e3, 1e3), |x| x.sin(), |x| x.sin()),
        ("cos", (-1e3, 1e3), |x| x.cos(), |x| x.cos()),
        ("sin", (1e3, 1e9), |x| x.sin(), |x| x.sin()),
        ("tan", (-100.0, 100.0), |x| x.tan(), |x| x.tan()),
        ("exp", (-1.0, 1.0), |x| x.exp(), |x| x.exp()),
        ("exp", (-300.0, 300.0), |x| x.exp(), |x| x.exp()),
        ("log", (1e-10, 1e10), |x| x.log(), |x| x.ln()),
        ("log", (0.85, 1.15), |x| x.log(), |x| x.ln()),
        ("sinh", (-0.5, 0.5), |x| x.sinh(), |x| x.sinh()),
        ("sinh", (-30.0, 30.0), |x| x.sinh(), |x| x.sinh()),
        ("cosh", (-30.0, 30.0), |x| x.cosh(), |x| x.cosh()),
        ("tanh", (-3.0, 3.0), |x| x.tanh(), |x| x.tanh()),
        ("tanh", (1e-5, 60.0), |x| x.tanh(), |x| x.tanh()),
        ("asin", (-0.999, 0.999), |x| x.asin(), |x| x.asin()),
        ("acos", (-0.999, 0.9), |x| x.acos(), |x| x.acos()),
        ("atan", (1e-6, 1e6), |x| x.atan(), |x| x.atan()),
        ("atan", (-2.0, 2.0), |x| x.atan(), |x| x.atan()),
        ("asinh", (1e-6, 1e6), |x| x.asinh(), |x| x.asinh()),
        ("asinh", (-1.0, 1.0), |x| x.asinh(), |x| x.asinh()),
        ("acosh", (1.0001, 1e6), |x| x.acosh(), |x| x.acosh()),
        ("atanh", (-0.99, 0.99), |x| x.atanh(), |x| x.atanh()),
        ("atanh", (1e-8, 0.1), |x| x.atanh(), |x| x.atanh()),
        ("sqrt", (1e-200, 1e-150), |x| x.sqrt(), |x| x.sqrt()),
    ];
    for (name, range, ours, theirs) in cases {
        let error = worst([range, one], |x, _| ours(x), |x, _| theirs(x));
        assert!(error < 8e-31, "{name} on {range:?}: {error:.2e}");
    }
    // the logarithm of the base times the exponent is what rounding acts on
    let error = worst([(0.1, 10.0), (-3.0, 3.0)], |x, y| x.powf(y), |x, y| x.powf(y));
    assert!(error < 2e-30, "powf: {error:.2e}");
    let error = worst([(-3.0, 3.0), (-3.0, 3.0)], |y, x| y.atan2(x), |y, x| y.atan2(x));
    assert!(error < 8e-31, "atan2: {error:.2e}");
}

#[test]
fn integer_powers_keep_the_sign_of_the_base() {
    let minus_two = DoubleDouble::from_f64(-2.0);
    assert_eq!(minus_two.powf(DoubleDouble::from_f64(3.0)).parts(), (-8.0, 0.0));
    assert_eq!(minus_two.powf(DoubleDouble::from_f64(-2.0)).parts(), (0.25, 0.0));
    assert!(minus_two.powf(DoubleDouble::from_f64(0.5)).parts().0.is_nan());
    assert!(minus_two.log().parts().0.is_nan() && minus_two.sqrt().parts().0.is_nan());
    assert!(DoubleDouble::from_f64(2.0).asin().parts().0.is_nan());
}

#[test]
fn linear_systems_are_solved_to_the_last_digits_in_any_units() {
    // [ 2 0 −1; 0 1 −1; 1 1 0 ] z = (1, 2, 3), z = (2/3, 7/3, 1/3)
    for unit in [1e-12, 1.0, 1e12] {
        let number = DoubleDouble::from_f64;
        let (u, zero, one) = (number(unit), number(0.0), number(1.0));
        let mut factors = Factors::new(3);
        factors.factorize(&[number(2.0), zero, -u, zero, one, -u, u, u, zero]).unwrap();
        let mut z = [one, number(2.0), u * number(3.0)];
        factors.solve(&mut z);
        let right = [(2, 3), (7, 3), (1, 3)].map(|(p, q)| DoubleDouble::from_ratio(p, q));
        assert!((z[0] - right[0]).size().max((z[1] - right[1]).size()) < 1e-30);
        assert!((z[2] * u - right[2]).size() < 1e-30);
    }
}
