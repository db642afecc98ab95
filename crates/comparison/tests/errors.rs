//! Everything that can keep a motion from starting, provoked.

use std::collections::BTreeMap;

use comparison::compare;
use equations::{DerivationError, EvaluationFailure, Formulation};
use integrate::{BoundaryError, CallError};
use mechanics::{ConstantsRule, Removal, RemovalError, StartError};
use motion::{
    CHETAEV, Choice, Motion, REMOVED_CONSTRAINT, Settings, SolveError, VAKONOMIC, VAKONOMIC_COSTATE, choices, derive,
    removals, setting, solve_choice,
};
use scene::{Scene, SceneErrorKind};

const SLEDGE: &str = r#"
title = "Ice sledge on an incline"
[coordinates]
x   = { start = 0 }
y   = { start = 0 }
phi = { start = 0.3 }
[system]
lagrangian  = "(x'^2 + y'^2)/2 + phi'^2/4 + 4*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start.velocities]
"phi'" = 1.1
"x'"   = 0.5
[removal.arc-length]
parameters = ["u", "phi"]
rates = { x = "u'*cos(phi)", y = "u'*sin(phi)" }
[removal.along-x]
parameters = ["x", "phi"]
rates = { y = "x'*tan(phi)" }
[run]
duration = 1
"#;

fn sledge() -> Scene {
    Scene::parse("sledge", SLEDGE).unwrap_or_else(|e| panic!("{e}"))
}

fn choice(formulation: &'static Formulation, removal: Option<&Removal>, constants: ConstantsRule) -> Choice {
    Choice { label: formulation.title.into(), formulation, removal: removal.cloned(), constants }
}

fn solve(scene: &Scene, formulation: &'static Formulation, constants: ConstantsRule) -> Result<Motion, SolveError> {
    let removal = formulation.needs_removal().then(|| &scene.removals[0]);
    solve_choice(scene, &choice(formulation, removal, constants), &Settings::default())
}

#[track_caller]
fn refused(outcome: Result<Motion, SolveError>) -> SolveError {
    let error = outcome.expect_err("not refused");
    println!("{error}");
    error
}

#[test]
fn a_wrong_number_of_constants_names_those_that_there_are() {
    let scene = sledge();
    for (name, found, names) in [
        (VAKONOMIC, vec![1.0, 2.0], "mu0_1"),
        (VAKONOMIC_COSTATE, vec![], "mu0_1"),
        (REMOVED_CONSTRAINT, vec![], "P0_x"),
        (REMOVED_CONSTRAINT, vec![1.0, 2.0, 3.0], "P0_x"),
    ] {
        let expected = SolveError::ConstantCount {
            formulation: name.name.into(),
            expected: 1,
            names: names.into(),
            found: found.len(),
        };
        assert_eq!(refused(solve(&scene, name, ConstantsRule::Given(found))), expected);
    }
    let error = refused(solve(&scene, CHETAEV, ConstantsRule::Given(vec![1.0])));
    assert!(matches!(error, SolveError::ConstantCount { expected: 0, found: 1, .. }), "{error}");
    let given = solve(&scene, REMOVED_CONSTRAINT, ConstantsRule::Given(vec![1.0, 0.0])).expect("zero for y");
    assert_eq!(given.constants, [1.0]);
    // the costate of y never moves: it is there where it is given
    let given = solve(&scene, REMOVED_CONSTRAINT, ConstantsRule::Given(vec![1.0, 2.0])).expect("both");
    assert_eq!(given.constants, [1.0, 2.0]);
}

#[test]
fn only_removed_constraints_have_a_natural_boundary_condition() {
    let scene = sledge();
    for name in [VAKONOMIC, VAKONOMIC_COSTATE] {
        let error = refused(solve(&scene, name, ConstantsRule::Natural { horizon: 1.0 }));
        assert_eq!(error, SolveError::NoNaturalCondition { formulation: name.name.into() });
    }
    // nothing to choose
    let motion = solve(&scene, CHETAEV, ConstantsRule::Natural { horizon: 1.0 }).expect("no constants");
    assert!(motion.constants.is_empty());
    // P_x' = −∂L/∂x = −4
    let motion = solve(&scene, REMOVED_CONSTRAINT, ConstantsRule::Natural { horizon: 1.0 }).expect("a horizon");
    assert!((motion.constants[0] - 4.0).abs() < 1e-8, "{:?}", motion.constants);
}

