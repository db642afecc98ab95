//! Removed-constraint equations of an ice sledge against `G` written by hand, derivatives by differences.

#[path = "../../chetaev/tests/differences.rs"]
#[allow(dead_code, reason = "shared with tests of other formulations")]
mod differences;

use differences::{derivative, rates};
use equations::Derivation;
use mechanics::{Removal, State, System};

/// `G(u̇, w, P)` for `x' = u' cos φ`, `y' = u' sin φ`; the parameters are `u` and `φ`.
fn generating(speeds: [f64; 2], [phi, x]: [f64; 2], [p_x, p_y]: [f64; 2]) -> f64 {
    let [u, turn] = speeds;
    (u * u + turn * turn) / 2.0 + x + p_x * u * phi.cos() + p_y * u * phi.sin()
}

#[test]
fn parameters_balance_and_costates_follow_the_memory() {
    let mut system = System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
    system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2 + x").expect("L");
    system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)").expect("f")];
    let start = State { t: 0.0, q: vec![0.0, 0.0, 0.3], v: vec![0.5, 0.5 * 0.3_f64.tan(), 1.0] };
    let removal = Removal::by_quasi_velocities(&system, &start).expect("a removal");
    let derivation = Derivation { removal: Some(&removal), all_costates: true, ..Default::default() };
    let equations = removed_constraint::derive(&system, &derivation).expect("derived");
    let values = [("u_x'", 0.8), ("phi", 0.3), ("phi'", 1.1), ("x", 0.4), ("y", -0.7), ("P_x", 0.6), ("P_y", -0.9)];
    let names: Vec<String> = equations.states.iter().map(|state| equations.graph.name(state.symbol)).collect();
    let value = |name: &str| values.iter().find(|(known, _)| *known == name).map_or(0.0, |(_, value)| *value);
    let y: Vec<f64> = names.iter().map(|name| value(name)).collect();
    let rates = rates(&equations, &y);
    let rate = |name: &str| rates[names.iter().position(|known| known == name).unwrap_or_else(|| panic!("{names:?}"))];

    let at = |name: &str, s: f64| value(name) + rate(name) * s;
    let g = |s: f64, change: [f64; 4]| {
        let speeds = [at("u_x'", s) + change[0], at("phi'", s) + change[1]];
        generating(speeds, [at("phi", s) + change[2], at("x", s) + change[3]], [at("P_x", s), at("P_y", s)])
    };
    let momentum = |i: usize, s: f64| derivative(|e| g(s, std::array::from_fn(|k| if k == i { e } else { 0.0 })));
    let along = derivative(|s| momentum(0, s));
    let turning = derivative(|s| momentum(1, s)) - derivative(|e| g(0.0, [0.0, 0.0, e, 0.0]));
    let memory = derivative(|e| g(0.0, [0.0, 0.0, 0.0, e]));
    let off = [along, turning, rate("P_x") + memory, rate("P_y"), rate("x") - 0.8 * 0.3_f64.cos()];
    assert!(off.iter().all(|off| off.abs() < 1e-7), "{off:?}");
}
