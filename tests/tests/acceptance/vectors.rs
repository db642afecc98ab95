//! Scenes written by vectors and rotations move as those whose components were worked out by hand.

use mechanics::ConstantsRule;
use motion::{CHETAEV, Settings, VAKONOMIC, solve_choice};
use scene::Scene;

use super::support::{choice, gap, must, tight};

/// By hand, by vectors, and the time over which both are known.
const PAIRS: [(&str, &str, f64); 4] = [
    (
        include_str!("../../../crates/scene/classics/chaplygin-sphere.toml"),
        include_str!("../scenes/sphere-by-vectors.toml"),
        2.0,
    ),
    (
        include_str!("../../../crates/scene/classics/falling-disc.toml"),
        include_str!("../scenes/disc-by-vectors.toml"),
        1.0,
    ),
    (
        include_str!("../../../crates/scene/classics/rattleback.toml"),
        include_str!("../scenes/rattleback-by-vectors.toml"),
        1.0,
    ),
    (include_str!("../../../crates/scene/scenes/bicycle.toml"), include_str!("../scenes/bicycle-by-vectors.toml"), 0.5),
];

#[test]
fn vectors_give_the_motions_of_components_by_hand() {
    let settings = Settings { max_steps: 40_000, ..tight() };
    for (by_hand, by_vectors, duration) in PAIRS {
        // the bicycle falls: upright and straight it would have nothing to tell
        let falls = [("duration", duration), ("yaw", 0.3), ("lean'", 0.5)].map(|(name, x)| (name.to_string(), x));
        let set = if by_hand.contains("bicycle") { &falls[..] } else { &falls[..1] };
        let read = |text: &str| Scene::parse_with("scene", text, set);
        let [by_hand, by_vectors] = [by_hand, by_vectors].map(|text| read(text).unwrap_or_else(|e| panic!("{e}")));
        let title = &by_vectors.title;
        assert_eq!(by_hand.start.q, by_vectors.start.q, "{title}");
        let h = by_hand.system.constraints.len();
        // multipliers belong to constraints as they are written: μ₀ = 0 says the same of both
        for (name, constants) in [(CHETAEV, Vec::new()), (VAKONOMIC, vec![0.0; h])] {
            let choice = choice(name, None, ConstantsRule::Given(constants));
            let [mut one, mut two] = [&by_hand, &by_vectors].map(|scene| {
                let motion = solve_choice(scene, &choice, &settings).unwrap_or_else(|e| panic!("{title}: {e}"));
                assert!(motion.is_complete(), "{title}: {:?}", motion.ending);
                motion
            });
            let (apart, end) = gap(&mut one, &mut two);
            must(&format!("{title}, {name:?}, over {end} s"), apart, 1e-12);
        }
    }
}
