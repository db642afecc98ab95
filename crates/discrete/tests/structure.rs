//! A step keeps its mirror, the symplectic form, energy and constraint over many steps; sums lose none.

use discrete::parts::Compensated;
use discrete::{Composition, Discrete, DiscreteError, RemovedStart};
use scene::Scene;

use crate::refusals::scene;

const SCENES: [&str; 6] = ["sledge", "particle", "ball-in-cone", "heisenberg", "trailer", "appell-hamel"];

/// The motions of a scene that there are, over a time of 1.
fn motions(name: &str) -> Vec<(String, Discrete)> {
    let scene = scene(name);
    let end = scene.start.t + 1.0;
    let multipliers: Vec<f64> = (0..scene.system.constraints.len()).map(|i| 0.3 - 0.2 * i as f64).collect();
    let mut found = vec![("Chetaev".to_string(), Discrete::chetaev(&scene.system, &scene.start, end).unwrap())];
    let vakonomic = Discrete::vakonomic(&scene.system, &scene.start, &multipliers, end);
    found.push(("vakonomic".to_string(), vakonomic.unwrap()));
    // L does not contain the rate of the heading
    for removal in scene.removals.iter().filter(|removal| removal.name != "by-heading") {
        let costates = vec![0.1; removal.memory.len()];
        let start = RemovedStart::at(&scene.system, removal, &scene.start, &costates).unwrap();
        match Discrete::removed(&scene.system, removal, &start, end) {
            Ok(discrete) => found.push((format!("removed, {}", removal.name), discrete)),
            Err(error) => assert!(matches!(error, DiscreteError::HighRate { .. }), "{error}"),
        }
    }
    found
}

#[test]
fn a_step_back_undoes_a_step() {
    let mut count = 0;
    for name in SCENES {
        for (what, discrete) in motions(name) {
            for composition in Composition::ALL {
                let mut discrete = discrete.clone().composed(composition);
                let mut node = discrete.start.clone();
                let h = 0.01;
                for k in 1..=5 {
                    discrete.composed_step(&mut node, h, f64::from(k) * h).unwrap();
                }
                let moved = largest(&difference(&node.x.value, &discrete.start.x.value));
                for k in (0..5).rev() {
                    discrete.step.forget();
                    discrete.composed_step(&mut node, -h, f64::from(k) * h).unwrap();
                }
                for (back, start) in [(&node.x, &discrete.start.x), (&node.p, &discrete.start.p)] {
                    let size = largest(&start.value).max(1.0);
                    let found = largest(&difference(&back.value, &start.value)) / size;
                    // the conditioning of the cone's chart is of the order of 100
                    assert!(found < 1e-13, "{name}, {what}, {composition:?}: {found:e} after moving by {moved:e}");
                }
                assert!(moved > 1e-3, "{name}, {what}");
                count += 1;
            }
        }
    }
    assert!(count >= 60, "{count}");
}

#[test]
fn motions_are_read_off_between_nodes_as_well_as_at_them() {
    let exact = |t: f64| 0.3 + 1.1 * t;
    for (name, what) in [("sledge", "Chetaev"), ("heisenberg", "vakonomic")] {
        let discrete = motions(name).into_iter().find(|m| m.0 == what).unwrap().1.composed(Composition::Sixth);
        let mut fine = discrete.trajectory(64).unwrap();
        let mut coarse = discrete.trajectory(20).unwrap();
        let h = coarse.step();
        for k in 0..=20 {
            for part in [0.0, 1e-17, 1e-15, 1e-12, 1e-6, 0.06, 0.07, 0.5, 0.99, 1.0 - 1e-14] {
                let t = ((f64::from(k) + part) * h).min(1.0);
                let (one, two) = (coarse.at(t).unwrap(), fine.at(t).unwrap());
                for (a, b) in [(&one.x, &two.x), (&one.v, &two.v)] {
                    let found = largest(&difference(a, b));
                    assert!(found < 1e-8, "{name} at {t}: {found:e}");
                }
                if name == "sledge" {
                    assert!((one.x[2] - exact(t)).abs() < 1e-14, "{t}");
                    assert!((one.v[1] * one.x[2].cos() - one.v[0] * one.x[2].sin()).abs() < 1e-14, "{t}");
                }
            }
        }
    }
}

