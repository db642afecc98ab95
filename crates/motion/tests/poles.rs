//! A ball that rolls past a pole of its angles, closer than its tolerance can see.

use integrate::Method;
use motion::{CHETAEV, Settings, choices, error_estimate, setting, solve_choice};
use scene::Scene;

const METHODS: [Option<Method>; 3] = [None, Some(Method::Dop853), Some(Method::Radau5)];

/// A homogeneous ball of radius 1 in Euler's angles z-x-z. At `d = 0` its axis goes through the pole after a
/// time of 1.
fn ball(d: f64) -> Scene {
    let text = format!(
        "title = \"A ball\"\n[coordinates]\npsi = {{ start = 0.2 }}\ntheta = {{ start = 1 }}\nphi = {{ start = 0.4 }}\n\
         x = {{ start = 0 }}\ny = {{ start = 0 }}\n[system]\nlagrangian = \"(x'^2 + y'^2)/2 \
         + (theta'^2 + psi'^2 + phi'^2 + 2*psi'*phi'*cos(theta))/5\"\n\
         constraints = [\"x' - theta'*sin(psi) + phi'*sin(theta)*cos(psi)\", \
         \"y' + theta'*cos(psi) + phi'*sin(theta)*sin(psi)\"]\n[start.velocities]\n\"psi'\" = {d:?}\n\
         \"theta'\" = -1\n\"phi'\" = {:?}\n[run]\nduration = 2\n",
        0.3 * d
    );
    Scene::parse("ball", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// Ends by these methods, with their estimates; all are trusted.
fn ends(scene: &Scene, methods: &[Option<Method>]) -> Vec<(Vec<f64>, Vec<f64>)> {
    let choice = choices(scene).into_iter().find(|choice| choice.formulation == CHETAEV).expect("it is there");
    let mut ends = Vec::new();
    for &method in methods {
        let settings = Settings { method, ..Settings::default() };
        let mut motion = solve_choice(scene, &choice, &settings).expect("a motion");
        let estimate = error_estimate(&mut motion, setting(scene)).expect("in range");
        assert_eq!(estimate.status(&motion), ("completed", None), "{method:?}");
        ends.push((motion.at(2.0).expect("the end").coordinates, estimate.coordinates));
    }
    ends
}

/// A homogeneous ball has a constant angular velocity, so that it rolls along a line. In quasi-velocities,
/// the default, its equations stay regular; with multipliers it stops before the pole and says so, as Radau's
/// method may do within some millionths.
#[test]
fn a_homogeneous_ball_passes_the_pole_at_a_millionth_of_a_radian() {
    for (d, methods) in [(1e-3, &METHODS[..]), (7e-6, &METHODS[..2]), (1e-8, &METHODS[..1])] {
        let (sine, cosine) = 0.2_f64.sin_cos();
        let (along, across) = (-1.0, -0.3 * d * 1.0_f64.sin());
        let line = [2.0 * (along * sine + across * cosine), 2.0 * (-along * cosine + across * sine)];
        for (end, estimate) in ends(&ball(d), methods) {
            let off = [3, 4].map(|i| (end[i] - line[i - 3]).abs() - 10.0 * estimate[i]);
            assert!(off.iter().all(|off| *off < 1e-12), "{d}: {end:?}, {line:?}");
        }
    }
}
