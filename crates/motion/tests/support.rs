//! Common parts of the tests: scenes, choices, members.

use equations::Formulation;
use motion::{Choice, Ensemble, EnsembleOptions, MemberMotion, Settings, choices};
use scene::Scene;

pub(crate) fn read(name: &str, text: &str) -> Scene {
    Scene::parse(name, text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

pub(crate) fn choice(scene: &Scene, formulation: &Formulation) -> Choice {
    choices(scene).into_iter().find(|c| c.formulation == formulation).expect("it is there")
}

/// The motion as two members of an ensemble, which are to be the same, looked at at these times.
pub(crate) fn member(scene: &Scene, choice: &Choice, times: &[f64]) -> MemberMotion {
    let mut ensemble = Ensemble::new(scene, choice, &[], &Settings::default()).expect("an ensemble");
    let members = vec![ensemble.member(&[]).expect("a member"); 2];
    let options = EnsembleOptions { threads: 1, estimate: true };
    let mut motions = ensemble.motions(&members, times, &options).into_iter().map(|motion| motion.expect("a motion"));
    let (first, second) = (motions.next().expect("one"), motions.next().expect("another"));
    assert_eq!((&first.run.states, first.status()), (&second.run.states, second.status()));
    first
}
