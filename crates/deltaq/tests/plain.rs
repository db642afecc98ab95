//! The same motion, its instants solved as derived and in the form that is chosen.

use deltaq::{Settings, choices, solve_choice};
use scene::Scene;

#[test]
fn a_plain_motion_is_the_chosen_one() {
    let scene = Scene::parse("sledge", include_str!("../../../validation/scenes/sledge.toml")).unwrap();
    for choice in choices(&scene) {
        let [mut chosen, mut plain] = [false, true].map(|plain| {
            let settings = Settings { plain, ..Settings::default() };
            solve_choice(&scene, &choice, &settings).unwrap_or_else(|error| panic!("{}: {error}", choice.label))
        });
        assert_eq!(plain.form.why, [""; 0], "{}: nothing is chosen", choice.label);
        let (chosen_at, plain_at) = (chosen.at(0.5).unwrap(), plain.at(0.5).unwrap());
        for (a, b) in chosen_at.coordinates.iter().zip(&plain_at.coordinates) {
            assert!((a - b).abs() < 1e-9 * (1.0 + a.abs()), "{}: {a} and {b}", choice.label);
        }
        for (a, b) in chosen_at.multipliers.iter().zip(&plain_at.multipliers) {
            assert!((a - b).abs() < 1e-8 * (1.0 + a.abs()), "{}, multiplier: {a} and {b}", choice.label);
        }
        // a system with blocks to solve has a choice
        assert_eq!(chosen.form.why.is_empty(), chosen.equations.blocks.is_empty(), "{}", choice.label);
    }
}
