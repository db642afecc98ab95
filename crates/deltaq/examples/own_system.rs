//! The README's example: the three formulations of a disc on a slope, from Rust.

use deltaq::scene::Scene;
use deltaq::{Settings, choices, compare, solve_choice};

/// One system in every formulation.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::parse("disc-on-slope", &std::fs::read_to_string("disc-on-slope.toml")?)?;
    let settings = Settings::default();
    let choices = choices(&scene);
    for choice in &choices {
        let mut motion = solve_choice(&scene, choice, &settings)?;
        println!("{}: x(2) = {:.6}", choice.label, motion.at(2.0)?.coordinates[0]); // Chetaev: 1.405317
    }
    println!("{:.2}", compare(scene, choices, Vec::new(), &settings)?.pairs[0].gap.largest); // 6.58
    Ok(())
}
