//! Names in texts.

use scene::find_name;

#[test]
fn whole_words_are_found() {
    assert_eq!(find_name("x'' + x1 + x'*x", "x"), Some(14));
    assert_eq!(find_name("x'' + x1", "x"), None);
}
