//! Methods that are built in.

use integrate::{CallError, Method};

#[test]
fn a_method_that_is_not_built_in_says_what_it_needs() {
    let of_libraries = Method::ALL.into_iter().filter_map(|method| Some((method.name(), method.feature()?)));
    let expected = ["tsit45", "bdf", "tr-bdf2", "esdirk34"].map(|name| (name, "diffsol"));
    assert_eq!(of_libraries.collect::<Vec<_>>(), expected);
    assert!(Method::ALL.into_iter().all(|m| m.is_built_in() == (m.feature().is_none() || cfg!(feature = "diffsol"))));
    let error = CallError::NotBuiltIn { method: "bdf", feature: "diffsol" };
    assert_eq!(error.to_string(), "the method bdf is not built in: it needs the feature `diffsol`");
}
