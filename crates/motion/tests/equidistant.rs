//! Equidistant values are the decimals that are meant, in any unit.

use motion::equidistant;

#[test]
fn tenths_are_tenths_in_any_unit() {
    for power in [-300, -24, -9, -3, 0, 3, 12, 24, 300] {
        let number = |digits: i32| format!("{digits}e{}", power - 1).parse::<f64>().expect("a number");
        let values: Vec<f64> = equidistant(number(-6), number(6), 13).collect();
        // beyond 1e37 the last digit is that of f64
        let apart = if power > 36 { 2.0 * f64::EPSILON * number(6) } else { 0.0 };
        assert!((-6..=6).zip(&values).all(|(k, x)| (x - number(k)).abs() <= apart), "{power}: {values:?}");
    }
}

#[test]
fn close_values_stay_apart_and_ends_stay_what_they_are() {
    let ends = [1e6, 1e6 + 1e-6];
    let values: Vec<f64> = equidistant(ends[0], ends[1], 201).collect();
    assert_eq!([values[0], values[200]], ends);
    assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{values:?}");
    assert_eq!(equidistant(0.1, 0.7, 1).collect::<Vec<_>>(), [0.1]);
    assert_eq!(equidistant(0.0, 0.0, 3).collect::<Vec<_>>(), [0.0; 3]);
    let third: Vec<f64> = equidistant(0.0, 1.0, 4).collect();
    assert_eq!(third, [0.0, 0.333_333_333_333_33, 0.666_666_666_666_67, 1.0]);
}
