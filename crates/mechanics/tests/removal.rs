//! Removals: every fault is refused with its figures, automatic ones satisfy the constraints.

use mechanics::{
    ConstantsRule, Removal, RemovalError, StartData, StartError, complete_removal_start, complete_start,
    project_velocity,
};
use symbolic::SplitMix;

use crate::systems;

const KNIFE_EDGE: &str = "y'*cos(phi) - x'*sin(phi)";

#[test]
fn a_wrong_number_of_parameters() {
    let (system, state) = systems::kinetic(&["x", "y", "phi"], &[], &[KNIFE_EDGE]);
    let mut removal = Removal::by_coordinates(&system, &state).unwrap();
    removal.parameters.pop();
    removal.name = "short".into();
    let expected = RemovalError::WrongCount { removal: "short".into(), found: 1, expected: 2 };
    assert_eq!(removal.verify(&system), Err(expected));
}

#[test]
fn a_constraint_that_remains_is_shown_with_its_residual() {
    let (system, state) = systems::kinetic(&["x", "y", "z", "w"], &[], &["w' - x*x'", "z' - y*x'"]);
    let mut removal = Removal::by_coordinates(&system, &state).unwrap();
    removal.verify(&system).unwrap();
    let z = removal.memory.iter().position(|w| system.graph.name(w.symbol) == "z").expect("z depends on x");
    removal.memory[z].rate = system.expression("y*x' + 1e-3*x'").unwrap();
    let error = removal.verify(&system).unwrap_err();
    let RemovalError::ConstraintRemains { constraint, text, residual, limit, .. } = error else { panic!("{error}") };
    assert_eq!((constraint, text), (2, system.graph.plain(system.constraints[1])));
    assert!(residual.abs() > 100.0 * limit, "{residual} {limit}");
}

#[test]
fn a_constraint_that_is_nowhere_finite_cannot_be_checked() {
    let (system, state) = systems::kinetic(&["x", "y", "phi"], &[], &[KNIFE_EDGE]);
    let mut removal = Removal::by_coordinates(&system, &state).unwrap();
    removal.memory[0].rate = system.expression("sqrt(-1 - phi^2)*x'").unwrap();
    let error = removal.verify(&system).unwrap_err();
    assert!(matches!(&error, RemovalError::NotCheckable { constraint: 1, .. }), "{error}");
}

/// Products of such parameters are no fractions that fit: what cancels in them leaves `10⁻¹⁶ x'`.
#[test]
fn what_parameters_cancel_to_is_round_off() {
    let third = [("a", 0.3333333333333333), ("b", 0.7777777777777778), ("c", 0.1415926535897931)];
    let (system, state) = systems::kinetic(&["x", "y"], &third, &["y' - (a + b)*c*x'"]);
    let mut removal = Removal::by_coordinates(&system, &state).unwrap();
    let remains = |text: &str| {
        removal.memory[0].rate = system.expression(text).unwrap();
        removal.verify(&system).is_err()
    };
    let rates = ["x'*(a + b)*c", "a*c*x' + b*c*x'", "a*c*x' + b*c*x' + 1e-9*x'", "a*c*x' + (b + 1e-9)*c*x'"];
    assert_eq!(rates.map(remains), [false, false, true, true]);
}

/// Powers of `q` would add up a million to be powers of `q − 24`.
#[test]
fn far_from_the_origin_constraints_are_solved_without_a_loss_of_digits() {
    let constraints = [
        "(4*b' - (a - 24)^2)*(sin(a) + 4)/16",
        "b'/64 - d'/8 + (a - 24)^4/32 - (a - 24)^2/256 + (32*c' - 4*b' + 8*(24 - a)^3 + (a - 24)^2)*(sin(a) + 4)/128",
        "(sin(a) + 4)*(32*d' - 4*b' - 8*(a - 24)^4 + (a - 24)^2)/128",
    ];
    let (system, mut state) = systems::kinetic(&["a", "b", "c", "d"], &[], &constraints);
    state.q = vec![24.0; 4];
    let removal = Removal::by_coordinates(&system, &state).unwrap();
    state.q[0] = 24.25;
    for (w, power) in removal.memory.iter().zip([2, 3, 4]) {
        let (rate, expected) =
            (system.graph.evaluate(w.rate, &system.values_at(&state)).unwrap(), 0.25_f64.powi(power) / 4.0);
        assert!((rate - expected).abs() <= 1e-13 * expected, "{}: {rate} for {expected}", system.graph.plain(w.rate));
    }
}

