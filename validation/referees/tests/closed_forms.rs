//! Every motion put into its equations of motion by central differences.

use referees::closed_forms::*;

/// First derivative by an eight-point central difference, error `O(h⁸)`.
fn derivative<const N: usize>(f: impl Fn(f64) -> [f64; N], t: f64) -> [f64; N] {
    let h = 2e-2;
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let mut out = [0.0; N];
    for (i, w) in (1..=4).zip(weights) {
        let d = h * f64::from(i);
        let (ahead, behind) = (f(t + d), f(t - d));
        for j in 0..N {
            out[j] += w * (ahead[j] - behind[j]) / h;
        }
    }
    out
}

#[track_caller]
fn close(left: f64, right: f64, tolerance: f64) {
    assert!((left - right).abs() <= tolerance * (1.0 + right.abs()), "{left} is not {right}");
}

/// Nine-digit comparison: what eight-point differences of step 0.02 leave.
#[track_caller]
fn same<const N: usize>(left: [f64; N], right: [f64; N]) {
    for (l, r) in left.into_iter().zip(right) {
        close(l, r, 1e-9);
    }
}

#[test]
fn small_argument_functions_join() {
    for z in [1.0 - 1e-12, 1.0 + 1e-12, -1.0 - 1e-12] {
        close(sine_defect(z), 1.0 - 1.0_f64.sin(), 1e-12);
    }
    close(sine_defect(1e-9), 1.0 / 6.0, 1e-16);
    close(sinc(1e-4 * (1.0 - 1e-9)), sinc(1e-4 * (1.0 + 1e-9)), 1e-15);
}

#[test]
fn sledge_obeys_its_equations() {
    for omega in [1.1, -0.4, 0.0, 1e-9, 1e-5] {
        let sledge = Sledge { gravity_along: 3.8, x: 0.1, y: -0.2, phi: 0.3, speed: 0.5, omega };
        for t in [0.0, 0.7, 4.0] {
            let at = |t| {
                let s = sledge.at(t);
                [s.x, s.y, s.run]
            };
            let state = sledge.at(t);
            let (sin, cos) = state.phi.sin_cos();
            let velocity = |t| derivative(at, t);
            same(velocity(t), [state.speed * cos, state.speed * sin, state.speed]);
            let exact_velocity = |t| {
                let s = sledge.at(t);
                [s.speed * s.phi.cos(), s.speed * s.phi.sin()]
            };
            // ẍ = g' − λ sin φ, ÿ = λ cos φ
            same(derivative(exact_velocity, t), [3.8 - state.reaction * sin, state.reaction * cos]);
        }
    }
}

#[test]
fn sledge_is_continuous_through_no_turning() {
    let start = Sledge { gravity_along: 3.8, x: 0.0, y: 0.0, phi: 0.3, speed: 0.5, omega: 0.0 };
    let still = start.at(5.0);
    let slow = Sledge { omega: 1e-9, ..start }.at(5.0);
    for (a, b) in [(slow.x, still.x), (slow.y, still.y), (slow.run, still.run), (slow.speed, still.speed)] {
        close(a, b, 3e-8);
    }
    // first order in ω: ∂y/∂ω = v₀ t² cos φ₀/2 + g' t³ (cos 2φ₀/4 + 1/12), to the digits that 1e-9 leaves
    let expected = 1e-9 * (0.5 * 12.5 * 0.3_f64.cos() + 3.8 * 125.0 * (0.6_f64.cos() / 4.0 + 1.0 / 12.0));
    assert!((slow.y - still.y - expected).abs() < 1e-14);
}

#[test]
fn turntable_ball_circles_and_rolls() {
    let (m, a, table) = (1.3, 0.1, 0.7);
    let inertia = 0.4 * m * a * a;
    let ball = TurntableBall::homogeneous(table, [0.65, 0.0], [0.0, 0.12]);
    close(ball.radius(), 0.6, 1e-14);
    same(ball.centre(), [0.05, 0.0]);
    for t in [0.0, 3.0, 11.0] {
        let [x, y, vx, vy] = ball.at(t);
        let d = derivative(|t| ball.at(t), t);
        same([d[0], d[1]], [vx, vy]);
        close((x - 0.05).hypot(y), 0.6, 1e-14);
        // rolling: a ω_y = ẋ + Ωy, a ω_x = Ωx − ẏ; contact force m v̇ on the spin: I ω̇ = −a e_z × m v̇
        let spin = |t: f64| {
            let [x, y, vx, vy] = ball.at(t);
            [(table * x - vy) / a, (vx + table * y) / a]
        };
        let turn = derivative(spin, t);
        same([inertia * turn[0], inertia * turn[1]], [a * m * d[3], -a * m * d[2]]);
    }
}

