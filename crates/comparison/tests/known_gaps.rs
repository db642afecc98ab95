//! Gaps beside what is known to have been added up to a coordinate: `y' = A − A cos(10⁻¹⁴ x)`, which is 0, of
//! a `y` that is 1 at the start.

use comparison::{Gap, Sampling, Verdict, compare_motions_by};
use equations::Formulation;
use motion::{CHETAEV, Metric, Motion, REMOVED_CONSTRAINT, Settings, choices, solve_choice};
use scene::Scene;

const EPS: f64 = f64::EPSILON;

/// The motion up to a time of 2 in which `sum` is added up to `y`, and that goes on by `drift t`.
fn motion(formulation: &'static Formulation, sum: f64, drift: f64, inertia: f64, start: f64) -> (Scene, Motion) {
    let text = format!(
        "title = \"added\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 1 }}\n[system]\n\
         lagrangian = \"(x'^2 + {inertia:?}*y'^2)/2\"\nconstraints = [\"y' - {0:?}*(1 - cos(1e-14*x)) - {drift:?}\"]\n\
         [start]\ntime = {start:?}\n[start.velocities]\n\"x'\" = 0.1\n[run]\nduration = 2\n",
        0.25 * sum
    );
    let scene = Scene::parse("added", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
    let choice = choices(&scene).into_iter().find(|c| c.formulation == formulation).expect("a choice");
    let motion = solve_choice(&scene, &choice, &Settings::default()).expect("a motion");
    (scene, motion)
}

fn compared((scene, mut one): (Scene, Motion), (_, mut other): (Scene, Motion), offset: f64) -> Gap {
    let mut metric = Metric::new(&scene.system).expect("a metric");
    let sampling = Sampling { offset, ..Sampling::default() };
    compare_motions_by(&mut one, &mut other, &mut metric, &sampling).expect("a gap")
}

#[test]
fn what_is_added_up_to_either_motion_is_in_the_limit() {
    let known = 10.0 * 240.0 * EPS;
    for (sums, offset) in [([240.0, 0.0], 0.0), ([0.0, 240.0], 0.0), ([0.0, 240.0], 100.0)] {
        let [one, other] =
            [(sums[0], 0.0), (sums[1], offset)].map(|(sum, start)| motion(REMOVED_CONSTRAINT, sum, 0.0, 1.0, start));
        let gap = compared(one, other, offset);
        let found = gap.limit_at(2.0);
        assert!((0.9 * known..1.7 * known).contains(&found), "{sums:?}, {offset}: {found:e}, {known:e}");
        assert_eq!(gap.verdict, Verdict::Same);
    }
    let none = || motion(CHETAEV, 0.0, 0.0, 1.0, 0.0);
    assert!(compared(none(), none(), 0.0).limit_at(2.0) < 0.5 * known);
}

/// A difference of `y`, whose inertia is little, has to pass a hundredfold of what was added up to it.
#[test]
fn a_difference_under_what_is_added_up_to_a_coordinate_is_not_certain() {
    let limit = 100.0 * 100.0 * EPS;
    for (part, certain) in [(0.8, false), (2.0, true)] {
        let apart = part * limit;
        let [one, other] = [0.0, 0.5 * apart].map(|drift| motion(REMOVED_CONSTRAINT, 100.0, drift, 1e-6, 0.0));
        let gap = compared(one, other, 0.0);
        assert!(!gap.shows());
        assert_eq!(gap.certain_by_coordinate[1].is_some(), certain, "{apart:e}, limit {limit:e}");
        assert!((gap.largest_by_coordinate[1] / apart - 1.0).abs() < 0.05, "{gap:?}");
    }
}
