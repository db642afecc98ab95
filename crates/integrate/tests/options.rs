//! Methods and their names.

use diffsol_methods::EVERY;
use integrate::Method;

#[test]
fn linked_methods_stand_beside_the_own_ones_under_names_of_their_own() {
    assert_eq!(EVERY.map(Method::name), ["taylor", "dop853", "tsit45", "radau5", "bdf", "tr-bdf2", "esdirk34"]);
    assert!(Method::ALL.iter().all(|own| EVERY.contains(own)));
    for method in EVERY {
        assert_eq!(EVERY.iter().filter(|other| **other == method).count(), 1, "{method:?}");
        assert_eq!(matches!(method, Method::Linked(_)), !Method::ALL.contains(&method), "{method:?}");
        assert!(method.order_in_steps().is_none_or(|order| order >= 3.0) && method.tightest() >= 8, "{method:?}");
    }
}
