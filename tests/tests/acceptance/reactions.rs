//! Reactions of one's own: `E = Q + Wᵀλ`, `f = 0`, against motions by hand.

use mechanics::StartError;
use motion::{PRESCRIBED, SolveError};
use scene::Scene;

use super::support::{
    at, chetaev, choice, complete, equations, error, index, largest_difference, motion_of, must, must_exceed,
    parameter, scene, tight,
};

fn prescribed(scene: &Scene) -> motion::Motion {
    motion_of(scene, equations(&scene.system, PRESCRIBED, None), &[], &tight())
}

/// `l₁ (sin ψ)'' = −g sin b`, `ψ = a − b`: the middle hinge is accelerated along the lower rod only.
#[test]
fn servo_pendulum() {
    for (b, duration) in [(0.05, 2.0), (-0.15, 0.42), (2.9, 0.3)] {
        let scene = scene("servo-pendulum", &[("b", b), ("duration", duration)]);
        let (a, rate) = (scene.start.q[0], scene.start.v[0]);
        let bend = -parameter(&scene, "g") * f64::sin(b) / parameter(&scene, "l1");
        let sine = |t: f64| f64::sin(a - b) + f64::cos(a - b) * rate * t + bend * t * t / 2.0;
        // the branch of the start
        let turned = |s: f64| if f64::cos(a - b) > 0.0 { s.asin() } else { -std::f64::consts::PI - s.asin() };
        let exact = |t: f64| vec![b + turned(sine(t)), b];
        let mut motion = complete(&scene, prescribed(&scene));
        must(&format!("servo pendulum, b = {b}"), error(&mut motion, &exact), 1e-10);
    }
}

/// Where the rods come to be perpendicular the motor has no hold on the lower one: sin ψ = 1.
#[test]
fn a_motor_that_loses_its_hold_ends_the_motion() {
    let scene = scene("servo-pendulum", &[("b", -0.15), ("duration", 2.0)]);
    let (b, a, rate) = (scene.start.q[1], scene.start.q[0], scene.start.v[0]);
    let bend = -parameter(&scene, "g") * b.sin() / parameter(&scene, "l1");
    let (first, half) = ((a - b).cos() * rate, bend / 2.0);
    let end = (-first + (first * first + 4.0 * half * (1.0 - (a - b).sin())).sqrt()) / (2.0 * half);
    let motion = prescribed(&scene);
    assert!(!motion.is_complete(), "{:?}", motion.ending);
    must("servo pendulum: end of the motion", (motion.end() - end).abs(), 1e-9);
}

/// `s' = dΩ (s + bΩ)/b` along the body.
#[test]
fn robot_turned_by_one_wheel() {
    let scene = scene("one-motor-robot", &[]);
    let [d, b, omega] = ["d", "b", "Omega"].map(|name| parameter(&scene, name));
    let (phi, start) = (scene.start.q[2], 0.3);
    let (rate, rest) = (d * omega / b, -b * omega);
    // ∫ (rest + (start − rest) e^{rate t}) e^{i(φ + Ωt)} dt
    let exact = |t: f64| {
        let (turned, grown) = (phi + omega * t, (start - rest) * (rate * t).exp());
        let steady = [turned.sin() - phi.sin(), phi.cos() - turned.cos()].map(|e| rest * e / omega);
        let square = rate * rate + omega * omega;
        let growing = |c: f64, s: f64, size: f64| size * (rate * c + omega * s) / square;
        let x = growing(turned.cos(), turned.sin(), grown) - growing(phi.cos(), phi.sin(), start - rest);
        let y = growing(turned.sin(), -turned.cos(), grown) - growing(phi.sin(), -phi.cos(), start - rest);
        vec![steady[0] + x, steady[1] + y, turned]
    };
    let mut motion = complete(&scene, prescribed(&scene));
    must("one-motor robot", error(&mut motion, &exact), 1e-10);
    // by Chetaev the turning needs a torque alone: s' = dΩ²
    let mut own = chetaev(&scene);
    let speed = |motion: &mut motion::Motion| {
        let now = at(motion, 4.0);
        now.velocities[0] * now.coordinates[2].cos() + now.velocities[1] * now.coordinates[2].sin()
    };
    must("one-motor robot, Chetaev: speed", (speed(&mut own) - (start + d * omega * omega * 4.0)).abs(), 1e-11);
    must_exceed("one-motor robot: the speeds", speed(&mut motion) - speed(&mut own), 2.0);
}

