//! Shorter runs than those of the report show the same.

use scene::catalogue::find;
use engine::{Contacts, EngineError, Ladder, Mapping, Run, Study, Surface};

fn tends_to_chetaev(name: &str, duration: f64, ladder: Ladder) -> Study {
    let scene = find(name, &[("duration".into(), duration.into())]).unwrap();
    let study = Study::of_scene(&scene, ladder).unwrap();
    assert_eq!(study.targets[0].formulation, "chetaev");
    for formulation in ["vakonomic", "removed-constraint"] {
        assert!(study.targets.iter().any(|t| t.formulation == formulation && t.remark.is_none()), "{formulation}");
    }
    assert!(study.finding().holds(), "{:?}", study.finding());
    study
}

#[test]
fn a_ball_rolls_down_with_five_sevenths() {
    let study = Study::of_incline(Ladder { coarsest: 100, runs: 4 }).unwrap();
    let finding = study.finding();
    assert!((finding.order - 1.0).abs() < 0.02, "{finding:?}");
    assert!(finding.extrapolated < 1e-4, "{finding:?}");
    // the way is s (1 + c₁ dt + c₂ dt²): velocity counts at the end of a step, the first has no friction
    let way = |steps| {
        let poses = Run { contacts: Contacts::HARD, duration: 1.0, steps, samples: 1 }.of(&study.setup).unwrap().poses;
        (poses[1].centre - poses[0].centre).length()
    };
    let acceleration = 2.0 * (8.0 * way(400) - 6.0 * way(200) + way(100)) / 3.0;
    assert!((acceleration / (5.0 / 7.0 * 9.81 * 0.3_f64.sin()) - 1.0).abs() < 1e-10, "{acceleration}");
}

#[test]
fn on_the_turntable_the_engine_tends_to_chetaev() {
    let study = tends_to_chetaev("turntable", 10.0, Ladder { coarsest: 2000, runs: 4 });
    // soft contacts leave an error that no step removes
    assert!(study.finding().shipped > 20.0 * study.finding().extrapolated, "{:?}", study.finding());
}

#[test]
fn in_the_cone_the_engine_tends_to_chetaev() {
    tends_to_chetaev("ball-in-cone", 1.0, Ladder { coarsest: 16_000, runs: 4 });
}

#[test]
fn the_start_rolls() {
    for name in ["turntable", "ball-in-cone"] {
        let mapping = Mapping::new(&find(name, &[]).unwrap()).unwrap();
        assert!(mapping.residual < 1e-15, "{name}: {:e}", mapping.residual);
    }
}

#[test]
fn a_wrong_sign_is_no_mapping() {
    let scene = find("turntable", &[]).unwrap();
    let mut setup = Mapping::new(&scene).unwrap().setup;
    setup.surface = Surface::Table { rate: -0.7 };
    let slip = setup.slip(setup.pose.centre, setup.velocity, setup.spin).length();
    assert!((slip - 2.0 * 0.7 * 0.65).abs() < 1e-12, "{slip}");
    // a ball that is not homogeneous has another kinetic energy
    let text = include_str!("../../../crates/scene/scenes/turntable.toml").replace("mass = \"m\"", "mass = \"m\"\ninertia = [\"2*m*a^2/3\", \"2*m*a^2/3\", \"2*m*a^2/3\"]");
    let hollow = scene::Scene::parse("turntable", &text).unwrap();
    assert!(matches!(Mapping::new(&hollow), Err(EngineError::Mapping { .. })));
    let slipping = include_str!("../../../crates/scene/scenes/turntable.toml").replace("rotation(z, Omega*t)", "rotation(z, -Omega*t)");
    let slipping = scene::Scene::parse("turntable", &slipping).unwrap();
    assert!(matches!(Mapping::new(&slipping), Err(EngineError::Mapping { .. })));
}

#[test]
fn what_cannot_be_done_is_said() {
    assert!(matches!(Mapping::new(&find("sledge", &[]).unwrap()), Err(EngineError::NotMapped(_))));
    let text = include_str!("../../../crates/scene/scenes/turntable.toml").replace("Omega", "rate");
    let renamed = scene::Scene::parse("turntable", &text).unwrap();
    assert!(matches!(Mapping::new(&renamed), Err(EngineError::Missing(_, name)) if name == "Omega"));
    let setup = Mapping::new(&find("turntable", &[]).unwrap()).unwrap().setup;
    let run = Run { contacts: Contacts::HARD, duration: 1.0, steps: 150, samples: 100 };
    assert!(matches!(run.of(&setup), Err(EngineError::Steps(150, 100))));
}
