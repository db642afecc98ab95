//! Round-off that is followed back by adjoints, beside round-off along paths.

use std::collections::HashMap;

use symbolic::{Bounded, Expr, Function, Graph, Scalar};

/// The magnitudes of one expression of `names` by adjoints, and along paths.
fn both(g: &Graph, names: &[&str], e: Expr, at: &[f64]) -> [f64; 2] {
    let symbols: Vec<_> = names.iter().map(|name| g.symbol(name)).collect();
    let tape = g.compile(&symbols, &[e], &HashMap::new()).unwrap();
    let recorded = tape.record(at, &mut tape.workspace());
    let sizes: Vec<f64> = at.iter().map(|x| x.abs()).collect();
    let inputs: Vec<Bounded> = at.iter().map(|&x| Scalar::from_f64(x)).collect();
    let mut value = [Bounded { value: 0.0, magnitude: 0.0 }];
    tape.evaluate(&inputs, &mut tape.workspace(), &mut value);
    [recorded.magnitudes(&[vec![(0, 1.0)]], &sizes)[0], value[0].magnitude]
}

#[test]
fn every_kind_of_instruction_has_its_slopes() {
    let g = Graph::new();
    let [x, y, z] = ["x", "y", "z"].map(|name| g.variable(g.symbol(name)));
    let (a, b) = (0.6_f64, 0.7_f64);
    let call = |f| g.call(f, x);
    let known: Vec<(Expr, f64)> = vec![
        (g.powi(x, 2), a * 2.0 * a + a * a),
        (g.powi(x, -1), 2.0 / a),
        (g.sqrt(x), 0.5 * a.sqrt() + a.sqrt()),
        (call(Function::Exp), (a + 1.0) * a.exp()),
        (call(Function::Tanh), a / a.cosh().powi(2) + a.tanh()),
        (g.sub(x, y), a + b + (a - b).abs()),
        (g.div(x, y), 3.0 * a / b),
        (g.add(g.mul(x, y), z), 3.0 * a * b + 0.4 + (a * b + 0.4)),
        (g.product(&[x, y, z]), 5.0 * a * b * 0.4),
        (g.pow(x, y), a.powf(b) * (b + b * a.ln().abs() + 1.0)),
    ];
    for (e, expected) in known {
        let [found, _] = both(&g, &["x", "y", "z"], e, &[a, b, 0.4]);
        assert!((found - expected).abs() < 1e-12 * expected, "{}: {found} {expected}", g.plain(e));
    }
    // both from one instruction: (sin x cos x)' = cos 2x
    let e = g.mul(call(Function::Sin), call(Function::Cos));
    let expected = a * (2.0 * a).cos() + 3.0 * a.sin() * a.cos();
    let [found, _] = both(&g, &["x", "y", "z"], e, &[a, b, 0.4]);
    assert!((found - expected).abs() < 1e-12 * expected, "{found} {expected}");
}

/// Forty rotations by 45°: 2²⁰ along paths, and no more than a term per operation by adjoints.
#[test]
fn rotations_do_not_add_up() {
    let g = Graph::new();
    let [mut x, mut y, t] = ["x", "y", "t"].map(|name| g.variable(g.symbol(name)));
    let (sin, cos) = (g.call(Function::Sin, t), g.call(Function::Cos, t));
    for _ in 0..40 {
        (x, y) = (g.sub(g.mul(x, cos), g.mul(y, sin)), g.add(g.mul(x, sin), g.mul(y, cos)));
    }
    let quarter = std::f64::consts::FRAC_PI_4;
    let [adjoint, paths] = both(&g, &["x", "y", "t"], x, &[1.0, 0.5, quarter]);
    assert!(paths > 2_f64.powi(20) && adjoint < 40.0 * 20.0, "{adjoint} {paths}");
}
