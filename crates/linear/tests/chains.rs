//! Jordan chains on the imaginary axis, with a feedback that splits them: the truth is in closed form.

use linear::{Block, Chain, Eigenvalue, Growth, Part, Spectrum};
use nalgebra::{Complex, DMatrix};

const FEEDBACK: [f64; 9] = [1e-20, 1e-19, 1e-18, 1e-17, 1e-16, 1e-15, 1e-14, 1e-13, 1e-12];

/// Eigenvalues with their errors, growth and chains.
type Found = (Vec<(Complex<f64>, f64)>, Growth, Vec<Chain>);

/// All eigenvalues with their errors, zeros among them; how deviations grow; and the chains.
fn spectrum(matrix: &DMatrix<f64>) -> Found {
    let n = matrix.nrows();
    let found = Spectrum::of(matrix, &DMatrix::zeros(n, n)).expect("converges");
    let eigenvalues: Vec<_> = found.blocks.iter().flat_map(|block| block.eigenvalues.clone()).collect();
    let zeros = n - eigenvalues.len();
    let mut all: Vec<_> = eigenvalues.iter().map(|e| (e.value, e.error)).collect();
    let zero = |block: &Block| std::iter::repeat_n((Complex::default(), block.zero_error), block.zeros);
    all.extend(found.blocks.iter().flat_map(zero));
    let zero_error = found.blocks.iter().fold(0.0_f64, |a, block| a.max(block.zero_error));
    let chains = found.chains.clone();
    let part = Part { states: (0..n).collect(), eigenvalues, zeros, zero_error, chains: found.chains };
    (all, part.growth(), chains)
}

/// Whether every true eigenvalue can be given a stated one of its own that is within its error.
fn is_covered(stated: &[(Complex<f64>, f64)], truth: &[Complex<f64>]) -> bool {
    fn place(
        i: usize,
        stated: &[(Complex<f64>, f64)],
        truth: &[Complex<f64>],
        seen: &mut [bool],
        of: &mut [Option<usize>],
    ) -> bool {
        (0..stated.len()).any(|j| {
            let fits = (stated[j].0 - truth[i]).norm() <= stated[j].1;
            if !fits || std::mem::replace(&mut seen[j], true) {
                return false;
            }
            let free = of[j].is_none_or(|other| place(other, stated, truth, seen, of));
            if free {
                of[j] = Some(i);
            }
            free
        })
    }
    let mut of = vec![None; stated.len()];
    stated.len() == truth.len()
        && (0..truth.len()).all(|i| place(i, stated, truth, &mut vec![false; stated.len()], &mut of))
}

/// The `k` roots of `μ^k = δ`.
fn roots(k: usize, feedback: f64) -> Vec<Complex<f64>> {
    let (size, angle) = (feedback.abs().powf(1.0 / k as f64), if feedback < 0.0 { std::f64::consts::PI } else { 0.0 });
    let at = |m: usize| Complex::from_polar(size, (angle + std::f64::consts::TAU * m as f64) / k as f64);
    (0..k).map(at).collect()
}

/// `xᵢ' = xᵢ₋₁`, `x₁' = δ xₖ`: `λ^k = δ`.
fn integrators(k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    let entry = |i: usize, j: usize| match (i, j) {
        (0, j) if j + 1 == k => feedback,
        (i, j) if i == j + 1 => 1.0,
        _ => 0.0,
    };
    (DMatrix::from_fn(k, k, entry), roots(k, feedback))
}

/// `xᵢ'' = −ω² xᵢ + xᵢ₋₁`, `x₁'' = −ω² x₁ + δ xₖ`: `(λ² + ω²)^k = δ`.
fn oscillators(k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    of_square(2.25, k, feedback)
}

/// The same with an `ω` that is rounded: round-off must not couple what is not coupled.
fn rounded(k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    of_square(0.6208404055296955, k, feedback)
}

fn of_square(square: f64, k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    let (chain, roots) = integrators(k, feedback);
    let matrix = DMatrix::from_fn(2 * k, 2 * k, |i, j| match (i % 2, j % 2) {
        (0, 1) if i + 1 == j => 1.0,
        (1, 0) if i == j + 1 => -square,
        (1, 0) => chain[(i / 2, j / 2)],
        _ => 0.0,
    });
    let truth = roots.iter().flat_map(|mu| [1.0, -1.0].map(|sign| Complex::i() * sign * (square - mu).sqrt()));
    (matrix, truth.collect())
}

/// Blocks that turn, `R` on the diagonal and 1 below: `λ = ±iω + μ`, `μ^k = δ`.
fn turning(k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    let (chain, roots) = integrators(k, feedback);
    let matrix = DMatrix::from_fn(2 * k, 2 * k, |i, j| match (i % 2, j % 2) {
        (0, 1) if i + 1 == j => -3.0,
        (1, 0) if i == j + 1 => 3.0,
        (a, b) if a == b => chain[(i / 2, j / 2)],
        _ => 0.0,
    });
    (matrix, roots.iter().flat_map(|mu| [3.0, -3.0].map(|w| mu + Complex::i() * w)).collect())
}

