//! Start velocities: completed from the constraints, projected onto them, or refused.

use mechanics::{Quantity, Removal, StartError, State, check_regularity, complete_removal_start, project_velocity};
use proptest::prelude::*;
use scene::{Scene, SceneErrorKind};

/// A scene with coordinates `x, y, z` at the given places.
fn text(start: [f64; 3], lagrangian: &str, constraints: &str, velocities: &str) -> String {
    let [x, y, z] = start.map(|x| format!("{x:?}"));
    format!(
        "title = \"test\"\n[coordinates]\nx = {{ start = {x} }}\ny = {{ start = {y} }}\nz = {{ start = {z} }}\n\
         [system]\nlagrangian = \"{lagrangian}\"\nconstraints = [{constraints}]\n[start]\n{velocities}\n[run]\nduration = 1\n"
    )
}

const KINETIC: &str = "(x'^2 + y'^2 + z'^2)/2";
const CONE: &str = "\"z'^2 - 0.25*(x'^2 + y'^2)\"";

fn load(start: [f64; 3], lagrangian: &str, constraints: &str, velocities: &str) -> Result<Scene, StartError> {
    Scene::parse("test", &text(start, lagrangian, constraints, velocities)).map_err(|e| match *e.kind {
        SceneErrorKind::Start(error) => error,
        _ => panic!("{e}"),
    })
}

#[test]
fn velocities_that_are_left_open_are_named() {
    let error = load([0.0; 3], KINETIC, "\"z' - y*x'\"", "velocities = { \"y'\" = 1 }").unwrap_err();
    assert_eq!(error, StartError::Undetermined { velocities: vec!["x'".into()], idle: vec![] });
    let error = load([0.0, 1.0, 0.0], KINETIC, "\"z' - y*x'\"", "velocities = { \"y'\" = 1 }").unwrap_err();
    assert_eq!(error, StartError::Undetermined { velocities: vec!["x'".into(), "z'".into()], idle: vec![] });
    let error = load([0.0; 3], KINETIC, "", "").unwrap_err();
    assert!(matches!(error, StartError::Undetermined { velocities, .. } if velocities.len() == 3));
}

#[test]
fn contradictions_show_residual_and_limit() {
    let all = "velocities = { \"x'\" = 1, \"y'\" = 0, \"z'\" = 1.5 }";
    let constraints = "\"y' - z*x'\", \"z' - y*x'\"";
    let error = load([0.0, 1.0, 0.0], KINETIC, constraints, all).unwrap_err();
    let StartError::Contradictory { constraint: 2, residual, limit } = error else { panic!("{error}") };
    assert!(residual > 0.1 && limit == 1e-10);
    // dependent constraints that contradict each other: the dependence is the deeper fault
    let error = load([0.0, 1.0, 0.0], KINETIC, "\"y' - 1\", \"y' + 0*z\"", "velocities = { \"z'\" = 1 }").unwrap_err();
    assert!(matches!(error, StartError::DependentConstraints { .. }), "{error}");
    let error = load([0.0, 1.0, 0.0], KINETIC, CONE, "velocities = { \"x'\" = 0, \"z'\" = 1, \"y'\" = 1 }");
    assert!(matches!(error.unwrap_err(), StartError::Contradictory { .. }));
}

#[test]
fn a_velocity_that_comes_out_zero_is_no_contradiction() {
    let scene =
        load([0.3; 3], KINETIC, "\"x'*cos(x) + y'*sin(x)\", \"y'*cos(x) - x'*sin(x)\"", "velocities = { \"z'\" = 1 }");
    assert!(scene.unwrap().start.v.iter().take(2).all(|v| v.abs() < 1e-15));
}

#[test]
fn projection_is_asked_for() {
    let all = "project = true\nvelocities = { \"x'\" = 1, \"y'\" = 0, \"z'\" = 1.5 }";
    let scene = load([0.0, 1.0, 0.0], "(x'^2 + y'^2 + 3*z'^2)/2", "\"z' - y*x'\"", all).unwrap();
    // 3 parts of the gap of 0.5 to x', 1 part to z'
    assert!((scene.start.v[0] - 1.375).abs() < 1e-15 && (scene.start.v[2] - 1.375).abs() < 1e-15);
    let length = scene.completion.projected.unwrap();
    assert!((length - (0.375_f64.powi(2) + 3.0 * 0.125_f64.powi(2)).sqrt()).abs() < 1e-15);
    let consistent = all.replace("1.5", "1.0");
    let scene = load([0.0, 1.0, 0.0], KINETIC, "\"z' - y*x'\"", &consistent).unwrap();
    assert_eq!(scene.completion.projected, Some(0.0));
}

