//! Systems from a few words.

use mechanics::{Parameter, State, System};
use symbolic::Graph;

/// A system with `L = Σ q̇²/2` in the named coordinates, and a generic state (not on the constraint).
pub fn kinetic(coordinates: &[&str], parameters: &[(&str, f64)], constraints: &[&str]) -> (System, State) {
    let named: Vec<(&str, &str)> = coordinates.iter().map(|&c| (c, "m")).collect();
    let mut system = System::new(Graph::new(), &named);
    let value = |&(name, value): &(&str, f64)| Parameter { symbol: system.graph.symbol(name), value, formula: None };
    system.parameters = parameters.iter().map(value).collect();
    let half_squares: Vec<String> = coordinates.iter().map(|c| format!("{c}'^2/2")).collect();
    let parse = |text: &str| system.expression(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    let (lagrangian, constraints) = (parse(&half_squares.join(" + ")), constraints.iter().map(|f| parse(f)).collect());
    (system.lagrangian, system.constraints) = (lagrangian, constraints);
    let spread = |first: f64, by: f64| (0..coordinates.len()).map(|i| first + by * i as f64).collect();
    (system, State { t: 0.2, q: spread(0.3, 0.4), v: spread(0.5, -0.2) })
}