#[test]
fn automatic_removals_need_linear_independent_constraints() {
    let automatic = [Removal::by_coordinates, Removal::by_quasi_velocities];
    let (cone, state) = systems::kinetic(&["x", "y", "z"], &[], &["x' - y'", "z'^2 - x'^2 - y'^2"]);
    for removal in automatic {
        let error = removal(&cone, &state).unwrap_err();
        assert!(matches!(&error, RemovalError::NotLinear { constraint: 2, text } if text.contains("z'")), "{error}");
    }
    let (twice, state) = systems::kinetic(&["x", "y", "z"], &[], &["z' - y*x'", "exp(x)*(z' - y*x')"]);
    for removal in automatic {
        let error = removal(&twice, &state).unwrap_err();
        assert!(matches!(error, RemovalError::Dependent { pivot, limit } if pivot < limit), "{error}");
    }
}

#[test]
fn automatic_removals_satisfy_the_constraints() {
    let four = ["x", "y", "psi", "phi"];
    let cases: [(&[&str], &[&str]); 8] = [
        (&["x", "y"], &[]),
        (&["x", "y", "phi"], &[KNIFE_EDGE]),
        (&["x", "y", "phi"], &["y'*cos(phi) - x'*sin(phi) - a*t"]),
        (&["x", "y"], &["2*x*x' + 2*y*y'"]),
        (&["x", "y", "z"], &["z' - (x*y' - y*x')/2"]),
        (&four, &["x' - a*psi'*cos(phi)", "y' - a*psi'*sin(phi)"]),
        (&four, &["x'*cos(y) + y'*(1 + phi^2) - psi'", "x' - exp(phi)*phi' + x*psi'"]),
        (&["x", "y", "z", "w", "s"], &["y' - z*x'", "z' - w*x'", "w' - s*x' + Omega*y"]),
    ];
    for (coordinates, constraints) in cases {
        let (system, state) = systems::kinetic(coordinates, &[("a", 0.7), ("Omega", 1.3)], constraints);
        let (state, _) = project_velocity(&system, &state).unwrap();
        for automatic in [Removal::by_coordinates, Removal::by_quasi_velocities] {
            let removal = automatic(&system, &state).unwrap();
            removal.verify(&system).unwrap_or_else(|e| panic!("{constraints:?}: {e}"));
            assert_eq!(removal.parameters.len(), coordinates.len() - constraints.len());
            assert_eq!(removal.constants, ConstantsRule::Zero);
            // velocities at the start come back
            let start = complete_removal_start(&system, &removal, &state).unwrap_or_else(|e| panic!("{e}"));
            let mut values = system.parameter_values();
            values.insert(system.time, state.t);
            values.extend(start.values());
            for (rate, v) in removal.velocities(&system).into_iter().zip(&state.v) {
                let found = system.graph.evaluate(rate, &values).unwrap();
                assert!((found - v).abs() < 1e-12, "{}, {constraints:?}: {found} for {v}", removal.name);
            }
        }
    }
}

#[test]
fn quasi_velocity_of_the_knife_edge_is_the_arc_length() {
    let (system, state) = systems::kinetic(&["x", "y", "phi"], &[], &[KNIFE_EDGE]);
    let (state, _) = project_velocity(&system, &state).unwrap();
    let removal = Removal::by_quasi_velocities(&system, &state).unwrap();
    let g = &system.graph;
    let blade = removal.parameters.iter().find(|u| u.coordinate.is_none()).expect("one parameter is not a coordinate");
    let velocities = removal.velocities(&system);
    let along = [system.expression("cos(phi)").unwrap(), system.expression("sin(phi)").unwrap()]
        .map(|e| g.mul(e, g.variable(blade.rate)));
    for (found, expected) in velocities.iter().zip(along) {
        let difference = g.vanishes(g.sub(*found, expected), &system.parameter_values());
        assert!(difference.is_zero(), "{} for {}", g.plain(*found), g.plain(expected));
    }
    let turning = removal.parameters.iter().find_map(|u| u.coordinate);
    assert_eq!(turning, Some(2));
    let start = complete_removal_start(&system, &removal, &state).unwrap().values();
    let speed = state.v[0] * state.q[2].cos() + state.v[1] * state.q[2].sin();
    assert!((start[&blade.rate] - speed).abs() < 1e-14);
    assert_eq!(start[&blade.symbol], 0.0);
    // q̇ = v is left of the parametrization, but for the turn, which is a coordinate; it holds at the start
    let residuals = removal.residuals(&system);
    assert_eq!(residuals.len(), 2);
    let mut values = system.values_at(&state);
    values.extend(start);
    for e in residuals {
        assert!(system.graph.evaluate(e, &values).unwrap().abs() < 1e-14, "{}", system.graph.plain(e));
    }
}

