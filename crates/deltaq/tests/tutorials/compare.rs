//! The program of docs/tutorials/compare.md.

use deltaq::scene::Scene;
use deltaq::{Settings, Verdict, choices, compare};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("disc-on-slope.toml".as_ref())?;
    let choices = choices(&scene);
    let comparison = compare(scene, choices, Vec::new(), &Settings::default())?;
    let gap = &comparison.pairs[0].gap; // Chetaev and vakonomic
    assert_eq!(gap.verdict, Verdict::Different);
    assert_eq!(format!("{:.2}", gap.largest), "6.58");
    Ok(())
}
