//! What derivatives along eight directions cost beside the motion: both runs of each, the least of several
//! times.

use std::time::Instant;

use integrate::{Method, Options};
use motion::{Choice, Settings, TIGHTER, choices, prepare, sensitivities, setting};
use scene::Scene;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let texts = [
        ("sledge", include_str!("../../scene/scenes/sledge.toml")),
        ("disc", include_str!("../../scene/scenes/disc.toml")),
        ("ball-in-cone", include_str!("../../scene/scenes/ball-in-cone.toml")),
    ];
    for (name, text) in texts {
        let scene = Scene::parse(name, text)?;
        let end = setting(&scene).end;
        let own: Vec<String> = scene.system.parameters.iter().map(|p| scene.system.graph.name(p.symbol)).collect();
        let coordinates = scene.system.coordinates.iter().map(|c| c.name.clone());
        let names: Vec<String> = own.into_iter().chain(coordinates).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).take(8).collect();
        for choice in choices(&scene) {
            let Choice { label, constants, .. } = &choice;
            let settings = Settings { method: Some(Method::Taylor), ..Settings::default() };
            let (equations, _) = motion::derive_in_form(&scene.system, &scene.start, &choice, settings.form)?;
            let Ok(mut prepared) = prepare(setting(&scene), equations, constants, &settings) else { continue };
            let (mut plain, mut with, mut steps) = (f64::INFINITY, f64::INFINITY, [0, 0]);
            for _ in 0..7 {
                let clock = Instant::now();
                for part in [TIGHTER, 1.0] {
                    let options = Options {
                        method: Method::Taylor,
                        max_steps: 1_000_000,
                        ..Options::with_tolerance(1e-11 * part)
                    };
                    let run = prepared.integrate(end, &options)?;
                    steps[0] = if part == 1.0 { steps[0] } else { run.solution.work.steps };
                }
                plain = plain.min(clock.elapsed().as_secs_f64());
                let Ok(found) = sensitivities(&scene, &choice, &names, &[end], &settings) else { break };
                with = with.min(found.seconds);
                steps[1] = found.work.steps;
            }
            println!(
                "{name}, {label}: {} directions, {:.0} µs and {:.0} µs, {:.2} times; {} and {} steps",
                names.len(),
                1e6 * plain,
                1e6 * with,
                with / plain,
                steps[0],
                steps[1]
            );
        }
    }
    Ok(())
}
