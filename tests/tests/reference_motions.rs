//! References with a known error on the paper's scenes.

use std::time::Instant;

use deltaq::{Settings, choices, derive, ready, setting};
use mechanics::Scene;
use reference::{Question, reference};

fn scene(name: &str) -> Scene {
    let path = format!("{}/../validation/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::parse(name, &std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn explore() {
    for (name, end) in [("sledge", 10.0), ("particle", 10.0), ("ball-in-cone", 5.0)] {
        let scene = scene(name);
        let times: Vec<f64> = (1..=10).map(|i| end * i as f64 / 10.0).collect();
        for choice in choices(&scene) {
            if std::env::var("ONLY").is_ok_and(|o| !format!("{name} {}", choice.label).contains(&o)) { continue; }
            let equations = derive(&scene.system, &choice).unwrap();
            let constants = match ready(setting(&scene), equations.clone(), &choice.constants, &Settings::default()) {
                Ok(r) => r.constants,
                Err(e) => {
                    println!("{name} {}: {e}", choice.label);
                    continue;
                }
            };
            let clock = Instant::now();
            let question =
                Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &constants };
            match reference(&question, &times, 1e-20) {
                Ok(r) => println!(
                    "{name} {} error {:.1e} {:?} residual {:.1e} scale {:.1} in {:.2} s",
                    choice.label,
                    r.error(),
                    r.agreement,
                    r.constraint_residual,
                    r.scale,
                    clock.elapsed().as_secs_f64()
                ),
                Err(e) => println!("{name} {}: {e} in {:.2} s", choice.label, clock.elapsed().as_secs_f64()),
            }
        }
    }
}
