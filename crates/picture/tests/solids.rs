//! Solids as a camera sees them.

use picture::{Camera, Placement, Solid, Space};

/// Points of the seen part of a line on a sphere.
const SEEN_POINTS: usize = 9;

const IDENTITY: [Space; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn dot(a: Space, b: Space) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn level_circle() -> Vec<Space> {
    (0..=48).map(|i| (f64::from(i % 48) / 48.0 * std::f64::consts::TAU).sin_cos()).map(|(s, c)| [c, s, 0.0]).collect()
}

#[test]
fn axes_of_cameras_are_orthonormal() {
    for camera in [Camera::ABOVE, Camera::oblique(0.4, 0.5)] {
        let axes = [camera.right, camera.up, camera.eye];
        for (i, a) in axes.iter().enumerate() {
            for (j, b) in axes.iter().enumerate() {
                assert!((dot(*a, *b) - f64::from(u8::from(i == j))).abs() < 1e-15);
            }
        }
        // the third is the product of the others
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            camera.right[j] * camera.up[k] - camera.right[k] * camera.up[j]
        });
        assert!((dot(cross, camera.eye) - 1.0).abs() < 1e-15);
    }
}

#[test]
fn a_sphere_hides_the_far_half_of_its_equator() {
    let ball = |poses| Solid { lines: vec![level_circle()], sphere: Some(1.0), poses };
    let camera = Camera::oblique(0.3, 0.5);
    let at = [5.0, -2.0, 1.0];
    let solid = ball(vec![Placement { at, rotation: IDENTITY }]);
    let seen = solid.seen(&camera, 0);
    let line = &seen.lines[0];
    let (centre, radius) = seen.circle.unwrap();
    assert_eq!((line.len(), radius, centre), (SEEN_POINTS, 1.0, camera.project(at)));
    // from one edge to the other, in front: below the centre, by the sine of the elevation
    let from = |p: (f64, f64)| (p.0 - centre.0, p.1 - centre.1);
    let [first, middle, last] = [0, SEEN_POINTS / 2, SEEN_POINTS - 1].map(|i| from(line[i]));
    assert!((first.0 + 1.0).abs() < 1e-2 && (last.0 - 1.0).abs() < 1e-2, "{first:?} {last:?}");
    assert!((middle.1 + 0.5_f64.sin()).abs() < 1e-2, "{middle:?}");
    // from above all of it is seen
    assert!(solid.seen(&Camera::ABOVE, 7).lines[0].iter().all(|&p| p.0.hypot(p.1) > 4.0));
}