/// The companion matrix of `(λ² + 1)^k − δ`, with the `δ` that its last entry has: `1 − δ` is rounded.
fn companion(k: usize, feedback: f64) -> (DMatrix<f64>, Vec<Complex<f64>>) {
    let last: f64 = 1.0 - feedback;
    let kept = 1.0 - last;
    let binomial = |j: usize| (0..j).fold(1.0, |b, i| b * (k - i) as f64 / (i + 1) as f64);
    let matrix = DMatrix::from_fn(2 * k, 2 * k, |i, j| match (i, j) {
        (i, j) if j == i + 1 => 1.0,
        (i, 0) if i + 1 == 2 * k => -last,
        (i, j) if i + 1 == 2 * k && j % 2 == 0 => -binomial(j / 2),
        _ => 0.0,
    });
    let truth = roots(k, kept).into_iter().flat_map(|mu| [1.0, -1.0].map(|w| Complex::i() * w * (1.0 - mu).sqrt()));
    (matrix, truth.collect())
}

type Case = fn(usize, f64) -> (DMatrix<f64>, Vec<Complex<f64>>);
const CASES: [(&str, Case); 5] = [
    ("integrators", integrators),
    ("oscillators", oscillators),
    ("rounded", rounded),
    ("turning", turning),
    ("companion", companion),
];

#[test]
fn no_error_of_a_chain_is_under_the_true_one() {
    let (mut decided, mut all) = (0, 0);
    for (name, case) in CASES {
        for k in 2..=4 {
            for feedback in FEEDBACK.into_iter().flat_map(|d| [d, -d]) {
                let (matrix, truth) = case(k, feedback);
                let (stated, growth, chains) = spectrum(&matrix);
                let what = format!("{name} {k}, {feedback:e}: {stated:?}, {growth:?}, {chains:?}; {truth:?}");
                assert!(is_covered(&stated, &truth), "{what}");
                let growing = truth.iter().filter(|z| z.re > 1e-14 * z.norm()).count();
                let error = stated.iter().fold(0.0_f64, |a, (_, e)| a.max(*e));
                match growth {
                    Growth::Exponential(count) => assert_eq!(count, growing, "{what}"),
                    Growth::AtLeast(count) => assert!(count <= growing, "{what}"),
                    Growth::None => assert!(growing == 0 && error < 1e-6, "{what}"),
                    Growth::Undecided => {}
                    Growth::Power(_) => panic!("{what}"),
                }
                if growth == Growth::Undecided {
                    let open = |chain: &Chain| chain.power + 1 == k || chain.size == 1 && chain.radius > 1e-8;
                    assert!(chains.iter().any(|chain| open(chain) && !chain.is_exact), "{what}");
                }
                decided += usize::from(growth != Growth::Undecided);
                all += 1;
            }
        }
    }
    println!("{decided} of {all} decided");
}

#[test]
fn a_chain_grows_like_a_power_of_time() {
    for (name, case) in CASES {
        for k in 2..=4 {
            let (matrix, truth) = case(k, 0.0);
            let (stated, growth, chains) = spectrum(&matrix);
            let what = format!("{name} {k}: {stated:?}, {growth:?}, {chains:?}");
            assert!(is_covered(&stated, &truth), "{what}");
            // entries of a companion matrix all belong to one block: what is equal there is not seen
            let expected = if name == "companion" { Growth::Undecided } else { Growth::Power(k - 1) };
            assert_eq!(growth, expected, "{what}");
            let [chain] = &chains[..] else { panic!("{what}") };
            assert_eq!((chain.size, chain.power, chain.is_exact), (k, k - 1, name != "companion"), "{what}");
        }
    }
}

#[test]
fn what_errors_leave_open_is_said_beside_what_they_do_not() {
    let chain = |power: usize, is_exact: bool| {
        let value = Complex::default();
        vec![Chain { value, size: 3, radius: 1e-7, power, is_exact, blocks: vec![0] }]
    };
    for (parts, chains, words) in [
        (&[1.0, 2.0, -1.0][..], Vec::new(), "2"),
        (&[1.0, 2.0, 1e-10], Vec::new(), "2"),
        (&[1.0, 2.0], chain(2, true), "2"),
        (&[1.0, 2.0], chain(2, false), "2 or more"),
        (&[-1.0], chain(2, false), "undecided"),
        (&[-1.0], chain(2, true), "like t^2"),
        (&[-1.0], chain(1, true), "like t"),
        (&[-1.0], Vec::new(), "0"),
        (&[], Vec::new(), "undecided"),
    ] {
        let of = |re: &f64| Eigenvalue { value: Complex::new(*re, 0.0), error: 1e-9 };
        let eigenvalues = parts.iter().map(of).collect();
        let part = Part { states: Vec::new(), eigenvalues, zeros: 0, zero_error: 0.0, chains };
        assert_eq!(part.growth().to_string(), words, "{part:?}");
    }
}
