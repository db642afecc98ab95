//! Motions against what is known of them in closed form.

use referees::closed_forms::{AppellHamel, Disc, Heisenberg, Particle, Pendulum, Sledge, Sleigh, TurntableBall};

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
fn sledge_from_rest_never_passes_its_bound() {
    for phi in [0.0, 0.3] {
        let scene = scene("sledge", &[("x'", 0.0), ("phi", phi), ("duration", 30.0)]);
        let exact = sledge(&scene);
        let bound = exact.descent_bound_from_rest();
        if phi == 0.0 {
            let known = exact.gravity_along / (2.0 * exact.omega * exact.omega);
            assert!((bound - known).abs() <= 1e-15 * known, "g'/(2ω²) = {known}, not {bound}");
        }
        let mut motion = chetaev(&scene);
        let deepest = (0..=30_000).map(|i| at(&mut motion, f64::from(i) * 1e-3).coordinates[0]).fold(0.0, f64::max);
        println!("sledge from rest, φ₀ = {phi}: bound {bound:.9}, deepest {deepest:.9}");
        must(&format!("sledge from rest, φ₀ = {phi}: descent over its bound − 1"), deepest / bound - 1.0, 1e-12);
        must(&format!("sledge from rest, φ₀ = {phi}: and the bound is reached to"), 1.0 - deepest / bound, 1e-5);
    }
}

#[test]
fn upright_disc_rolls_uniformly_and_so_does_the_special_vakonomic_one() {
    let scene = scene("disc", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let disc = Disc {
        radius: parameter(&scene, "R"),
        x: q[0],
        y: q[1],
        psi: q[2],
        phi: q[3],
        roll_rate: v[2],
        turn_rate: v[3],
    };
    let mut uniform = chetaev(&scene);
    must("disc, Chetaev: uniform rolling", error(&mut uniform, &|t| disc.at(t).to_vec()), 1e-9);
    let m = parameter(&scene, "m");
    let mut special = vakonomic(&scene, &[-m * v[0], -m * v[1]]);
    must("disc, vakonomic with μ₀ = −m(ẋ₀, ẏ₀) against Chetaev", gap(&mut special, &mut uniform).0, 1e-9);
    let mut other = vakonomic(&scene, &[0.0, 0.0]);
    must_exceed("disc, vakonomic with μ₀ = 0 against Chetaev", gap(&mut other, &mut uniform).0, 1e-2);
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
fn particle_and_heisenberg_are_elementary() {
    let particle_scene = scene("particle", &[]);
    let (q, v) = (&particle_scene.start.q, &particle_scene.start.v);
    let particle = Particle { position: [q[0], q[1], q[2]], x_speed: v[0], y_speed: v[1] };
    let mut motion = chetaev(&particle_scene);
    must("particle, Chetaev", error(&mut motion, &|t| particle.at(t).to_vec()), 1e-9);

    let scene = scene("heisenberg", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let exact = |multiplier| Heisenberg { multiplier, position: [q[0], q[1], q[2]], velocity: [v[0], v[1]] };
    let straight = exact(0.0);
    must("heisenberg, Chetaev: straight lines", error(&mut chetaev(&scene), &|t| straight.at(t).to_vec()), 1e-9);
    for mu in [0.8, -1.7, 0.0] {
        let circle = exact(mu);
        let mut motion = vakonomic(&scene, &[mu]);
        let what = format!("heisenberg, vakonomic: circles of rate μ = {mu}");
        must(&what, error(&mut motion, &|t| circle.at(t).to_vec()), 1e-9);
    }
}

#[test]
fn appell_hamel_runs_straight_in_every_formulation() {
    let scene = scene("appell-hamel", &[]);
    let (q, v) = (&scene.start.q, &scene.start.v);
    let (g, a) = (parameter(&scene, "g"), parameter(&scene, "a"));
    let run = AppellHamel { gravity: g, slope: a, position: [q[0], q[1], q[2]], velocity: [v[0], v[1], v[2]] };
    assert!((run.acceleration() + g * a / (1.0 + a * a)).abs() < 1e-15);
    let exact = |t| run.at(t).expect("not yet at rest").to_vec();
    let mut reference = chetaev(&scene);
    must("appell-hamel, Chetaev: straight, v̇_h = −g a/(1 + a²)", error(&mut reference, &exact), 1e-9);
    for mu in [0.0, 0.5, -1.0] {
        let mut motion = vakonomic(&scene, &[mu]);
        must(
            &format!("appell-hamel, vakonomic with μ₀ = {mu} against Chetaev"),
            gap(&mut motion, &mut reference).0,
            1e-9,
        );
        must(&format!("appell-hamel, vakonomic with μ₀ = {mu}: closed form"), error(&mut motion, &exact), 1e-9);
    }
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
    use tests::references::{Motion, REFERENCES};
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
