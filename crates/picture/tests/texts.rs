//! Numbers and words in pictures.

use picture::text::{decimal, escape, fit, power_of_ten, px, width, wrap};

#[test]
fn numbers() {
    assert_eq!(power_of_ten(-16), "10⁻¹⁶");
    assert_eq!(power_of_ten(0), "10⁰");
    assert_eq!(power_of_ten(308), "10³⁰⁸");
    assert_eq!(decimal(-0.04, 1), "0.0");
    assert_eq!(decimal(-1.25, 2), "−1.25");
    assert_eq!(px(-0.04), "0");
    assert_eq!(px(-0.5), "-.5");
    assert_eq!(px(12.34), "12.3");
}

#[test]
fn text_fits() {
    assert_eq!(escape("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot;\u{fffd}");
    assert!(width(&fit(&"long ".repeat(40), 12.0, 200.0), 12.0) <= 212.0);
    let lines = wrap("several words that do not fit on a single line", 12.0, 120.0);
    assert!(lines.len() > 1 && lines.iter().all(|line| width(line, 12.0) <= 120.0));
    assert!(wrap("", 12.0, 120.0).is_empty());
}
