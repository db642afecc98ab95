//! Curves as they are drawn: clipped, thinned, rounded.

use picture::trace::{Coarseness, Extent, Place, Trace, clip, distance_to_segment};

const EXTENT: Extent = Extent { width: 600.0, height: 300.0 };

#[test]
fn thinning_keeps_the_line_within_tolerance() {
    let sine: Vec<Place> =
        (0..5000).map(|i| f64::from(i) * 0.12).map(|x| (x, 150.0 + 100.0 * (x / 60.0).sin())).collect();
    let trace = Trace::new(std::slice::from_ref(&sine), EXTENT, Coarseness::steps()[0]);
    let [line] = trace.lines.as_slice() else { panic!("{} lines", trace.lines.len()) };
    assert!(line.len() < 300, "{} points", line.len());
    for &point in &sine {
        let distance =
            line.windows(2).map(|pair| distance_to_segment(point, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
        assert!(distance <= 0.25, "{point:?} is off by {distance}");
    }
}

#[test]
fn fast_oscillations_keep_their_height() {
    let fast: Vec<Place> = (0..200_000).map(|i| (f64::from(i) * 0.003, 150.0 + 100.0 * f64::from(i).sin())).collect();
    let trace = Trace::new(&[fast], EXTENT, Coarseness::steps()[0]);
    let line = &trace.lines[0];
    assert!(line.len() < 5000, "{} points", line.len());
    let top = line.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
    assert!((top - 50.0).abs() < 0.1);
}

#[test]
fn clipping_keeps_the_slope_and_splits_lines() {
    let far = [(-1e6, -1e6), (1e6, 1e6), (f64::INFINITY, 0.0), (300.0, 1e7), (300.0, 100.0)];
    let pieces = clip(&far, EXTENT);
    assert_eq!(pieces.len(), 2);
    let first = &pieces[0];
    assert!(first.iter().all(|(x, y)| (x - y).abs() < 1e-6 && x.abs() <= 600.0));
    assert_eq!(pieces[1].last(), Some(&(300.0, 100.0)));
}

#[test]
fn path_data_is_short() {
    let trace = Trace::new(&[vec![(0.0, 0.0), (10.25, 0.5), (9.75, 20.0)]], EXTENT, Coarseness::steps()[0]);
    assert_eq!(trace.path(), "M0 0l10.3 .5-.5 19.5");
    assert_eq!(trace.marks(5, 0.5).len(), 5);
}

#[test]
fn one_point_is_a_dot() {
    let trace = Trace::new(&[vec![(5.0, 5.0)], vec![(7.0, 7.0), (7.01, 7.0)]], EXTENT, Coarseness::steps()[0]);
    assert_eq!((trace.lines.len(), trace.dots.len()), (0, 2));
}
