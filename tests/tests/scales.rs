//! Scales change no motion: built-in scenes with other units of action, length and time.

use std::collections::BTreeMap;

use deltaq::{Settings, choices, error_estimate, setting, solve_choice};
use random::Scaling;
use scene::Scene;
use symbolic::SplitMix;

/// Factors of `L`, of lengths and of times.
const ACTIONS: [f64; 3] = [1e-13, 1.0, 1e13];
const LENGTHS: [f64; 3] = [1e-9, 1.0, 1e9];
const TIMES: [f64; 3] = [1e-6, 1.0, 1e6];
/// So many of these scales are drawn for each motion; `SCALES` says another number.
const DRAWN: usize = 2;
/// The error estimates of two motions may be wrong by so much, and coordinates by this part of their size.
const FACTOR: f64 = 100.0;
const ROUND_OFF: f64 = 1e-11;

/// Where a motion has come in half of its time and at its end, its estimates, and its sizes; or why not.
type Found = Result<(Vec<f64>, Vec<f64>), String>;

fn motion(scene: &Scene, choice: usize) -> Found {
    let choice = choices(scene).swap_remove(choice);
    let mut motion = solve_choice(scene, &choice, &Settings::default()).map_err(|error| error.to_string())?;
    let estimate = error_estimate(&mut motion, setting(scene)).map_err(|error| error.to_string())?;
    if let (status, Some(cause)) = estimate.status(&motion) {
        return Err(format!("{status}: {cause}"));
    }
    let end = motion.at(motion.end()).map_err(|error| error.to_string())?;
    Ok((end.coordinates, estimate.coordinates))
}

#[test]
fn scales_change_no_motion() {
    let drawn = std::env::var("SCALES").ok().and_then(|n| n.parse().ok()).unwrap_or(DRAWN);
    let mut random = SplitMix::new(36);
    let mut pick = |of: &[f64]| of[(random.unit() * of.len() as f64) as usize % of.len()];
    let (mut same, mut refused, mut other) = (0, BTreeMap::<String, usize>::new(), Vec::new());
    for (name, text) in catalogue::SCENES {
        let scene = Scene::parse(name, text).unwrap_or_else(|e| panic!("{name}: {e}"));
        for choice in 0..choices(&scene).len() {
            let Ok((here, own)) = motion(&scene, choice) else { continue };
            for _ in 0..drawn {
                let (action, length, time) = (pick(&ACTIONS), pick(&LENGTHS), pick(&TIMES));
                let of = |c: &mechanics::Coordinate| if c.unit == "m" { length } else { 1.0 };
                let lengths: Vec<f64> = scene.system.coordinates.iter().map(of).collect();
                let scaled = Scaling { lengths: lengths.clone(), time, action, constraint: 1.0 }.scene(&scene);
                let place = format!(
                    "{name}, {}, L {action:e}, length {length:e}, time {time:e}",
                    choices(&scene)[choice].label
                );
                match motion(&scaled, choice) {
                    Err(cause) => {
                        println!("{place}: {cause}");
                        *refused.entry(cause).or_default() += 1;
                    }
                    Ok((there, others)) => {
                        let far = (0..here.len()).find(|&i| {
                            let apart = (there[i] * lengths[i] - here[i]).abs();
                            let size = here.iter().zip(&lengths).map(|(x, l)| x.abs() / l * lengths[i]);
                            let size = size.fold(0.0, f64::max);
                            let is_near = apart <= FACTOR * (own[i] + others[i] * lengths[i]) + ROUND_OFF * size;
                            !is_near
                        });
                        match far {
                            None => same += 1,
                            Some(i) => other.push(format!("{place}: {} and {}", here[i], there[i] * lengths[i])),
                        }
                    }
                }
            }
        }
    }
    let refusals: usize = refused.values().sum();
    println!("{same} the same, {refusals} refused: {refused:#?}");
    assert!(other.is_empty(), "{same} the same, {refusals} refused, others:\n{}", other.join("\n"));
    assert!(same > 50 && 10 * refusals <= same, "{same} the same, {refused:#?}");
}
