//! Orders of runs of the engine.

use engine::{Level, order};

#[test]
fn the_order_of_a_power_is_its_exponent() {
    let level = |dt: f64| Level { dt, distances: vec![3.0 * dt.powf(1.5)], extrapolated: None, off_surface: 0.0 };
    assert!((order(&[level(0.1), level(0.05), level(0.01)]) - 1.5).abs() < 1e-12);
}
