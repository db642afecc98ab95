//! Every error, and what needs more than the order to be seen.

use mechanics::{State, System};
use scene::Scene;
use symbolic::Graph;

use super::*;

pub(crate) fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../validation/scenes");
    Scene::load(&std::path::Path::new(folder).join(name).with_extension("toml")).unwrap()
}

#[test]
fn removed_sledge_has_its_costates() {
    // P_x' = −G_x = −g sin α, P_y' = 0, so P_x = P_x(0) − g sin α t even on the grid; only x has weight
    let scene = scene("sledge");
    let removal = scene.removals.iter().find(|r| r.name == "arc-length").unwrap();
    let at = RemovedStart::at(&scene.system, removal, &scene.start, &[2.0, -0.5]).unwrap();
    let mut discrete = Discrete::removed(&scene.system, removal, &at, 1.0, Ends::GivenStart).unwrap();
    let (steps, momenta) = (10, discrete.momenta(10).unwrap());
    for (k, p) in momenta.iter().enumerate() {
        let expected = 2.0 - 9.81 * 0.4_f64.sin() * k as f64 / steps as f64;
        assert!((p[2] + expected).abs() < 1e-12 && (p[3] - 0.5).abs() < 1e-12, "{p:?}");
    }
    // the natural end P(1) = 0 is P_x(0) = g sin α, P_y = 0, from whatever guess
    let momenta = Discrete::removed(&scene.system, removal, &at, 1.0, Ends::Natural).unwrap().momenta(10).unwrap();
    assert!((momenta[0][2] + 9.81 * 0.4_f64.sin()).abs() < 1e-12 && momenta[0][3].abs() < 1e-12, "{momenta:?}");
    assert!(momenta[10][2].abs() < 1e-13 && momenta[10][3].abs() < 1e-13, "{momenta:?}");
}

#[test]
fn every_error_is_said() {
    let sledge = scene("sledge");
    let (system, start) = (&sledge.system, &sledge.start);
    let mut full = system.clone();
    full.constraints = vec![full.constraints[0]; 3];
    let refused = |error: Result<Discrete, DiscreteError>| error.unwrap_err();
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
    let e = refused(Discrete::removed(&cylinders.system, paper, &at, 1.0, Ends::GivenStart));
    assert!(matches!(&e, DiscreteError::HighRate { symbol, .. } if symbol == "u'"), "{e}");
    let off = State { v: vec![0.0, 1.0, 0.0], ..start.clone() };
    let e = RemovedStart::at(system, &sledge.removals[0], &off, &[0.0; 2]).unwrap_err();
    assert!(matches!(e, DiscreteError::Removal(_)), "{e}");

    let mut discrete = Discrete::chetaev(system, start, 1.0).unwrap();
    let e = discrete.positions(0).unwrap_err();
    assert!(matches!(e, DiscreteError::TooFew { found: 0, limit: 1, .. }), "{e}");
    let mut twice = system.clone();
    twice.constraints.push(twice.constraints[0]);
    let e = Discrete::chetaev(&twice, start, 1.0).unwrap().positions(3).unwrap_err();
    assert!(matches!(e, DiscreteError::Singular { t: 0.0 }), "{e}");
    let hamel = scene("appell-hamel");
    let heading = hamel.removals.iter().find(|r| r.name == "by-heading").unwrap();
    let at = RemovedStart::at(&hamel.system, heading, &hamel.start, &[0.1; 3]).unwrap();
    let e = Discrete::removed(&hamel.system, heading, &at, 1.0, Ends::GivenStart).unwrap().positions(100).unwrap_err();
    assert!(matches!(e, DiscreteError::Singular { t: 0.0 }), "{e}");
    // z'² = a²(x'² + y'²) at rest has no direction
    let rest = State { v: vec![0.0; 3], ..hamel.start.clone() };
    let e = refused(Discrete::chetaev(&hamel.system, &rest, 1.0));
    assert!(matches!(e, DiscreteError::OffConstraint { found, .. } if found.is_nan()), "{e}");
    // with + 100 x⁷ in L the motion runs away in finite time, and no step of 1 follows it
    let mut system = System::new(Graph::new(), &[("x", "m"), ("y", "m")]);
    system.lagrangian = system.expression("(x'^2 + y'^2 - x^2 - 4*y^2)/2 + 100*x^7").unwrap();
    let start = State { t: 0.2, q: vec![1.0, 0.0], v: vec![0.5, 2.0] };
    let e = Discrete::chetaev(&system, &start, 3.0).unwrap().positions(3).unwrap_err();
    assert!(matches!(e, DiscreteError::NotConverged { .. } | DiscreteError::NotFinite { .. }), "{e}");
}