#[test]
fn sleigh_obeys_its_equations() {
    for (offset, speed, omega) in
        [(0.4, -0.6, 1.5), (0.4, 0.6, -1.5), (-0.3, 0.2, 0.9), (1e-7, 0.3, 1.0), (0.0, 0.3, 1.0), (0.4, 0.7, 0.0)]
    {
        let sleigh = Sleigh { mass: 1.2, inertia: 0.3, offset, phi: 0.2, speed, omega };
        let j = 0.3 + 1.2 * offset * offset;
        let at = |t| {
            let s = sleigh.at(t);
            [s.speed, s.omega, s.phi]
        };
        same(at(0.0), [speed, omega, 0.2]);
        for t in [0.1, 1.0, 3.0] {
            let s = sleigh.at(t);
            same(derivative(at, t), [offset * s.omega * s.omega, -1.2 * offset * s.speed * s.omega / j, s.omega]);
            close(1.2 * s.speed * s.speed + j * s.omega * s.omega, 1.2 * speed * speed + j * omega * omega, 1e-13);
        }
    }
    // far ahead and far back: finite, the whole turn is π√(J/m)/a
    let sleigh = Sleigh { mass: 1.0, inertia: 0.3, offset: 0.4, phi: 0.0, speed: -0.6, omega: 1.5 };
    let turn = sleigh.at(1e6).phi - sleigh.at(-1e6).phi;
    close(turn, std::f64::consts::PI * 0.46_f64.sqrt() / 0.4, 1e-14);
}

#[test]
fn particle_obeys_its_equations() {
    for (y0, vy) in [(-1.0, 0.5), (2.0, 0.7), (-3.0, -1e-9), (1.5, 0.0), (0.0, 1e-3)] {
        let particle = Particle { position: [0.3, y0, -0.2], x_speed: 1.2, y_speed: vy };
        let velocity = |t| derivative(|t| particle.at(t), t);
        for t in [0.0, 0.5, 2.0, 6.0] {
            let y = particle.at(t)[1];
            let [dx, dy, dz] = velocity(t);
            close(dy, vy, 1e-9);
            close(dz, y * dx, 1e-9);
            close(dx * y.hypot(1.0), 1.2 * y0.hypot(1.0), 1e-9);
            // ẍ = −y λ, z̈ = λ  ⇒  ẍ + y z̈ = 0
            let [ax, _, az] = derivative(velocity, t);
            close(ax + y * az, 0.0, 1e-7);
        }
    }
}

#[test]
fn pendulum_obeys_its_equations_and_a_reference() {
    let pendulum = Pendulum { length: 1.0, gravity: 9.81, angle: 0.6_f64.asin(), rate: 1.5 };
    same(pendulum.at(0.0).unwrap(), [0.6, -0.8, 1.2, 0.9]);
    for t in [0.0, 1.0, 10.0] {
        let [x, y, vx, vy] = pendulum.at(t).unwrap();
        let [dx, dy, ax, ay] = derivative(|t| pendulum.at(t).unwrap(), t);
        same([dx, dy], [vx, vy]);
        close(x * x + y * y, 1.0, 1e-14);
        // a + g e_y along (x, y)
        close(ax * y - (ay + 9.81) * x, 0.0, 1e-7);
    }
    let period = pendulum.period().unwrap();
    same(pendulum.at(period).unwrap(), pendulum.at(0.0).unwrap());
    // mpmath, 30 digits: ellipfun/ellipk, and odefun on θ̈ = −g sin θ, which agree
    close(period, 2.092_827_185_826_671_7, 4e-16);
    let reference = [
        (1.0, [-0.537_735_194_321_850_1, -0.843_113_788_754_306_9, -1.483_471_238_258_761_9, 0.946_153_064_053_865_4]),
        (10.0, [-0.379_583_687_366_694_2, -0.925_157_405_139_851_7, 2.006_885_487_821_232_3, -0.823_406_902_822_915_1]),
    ];
    for (t, expected) in reference {
        for (ours, theirs) in pendulum.at(t).unwrap().into_iter().zip(expected) {
            close(ours, theirs, 4e-14);
        }
    }
    assert!(Pendulum { rate: 7.0, ..pendulum }.at(1.0).is_none());
}
