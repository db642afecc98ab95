//! The program of docs/tutorials/prove.md.

use deltaq::comparison::certificate;
use deltaq::integrals::NoMultipliers;
use deltaq::scene::Scene;

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("disc-on-slope.toml".as_ref())?;
    let certificate = certificate(&scene, false)??; // the inner error says why there is none
    assert_eq!(certificate.order, 2);
    let text = serde_json::to_string(&NoMultipliers::of(&certificate, &[]))?; // for validation/proof/verify.py
    assert!(text.contains("minor"));
    Ok(())
}