#[test]
fn projection_onto_a_nonlinear_constraint() {
    let scene = load([0.0; 3], KINETIC, CONE, "velocities = { \"x'\" = 3, \"y'\" = 4, \"z'\" = 2.5 }").unwrap();
    let state = State { v: vec![3.0, 4.0, 5.0], ..scene.start.clone() };
    let (projected, length) = project_velocity(&scene.system, &state).unwrap();
    // the nearest point of the line z = speed/2 to (5, 5)
    let expected = [3.6, 4.8, 3.0];
    assert!(projected.v.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-13), "{:?}", projected.v);
    assert!((length - 5.0_f64.sqrt()).abs() < 1e-13);
    let (again, nothing) = project_velocity(&scene.system, &projected).unwrap();
    assert!(nothing < 1e-14 && again.v.iter().zip(&projected.v).all(|(a, b)| (a - b).abs() < 1e-14));
    let wrong = State { v: vec![0.0], ..scene.start.clone() };
    assert!(matches!(project_velocity(&scene.system, &wrong), Err(StartError::WrongLength { found: 1, expected: 3 })));
    let rest = State { v: vec![0.0; 3], ..scene.start.clone() };
    assert!(matches!(project_velocity(&scene.system, &rest), Err(StartError::DependentConstraints { .. })));
}

#[test]
fn unreachable_constraint_is_an_error() {
    let scene = load([0.0; 3], KINETIC, CONE, "velocities = { \"x'\" = 3, \"y'\" = 4, \"z'\" = 2.5 }").unwrap();
    let mut system = scene.system.clone();
    let g = &system.graph;
    system.constraints = vec![g.add(g.powi(g.variable(system.coordinates[0].velocity), 2), g.one())];
    let error = project_velocity(&system, &scene.start).unwrap_err();
    assert!(matches!(error, StartError::Projection(_)), "{error}");
}

#[test]
fn a_sign_is_chosen_by_the_guess() {
    let given = "velocities = { \"x'\" = 3, \"y'\" = 4 }";
    let error = load([0.0; 3], KINETIC, CONE, given).unwrap_err();
    let StartError::Ambiguous { velocities, first, second } = error else { panic!("{error}") };
    assert_eq!(velocities, ["z'"]);
    assert!((first[0] - 2.5).abs() < 1e-14 && (second[0] + 2.5).abs() < 1e-14);
    for sign in [1.0, -1.0] {
        let scene = load([0.0; 3], KINETIC, CONE, &format!("{given}\nguess = {{ \"z'\" = {sign:?} }}")).unwrap();
        assert!((scene.start.v[2] - sign * 2.5).abs() < 1e-15);
    }
}

#[test]
fn dependent_constraints_show_singular_values() {
    let velocities = "velocities = { \"x'\" = 0, \"y'\" = 0, \"z'\" = 0 }";
    let error = load([0.1; 3], KINETIC, "\"x' - y'\", \"1000*y' - 1000*x' + (z - 0.1)*z'\"", velocities).unwrap_err();
    let told = error.to_string();
    let StartError::DependentConstraints { singular_values, ratio, limit, combination } = error else {
        panic!("{told}")
    };
    assert!(combination.len() == 2 && (combination[0].1 / combination[1].1 - 1000.0).abs() < 1e-9, "{combination:?}");
    assert!(told.contains("drop one of constraints 1, 2"), "{told}");
    assert!(singular_values.len() == 2 && ratio < 1e-15 && limit == 1e-10);
    // at rest the cone has no tangent plane
    let error = load([0.1; 3], KINETIC, CONE, velocities).unwrap_err();
    assert!(matches!(error, StartError::DependentConstraints { .. }), "{error}");
    let error = load([0.1; 3], KINETIC, CONE, "velocities = { \"x'\" = 0, \"y'\" = 0 }").unwrap_err();
    assert!(matches!(error, StartError::DependentConstraints { .. }), "{error}");
    // round-off does not make a rank
    let error = load([std::f64::consts::PI; 3], KINETIC, "\"x'*sin(x)\"", velocities).unwrap_err();
    assert!(matches!(error, StartError::DependentConstraints { .. }), "{error}");
}

#[test]
fn units_do_not_feign_dependence_or_singularity() {
    let velocities = "velocities = { \"x'\" = 1, \"y'\" = 1 }";
    let scaled = "(1e-24*x'^2 + 1e14*y'^2 + z'^2)/2";
    let scene = load([0.1; 3], scaled, "\"1e-13*z' - 1e-13*y*x'\"", velocities).unwrap();
    assert!((scene.start.v[2] - 0.1).abs() < 1e-16);
}

