//! The family between the vakonomic and the Chetaev formulation: `d/dt 𝓛_v − 𝓛_q = Q − κ Aᵀ μ`.

use deltaq::Motion;
use scene::Scene;

use super::support::{at, chetaev, equations, motion_of, must, scene, tight, vakonomic};

fn between(name: &str, kappa: f64, mu0: &[f64]) -> Motion {
    let scene = scene(name, &[("kappa", kappa), ("duration", 3.0)]);
    motion_of(&scene, equations(&scene.system, "kappa", None), mu0, &tight())
}

fn apart(one: &mut Motion, two: &mut Motion, scene: &Scene) -> f64 {
    let end = scene.start.t + scene.duration;
    let (a, b) = (at(one, end).coordinates, at(two, end).coordinates);
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn without_kappa_it_is_vakonomic() {
    for (name, mu0) in [("sledge", vec![0.4]), ("disc", vec![0.4, -0.3]), ("turntable", vec![0.1, 0.05])] {
        let scene = scene(name, &[("duration", 3.0)]);
        let apart = apart(&mut between(name, 0.0, &mu0), &mut vakonomic(&scene, &mu0), &scene);
        must(&format!("{name}, κ = 0"), apart, 1e-9);
    }
}

#[test]
fn large_kappa_leads_to_chetaev_at_the_rate_one_over_kappa() {
    for (name, mu0) in [("sledge", vec![0.4]), ("disc", vec![0.4, -0.3]), ("turntable", vec![0.1, 0.05])] {
        let scene = scene(name, &[("duration", 3.0)]);
        let mut limit = chetaev(&scene);
        let [far, near] = [3e2, 3e3].map(|kappa| apart(&mut between(name, kappa, &mu0), &mut limit, &scene));
        println!("{name}: {far:.3e} from Chetaev at κ = 300, {near:.3e} at 3000");
        must(&format!("{name}, ten times κ, a tenth of the distance"), (far / near / 10.0 - 1.0).abs(), 0.1);
    }
}

#[test]
fn it_is_asked_for_by_its_parameter() {
    let without = scene("sledge", &[]);
    assert!(deltaq::choices(&without).iter().all(|choice| choice.formulation != "kappa"));
    let error = (deltaq::formulation("kappa").expect("there").derive)(&without.system, &Default::default());
    assert!(error.err().expect("refused").to_string().contains("a parameter `kappa` is needed"));
    let with = scene("sledge", &[("kappa", 2.0)]);
    assert!(deltaq::choices(&with).iter().any(|choice| choice.formulation == "kappa"));
}