/// Found by random systems: a zero that did not simplify counted as a rate, and `q2' = 0` could not start.
#[test]
fn what_cancels_without_simplifying_is_zero() {
    let integrable = "(16*q3' - 3*q1'*cos(q1))";
    let mixed = [
        format!("3*q2'/8 + 9*(sin(q1) + 2)*{integrable}/2048 + {integrable}*(sin(q1) + 4)/64"),
        format!("(sin(q1) + 4)*(256*q2' + 3*(sin(q1) + 2)*{integrable})/1024"),
    ];
    let constraints: Vec<&str> = mixed.iter().map(String::as_str).collect();
    let (system, state) = systems::kinetic(&["q1", "q2", "q3"], &[], &constraints);
    let state = project_velocity(&system, &mechanics::State { v: vec![0.5, 0.3, 0.1], ..state }).unwrap().0;
    assert!(state.v[1].abs() < 1e-14, "{state:?}");
    for removal in [Removal::by_coordinates, Removal::by_quasi_velocities].map(|find| find(&system, &state).unwrap()) {
        let second = removal.memory.iter().find(|w| w.coordinate == Some(1)).expect("q2 is memory");
        assert!(system.graph.is_zero(second.rate), "{}", system.graph.plain(second.rate));
        complete_removal_start(&system, &removal, &state).unwrap();
    }
    let verdict = mechanics::integrability(&system, &state, 3.0).unwrap();
    assert!(matches!(verdict, mechanics::Integrability::Integrable { .. }), "{verdict}");
}

/// A supplied velocity that vanishes is the round-off of what cancels in its constraint, and no
/// contradiction.
#[test]
fn velocities_that_vanish_are_represented() {
    let mut random = SplitMix::new(16);
    let mut number = |from: f64, to: f64| (100.0 * (from + (to - from) * random.unit())).round() / 100.0;
    let (mut round_off, mut represented) = (0, 0);
    for case in 0..200 {
        let rolls = format!("x' - {}*a'*cos(b) + {}*y'", number(0.1, 3.0), number(-2.0, 2.0));
        let turns = format!("{}*y'*cos(x) + sin(b)*a'", number(0.5, 2.0));
        let mixed = format!("{turns} + {}*({rolls})", if case == 0 { 0.1 } else { number(0.1, 2.0) });
        let (system, mut state) = systems::kinetic(&["x", "y", "a", "b"], &[], &[&rolls, &mixed]);
        state.q.fill(0.0);
        let given = [(2, number(0.1, 2.0)), (3, number(-1.0, 1.0))];
        let given = given.map(|(i, v)| (system.coordinates[i].velocity, v)).into();
        let data = StartData { positions: state.q, given, ..StartData::default() };
        let (state, _) = complete_start(&system, &data).unwrap();
        assert!(state.v[1].abs() < 1e-14, "y' = {} of a chassis that runs along x", state.v[1]);
        round_off += usize::from(state.v[1] != 0.0);
        for automatic in [Removal::by_coordinates, Removal::by_quasi_velocities] {
            let removal = automatic(&system, &state).unwrap();
            represented += usize::from(complete_removal_start(&system, &removal, &state).is_ok());
            // a slip that is none of round-off is one
            let slips = mechanics::State { v: vec![state.v[0], 1e-6, state.v[2], state.v[3]], ..state.clone() };
            let error = complete_removal_start(&system, &removal, &slips).unwrap_err();
            assert!(matches!(error, StartError::RemovalStart { .. }), "{error}");
        }
    }
    assert!(round_off > 50, "only {round_off} velocities are round-off");
    assert_eq!(represented, 400);
}
