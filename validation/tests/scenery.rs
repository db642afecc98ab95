//! Bodies along motions.

use picture::Style;
use scene::Scene;
use scene::scenery::{Drawn, FINER, STEPS, moving};
use symbolic::CompileError;

/// A ball at `x`, a lid that `t` turns, and the ground, from t = 2 on for 3.
const TEXT: &str = "title = \"rolls\"\ncoordinates.x.start = 4\nsystem.lagrangian = \"x'^2/2\"\n\
                    [start]\ntime = 2\nvelocities = { \"x'\" = 1 }\n[run]\nduration = 3\n\
                    [view.ground]\nshape = \"plane\"\nsize = [20, 2]\n[view.ball]\nshape = \"ball\"\nsize = [1]\n\
                    at = \"[x, 0, 1]\"\n[view.lid]\nshape = \"rod\"\nsize = [1]\nrotation = \"t\"\n";

fn scene(text: &str) -> Scene {
    Scene::parse("rolls", text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

fn drawn<E>(at: impl Fn(f64) -> Result<Vec<f64>, E> + 'static) -> Vec<Drawn<'static, E>> {
    vec![Drawn { label: "one".into(), style: Style::Chetaev, at: Box::new(at) }]
}

#[test]
fn bodies_are_where_the_motion_has_them() {
    let picture = moving(&scene(TEXT), drawn(|t| Ok::<_, CompileError>(vec![10.0 * t])));
    let picture = picture.unwrap_or_else(|e| panic!("{e}")).expect("a picture");
    assert_eq!(picture.time, (2.0, 5.0, "s".to_string()));
    let [one] = &picture.motions[..] else { panic!("{} motions", picture.motions.len()) };
    let time = |i: usize, steps: usize| 2.0 + 3.0 * i as f64 / steps as f64;
    assert_eq!(one.path.len(), STEPS * FINER + 1);
    assert!(one.path.iter().enumerate().all(|(i, p)| *p == [10.0 * time(i, STEPS * FINER), 0.0, 1.0]));
    // the ball, in the motion; the ground and the lid, which no coordinate moves
    let [ball] = &one.solids[..] else { panic!("{:?}", one.solids) };
    assert!(ball.sphere == Some(1.0) && ball.poses.len() == STEPS + 1, "{ball:?}");
    assert!(ball.poses.iter().enumerate().all(|(i, pose)| pose.at == [10.0 * time(i, STEPS), 0.0, 1.0]));
    let [ground, lid] = &picture.ground[..] else { panic!("{:?}", picture.ground) };
    assert_eq!((ground.sphere, ground.poses.len(), lid.poses.len()), (None, 1, STEPS + 1));
    for (i, pose) in lid.poses.iter().enumerate() {
        let (sine, cosine) = time(i, STEPS).sin_cos();
        let [x, y, _] = pose.rotation;
        let off = (x[0] - cosine).abs() + (y[0] - sine).abs() + (x[1] + sine).abs();
        assert!(off < 1e-12, "{i}: {pose:?}");
    }
}

#[test]
fn what_a_motion_refuses_is_said_and_what_does_not_move_has_no_picture() {
    let unseen = moving(&scene(TEXT), drawn(|_| Err("it has gone"))).expect_err("no motion");
    assert_eq!(unseen.to_string(), "it has gone");
    let still = TEXT.replace("at = \"[x, 0, 1]\"\n", "");
    let none = moving(&scene(&still), drawn(|t| Ok::<_, CompileError>(vec![t])));
    assert!(none.is_ok_and(|picture| picture.is_none()));
}
