//! Equations written by hand: what is left out, how an instant is solved, and its exact derivatives.

use std::collections::HashMap;

use equations::{
    Block, Compiled, ConstraintProjection, Equations, EvaluationFailure, LaneEquations, Named, Plan, Role,
    StateVariable,
};
use mechanics::System;
use symbolic::{Expr, Graph, LANES, Matrix};

const REGULAR: &str = "whatever the test needs";

fn parse(g: &Graph, text: &str) -> Expr {
    g.parse(text, &|name: &str| Some(g.variable(g.symbol(name)))).unwrap_or_else(|e| panic!("{text}: {e}"))
}

/// States as (name, role, rate), blocks as (unknowns, residuals); coordinates and velocities as they are.
fn equations(
    parameters: &[(&str, f64)],
    states: &[(&str, Role, &str)],
    blocks: &[(&[&str], &[&str])],
    coordinates: &[&str],
    velocities: &[&str],
) -> Equations {
    let system = System::new(Graph::new(), &[]);
    let mut equations = Equations::new("by hand", &system);
    let g = system.graph;
    equations.parameters = parameters.iter().map(|&(name, x)| (g.symbol(name), x)).collect::<HashMap<_, _>>();
    for &(name, role, rate) in states {
        let symbol = g.symbol(name);
        equations.states.push(StateVariable { symbol, role, rate: parse(&g, rate), start: g.variable(symbol) });
    }
    for (unknowns, residuals) in blocks {
        equations.blocks.push(Block {
            unknowns: unknowns.iter().map(|z| g.symbol(z)).collect(),
            residuals: residuals.iter().map(|r| parse(&g, r)).collect(),
            guess: Vec::new(),
            regular: REGULAR,
        });
    }
    equations.coordinates = coordinates.iter().map(|e| parse(&g, e)).collect();
    equations.velocities = velocities.iter().map(|e| parse(&g, e)).collect();
    equations.graph = g;
    equations
}

fn names(equations: &Equations, symbols: &[symbolic::Symbol]) -> Vec<String> {
    symbols.iter().map(|&s| equations.graph.name(s)).collect()
}

/// Rates by the solve of the instant.
fn rates(equations: &Equations, y: &[f64]) -> Vec<f64> {
    let mut rates = vec![0.0; y.len()];
    Compiled::new(equations).unwrap().rates(0.0, y, &mut rates).unwrap_or_else(|e| panic!("{e}"));
    rates
}

const PLANE: [(&str, Role, &str); 6] = [
    ("x", Role::Position, "vx"),
    ("y", Role::Position, "vy"),
    ("z", Role::Position, "vz"),
    ("vx", Role::Velocity, "ax"),
    ("vy", Role::Velocity, "ay"),
    ("vz", Role::Velocity, "az"),
];

#[test]
fn independent_parts_of_a_block_are_solved_apart() {
    let residuals: [&str; 3] = ["(1 + x^2)*ax + x*az - y", "(2 + y^2)*ay + vx", "x*ax + (3 + x)*az + z"];
    let whole = equations(&[], &PLANE, &[(&["ax", "ay", "az"], &residuals)], &["x", "y", "z"], &["vx", "vy", "vz"]);
    let split = whole.clone().leave_out_unneeded();
    let parts: Vec<Vec<String>> = split.blocks.iter().map(|b| names(&split, &b.unknowns)).collect();
    assert_eq!(parts, [vec!["ax", "az"], vec!["ay"]]);
    assert!(split.blocks.iter().all(|b| b.unknowns.len() == b.residuals.len() && b.regular == REGULAR));
    let y = [0.3, -0.4, 0.9, 1.1, 0.2, -0.7];
    for (one, two) in rates(&whole, &y).iter().zip(rates(&split, &y)) {
        assert!((one - two).abs() < 1e-14, "{one} {two}");
    }
}

#[test]
fn a_block_that_cannot_be_split_evenly_is_kept_and_refused() {
    let residuals: [&str; 2] = ["ax - y", "ax + y"];
    let states = [("x", Role::Position, "vx"), ("vx", Role::Velocity, "ax + ay"), ("y", Role::Position, "1")];
    let kept = equations(&[], &states, &[(&["ax", "ay"], &residuals)], &["x"], &["vx"]).leave_out_unneeded();
    assert_eq!(kept.blocks.len(), 1);
    let failure = Compiled::new(&kept).unwrap().rates(0.0, &[1.0; 3], &mut [0.0; 3]).unwrap_err();
    assert!(matches!(failure, EvaluationFailure::Singular { regular: REGULAR, .. }), "{failure}");
}

