//! What the Taylor series of one step cost, and a whole motion beside DOP853.

use criterion::{Criterion, criterion_group, criterion_main};
use deltaq::{Settings, choices, derive, ready, setting, solve};
use integrate::Method;
use mechanics::Scene;
use std::hint::black_box;

const SCENES: [(&str, &str); 2] = [
    ("sledge", include_str!("../../../validation/scenes/sledge.toml")),
    ("ball-in-cone", include_str!("../../../validation/scenes/ball-in-cone.toml")),
];

fn series(criterion: &mut Criterion) {
    for (name, text) in SCENES {
        let scene = Scene::parse(name, text).expect("a scene");
        let settings = Settings { method: Method::Taylor, ..Settings::default() };
        for choice in choices(&scene) {
            let equations = derive(&scene.system, &choice).expect("equations");
            let Ok(mut ready) = ready(setting(&scene), equations, &choice.constants, &settings) else { continue };
            for order in [14, 18, 24] {
                let mut coefficients = vec![0.0; (order + 1) * ready.start.len()];
                criterion.bench_function(&format!("{name}, {}: series of order {order}", choice.label), |bencher| {
                    bencher
                        .iter(|| ready.compiled.taylor(scene.start.t, black_box(&ready.start), 0.1, &mut coefficients));
                });
            }
        }
    }
}

fn motions(criterion: &mut Criterion) {
    for (name, text) in SCENES {
        let scene = Scene::parse(name, text).expect("a scene");
        for choice in choices(&scene) {
            let equations = derive(&scene.system, &choice).expect("equations");
            for method in [Method::Taylor, Method::Dop853] {
                let settings = Settings { method, tolerance: 1e-9, ..Settings::default() };
                let name = format!("{name}, {}: both runs, {method:?}", choice.label);
                criterion.bench_function(&name, |bencher| {
                    bencher.iter(|| solve(setting(&scene), equations.clone(), &choice.constants, &settings));
                });
            }
        }
    }
}

criterion_group!(benches, series, motions);
criterion_main!(benches);
