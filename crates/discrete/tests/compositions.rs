//! The order of every composition.
//!
//! A symmetric step is `exp(h A₁ + h³ A₃ + h⁵ A₅ + …)`, no two `A_j` commuting. So order p means `Π
//! exp(γ_i A₁ + γ_i³ A₃ + γ_i⁵ A₅ + …) = exp(A₁)` for all words in `A_j` of grade (sum of `j`) ≤ p.

use std::collections::BTreeMap;

use discrete::Composition;

/// Coefficients by word.
type Series = BTreeMap<Vec<u32>, f64>;

fn grade(word: &[u32]) -> u32 {
    word.iter().sum()
}

fn product(a: &Series, b: &Series, highest: u32) -> Series {
    let mut out = Series::new();
    for (u, x) in a {
        for (v, y) in b.iter().filter(|(v, _)| grade(u) + grade(v) <= highest) {
            *out.entry([&u[..], v].concat()).or_default() += x * y;
        }
    }
    out
}

fn exponential(letters: &Series, highest: u32) -> Series {
    let mut sum = Series::from([(Vec::new(), 1.0)]);
    let mut term = sum.clone();
    for k in 1..=highest {
        term = product(&term, letters, highest);
        term.values_mut().for_each(|x| *x /= f64::from(k));
        for (word, x) in &term {
            *sum.entry(word.clone()).or_default() += x;
        }
    }
    sum
}

/// Largest violation among words of exactly that grade.
fn violations(lengths: &[f64], highest: u32) -> Vec<f64> {
    let mut composed = Series::from([(Vec::new(), 1.0)]);
    for &length in lengths {
        let letters = (1..=highest).step_by(2).map(|j| (vec![j], length.powi(j as i32))).collect();
        composed = product(&composed, &exponential(&letters, highest), highest);
    }
    for (word, x) in exponential(&Series::from([(vec![1], 1.0)]), highest) {
        *composed.entry(word).or_default() -= x;
    }
    let of_grade = |k: u32| composed.iter().filter(move |(word, _)| grade(word) == k);
    (1..=highest).map(|k| of_grade(k).fold(0.0, |m, (_, x)| f64::max(m, x.abs()))).collect()
}

#[test]
fn every_composition_has_its_order_and_no_more() {
    for composition in Composition::ALL {
        let order = composition.order();
        let found = violations(composition.lengths(), order + 1);
        assert!(found[..order as usize].iter().all(|&x| x < 4e-15), "{composition:?}: {found:?}");
        assert!(found[order as usize] > 1e-6, "{composition:?}: {found:?}");
    }
}

#[test]
fn there_are_as_many_words_as_there_should_be() {
    // compositions of k into odd parts are Fibonacci numbers
    let letters = (1..=9).step_by(2).map(|j| (vec![j], 1.0)).collect();
    let words = exponential(&letters, 9);
    let counts: Vec<usize> = (1..=9).map(|k| words.keys().filter(|w| grade(w) == k).count()).collect();
    assert_eq!(counts, [1, 1, 2, 3, 5, 8, 13, 21, 34]);
}
