//! Lengths in the kinetic metric.

use mechanics::{Parameter, System};
use motion::Metric;
use symbolic::Graph;

/// `L = (m q + s t) q̇²/2`: a mass that changes with place, time and parameter, and its sign.
#[test]
fn what_was_asked_before_changes_no_length() {
    let mut system = System::new(Graph::new(), &[("q", "m")]);
    let [m, s] = ["m", "s"].map(|name| system.graph.symbol(name));
    system.parameters =
        vec![Parameter { symbol: m, value: 1.0, formula: None }, Parameter { symbol: s, value: 0.5, formula: None }];
    system.lagrangian = system.expression("(m*q + s*t)*q'^2/2").expect("a Lagrangian");
    let mut metric = Metric::varying(&system, &[m]).expect("a metric");
    for m in [1.0, -1.0, 4.0] {
        metric.set_parameters(&[m]);
        for (t, q) in [(0.0, 2.0), (0.0, 2.0), (0.0, -2.0), (2.0, -2.0), (2.0, 2.0), (0.0, 2.0)] {
            let length = f64::sqrt(f64::abs(m * q + 0.5 * t));
            for difference in [1.0, -3.0] {
                let found = metric.length(t, &[q], &[0.0], &[difference]);
                assert!((found - length * f64::abs(difference)).abs() < 1e-14, "{m}, {t}, {q}: {found}");
            }
            assert!((metric.distance(t, &[q], &[0.0], &[q + 2.0]) - 2.0 * length).abs() < 1e-14);
        }
    }
}