#[test]
fn mass_matrix_on_the_kernel() {
    let velocities = "velocities = { \"x'\" = 1, \"y'\" = 1 }";
    // singular, but not on the kernel
    assert!(load([0.1; 3], "(x'^2 + y'^2)/2", "\"z' - y*x'\"", velocities).is_ok());
    // indefinite
    assert!(load([0.1; 3], "(x'^2 - y'^2)/2", "\"z' - y*x'\"", velocities).is_ok());
    for singular in ["(x'^2 + z'^2)/2", "x + y", "(x' + y')^2", "x'^2 + (y - 0.1)^2*y'^2"] {
        let error = load([0.1; 3], singular, "\"z' - y*x'\"", velocities).unwrap_err();
        assert!(matches!(error, StartError::SingularMassMatrix { limit: 1e-10, .. }), "{singular}: {error}");
    }
    // regular M, null direction of the kernel: x'^2 - y'^2 on x' = y'
    let error = load([0.1; 3], "(x'^2 - y'^2 + z'^2)/2", "\"x' - y'\"", "velocities = { \"x'\" = 1, \"z'\" = 1 }");
    assert!(matches!(error.unwrap_err(), StartError::SingularMassMatrix { .. }));
}

#[test]
fn what_is_not_finite_at_the_start() {
    let velocities = "velocities = { \"x'\" = 1, \"y'\" = 1 }";
    let quantity = |lagrangian: &str, constraint: &str| {
        let error = load([0.0; 3], lagrangian, constraint, velocities).unwrap_err();
        let StartError::NotFinite { quantity, .. } = error else { panic!("{error}") };
        quantity
    };
    assert_eq!(quantity("x'^2 + y'^2 + 1/x", "\"z' - y*x'\""), Quantity::Lagrangian);
    assert_eq!(quantity("x'^2 + y'^2 + (x'*x^2)^1.5", "\"z' - y*x'\""), Quantity::MassMatrix);
    let error = load([0.0; 3], KINETIC, "\"z' - x'/y\"", velocities).unwrap_err();
    assert_eq!(error, StartError::NotSolved { points: 1 });
    let forced =
        text([0.0; 3], KINETIC, "\"z' - x'\"", velocities).replace("[start]", "forces = { x = \"1/y\" }\n[start]");
    let error = Scene::parse("test", &forced).unwrap_err();
    assert!(error.to_string().contains("the force along `x` is not finite at the start"), "{error}");
    assert_eq!(error.line, 9);
}

#[test]
fn a_removal_that_cannot_represent_the_start() {
    let velocities = "velocities = { \"x'\" = 1, \"y'\" = 1 }";
    let scene = load([0.0; 3], KINETIC, "\"z' - y*x'\"", velocities).unwrap();
    let removal = Removal::by_coordinates(&scene.system, &scene.start).unwrap();
    let start = complete_removal_start(&scene.system, &removal, &scene.start).unwrap();
    assert_eq!((start.parameters.len(), start.rates.len(), start.memory.len()), (2, 2, 1));
    assert!(start.free.is_empty() && start.second_rates.is_empty());
    let off = State { v: vec![1.0, 1.0, 0.5], ..scene.start.clone() };
    let error = complete_removal_start(&scene.system, &removal, &off).unwrap_err();
    assert!(matches!(error, StartError::RemovalStart { residual, limit: 1e-10, .. } if residual > 0.1), "{error}");
}

#[test]
fn quasi_velocities_start_nearest_to_zero() {
    let velocities = "velocities = { \"x'\" = 1, \"z'\" = 1 }";
    let knife = "\"y'*cos(z) - x'*sin(z)\"";
    let scene = load([0.4; 3], KINETIC, knife, velocities).unwrap();
    let removal = Removal::by_quasi_velocities(&scene.system, &scene.start).unwrap();
    let start = complete_removal_start(&scene.system, &removal, &scene.start).unwrap();
    let own: Vec<_> = removal.parameters.iter().filter(|u| u.coordinate.is_none()).collect();
    assert_eq!(own.len(), 1);
    assert_eq!(start.parameters[&own[0].symbol], 0.0);
    assert!(start.rates[&own[0].rate].abs() > 0.1);
}

#[test]
fn lengths_are_checked() {
    let scene = load([0.0; 3], KINETIC, "\"z' - y*x'\"", "velocities = { \"x'\" = 1, \"y'\" = 1 }").unwrap();
    let short = State { q: vec![0.0], ..scene.start.clone() };
    assert!(matches!(check_regularity(&scene.system, &short), Err(StartError::WrongLength { found: 1, expected: 3 })));
}