#[test]
fn the_horizon_is_after_the_start() {
    let scene = sledge();
    for horizon in [0.0, -1.0, f64::NAN] {
        let error = refused(solve(&scene, REMOVED_CONSTRAINT, ConstantsRule::Natural { horizon }));
        assert!(matches!(error, SolveError::Horizon { start: 0.0, .. }), "{error}");
    }
}

#[test]
fn a_horizon_beyond_a_singularity_has_no_constants() {
    // without constants φ runs into π/2, where the chart of this removal ends
    let scene = Scene::parse("sledge", &SLEDGE.replace("4*x\"", "4*x + y\"")).unwrap_or_else(|e| panic!("{e}"));
    let along_x = choice(REMOVED_CONSTRAINT, Some(&scene.removals[1]), ConstantsRule::Natural { horizon: 30.0 });
    let error = refused(solve_choice(&scene, &along_x, &Settings::default()));
    let SolveError::Boundary { horizon: 30.0, error: BoundaryError::Residual { reason } } = error else {
        panic!("{error}")
    };
    assert!(reason.contains("the motion stops at t = "), "{reason}");
}

/// Turns fast once it has a costate; the blow at the end asks for a large one.
const LATE_BLOW: &str = r#"
title = "late blow"
[coordinates]
x = { unit = "m", start = 0.3 }
y = { unit = "m", start = 0.1 }
z = { unit = "m", start = 0 }
[system]
lagrangian = "(x'^2 + y'^2 + z'^2)/2 + 1e9*y*exp(-((t - 2.999)/0.0001)^2)"
constraints = ["y' - z'*x"]
[start.velocities]
"x'" = 1
"z'" = 1
[run]
duration = 3
"#;

#[test]
fn a_search_that_comes_to_motions_of_many_steps_is_given_up() {
    let scene = Scene::parse("late-blow", LATE_BLOW).unwrap_or_else(|e| panic!("{e}"));
    let removal = Removal::by_coordinates(&scene.system, &scene.start).expect("linear constraints");
    let natural = choice(REMOVED_CONSTRAINT, Some(&removal), ConstantsRule::Natural { horizon: 3.0 });
    let settings = Settings { tolerance: 1e-9, ..Settings::default() };
    let error = refused(solve_choice(&scene, &natural, &settings));
    assert!(matches!(error, SolveError::Search { horizon: 3.0, steps: 1..2_000_000 }), "{error}");
}

#[test]
fn a_removal_is_needed_and_has_to_be_of_first_order_or_regular() {
    let scene = sledge();
    let none = choice(REMOVED_CONSTRAINT, None, ConstantsRule::Zero);
    let error = refused(solve_choice(&scene, &none, &Settings::default()));
    let missing = DerivationError::RemovalMissing { formulation: REMOVED_CONSTRAINT.name };
    assert_eq!(error, SolveError::Derivation(missing));
    // φ = u'/w', speed u' along the blade: second rates are in φ' only, so in one combination
    let removal = "[removal.second]\nparameters = [\"u\", \"w\"]\ndirect = { phi = \"u'/w'\" }\n\
                   rates = { x = \"u'*cos(u'/w')\", y = \"u'*sin(u'/w')\" }\n[run]";
    let scene = Scene::parse("sledge", &SLEDGE.replace("[run]", removal)).unwrap_or_else(|e| panic!("{e}"));
    let second = choice(REMOVED_CONSTRAINT, scene.removals.last(), ConstantsRule::Zero);
    let error = refused(solve_choice(&scene, &second, &Settings::default()));
    let SolveError::Derivation(DerivationError::SingularHighestHessian { removal, rank, size, .. }) = error else {
        panic!("{error}")
    };
    assert_eq!((removal.as_str(), rank, size), ("second", 1, 2));
}

#[test]
fn constraints_that_nothing_removes() {
    let text = "title = \"cone\"\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\nz = { start = 0 }\n[system]\n\
        lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [\"z'^2 - x'^2 - y'^2\"]\n\
        [start.velocities]\n\"x'\" = 3\n\"y'\" = 4\n\"z'\" = 5\n[run]\nduration = 1\n";
    let scene = Scene::parse("cone", text).unwrap_or_else(|e| panic!("{e}"));
    assert!(matches!(removals(&scene), Err(RemovalError::NotLinear { constraint: 1, .. })));
    // the others are compared all the same, and the refusal is part of the result
    let comparison =
        compare(scene.clone(), choices(&scene), Vec::new(), &Settings::default()).unwrap_or_else(|e| panic!("{e}"));
    let removed = comparison.run(REMOVED_CONSTRAINT).expect("a run that says why not");
    let error = comparison.runs[removed].outcome.as_ref().expect_err("refused");
    assert!(matches!(error, SolveError::Removal(RemovalError::NotLinear { constraint: 1, .. })), "{error}");
    let (chetaev, vakonomic) = (comparison.run(CHETAEV), comparison.run(VAKONOMIC));
    assert!(chetaev.zip(vakonomic).is_some_and(|(a, b)| comparison.pair(a, b).is_some()));
}

