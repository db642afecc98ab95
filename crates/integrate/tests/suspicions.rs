//! What may have been passed over between two instants: zeros of divisors, and gauges that grow.

use integrate::divisor_zeros::may_vanish;
use integrate::{GAUGE_LIMIT, GAUGE_NODES, Gauge, gauge_growth};

#[test]
fn zeros_and_near_zeros_are_suspected_and_no_others() {
    for values in [[1.0, -1.0, 1.0], [1.0, 0.5, -0.1], [0.0, 1.0, 2.0], [-1.0, -0.2, 1.0]] {
        assert!(may_vanish(values), "{values:?}");
    }
    // r² on a straight line that passes at b
    let passing = |place: f64, b: f64| [0.0, 0.5, 1.0].map(|theta: f64| (theta - place).powi(2) + b * b);
    for place in [0.05, 0.3, 0.5, 0.9] {
        assert!(may_vanish(passing(place, 1e-9)) && may_vanish(passing(place, 1e-3)), "{place}");
    }
    for values in [[1.0, 1.0, 1.0], [1.0, 2.0, 4.0], passing(0.5, 1.0), passing(1.5, 1e-9), passing(-0.2, 0.0)] {
        assert!(!may_vanish(values) && !may_vanish(values.map(|x| -x)), "{values:?}");
    }
}

fn of(gauge: Gauge, x: impl Fn(f64) -> f64) -> f64 {
    gauge_growth(gauge, &std::array::from_fn(|k| x(k as f64 / (GAUGE_NODES - 1) as f64)))
}

#[test]
fn what_is_passed_over_is_seen_and_what_is_constant_is_not() {
    let tanh: Gauge = |x| x.clamp(-20.0, 20.0);
    let exp: Gauge = |x| x.max(-40.0);
    assert_eq!(of(tanh, |t| 1000.0 * t - 500.0), 40.0);
    assert_eq!(of(tanh, |t| 100.0 * t - 500.0), 0.0);
    assert!(of(tanh, |t| 3.0 * t) <= 3.0 + 1e-12);
    // a bell a thousandth of the step wide, with a round or with a flat top, at any place
    for place in (1..100).map(|i| f64::from(i) / 100.0) {
        for (power, width) in [(2, 1e-3), (2, 1e-8), (4, 1e-3), (4, 1e-6), (8, 1e-3), (20, 1e-3)] {
            let grown = of(exp, |t| -((t - place) / width).powi(power));
            assert!(grown > GAUGE_LIMIT, "{place}, {power}: {grown}");
        }
    }
    let root: Gauge = |x| x.max(1e-20).ln();
    assert!(of(root, |t| (t - 0.3).powi(2) + 1e-16) > GAUGE_LIMIT);
    // what overflows on both sides hides nothing
    assert!(of(exp, |t| if (t - 0.5).abs() < 0.1 { 1.0 } else { f64::NEG_INFINITY }) > 40.0);
}
