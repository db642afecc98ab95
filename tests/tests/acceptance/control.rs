//! The control formulation is wrong on purpose: it must be caught wherever it is wrong, and called right where it is right (T12).

use std::collections::HashMap;

use deltaq::{Metric, Motion, Settings, Verdict, compare_motions};
use mechanics::Removal;
use random::substitution;
use scene::Scene;
use symbolic::Symbol;

use super::support::{at, chetaev, complete, number, removal_values, scenes, state_at};

/// Times along the Chetaev motion at which the control's equations are put to the test.
const TIMES: [f64; 4] = [0.0, 0.11, 0.23, 0.42];

/// What the control's equations leave over on the Chetaev motion, relative to their terms, at the worst of [`TIMES`].
///
/// With `q̇ = Φ(u̇, u, w)` and `L̃ = L(q, Φ)`, the Chetaev motion has `(d/dt L_v − L_q)·Φ_u̇ = 0`, so there
///
/// ```text
/// d/dt L̃_u̇ − L̃_u = L_q·Φ_u̇ + L_v·(d/dt Φ_u̇ − Φ_u) − L_q·q_u
/// ```
///
/// with `q_u` the explicit derivative of the coordinates. Nothing here is taken from the control itself.
fn defect(scene: &Scene, removal: &Removal, motion: &mut Motion) -> f64 {
    let system = scene.system.clone();
    let g = &system.graph;
    let phi = removal.velocities(&system);
    let rewrite = |e| removal.rewrite(&system, e);
    let force: Vec<_> = g.gradient(system.lagrangian, &system.positions()).into_iter().map(rewrite).collect();
    let momenta: Vec<_> = g.gradient(system.lagrangian, &system.velocities()).into_iter().map(rewrite).collect();
    let flow = removal.flow(&system);
    let mut worst = 0.0_f64;
    for part in TIMES {
        let t = scene.start.t + part * scene.duration;
        let mut values = removal_values(&system, removal, &state_at(motion, t));
        values.extend(accelerations(removal, motion, t));
        for u in &removal.parameters {
            let (mut sum, mut size) = (0.0, 0.0);
            for i in 0..phi.len() {
                let by_rate = g.derivative(phi[i], u.rate);
                let curvature = g.sub(g.total_derivative(by_rate, &flow), g.derivative(phi[i], u.symbol));
                let explicit = g.derivative(removal.coordinates[i], u.symbol);
                for term in [g.mul(force[i], by_rate), g.mul(momenta[i], curvature), g.neg(g.mul(force[i], explicit))] {
                    let x = number(g, term, &values);
                    sum += x;
                    size += x.abs();
                }
            }
            if size > 0.0 {
                worst = worst.max(sum.abs() / size.max(1e-6));
            }
        }
    }
    worst
}

/// `ü` of parameters that are coordinates, by differences along the motion.
fn accelerations(removal: &Removal, motion: &mut Motion, t: f64) -> HashMap<Symbol, f64> {
    let h = 1e-4;
    let (from, to) = ((t - h).max(motion.start()), t + h);
    let (before, after) = (at(motion, from).velocities, at(motion, to).velocities);
    let of = |u: &mechanics::DisplacementParameter| {
        let rate = u.coordinate.map_or(0.0, |i| (after[i] - before[i]) / (to - from));
        (u.second_rate, rate)
    };
    removal.parameters.iter().map(of).collect()
}

#[test]
fn control_is_flagged_wherever_it_is_wrong() {
    let mut right = Vec::new();
    for scene in scenes() {
        let run = substitution::run(&scene, &deltaq::choices(&scene), &Settings::default());
        let run = run.unwrap_or_else(|| panic!("{}: the control did not run", scene.name));
        let mut reference = chetaev(&scene);
        let removal = run.choice.removal.expect("the control has a removal");
        let defect = defect(&scene, &removal, &mut reference);
        assert!(!(1e-9..1e-4).contains(&defect), "{}: cannot tell whether {defect:e} is zero", scene.name);
        let wrong = defect > 1e-4;
        let mut control = run.outcome.unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        let mut metric = Metric::new(&scene.system).expect("compiles");
        let gap = compare_motions(&mut control, &mut reference, &mut metric).expect("readable");
        println!(
            "{:<26} removal {:<14} defect on the Chetaev motion {defect:8.1e}, gap {:8.1e}: {:?} from {:?}",
            scene.name, removal.name, gap.largest, gap.verdict, gap.certain_from
        );
        if wrong {
            assert_eq!(gap.verdict, Verdict::Different, "{}: wrong, and not noticed", scene.name);
        } else {
            right.push(scene.name.clone());
            complete(&scene, control);
            assert_eq!(gap.verdict, Verdict::Same, "{}: right, and not called so", scene.name);
        }
    }
    assert!(right.iter().any(|name| name == "bowl"), "bowl is not among {right:?}");
    assert!(right.len() < 5, "wrong on too few scenes: right on {right:?}");
}
