//! Motions against what is known of them in closed form.

use referees::closed_forms::{Particle, Pendulum, Sledge, Sleigh, TurntableBall};

use super::support::{at, chetaev, common_times, error, gap, index, must, must_exceed, parameter, scene, vakonomic};
use scene::Scene;

/// The closed form from the start of a scene.
pub fn sledge(scene: &Scene) -> Sledge {
    let (q, v) = (&scene.start.q, &scene.start.v);
    Sledge {
        gravity_along: parameter(scene, "g") * parameter(scene, "alpha").sin(),
        x: q[0],
        y: q[1],
        phi: q[2],
        speed: v[0] * q[2].cos() + v[1] * q[2].sin(),
        omega: v[2],
    }
}

#[test]
fn sledge_chetaev_follows_its_closed_form_at_every_rate_of_turning() {
    for omega in [1.1, 1e-9, 0.0] {
        let scene = scene("sledge", &[("phi'", omega)]);
        let exact = sledge(&scene);
        let mut motion = chetaev(&scene);
        let at_end = exact.at(10.0);
        let end = at(&mut motion, 10.0);
        let gap = super::support::largest_difference(&end.coordinates, &[at_end.x, at_end.y, at_end.phi]);
        println!("sledge, ω = {omega}: x = {}, y = {}", at_end.x, at_end.y);
        must(&format!("sledge, Chetaev, ω = {omega:e}: error at t = 10"), gap, 1e-10);
        let whole = error(&mut motion, &|t| {
            let s = exact.at(t);
            vec![s.x, s.y, s.phi]
        });
        must(&format!("sledge, Chetaev, ω = {omega:e}: largest error over 10 s"), whole, 1e-10);
        let reaction = (end.multipliers[0] - at_end.reaction).abs();
        must(&format!("sledge, Chetaev, ω = {omega:e}: reaction at t = 10"), reaction, 1e-10);
    }
}

#[test]
fn ball_on_a_turntable_circles_at_two_sevenths() {
    let scene = scene("turntable", &[]);
    let (x, y) = (index(&scene, "x"), index(&scene, "y"));
    let (q, v) = (&scene.start.q, &scene.start.v);
    let table = parameter(&scene, "Omega");
    let ball = TurntableBall::homogeneous(table, [q[x], q[y]], [v[x], v[y]]);
    let mut motion = chetaev(&scene);
    let (mut error, mut rate) = (0.0_f64, 0.0_f64);
    let centre = ball.centre();
    for t in common_times(&[&motion]) {
        let now = at(&mut motion, t);
        let expected = ball.at(t);
        let found = [now.coordinates[x], now.coordinates[y], now.velocities[x], now.velocities[y]];
        error = error.max(super::support::largest_difference(&found, &expected));
        let arm = [found[0] - centre[0], found[1] - centre[1]];
        let turning = (arm[0] * found[3] - arm[1] * found[2]) / (arm[0] * arm[0] + arm[1] * arm[1]);
        rate = rate.max((turning / table - 2.0 / 7.0).abs());
    }
    must("turntable, Chetaev: circle, position and velocity", error, 1e-9);
    must("turntable, Chetaev: rate over table's rate − 2/7", rate, 1e-9);
    let mut other = vakonomic(&scene, &[0.0, 0.0]);
    must_exceed("turntable, vakonomic with μ₀ = 0 against Chetaev", gap(&mut other, &mut motion).0, 1e-3);
}

#[test]
fn sleigh_settles_as_a_hyperbolic_tangent() {
    let scene = scene("sleigh", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let speed = |velocities: &[f64], phi: f64| velocities[0] * phi.cos() + velocities[1] * phi.sin();
    let (m, i, a) = (parameter(&scene, "m"), parameter(&scene, "I"), parameter(&scene, "a"));
    let sleigh = Sleigh { mass: m, inertia: i, offset: a, phi: q[2], speed: speed(v, q[2]), omega: v[2] };
    // v = V tanh(κt + c), written out here as well
    let j = i + m * a * a;
    let w = (v[2] * v[2] + m * sleigh.speed * sleigh.speed / j).sqrt();
    let (top, kappa) = (w * (j / m).sqrt(), a * w * (m / j).sqrt());
    let c = (sleigh.speed / top).atanh();
    let mut motion = chetaev(&scene);
    let (mut error, mut tangent) = (0.0_f64, 0.0_f64);
    for t in common_times(&[&motion]) {
        let now = at(&mut motion, t);
        let phi = now.coordinates[2];
        let found = speed(&now.velocities, phi);
        let known = sleigh.at(t);
        error = error
            .max((found - known.speed).abs())
            .max((now.velocities[2] - known.omega).abs())
            .max((phi - known.phi).abs());
        tangent = tangent.max((found - top * (kappa * t + c).tanh()).abs());
    }
    must("sleigh, Chetaev: v, ω, φ", error, 1e-9);
    must("sleigh, Chetaev: v − V tanh(κt + c)", tangent, 1e-9);
}

#[test]
fn particle_is_elementary() {
    let scene = scene("particle", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let particle = Particle { position: [q[0], q[1], q[2]], x_speed: v[0], y_speed: v[1] };
    let mut motion = chetaev(&scene);
    must("particle, Chetaev", error(&mut motion, &|t| particle.at(t).to_vec()), 1e-9);
}

#[test]
fn pendulum_swings_as_jacobi_says() {
    let scene = scene("velocity-pendulum", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let length = parameter(&scene, "l");
    let rate = (q[0] * v[1] - q[1] * v[0]) / (length * length);
    let pendulum = Pendulum { length, gravity: parameter(&scene, "g"), angle: q[0].atan2(-q[1]), rate };
    let exact = |t| {
        let [x, y, ..] = pendulum.at(t).expect("swings");
        vec![x, y]
    };
    must("velocity-pendulum, Chetaev: Jacobi's functions", error(&mut chetaev(&scene), &exact), 1e-9);
    for mu in [0.0, 0.7, -2.0] {
        let what = format!("velocity-pendulum, vakonomic with μ₀ = {mu}: Jacobi's functions");
        must(&what, error(&mut vakonomic(&scene, &[mu]), &exact), 1e-9);
    }
}

#[test]
fn the_closed_form_of_the_sledge_agrees_with_the_independent_references() {
    use crate::references::{Motion, REFERENCES};
    let sledge = sledge(&scene("sledge", &[]));
    let chetaev = REFERENCES.iter().filter(|r| r.scene == "sledge" && r.motion == Motion::Chetaev);
    assert_eq!(chetaev.clone().count(), 2);
    for reference in chetaev {
        let state = sledge.at(reference.t);
        let found = [state.x, state.y, state.phi, state.reaction];
        let known = reference.q.iter().chain(&reference.multipliers);
        for (a, b) in found.into_iter().zip(known) {
            assert!((a - b).abs() <= 1e-14 * b.abs(), "{a} is not {b} at t = {}", reference.t);
        }
    }
}
