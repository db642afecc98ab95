//! Ticks and ranges of axes.

use picture::axis::{Direction, Interval, LeftOut, apart, around, given, measure, ticks};
use picture::{Axis, PictureError, Scale};

fn labels(scale: Scale, low: f64, high: f64) -> Vec<String> {
    let interval = Interval { low: measure(scale, low).unwrap(), high: measure(scale, high).unwrap() };
    let ticks = ticks(scale, interval, 340.0, Direction::Vertical);
    assert!(apart(&ticks.labelled, interval, 340.0, Direction::Vertical));
    let mut labels: Vec<String> = ticks.labelled.into_iter().map(|tick| tick.label).collect();
    labels.extend(ticks.factor);
    labels
}

#[test]
fn linear_labels() {
    assert_eq!(labels(Scale::Linear, 0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(labels(Scale::Linear, -12.0, 31.0), ["−10", "0", "10", "20", "30"]);
    assert_eq!(labels(Scale::Linear, 0.0, 4.2e-7), ["0", "1", "2", "3", "4", "×10⁻⁷"]);
    assert_eq!(labels(Scale::Linear, -1e300, 1e300).last().unwrap(), "×10³⁰⁰");
    assert!(labels(Scale::Linear, 1.0, 1.0 + 1e-8).len() >= 3);
}

#[test]
fn log_labels() {
    assert_eq!(labels(Scale::Log, 1e-6, 1e1), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
    assert_eq!(labels(Scale::Log, 3e-15, 2.0), ["10⁻¹⁴", "10⁻¹²", "10⁻¹⁰", "10⁻⁸", "10⁻⁶", "10⁻⁴", "10⁻²", "10⁰"]);
    assert_eq!(labels(Scale::Log, 0.1, 7.0), ["0.1", "0.2", "0.5", "1", "2", "5"]);
    assert_eq!(labels(Scale::Log, 1e-7, 7e-6).first().unwrap(), "10⁻⁷");
    assert!(labels(Scale::Log, 3.0, 4.0).len() >= 3);
    assert!((3..=10).contains(&labels(Scale::Log, 1e-300, 1e300).len()));
}

#[test]
fn ranges() {
    let same = around(Scale::Linear, [vec![3.0, 3.0]].into_iter(), 0.05).unwrap();
    assert!(same.low < 3.0 && same.high > 3.0);
    let zero = around(Scale::Linear, [vec![0.0]].into_iter(), 0.05).unwrap();
    assert_eq!((zero.low, zero.high), (-1.0, 1.0));
    assert_eq!(around(Scale::Log, std::iter::empty(), 0.05), None);
    let of = |scale, ends: &[f64]| {
        let range = around(scale, ends.iter().map(|&end| vec![0.0, end]), 0.0).unwrap();
        (range.low, range.high)
    };
    assert_eq!(of(Scale::Linear, &[1.0, 8.0, 39.0]), (0.0, 39.0));
    assert_eq!(of(Scale::Linear, &[1.0, 39.0]), (0.0, 39.0));
    assert_eq!(of(Scale::Linear, &[41.0, 1.0, 8.0]), (0.0, 41.0));
    assert_eq!(of(Scale::Linear, &[1.0, 8.0, 41.0, -1000.0]), (0.0, 8.0));
    assert_eq!(of(Scale::Log, &[1.0, 8.0, 41.0]), (0.0, 41.0));
    assert_eq!(of(Scale::Linear, &[1e-9, 1e-9, 41.0]), (0.0, 41.0), "round-off is nothing to compare with");
    assert_eq!(measure(Scale::Log, -1.0), Err(LeftOut::NotPositive));
    assert_eq!(measure(Scale::Linear, f64::INFINITY), Err(LeftOut::NotFinite));
    for range in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (1.0, 1.0 + 1e-12), (0.0, f64::MAX)] {
        let axis = Axis { range: Some(range), ..Axis::linear("x (m)") };
        assert!(matches!(given(&axis), Err(PictureError::Range { .. })), "{range:?}");
    }
    let axis = Axis { range: Some((0.0, 1.0)), ..Axis::log("x (m)") };
    assert!(matches!(given(&axis), Err(PictureError::Range { .. })));
}
