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

/// A ball of radius 1 with moments of inertia 0.4, 0.4, 0.5, of this rotation, whose third axis passes the
/// vertical after a time of 1 at a distance of `d` radians.
fn inhomogeneous(rotation: &str, angles: [(&str, f64, f64); 3]) -> Scene {
    let starts = angles.map(|(name, start, _)| format!("{name} = {{ start = {start} }}\n")).concat();
    let rates = angles.map(|(name, _, rate)| format!("\"{name}'\" = {rate:?}\n")).concat();
    let text = format!(
        "title = \"A ball\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 0 }}\n{starts}[body.ball]\n\
         at = \"[x, y, 1]\"\nrotation = \"{rotation}\"\nshape = \"ball\"\nsize = [1]\nmass = 1\n\
         inertia = [0.4, 0.4, 0.5]\n[contact.ball]\nof = \"ball\"\nlaw = \"rolls\"\n[start.velocities]\n{rates}\
         [run]\nduration = 2\n"
    );
    Scene::parse("ball", &text).unwrap_or_else(|e| panic!("{e}"))
}

/// In angles that have a pole where it passes, an inhomogeneous ball stops by every method and says why; in
/// others it passes, and rolls straight on: `ω = (−1, 0, 0)`, so that `y = t`, as far as `d` tells.
#[test]
fn an_inhomogeneous_ball_passes_a_pole_in_other_angles() {
    let choice = |scene: &Scene| choices(scene).into_iter().find(|choice| choice.formulation == CHETAEV);
    for d in [7e-6, 1e-8] {
        let at_a_pole = [("psi", 0.0, d), ("theta", 1.0, -1.0), ("phi", 0.4, -0.3 * d)];
        let scene = inhomogeneous("rotation(zxz, psi, theta, phi)", at_a_pole);
        for method in METHODS {
            let settings = Settings { method, ..Settings::default() };
            let motion = solve_choice(&scene, &choice(&scene).expect("it is there"), &settings).expect("a motion");
            let (status, cause) = motion.ending.status(None);
            let cause = cause.expect("a cause");
            assert!(status == "stopped" && cause.contains("nearly dependent"), "{method:?}: {status}, {cause}");
        }
        let beside = [("a", 1.0, -1.0), ("b", 0.0, d), ("c", 0.4, -0.3 * d)];
        let scene = inhomogeneous("rotation(xyz, a, b, c)", beside);
        for (end, _) in ends(&scene, &METHODS) {
            let off = end[0].hypot(end[1] - 2.0).hypot(end[2] + 1.0);
            assert!(off < 10.0 * d, "{d}: {end:?}");
        }
    }
}