#[test]
fn a_removal_that_cannot_represent_the_start() {
    let scene = sledge();
    let mut elsewhere = scene.removals[0].clone();
    let u = elsewhere.parameters[0].rate;
    elsewhere.start = BTreeMap::from([(u, scene.system.graph.number(7.0))]);
    let error = refused(solve_choice(
        &scene,
        &choice(REMOVED_CONSTRAINT, Some(&elsewhere), ConstantsRule::Zero),
        &Settings::default(),
    ));
    let SolveError::Start(StartError::RemovalStart { removal, residual, limit }) = error else { panic!("{error}") };
    assert!(removal == "arc-length" && residual > limit, "{residual}");
}

#[test]
fn dependent_constraints_at_the_start() {
    let mut scene = sledge();
    let f = scene.system.constraints[0];
    scene.system.constraints.push(f);
    for name in [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE] {
        let error = refused(solve(&scene, name, ConstantsRule::Zero));
        assert!(matches!(error, SolveError::Start(StartError::DependentConstraints { .. })), "{error}");
        // equations that were derived without a look at the start are refused when they are solved there
        let equations = derive(&scene.system, &choice(name, None, ConstantsRule::Zero)).expect("equations");
        let error = refused(motion::solve(setting(&scene), equations, &ConstantsRule::Zero, &Settings::default()));
        assert!(matches!(error, SolveError::AtStart(EvaluationFailure::Singular { .. })), "{error}");
    }
    let error = compare(scene.clone(), choices(&scene), Vec::new(), &Settings::default()).expect_err("not refused");
    assert!(matches!(error, SolveError::Removal(RemovalError::Dependent { .. })), "{error}");
    // a scene leaves out what follows from the others, and refuses what depends at the start only
    let edge = "\"y'*cos(phi) - x'*sin(phi)\"";
    let removals = SLEDGE.find("[removal").expect("there are some")..SLEDGE.find("[run]").expect("there is one");
    let with = |other: &str| SLEDGE.replace(&SLEDGE[removals.clone()], "").replace(edge, &format!("{edge}, {other}"));
    let twice = Scene::parse("sledge", &with(edge)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((twice.system.constraints.len(), twice.system.redundant.len()), (1, 1));
    let error = Scene::parse("sledge", &with("\"y'*cos(phi) - x'*sin(phi) + x*phi'\"")).unwrap_err();
    assert!(matches!(*error.kind, SceneErrorKind::Start(StartError::DependentConstraints { .. })), "{error}");
}

#[test]
fn undefined_symbols_do_not_compile() {
    let mut scene = sledge();
    let g = &scene.system.graph;
    let stray = g.mul(g.variable(g.symbol("stray")), g.variable(scene.system.coordinates[0].position));
    scene.system.lagrangian = g.add(scene.system.lagrangian, stray);
    for name in [CHETAEV, VAKONOMIC, VAKONOMIC_COSTATE, REMOVED_CONSTRAINT] {
        let error = refused(solve(&scene, name, ConstantsRule::Zero));
        assert!(matches!(error, SolveError::Compile(_)) && error.to_string().contains("stray"), "{error}");
    }
}

#[test]
fn wrong_calls_of_the_integrator() {
    let run = |duration: f64, settings: &Settings| {
        let scene = Scene { duration, ..sledge() };
        refused(solve_choice(&scene, &choice(CHETAEV, None, ConstantsRule::Zero), settings))
    };
    let usual = Settings::default();
    assert!(matches!(run(0.0, &usual), SolveError::Call(CallError::EmptyInterval { .. })));
    assert!(matches!(run(f64::NAN, &usual), SolveError::Call(CallError::TimeNotFinite { .. })));
    for tolerance in [0.0, -1e-9, f64::NAN, 2.0, 1e-300] {
        let error = run(1.0, &Settings { tolerance, ..Settings::default() });
        assert!(matches!(error, SolveError::Tolerance { .. }), "{error}");
    }
    let error = run(1.0, &Settings { max_steps: 0, ..Settings::default() });
    assert!(matches!(error, SolveError::Call(CallError::MaxSteps { found: 0, .. })), "{error}");
}
