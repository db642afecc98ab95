//! The program of docs/tutorials/ensemble.md.

use deltaq::motion::EnsembleOptions;
use deltaq::scene::Scene;
use deltaq::{Ensemble, Settings, choices};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("disc-on-slope.toml".as_ref())?;
    let ensemble = Ensemble::new(&scene, &choices(&scene)[0], &["g"], &Settings::default())?;
    let options = EnsembleOptions::default();
    let members = ensemble.members(&[[1.0], [1.5], [2.0]], options.threads);
    for (motion, x) in ensemble.answers(members, &[2.0], &options).into_iter().zip([1.145123, 1.405317, 1.665512]) {
        assert!((motion?.outputs[0].coordinates[0] - x).abs() < 1e-6);
    }
    Ok(())
}
