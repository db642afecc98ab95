//! Rates at which realizations come near: when they hold, and when they are not shown.

use random::judged::{judge_rate, shows_two_terms};
use random::{Case, Kind, Word, draw_recipe};

const N: f64 = 10.0;

/// What is said where distances at 10ⁿ are these, and motions are off by `own`; none where nothing is.
fn word(own: f64, distance: impl Fn(f64) -> f64) -> Option<Word> {
    let mut case = Case::new(draw_recipe(1, 0, &[Kind::Free]), "rates").unwrap_or_else(|e| panic!("{e}"));
    judge_rate(&mut case, "a rate", "rates", |_, power| Ok([distance(N * power), own])).expect("distances");
    case.found.word(8)
}

#[test]
fn a_distance_falls_at_last_sevenfold_or_faster() {
    for (rate, fails) in [(6.5, true), (7.5, false), (13.0, false), (100.0, false)] {
        let found = word(0.0, |n| 1e-2 * f64::powf(n, -f64::log10(rate)));
        assert_eq!(found, Some(if fails { Word::Fails } else { Word::Holds }), "{rate}");
    }
}

#[test]
fn a_distance_near_its_own_error_or_hardly_to_be_seen_shows_no_rate() {
    // of distances 10⁻¹, 10⁻², 1 the rate is wrong
    for (own, said) in [(0.5e-3, Word::Fails), (2e-3, Word::Undecided)] {
        assert_eq!(word(own, |n| if n > 500.0 { 1.0 } else { n.recip() }), Some(said), "{own}");
    }
    for (before, said) in [(0.5e-7, None), (2e-7, Some(Word::Fails))] {
        assert_eq!(word(0.0, |n| if n > 500.0 { 1.0 } else { before }), said, "{before}");
    }
}

#[test]
fn two_terms_tell_the_distance_before_to_a_seventh() {
    for (off, shows) in [(0.8, false), (0.9, true), (1.1, true), (1.2, false)] {
        // with b = −8 a, which cancels at the second of them
        let distances: Vec<f64> = (1..=4).map(|power| 10_f64.powi(power)).map(|n| 1.0 / n - 8.0 / (n * n)).collect();
        let [_, first, before, last] = distances[..] else { panic!("{distances:?}") };
        assert_eq!(shows_two_terms(&[1.0, first / off, before, last]), shows, "{off}");
    }
}

#[test]
fn only_a_distance_that_falls_like_1_over_n_shows_two_terms() {
    let of = |distance: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (1..=4).map(|power| distance(10_f64.powi(power)).abs()).collect()
    };
    // measured: random system 304 of seed 2223
    assert!(shows_two_terms(&[7.39e-4, 6.73e-6, 1.190e-7, 1.923e-8]));
    assert!(shows_two_terms(&of(&|n| 2e-4 / n - 8e-2 / (n * n))));
    for distance in
        [|_: f64| 1.0, |n: f64| n.powf(-0.5), |n: f64| n.powi(-2), |n: f64| 1.0 + 1.0 / n, |n: f64| n.powf(-1.4)]
    {
        assert!(!shows_two_terms(&of(&distance)), "{:?}", of(&distance));
    }
    assert!(!shows_two_terms(&of(&|n| 1.0 / n)[1..]));
}
