//! The program of docs/tutorials/derive.md.

use deltaq::motion::{EquationStyle, equations_text};
use deltaq::scene::Scene;
use deltaq::{CHETAEV, choices, derive};

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("disc-on-slope.toml".as_ref())?;
    let chetaev = choices(&scene).into_iter().find(|choice| choice.formulation == CHETAEV).ok_or("none")?;
    let equations = derive(&scene.system, &chetaev)?;
    let text = equations_text(&equations, EquationStyle::Plain);
    assert!(text.contains("x'' - g - lambda_1 = 0"), "{text}");
    Ok(())
}
