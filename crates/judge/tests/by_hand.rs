//! Steppers by hand, for a sledge on an incline: `ẍ = (G, 0, 0) + reactions`, unit masses.

use judge::{Judgement, Law, Samples, judge};
use scene::Scene;

const G: f64 = 0.7;

const SLEDGE: &str = r#"
title = "Sledge"
[coordinates]
x = { unit = "m", start = 0 }
y = { unit = "m", start = 0 }
phi = { unit = "rad", start = 0.3 }
[system]
lagrangian = "(x'^2 + y'^2 + phi'^2)/2 + 0.7*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start]
velocities = { "x'" = 0.5, "phi'" = 1.1 }
[run]
duration = 3
"#;

fn judged(samples: &Samples) -> Judgement {
    judge(&Scene::parse("sledge", SLEDGE).unwrap(), samples, 0.01).unwrap()
}

fn start() -> [f64; 6] {
    [0.0, 0.0, 0.3, 0.5, 0.5 * 0.3f64.tan(), 1.1]
}

/// Classic Runge–Kutta steps of 1 ms, every tenth of them a sample.
fn runge_kutta(acceleration: impl Fn(&[f64; 6]) -> [f64; 3]) -> Samples {
    let rate = |y: &[f64; 6]| {
        let a = acceleration(y);
        [y[3], y[4], y[5], a[0], a[1], a[2]]
    };
    let step = 1e-3;
    let moved = |y: &[f64; 6], k: &[f64; 6], h: f64| -> [f64; 6] { std::array::from_fn(|i| y[i] + h * k[i]) };
    let mut y = start();
    let mut samples = Samples { t: Vec::new(), q: Vec::new(), v: Some(Vec::new()) };
    for i in 0..=3000 {
        if i % 10 == 0 {
            samples.t.push(f64::from(i) * step);
            samples.q.push(y[..3].to_vec());
            samples.v.as_mut().unwrap().push(y[3..].to_vec());
        }
        let k1 = rate(&y);
        let k2 = rate(&moved(&y, &k1, step / 2.0));
        let k3 = rate(&moved(&y, &k2, step / 2.0));
        let k4 = rate(&moved(&y, &k3, step));
        y = std::array::from_fn(|i| y[i] + step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    samples
}

#[test]
fn a_rate_that_is_left_out_is_named() {
    // the reaction keeps A a = 0: it takes the force across the blade, and does not turn the velocity
    let samples = runge_kutta(|y| {
        let (s, c) = y[2].sin_cos();
        let across = -s * G;
        [G + s * across, -c * across, 0.0]
    });
    let found = judged(&samples);
    assert_eq!(found.fitting, [Law::MissingRate], "{:?}", found.laws);
    let part = found.left_out.unwrap();
    assert!((part.value - 1.0).abs() < 1e-6, "{part:?}");
}

#[test]
fn a_soft_contact_by_semi_implicit_steps_slips_by_its_viscosity_and_is_of_first_order() {
    let made = |parts: i32| {
        let step = 1e-3 / f64::from(parts);
        let mut y = start();
        let mut samples = Samples { t: Vec::new(), q: Vec::new(), v: Some(Vec::new()) };
        for i in 0..=3000 * parts {
            if i % (10 * parts) == 0 {
                samples.t.push(f64::from(i) * step);
                samples.q.push(y[..3].to_vec());
                samples.v.as_mut().unwrap().push(y[3..].to_vec());
            }
            let (s, c) = y[2].sin_cos();
            let lambda = -(c * y[4] - s * y[3]) / 0.05;
            y[3] += step * (G - s * lambda);
            y[4] += step * c * lambda;
            for k in 0..3 {
                y[k] += step * y[k + 3];
            }
        }
        samples
    };
    let motions = [made(1), made(2), made(4)];
    let order = judge::order(&motions, &[1e-3, 5e-4, 2.5e-4]).unwrap();
    assert!((order.order - 1.0).abs() < 0.05, "{order:?}");
    let [coarse, fine] = [judged(&motions[1]), judged(&motions[2])].map(|j| {
        assert_eq!(j.law(), Some(Law::Chetaev), "{:?}", j.laws);
        j.slip.unwrap().value
    });
    let slip = 2.0 * fine - coarse;
    assert!((slip - 0.05).abs() < 5e-4, "{coarse} {fine} {slip}");
}

#[test]
fn errors_cover_what_noise_does_to_a_motion() {
    // Chetaev's sledge with a drag of 0.05, and noise of 1e-6 on rates
    let exact = runge_kutta(|y| {
        let (s, c) = y[2].sin_cos();
        let lambda = G * s - y[5] * (-y[3] * c - y[4] * s);
        [G - s * lambda - 0.05 * y[3], c * lambda - 0.05 * y[4], -0.05 * y[5]]
    });
    let mut state = 12345u64;
    let mut uniform = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut scores = Vec::new();
    for _ in 0..60 {
        let mut noisy = exact.clone();
        for row in noisy.v.as_mut().unwrap() {
            row.iter_mut().for_each(|v| *v += 1e-6 * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0));
        }
        let drag = judged(&noisy).drag.unwrap();
        scores.push((drag.value - 0.05) / drag.error);
    }
    let within = scores.iter().filter(|z| z.abs() < 2.0).count();
    let size = (scores.iter().map(|z| z * z).sum::<f64>() / 60.0).sqrt();
    // noise of rates cancels in sums of their differences: errors are on the safe side, five times as large
    println!("within two errors: {within} of 60, rms {size:.2}");
    assert!(within >= 51 && size > 0.1, "{within} of 60, rms {size}");
}
