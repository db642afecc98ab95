//! Last digits of states, by which starts are moved.

use motion::parts::{move_digits, signs};

#[test]
fn signs_are_of_both_kinds_and_follow_no_period() {
    let all: Vec<f64> = signs().take(400).collect();
    assert!(all.iter().all(|sign| sign.abs() == 1.0) && all.iter().sum::<f64>().abs() < 80.0, "{all:?}");
    for period in 1..100 {
        let alike = all.iter().zip(&all[period..]).filter(|(a, b)| a == b).count();
        let part = alike as f64 / (all.len() - period) as f64;
        assert!((0.35..0.65).contains(&part), "{period}: {part}");
    }
}

#[test]
fn digits_are_moved_in_units_of_each() {
    let (before, units) = ([1.0, -2e9, 3e-7, 0.0], [4.0, 4.0, 16.0, 4.0]);
    let mut y = before;
    move_digits(&mut y, |i| units[i]);
    for ((x, y), units) in before.into_iter().zip(y).zip(units) {
        let moved = ((y - x) / (f64::EPSILON * units)).abs();
        assert!((moved - x.abs()).abs() <= 0.5 * x.abs(), "{x:e}: {moved:e}");
    }
}