#[test]
fn a_single_unknown_with_a_constant_coefficient_is_solved_on_the_spot() {
    let states = [("x", Role::Position, "vx"), ("vx", Role::Velocity, "ax")];
    let parameters = [("m", 2.0), ("k", 3.0)];
    let mut spring = equations(&parameters, &states, &[(&["ax"], &["m*ax + k*x"])], &["x"], &["vx"]);
    let power = parse(&spring.graph, "vx*ax");
    spring.multipliers.push(Named { name: "power".into(), expression: power });
    let solved = spring.leave_out_unneeded();
    assert!(solved.blocks.is_empty() && solved.unknowns().is_empty());
    assert_eq!(rates(&solved, &[0.5, 7.0]), [7.0, -0.75]);
    let outputs = Compiled::new(&solved).unwrap().outputs(0.0, &[0.5, 7.0]).unwrap();
    assert_eq!(outputs.multipliers, [-5.25]);
    // a coefficient that moves, or is zero, stays with the solve that can refuse it
    for residual in ["m*x*ax + k", "(m - 2)*ax + k*x", "m*ax^3 + k*x"] {
        let kept = equations(&parameters, &states, &[(&["ax"], &[residual])], &["x"], &["vx"]).leave_out_unneeded();
        assert_eq!(kept.blocks.len(), 1, "{residual}");
    }
}

#[test]
fn quadratures_are_named_and_unneeded_states_dropped() {
    let states = [
        ("x", Role::Position, "vx"),
        ("s", Role::Memory, "vx^2"),
        ("vx", Role::Velocity, "ax"),
        ("P", Role::MemoryCostate, "x"),
    ];
    let blocks: [(&[&str], &[&str]); 1] = [(&["ax"], &["(1 + vx^2)*ax + vx"])];
    let mut with_invariant = equations(&[], &states, &blocks, &["x", "s"], &["vx", "vx^2"]);
    let costate = parse(&with_invariant.graph, "P - x");
    with_invariant.invariants.push(Named { name: "of the costate".into(), expression: costate });
    let less = with_invariant.leave_out_unneeded();
    assert_eq!(names(&less, &less.state_symbols()), ["x", "s", "vx"]);
    assert!(less.invariants.is_empty(), "an invariant of a state that is gone");
    let about = |word: &str| -> Vec<String> {
        let found = less.left_out.iter().find(|l| l.words.contains(word));
        names(&less, &found.unwrap_or_else(|| panic!("nothing about {word}: {:?}", less.left_out)).variables)
    };
    assert_eq!(about("quadrature"), ["x", "s"]);
    assert_eq!(about("nothing that is asked for"), ["P"]);
    // in an equation of motion: no quadrature
    let blocks: [(&[&str], &[&str]); 1] = [(&["ax"], &["(1 + vx^2)*ax + x"])];
    let kept = equations(&[], &states[..3], &blocks, &["x", "s"], &["vx", "vx^2"]).leave_out_unneeded();
    let named: Vec<String> = kept.left_out.iter().flat_map(|l| names(&kept, &l.variables)).collect();
    assert_eq!(named, ["s"]);
}

#[test]
fn dependent_constraints_make_the_instant_singular() {
    let residuals = |second: &'static str| ["ax - l1 - 2*l2 - 1", "ay - y*l1 - 2*y*l2", "ax + y*ay", second];
    let states = &PLANE[..2].iter().chain(&PLANE[3..5]).copied().collect::<Vec<_>>();
    let unknowns: [&str; 4] = ["ax", "ay", "l1", "l2"];
    let twice = equations(&[], states, &[(&unknowns, &residuals("2*ax + 2*y*ay"))], &["x", "y"], &["vx", "vy"]);
    let mut out = [0.0; 4];
    let failure = Compiled::new(&twice).unwrap().rates(0.0, &[0.3, 0.4, 0.5, 0.6], &mut out).unwrap_err();
    let EvaluationFailure::Singular { reciprocal, limit, regular } = failure.clone() else { panic!("{failure}") };
    assert!(reciprocal < limit && regular == REGULAR, "{failure}");
    assert!(failure.to_string().ends_with(&format!("needed: {REGULAR}")), "{failure}");
}

#[test]
fn newton_that_finds_no_root_says_so() {
    let states = [("x", Role::Position, "vx")];
    let none = equations(&[], &states, &[(&["vx"], &["vx^2 + 1 + x^2"])], &["x"], &["vx"]);
    let mut compiled = Compiled::new(&none).unwrap();
    compiled.set_guess(&[0.7]);
    let failure = compiled.rates(0.0, &[0.1], &mut [0.0]).unwrap_err();
    assert!(matches!(failure, EvaluationFailure::NotConverged { step, limit, .. } if step > limit), "{failure}");
}

