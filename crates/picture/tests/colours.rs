//! Colours on light and on dark pages.

use picture::{BLUE, GREEN, INKS, PURPLE, VERMILION};

/// Contrast ratio of two colours, after WCAG 2.
fn contrast(a: &str, b: &str) -> f64 {
    let luminance = |colour: &str| -> f64 {
        [(1, 0.2126), (3, 0.7152), (5, 0.0722)]
            .iter()
            .map(|&(at, weight)| {
                let c = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
                weight * if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
            })
            .sum()
    };
    let (a, b) = (luminance(a), luminance(b));
    (a.max(b) + 0.05) / (a.min(b) + 0.05)
}

#[test]
fn colours_are_legible_on_light_and_dark_pages() {
    for page in ["#ffffff", "#0d1117"] {
        for colour in [BLUE, VERMILION, GREEN, PURPLE] {
            assert!(contrast(colour, page) >= 3.0, "{colour} on {page}");
        }
        assert!(contrast(INKS[0], page) >= 4.0, "{} on {page}", INKS[0]);
    }
    assert!(contrast(INKS[1], "#ffffff") >= 7.0);
    assert!(contrast(INKS[2], "#0d1117") >= 7.0);
    // A viewer may report the scheme of the desktop while the page has the other one.
    assert!(contrast(INKS[1], "#0d1117") >= 2.0);
    assert!(contrast(INKS[2], "#ffffff") >= 2.0);
}