proptest! {
    #[test]
    fn completion_projection_and_writing_agree(
        q in prop::array::uniform3(-3.0..3.0_f64),
        v in prop::array::uniform3(-5.0..5.0_f64),
        a in prop::array::uniform3(0.3..2.0_f64),
        unit in -6..6_i32,
    ) {
        let s = 10.0_f64.powi(unit);
        let constraint = format!("\"{:?}*(z' - ({:?}*y + {:?})*x' - sin(x)*y' - {:?})\"", s, a[0], a[1], a[2]);
        let velocities = format!("velocities = {{ \"x'\" = {:?}, \"y'\" = {:?} }}", v[0], v[1]);
        let scene = load(q, KINETIC, &constraint, &velocities).unwrap();
        let expected = (a[0] * q[1] + a[1]) * v[0] + q[0].sin() * v[1] + a[2];
        prop_assert!((scene.start.v[2] - expected).abs() <= 4e-15 * (1.0 + expected.abs()) + 4e-14);
        prop_assert!(scene.completion.residual < 1e-14);
        let again = Scene::parse("again", &scene.to_toml()).unwrap();
        prop_assert_eq!(&again.start, &scene.start);
        let off = State { v: vec![v[0], v[1], v[2]], ..scene.start.clone() };
        let (projected, length) = project_velocity(&scene.system, &off).unwrap();
        let moved: f64 = projected.v.iter().zip(&off.v).map(|(a, b)| (a - b).powi(2)).sum();
        prop_assert!((moved.sqrt() - length).abs() < 1e-12 * (1.0 + length));
        // the move is along the constraint's gradient, and no longer than to the completed start
        prop_assert!(length <= (expected - v[2]).abs() + 1e-12);
        let (_, nothing) = project_velocity(&scene.system, &projected).unwrap();
        prop_assert!(nothing < 1e-13);
    }
}

#[test]
fn a_speed_that_is_exceeded_has_no_real_start() {
    let speed = "\"x'^2 + y'^2 + z'^2 - 4\"";
    let given = "velocities = { \"x'\" = 3, \"z'\" = 0 }";
    let error = load([0.0; 3], KINETIC, speed, given).unwrap_err();
    let StartError::NoRealSolution { velocities, constraint: 1, residual, limit } = &error else { panic!("{error}") };
    assert!(velocities == &["y'"] && residual > limit);
    assert!(error.to_string().starts_with("no real `y'` satisfies constraint 1"), "{error}");
}

/// Rows that depend everywhere where the others hold are left out; their multipliers are zero.
#[test]
fn constraints_that_follow_from_others_are_left_out() {
    let text = |constraints: &str, multipliers: &str| {
        format!(
            "title = \"t\"\n[coordinates]\nx = {{ start = 0.1 }}\ny = {{ start = 0.2 }}\nz = {{ start = 0 }}\n[system]\n\
             lagrangian = \"(x'^2 + y'^2 + z'^2)/2\"\nconstraints = [{constraints}]\n[start.velocities]\n\"x'\" = 1\n\
             [vakonomic]\nmultipliers = [{multipliers}]\n[run]\nduration = 1\n"
        )
    };
    let three = "\"z' - y*x'\", \"3*z' - 3*y*x'\", \"y' + x*x'\"";
    let scene = Scene::parse("t", &text(three, "0.5, 0, 0.25")).unwrap_or_else(|e| panic!("{e}"));
    let numbers: Vec<usize> = scene.system.redundant.iter().map(|(number, _)| *number).collect();
    assert_eq!((numbers, &scene.multipliers[..]), (vec![2], &[0.5, 0.25][..]));
    assert_eq!(scene.multiplier_names(), ["mu0_1", "mu0_3"]);
    let refused = Scene::parse("t", &text(three, "0.5, 1, 0.25")).unwrap_err().to_string();
    assert!(refused.contains("constraint 2 follows from the others: its multiplier is zero, not 1.0"), "{refused}");
    // another offset contradicts, and does not follow
    for contradictory in ["\"z' - y*x'\", \"z' - y*x' - 1\"", "\"z' - y*x'\", \"z' - y*x' + 1e-3*t\""] {
        Scene::parse("t", &text(contradictory, "0, 0")).expect_err(contradictory);
    }
    // a component of a vector that is 0 = 0 is left out before they are counted
    let vector = text("\"[z' - y*x', 0*x', 0]\"", "0.5").replace("\"x'\" = 1", "\"x'\" = 1\n\"y'\" = 0");
    let vector = Scene::parse("t", &vector).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((vector.system.constraints.len(), vector.system.redundant.len()), (1, 0));
}