/// `v² = x`: two roots. The anchor decides: [`Compiled::settle`] moves it, [`Compiled::rates`] does not.
#[test]
fn a_block_with_two_roots_keeps_to_the_one_it_was_settled_on() {
    let states = [("x", Role::Position, "vx")];
    let square = equations(&[], &states, &[(&["vx"], &["vx^2 - x"])], &["x"], &["vx"]);
    let mut compiled = Compiled::new(&square).unwrap();
    assert!(compiled.needs_guess());
    let mut rate = [0.0];
    for (guess, sign) in [(0.9, 1.0), (-1.1, -1.0)] {
        compiled.set_guess(&[guess]);
        for x in [1.0, 1.3, 1.7, 2.2] {
            let settled = compiled.settle(0.0, &[x]).unwrap()[0];
            assert!((settled - sign * x.sqrt()).abs() < 1e-13);
        }
        // wherever the rates were asked for in between, the next ones start from 2.2
        compiled.rates(0.0, &[1.4], &mut rate).unwrap();
        compiled.rates(0.0, &[2.9], &mut rate).unwrap();
        assert!((rate[0] - sign * 2.9_f64.sqrt()).abs() < 1e-13);
    }
    // too far to be sure of the root: refused, not guessed
    compiled.set_guess(&[0.05]);
    let failure = compiled.rates(0.0, &[-0.01], &mut rate).unwrap_err();
    assert!(matches!(failure, EvaluationFailure::NotConverged { .. }), "{failure}");
}

/// `[x, e; e, −(3 + y²)] (vx, ay) = (y, 1)`, `e = 2 + x`: regular, but the pivot `x` goes through zero.
#[test]
fn where_a_pivot_of_the_form_is_zero_the_plain_form_takes_over() {
    let states = [("x", Role::Position, "vx"), ("y", Role::Position, "vy"), ("vy", Role::Velocity, "ay")];
    let residuals: [&str; 2] = ["x*vx + (2 + x)*ay - y", "(2 + x)*vx - (3 + y^2)*ay - 1"];
    let blocks: [(&[&str], &[&str]); 1] = [(&["vx", "ay"], &residuals)];
    let equations = equations(&[], &states, &blocks, &["x", "y"], &["vx", "vy"]);
    let g = &equations.graph;
    let define = |name: &str, text: &str| (g.symbol(name), parse(g, text));
    let plan = Plan {
        definitions: vec![
            define("l", "(2 + x)/x"),
            define("ay", "(1 - l*y)/(-(3 + y^2) - l*(2 + x))"),
            define("vx", "(y - (2 + x)*ay)/x"),
        ],
        condition: Some(parse(g, "l^2")),
        ..Plan::default()
    };
    let mut chosen = Compiled::with_plan(&equations, &plan).unwrap();
    let mut plain = Compiled::plain(&equations).unwrap();
    let mut worst = 0.0_f64;
    // evenly, and ever closer to zero from both sides
    let near = (1..=300).flat_map(|k| [1.0, -1.0].map(|s| s * 10.0_f64.powi(-k)));
    for x in (-50..=50).map(|i| 0.01 * f64::from(i)).chain(near) {
        let y = [x, 0.7, -0.2];
        let mut rates = [[0.0; 3]; 2];
        chosen.rates(0.0, &y, &mut rates[0]).unwrap();
        plain.rates(0.0, &y, &mut rates[1]).unwrap();
        worst = rates[0].iter().zip(&rates[1]).fold(worst, |a, (one, two)| a.max((one - two).abs()));
        assert_eq!(chosen.outputs(0.0, &y).unwrap().velocities.len(), 2);
    }
    assert!(worst < 1e-12, "{worst:.1e}");
    // |l| > 1000 where |x| < 0.002
    assert_eq!(chosen.fallbacks(), 1 + 2 * 298);
    // without the condition the same plan is wrong
    let mut careless = Compiled::with_plan(&equations, &Plan { condition: None, ..plan }).unwrap();
    let mut rates = [[0.0; 3]; 2];
    careless.rates(0.0, &[1e-13, 0.7, -0.2], &mut rates[0]).unwrap();
    plain.rates(0.0, &[1e-13, 0.7, -0.2], &mut rates[1]).unwrap();
    assert!((rates[0][0] - rates[1][0]).abs() > 1e-6);
}

