//! Tests of every error, and of properties that the order does not show.

use discrete::{Discrete, DiscreteError, RemovedStart, START_LIMIT};
use mechanics::{State, System};
use scene::Scene;
use symbolic::Graph;

pub(crate) fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../crates/scene/scenes");
    Scene::load(&std::path::Path::new(folder).join(name).with_extension("toml")).unwrap()
}

#[test]
fn removed_sledge_has_its_costates() {
    // P_x' = −G_x = −g sin α, P_y' = 0, so P_x = P_x(0) − g sin α t even on the grid; only x has weight
    let scene = scene("sledge");
    let removal = scene.removals.iter().find(|r| r.name == "arc-length").unwrap();
    let at = RemovedStart::at(&scene.system, removal, &scene.start, &[2.0, -0.5]).unwrap();
    let discrete = Discrete::removed(&scene.system, removal, &at, 1.0).unwrap();
    let mut trajectory = discrete.trajectory(10).unwrap();
    for t in trajectory.times().to_vec() {
        let (found, expected) = (trajectory.at(t).unwrap().multipliers, 2.0 - 9.81 * 0.4_f64.sin() * t);
        assert!((found[0] - expected).abs() < 1e-12 && (found[1] + 0.5).abs() < 1e-12, "{found:?}");
    }
}

#[test]
fn every_error_is_said() {
    let sledge = scene("sledge");
    let (system, start) = (&sledge.system, &sledge.start);
    let mut full = system.clone();
    full.constraints = vec![full.constraints[0]; 3];
    let refused = |error: Result<Discrete, DiscreteError>| error.unwrap_err();
    let begun = |discrete: Discrete, steps: usize| discrete.trajectory(steps).unwrap_err();
    let e = refused(Discrete::chetaev(&full, start, 1.0));
    assert!(matches!(e, DiscreteError::NoFreedom { found: 3, limit: 3 }), "{e}");
    let e = refused(Discrete::vakonomic(system, start, &[], 1.0));
    assert!(matches!(e, DiscreteError::Length { what: "multipliers", found: 0, expected: 1 }), "{e}");
    let e = refused(Discrete::chetaev(system, &State { v: vec![0.0, 1.0, 0.0], ..start.clone() }, 1.0));
    assert!(matches!(e, DiscreteError::OffConstraint { found, limit: START_LIMIT } if found > 0.4), "{e}");
    let e = refused(Discrete::chetaev(system, start, f64::NAN));
    assert!(matches!(e, DiscreteError::NotFinite { what: "a time", .. }), "{e}");
    let mut unknown = system.clone();
    unknown.forces[0] = unknown.graph.variable(unknown.graph.symbol("nobody"));
    assert!(matches!(refused(Discrete::chetaev(&unknown, start, 1.0)), DiscreteError::Compile(_)));
    let mut pushed = system.clone();
    pushed.forces[1] = pushed.graph.one();
    let e = refused(Discrete::vakonomic(&pushed, start, &[0.0], 1.0));
    assert!(matches!(e, DiscreteError::Force { number: 2 }), "{e}");
    let cylinders = scene("three-cylinders");
    let paper = cylinders.removals.iter().find(|r| r.name == "paper").unwrap();
    let (m, k) = (paper.parameters.len(), paper.memory.len());
    let at = RemovedStart {
        t: 0.0,
        parameters: vec![1.0; m],
        rates: vec![1.0; m],
        memory: vec![0.0; k],
        costates: vec![0.0; k],
    };
    let e = refused(Discrete::removed(&cylinders.system, paper, &at, 1.0));
    assert!(matches!(&e, DiscreteError::HighRate { symbol, .. } if symbol == "u'"), "{e}");
    let off = State { v: vec![0.0, 1.0, 0.0], ..start.clone() };
    let e = RemovedStart::at(system, &sledge.removals[0], &off, &[0.0; 2]).unwrap_err();
    assert!(matches!(e, DiscreteError::Removal(_)), "{e}");

    let e = begun(Discrete::chetaev(system, start, 1.0).unwrap(), 0);
    assert!(matches!(e, DiscreteError::NoSteps), "{e}");
    let mut twice = system.clone();
    twice.constraints.push(twice.constraints[0]);
    let e = begun(Discrete::chetaev(&twice, start, 1.0).unwrap(), 3);
    assert!(matches!(e, DiscreteError::Singular { t: 0.0 }), "{e}");
    let hamel = scene("appell-hamel");
    let heading = hamel.removals.iter().find(|r| r.name == "by-heading").unwrap();
    let at = RemovedStart::at(&hamel.system, heading, &hamel.start, &[0.1; 3]).unwrap();
    let e = begun(Discrete::removed(&hamel.system, heading, &at, 1.0).unwrap(), 100);
    assert!(matches!(e, DiscreteError::Singular { t: 0.0 }), "{e}");
    // z'² = a²(x'² + y'²) at rest has no direction
    let rest = State { v: vec![0.0; 3], ..hamel.start.clone() };
    let e = refused(Discrete::chetaev(&hamel.system, &rest, 1.0));
    assert!(matches!(e, DiscreteError::OffConstraint { found, .. } if found.is_nan()), "{e}");
    // with + 100 x⁷ in L the motion runs away in finite time, and no step of 1 follows it
    let mut system = System::new(Graph::new(), &[("x", "m"), ("y", "m")]);
    system.lagrangian = system.expression("(x'^2 + y'^2 - x^2 - 4*y^2)/2 + 100*x^7").unwrap();
    let start = State { t: 0.2, q: vec![1.0, 0.0], v: vec![0.5, 2.0] };
    let e = Discrete::chetaev(&system, &start, 3.0).unwrap().trajectory(3).unwrap().stop.unwrap();
    assert!(matches!(e, DiscreteError::NotConverged { .. } | DiscreteError::NotFinite { .. }), "{e}");
}
