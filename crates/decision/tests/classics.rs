//! Systems of the literature. Scripts that share nothing with this crate found the orders beforehand: series
//! of 50 digits from the scene's text, for the falling disc a program in the integers modulo a prime.

use decision::Finding;

use crate::questions::{beside, proved};

#[test]
fn orders_of_the_referee() {
    for (name, expected) in [
        ("coin-on-incline", 2),
        ("turning-knife-edge", 1),
        ("unicycle-in-potential", 1),
        ("two-wheeled-carriage", 2),
        ("suslov", 1),
        ("veselova", 1),
        ("roller-racer", 2),
        ("snakeboard", 2),
        ("falling-disc", 2),
        ("chaplygin-sphere", 1),
    ] {
        let (proof, _) = proved(&beside(name));
        let Finding::None(found) = &proof.this_start else { panic!("{name}: {proof:?}") };
        assert_eq!(found.order, expected, "{name}");
        assert!(matches!(proof.almost_every_start, Finding::None(_)), "{name}");
    }
}

#[test]
fn the_generalized_heisenberg_system_is_in_the_family_without_multipliers() {
    let (proof, section) = proved(&beside("generalized-heisenberg"));
    assert!(matches!(proof.this_start, Finding::Contained { rank: 1, .. }), "{proof:?}");
    assert!(section.is_some());
}