/// Six coupled unknowns in a chain: the elimination is as long as the chain, whatever the chosen pivots.
#[test]
fn a_chain_is_eliminated_in_definitions_and_dependent_rows_are_left_to_be_refused() {
    let states = [("x", Role::Position, "z1"), ("y", Role::Position, "z6")];
    let unknowns: [&str; 6] = ["z1", "z2", "z3", "z4", "z5", "z6"];
    let residuals = [
        "(3 + x^2)*z1 + y*z2 - 1",
        "y*z1 + (3 + y^2)*z2 + x*z3",
        "x*z2 + 4*z3 - z4 - y",
        "5*z4 - z3 + x*z5",
        "x*z4 + (3 + x^2)*z5 - z6",
        "7*z6 - z5 - x",
    ];
    let chain = equations(&[], &states, &[(&unknowns, &residuals)], &["x", "y"], &["z1", "z6"]);
    let plan = Plan::choose(&chain, Some(&[0.0, 0.4, -0.3])).unwrap();
    assert!(plan.left.is_empty() && plan.why[0].contains("eliminated beforehand"), "{:?}", plan.why);
    let y = [0.9, 0.8];
    let (mut one, mut two) = ([0.0; 2], [0.0; 2]);
    Compiled::with_plan(&chain, &plan).unwrap().rates(0.0, &y, &mut one).unwrap();
    Compiled::plain(&chain).unwrap().rates(0.0, &y, &mut two).unwrap();
    assert!((one[0] - two[0]).abs() < 1e-15 && (one[1] - two[1]).abs() < 1e-15, "{one:?} {two:?}");
    let twice =
        equations(&[], &states, &[(&["z1", "z6"], &["x*z1 + y*z6 - 1", "2*x*z1 + 2*y*z6 - 2"])], &["x"], &["z1"]);
    let plan = Plan::choose(&twice, Some(&[0.0, 0.4, -0.3])).unwrap();
    assert_eq!(plan.left, [0]);
    let failure = Compiled::with_plan(&twice, &plan).unwrap().rates(0.0, &y, &mut one).unwrap_err();
    assert!(matches!(failure, EvaluationFailure::Singular { .. }), "{failure}");
}

/// `arctan(8 (v − 1)) = 0` from `v = 3`: Newton's method goes farther away with every step.
#[test]
fn a_return_that_does_not_converge_is_a_failure() {
    let states = [("x", Role::Position, "v"), ("v", Role::Velocity, "0")];
    let mut astray = equations(&[], &states, &[], &["x"], &["v"]);
    let g = &astray.graph;
    let (v, f) = (g.symbol("v"), parse(g, "atan(8*(v - 1))"));
    astray.projection = Some(ConstraintProjection {
        velocities: vec![v],
        constraints: vec![f],
        jacobian: Matrix::from_fn(1, 1, |_, _| g.derivative(f, v)),
        metric: Matrix::from_fn(1, 1, |_, _| g.one()),
    });
    let mut compiled = Compiled::new(&astray).unwrap();
    let mut near = [0.0, 1.05];
    compiled.project(0.0, &mut near).unwrap();
    assert!((near[1] - 1.0).abs() < 1e-14, "{near:?}");
    // one step is exact to the last digit: nothing is left, whatever its length was
    compiled.project(0.0, &mut [0.0, 1.0]).unwrap();
    let failure = compiled.project(0.0, &mut [0.0, 3.0]).unwrap_err();
    assert!(
        matches!(failure, EvaluationFailure::NotProjected { .. } | EvaluationFailure::Singular { .. }),
        "{failure}"
    );
    // in lanes, too: only the lane that fails
    let plan = Plan::choose(&astray, Some(&[0.0, 0.0, 1.0])).unwrap();
    let mut lanes = LaneEquations::new(&astray, &plan, &[0.0, 0.0, 1.0]).unwrap().unwrap();
    let mut speeds = [1.05; LANES];
    speeds[3] = 3.0;
    let moved = lanes.project(&[0.0; LANES], &mut [[0.0; LANES], speeds]);
    assert!((0..LANES).all(|l| moved[l].is_nan() == (l == 3)), "{moved:?}");
}

/// `x' = x + 3 y`, `y' = a` with `2 a = x³ − x²y`, at `(x, y)` and where both have the other sign: magnitudes
/// have no sign.
#[test]
fn terms_by_adjoints_are_those_of_the_mirrored_states() {
    let states = [("x", Role::Position, "x + 3*y"), ("y", Role::Position, "a")];
    let whole = equations(&[], &states, &[(&["a"], &["2*a - x^3 + x^2*y"])], &["x", "y"], &["x + 3*y", "a"]);
    let mut compiled = Compiled::new(&whole).unwrap();
    for y in [[0.5, 0.25], [0.5, -0.25]] {
        let mut of = |y: [f64; 2]| compiled.adjoint_terms_of_rates(0.0, &y).unwrap_or_else(|e| panic!("{e}"));
        let (here, there) = (of(y), of(y.map(|x| -x)));
        assert_eq!(here, there);
        let bounds = [y[0].abs() + 3.0 * y[1].abs(), 0.5 * (y[0].abs().powi(3) + y[0].powi(2) * y[1].abs())];
        assert!(here.iter().zip(bounds).all(|(term, bound)| *term >= bound), "{here:?} {bounds:?}");
    }
}
