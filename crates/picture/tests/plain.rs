//! Pictures in characters.

use picture::{Axis, Curve, Picture, PictureError, Style};

fn line(label: &str, style: Style, value: impl Fn(f64) -> f64) -> Curve {
    let points = (0..=300).map(|i| f64::from(i) / 30.0).map(|t| (t, value(t))).collect();
    Curve { label: label.into(), style, points }
}

#[test]
fn a_decade_is_a_row() {
    let curves =
        vec![line("grows", Style::Vakonomic, |t| 10f64.powf(t - 10.0)), line("limit", Style::Threshold, |_| 1e-10)];
    let text = Picture::new("gap", Axis::linear("t (s)"), Axis::log("gap"), curves).to_text(50, 11).unwrap();
    let rows: Vec<&str> = text.lines().collect();
    assert_eq!(rows[0], "gap");
    assert!(rows[1].starts_with("    10⁰┤") && rows[1].ends_with('a'), "{text}");
    assert!(rows[10].starts_with("   10⁻⁹┤") && rows[11].contains("···"), "{text}");
    let column = |row: &str| row.chars().position(|c| c == 'a').expect("the curve");
    // ten decades in 42 columns, one after the other
    assert!((1..11).all(|i| column(rows[i]) - column(rows[i + 1]) <= 5 && column(rows[i]) > column(rows[i + 1])));
    assert!(text.contains("        a grows\n        · limit\n"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 50), "{text}");
}

#[test]
fn nothing_is_refused() {
    let curves = vec![line("none", Style::Vakonomic, |_| 0.0)];
    let refused = Picture::new("gap", Axis::linear("t"), Axis::log("gap"), curves).to_text(80, 12);
    assert!(matches!(refused, Err(PictureError::NothingToDraw { not_positive: 301, .. })), "{refused:?}");
}
