//! What one evaluation of all second derivatives of 𝓛 = L + μ·f costs: the velocity Hessian, ∂²𝓛/∂v∂q
//! and ∂𝓛/∂q.

use criterion::{Criterion, criterion_group, criterion_main};
use std::collections::HashMap;
use std::hint::black_box;
use symbolic::{Expr, Graph, Symbol, Tape};

const SLEDGE: &str = "(x'^2 + y'^2)/2 + k^2*phi'^2/2 + g*x*sin(alpha) + mu*(y'*cos(phi) - x'*sin(phi))";

const BALL_IN_CONE: &str = "m/2*(r'^2 + (r*sin(alpha) - a*cos(alpha))^2*gamma'^2)
    + m*k^2/2*(phi'^2 + (chi' + gamma')^2 + theta'^2 + 2*phi'*(chi' + gamma')*cos(theta))
    - m*g*r*cos(alpha)
    + mu1*(r*sin(alpha)*gamma' + a*theta'*cos(chi)*sin(alpha)
        + a*phi'*(sin(theta)*sin(chi)*sin(alpha) + cos(theta)*cos(alpha)) + a*chi'*cos(alpha))
    + mu2*(r' - a*theta'*sin(chi) + a*phi'*sin(theta)*cos(chi))";

/// The tape of the derivatives; inputs are coordinates, velocities, multipliers.
fn second_derivatives(
    lagrangian: &str,
    coordinates: &[&str],
    multipliers: &[&str],
    parameters: &[(&str, f64)],
) -> Tape {
    let graph = Graph::new();
    let symbols = |names: &[&str], prime: &str| -> Vec<Symbol> {
        names.iter().map(|name| graph.symbol(&format!("{name}{prime}"))).collect()
    };
    let q = symbols(coordinates, "");
    let v = symbols(coordinates, "'");
    let mu = symbols(multipliers, "");
    let constants: HashMap<Symbol, f64> = parameters.iter().map(|(name, value)| (graph.symbol(name), *value)).collect();
    let scope = |name: &str| graph.find_symbol(name).map(|s| graph.variable(s));
    let lagrangian = graph.parse(lagrangian, &scope, &[]).expect("a formula");
    let momenta = graph.gradient(lagrangian, &v);
    let outputs: Vec<Expr> = [
        graph.jacobian(&momenta, &v).entries(),
        graph.jacobian(&momenta, &q).entries(),
        &graph.gradient(lagrangian, &q),
    ]
    .concat();
    let inputs = [q, v, mu].concat();
    graph.compile(&inputs, &outputs, &constants).expect("all symbols are bound")
}

fn measure(criterion: &mut Criterion, name: &str, tape: &Tape) {
    let mut workspace = tape.workspace::<f64>();
    let inputs: Vec<f64> = (0..tape.inputs()).map(|i| 0.3 + 0.1 * i as f64).collect();
    let mut outputs = vec![0.0; tape.outputs()];
    let name = format!("{name} ({} outputs, {} instructions)", tape.outputs(), tape.len());
    criterion.bench_function(&name, |bencher| {
        bencher.iter(|| tape.evaluate(black_box(&inputs), &mut workspace, black_box(&mut outputs)));
    });
}

fn benchmarks(criterion: &mut Criterion) {
    let sledge = second_derivatives(SLEDGE, &["x", "y", "phi"], &["mu"], &[("k", 0.7), ("g", 9.81), ("alpha", 0.4)]);
    measure(criterion, "sledge", &sledge);
    let ball = second_derivatives(
        BALL_IN_CONE,
        &["r", "gamma", "phi", "chi", "theta"],
        &["mu1", "mu2"],
        &[("m", 1.0), ("a", 0.1), ("k", 0.1 * 0.4_f64.sqrt()), ("g", 9.81), ("alpha", 0.6)],
    );
    measure(criterion, "ball in cone", &ball);
}

criterion_group!(benches, benchmarks);
criterion_main!(benches);
