//! Searches for motions between two points: where they start, which are one, and conjugate times.

use motion::parts::{each_once, samples, times};
use motion::shooting::{Minimum, least_from, spread};
use nalgebra::DMatrix;

#[test]
fn motions_are_one_up_to_a_part_of_their_unknowns() {
    // |x − y| against 10⁻³ (1 + |y|), each unknown by itself
    let known = [99.0, 0.0];
    for (moved, found) in [([0.09, 0.0], 1), ([0.11, 0.0], 2), ([0.0, 0.9e-3], 1), ([0.0, 1.1e-3], 2)] {
        let first = Minimum { reached: 2, value: 1.0, ..Minimum::start(7, known.to_vec()) };
        let other = vec![known[0] + moved[0], known[1] + moved[1]];
        let mut all = vec![Minimum { reached: 3, value: 2.0, ..Minimum::start(1, other) }, first];
        each_once(&mut all, 1e-3);
        assert_eq!(all.len(), found, "{moved:?}");
        assert_eq!(all.iter().map(|end| end.reached).sum::<usize>(), 5);
        assert_eq!((all[0].reached, all[0].first), if found == 1 { (5, 1) } else { (2, 7) });
        // what half of eight starts would have found
        let by_half = if found == 1 { 1.0 } else { 2.0 };
        assert_eq!([8, 4, 1].map(|starts| least_from(starts, &all)), [1.0, by_half, f64::INFINITY]);
    }
}

/// In one dimension multiples of the golden ratio, in two of the powers of 1/1.3247…, `φ³ = φ + 1`.
#[test]
fn spread_points_lie_on_both_sides_of_the_middle() {
    let golden = 0.5 * (1.0 + 5_f64.sqrt());
    for k in 1..40 {
        let one = spread(k, 1)[0];
        let known = 2.0 * (0.5 + k as f64 / golden).fract() - 1.0;
        assert!((one - known).abs() < 1e-12 && (-1.0..1.0).contains(&one), "{k}: {one} {known}");
        let plastic = 1.324_717_957_244_746;
        for (j, two) in spread(k, 2).into_iter().enumerate() {
            let known = 2.0 * (0.5 + k as f64 / f64::powi(plastic, 1 + j as i32)).fract() - 1.0;
            assert!((two - known).abs() < 1e-12, "{k}, {j}: {two} {known}");
        }
    }
    let mean = (1..100).map(|k| spread(k, 1)[0]).sum::<f64>() / 99.0;
    assert!(mean.abs() < 0.02, "{mean}");
}

fn found(matrix: impl Fn(f64) -> [f64; 4]) -> Vec<(f64, usize)> {
    let mut at = |t: f64| Ok(DMatrix::from_row_slice(2, 2, &matrix(t)));
    times(&mut at, &samples(0.0, 10.0, &[])).expect("no error").expect("regular somewhere")
}

#[test]
fn zeros_are_found_with_their_multiplicities() {
    let pi = std::f64::consts::PI;
    let near = |found: &[(f64, usize)], expected: &[(f64, usize)]| {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (a, b) in found.iter().zip(expected) {
            assert!((a.0 - b.0).abs() < 1e-7 && a.1 == b.1, "{found:?} for {expected:?}");
        }
    };
    // two oscillators alike: the determinant sin² touches zero
    near(&found(|t| [t.sin(), 0.0, 0.0, t.sin()]), &[(pi, 2), (2.0 * pi, 2), (3.0 * pi, 2)]);
    near(&found(|t| [t.sin(), 0.0, 0.0, 1.0]), &[(pi, 1), (2.0 * pi, 1), (3.0 * pi, 1)]);
    // two zeros between two samples, and a minimum that is none
    near(&found(|t| [(t - 5.01) * (t - 5.02), 0.0, 0.0, 1.0]), &[(5.01, 1), (5.02, 1)]);
    near(&found(|t| [(t - 5.013) * (t - 5.013) + 1e-4, 0.0, 0.0, 1.0]), &[]);
}
