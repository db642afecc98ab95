//! A scene file: what is read is written so that it is read back, with the same start.
#![no_main]

use libfuzzer_sys::fuzz_target;
use scene::Scene;

fuzz_target!(|text: &str| {
    let Ok(scene) = Scene::parse("fuzz", text) else { return };
    let written = scene.to_toml();
    let again = match Scene::parse("fuzz", &written) {
        Ok(again) => again,
        Err(fault) => panic!("{fault}\n{written}"),
    };
    assert_eq!(scene.start.q, again.start.q, "{written}");
    assert_eq!(scene.system.constraints.len(), again.system.constraints.len());
});