/// `u' = 0`, `J w' = −c m u w`: the turning dies out, though the force is across the body.
#[test]
fn skate_kept_on_course_from_its_stern() {
    let scene = scene("rudder-skate", &[]);
    let [m, inertia, c] = ["m", "J", "c"].map(|name| parameter(&scene, name));
    let (speed, turn, phi) = (0.8, scene.start.v[2], index(&scene, "phi"));
    let rate = c * m * speed / inertia;
    let mut motion = complete(&scene, prescribed(&scene));
    let (mut course, mut reaction) = (0.0_f64, 0.0_f64);
    for i in 0..=40 {
        let now = at(&mut motion, 0.1 * f64::from(i));
        let decayed = (-rate * 0.1 * f64::from(i)).exp();
        let angle = scene.start.q[phi] + turn * (1.0 - decayed) / rate;
        let along = [angle.cos(), angle.sin()].map(|e| speed * e);
        let found = [now.coordinates[phi], now.velocities[0], now.velocities[1], now.velocities[phi]];
        course = course.max(largest_difference(&found, &[angle, along[0], along[1], turn * decayed]));
        // m times the centripetal acceleration
        reaction = reaction.max((now.multipliers[0] - m * speed * turn * decayed).abs());
    }
    must("rudder skate", course, 1e-10);
    must("rudder skate: reaction", reaction, 1e-8);
    assert!(motion.equations.invariants.is_empty(), "the reaction does work: {:?}", motion.equations.invariants);
}

#[test]
fn reactions_that_cannot_keep_the_constraints_are_refused_with_the_number() {
    let refused = |name: &str, overrides: &[(&str, f64)], change: Option<(&str, &str)>| {
        let mut scene = scene(name, overrides);
        if let Some((from, to)) = change {
            let text = scene::catalogue::text_of(name).expect("built in");
            assert!(text.contains(from), "{from}");
            scene = Scene::parse(name, &text.replace(from, to)).unwrap_or_else(|e| panic!("{e}"));
        }
        let choice = choice(PRESCRIBED, None, mechanics::ConstantsRule::Zero);
        match motion::solve_choice(&scene, &choice, &tight()) {
            Err(SolveError::Start(StartError::SingularReactions { ratio, limit, .. })) => {
                assert_eq!(limit, 1e-10);
                ratio
            }
            Err(other) => panic!("{name}: {other}"),
            Ok(_) => f64::INFINITY,
        }
    };
    let perpendicular = 0.05 + std::f64::consts::FRAC_PI_2;
    must("rods perpendicular", refused("servo-pendulum", &[("a", perpendicular)], None), 1e-12);
    // nearly: it is accepted, and the number is not small by units
    let near = [("a", perpendicular - 1e-6), ("duration", 1e-9)];
    assert_eq!(refused("servo-pendulum", &near, None), f64::INFINITY);
    // a force along the blade does not keep it from sliding, in any units
    let along = Some(("[\"y'*cos(phi) - x'*sin(phi) - c*phi'\"]", "[\"x'*cos(phi) + y'*sin(phi)\"]"));
    must("skate pushed along", refused("rudder-skate", &[], along), 1e-12);
    let dependent = Some(("x'*cos(phi) + y'*sin(phi) + b*phi'", "2e7*(y'*cos(phi) - x'*sin(phi))"));
    must("rows dependent", refused("one-motor-robot", &[], dependent), 1e-12);
}