#[test]
fn steps_of_stationary_action_are_symplectic() {
    let mut count = 0;
    for name in ["sledge", "particle", "ball-in-cone", "heisenberg"] {
        for (what, discrete) in motions(name).into_iter().skip(1) {
            for (composition, h) in [(Composition::Second, 0.05), (Composition::Fourth, 0.05)] {
                let mut discrete = discrete.clone().composed(composition);
                let n = discrete.step.size;
                let mut column = |i: usize, change: f64| {
                    let mut node = discrete.start.clone();
                    let part = if i < n { &mut node.x } else { &mut node.p };
                    part.value[i % n] += change;
                    discrete.step.forget();
                    discrete.composed_step(&mut node, h, h).unwrap();
                    [node.x.value, node.p.value].concat()
                };
                // the differences are of order 6
                let d = 4e-3;
                let columns: Vec<Vec<f64>> = (0..2 * n)
                    .map(|i| {
                        let mut sum = vec![0.0; 2 * n];
                        for (times, weight) in [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)] {
                            let (up, down) = (column(i, times * d), column(i, -times * d));
                            for (s, (a, b)) in sum.iter_mut().zip(up.iter().zip(&down)) {
                                *s += weight * (a - b) / (60.0 * d);
                            }
                        }
                        sum
                    })
                    .collect();
                // Ω = Σ dx ∧ dp
                let form = |a: &[f64], b: &[f64]| (0..n).map(|k| a[k] * b[n + k] - a[n + k] * b[k]).sum::<f64>();
                let mut worst = 0.0_f64;
                for i in 0..2 * n {
                    for j in 0..2 * n {
                        let unit = f64::from(u8::from(j == i + n)) - f64::from(u8::from(i == j + n));
                        worst = worst.max((form(&columns[i], &columns[j]) - unit).abs());
                    }
                }
                assert!(worst < 1e-7, "{name}, {what}, {composition:?}: {worst:e}");
                count += 1;
            }
        }
    }
    assert!(count >= 16, "{count}");
}

/// Steps of a long run, unless `STEPS` says another number. Limits below are those of a million: of what
/// grows with the steps, or with their root, fewer steps have to leave less.
const LONG: usize = 125_000;

fn long() -> (usize, f64) {
    let steps = std::env::var("STEPS").map_or(LONG, |steps| steps.parse().expect("a number"));
    (steps, steps as f64 / 1e6)
}

/// What a long run loses.
#[derive(Debug)]
struct Drift {
    /// Largest `|E − E₀|`, over the largest `|v·p|`.
    energy: f64,
    /// Spread of the mean energies of ten parts of the run, same unit: a drift, not an oscillation.
    trend: f64,
    /// Largest `|f_i|`.
    constraint: f64,
}

fn drift(discrete: &Discrete, steps: usize) -> Drift {
    let mut discrete = discrete.clone();
    let reacts = discrete.step.reacts;
    let (mut energies, mut size, mut constraint) = (Vec::with_capacity(steps + 1), 0.0_f64, 0.0_f64);
    let marched = discrete.march(discrete.start.clone(), steps, |step, node| {
        let mut node = node.clone();
        if !reacts {
            step.read(&mut node, 1.0)?;
        }
        let readings = step.readings(&node);
        energies.push(readings[0]);
        constraint = constraint.max(largest(&readings[1..]));
        size = size.max(node.v.iter().zip(&node.p.value).map(|(v, p)| v * p).sum::<f64>().abs());
        Ok(())
    });
    assert_eq!(marched, Ok(()));
    let start = energies[0];
    let energy = energies.iter().fold(0.0_f64, |a, e| a.max((e - start).abs()));
    let means =
        energies.chunks(steps / 10 + 1).map(|part| part.iter().map(|e| e - start).sum::<f64>() / part.len() as f64);
    let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), e| (a.min(e), b.max(e)));
    Drift { energy: energy / size, trend: (high - low) / size, constraint }
}

#[test]
fn many_steps_of_order_four_keep_energy_and_constraint() {
    // an integrable constraint: the particle swings in a bowl
    let bowl = scene("bowl");
    // means of parts of the run hold what of an oscillation is left over, the less the longer they are
    let steps = 4 * long().0;
    let swing = Discrete::chetaev(&bowl.system, &bowl.start, 0.02 * steps as f64).unwrap();
    let found = drift(&swing.composed(Composition::Fourth), steps);
    assert!(found.energy < 5e-8 && found.trend < 1e-11 && found.constraint < 1e-14, "bowl: {found:?}");
}

#[test]
fn round_off_of_many_steps_is_a_random_walk_of_increments() {
    // order 6 leaves nothing else: vakonomic circles, 2.5 turns in 1000 steps, and a removal's motion
    let Scene { system, start, removals, .. } = scene("heisenberg");
    let (steps, part) = long();
    let end = 0.02 * steps as f64;
    let circles = Discrete::vakonomic(&system, &start, &[0.8], end).unwrap();
    let at = RemovedStart::at(&system, &removals[0], &start, &[-0.8]).unwrap();
    let removed = Discrete::removed(&system, &removals[0], &at, 0.25 * end).unwrap();
    // a random walk of a part of the steps comes as far as the root of that part
    for (what, discrete, steps, part) in
        [("vakonomic", circles, steps, part), ("removed", removed, steps / 4, part / 4.0)]
    {
        let found = drift(&discrete.composed(Composition::Sixth), steps);
        let limits = [1e-13, 1e-13, 1e-12].map(|limit| part.sqrt() * limit);
        let all = [found.energy, found.trend, found.constraint];
        assert!(all.iter().zip(limits).all(|(x, limit)| *x < limit), "{what}: {found:?}");
    }
}

#[test]
fn a_motion_that_does_not_return_lets_the_energy_of_order_two_go() {
    // energy is kept on integrable reversible motions or by a symplectic form; here is neither, as measured
    let scene = scene("trailer");
    let discrete = Discrete::chetaev(&scene.system, &scene.start, 0.01 * 100_000.0).unwrap();
    let second = drift(&discrete, 100_000);
    assert!(second.trend > 1e-4 && second.trend < 1e-3 && second.constraint < 1e-14, "{second:?}");
    let fourth = drift(&discrete.composed(Composition::Fourth), 100_000);
    assert!(fourth.trend < 1e-9, "{fourth:?}");
}

#[test]
fn compensated_sums_lose_less_than_plain_ones() {
    // vakonomic circles on the Heisenberg group: x and y stay on a circle, so that every loss is one of sums
    let scene = scene("heisenberg");
    let (steps, h) = (50_000, 0.02);
    let discrete = Discrete::vakonomic(&scene.system, &scene.start, &[0.8], h * f64::from(steps))
        .unwrap()
        .composed(Composition::Sixth);
    let plain = plainly_summed(&discrete, steps as usize, h);
    let compensated = drift(&discrete, steps as usize).energy;
    assert!(plain > 10.0 * compensated, "{plain:e} {compensated:e}");
    assert!(compensated < 1e-14, "{compensated:e}");
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// The energy that is lost where sums are plain: what each addition loses is forgotten after each step of
/// order 2.
fn plainly_summed(discrete: &Discrete, steps: usize, h: f64) -> f64 {
    let mut discrete = discrete.clone();
    let mut node = discrete.start.clone();
    let (mut energies, mut size) = (Vec::with_capacity(steps + 1), 0.0_f64);
    let lengths = Composition::Sixth.lengths();
    for k in 0..=steps {
        let mut read = node.clone();
        discrete.step.read(&mut read, 1.0).unwrap();
        energies.push(discrete.step.readings(&read)[0]);
        size = size.max(read.v.iter().zip(&read.p.value).map(|(v, p)| v * p).sum::<f64>().abs());
        let mut done = k as f64;
        for length in lengths.iter().filter(|_| k < steps) {
            done += length;
            discrete.step.advance(&mut node, length * h, done * h).unwrap();
            for sum in [&mut node.x, &mut node.p] {
                *sum = Compensated::new(std::mem::take(&mut sum.value));
            }
        }
    }
    energies.iter().fold(0.0_f64, |a, e| a.max((e - energies[0]).abs())) / size
}

fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |m, x| m.max(x.abs()))
}
