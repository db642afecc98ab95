//! Two-point problems by collocation: nothing of ours, equations by hand.
//!
//! A panel is one step of Gauss and Legendre's method with six stages, order 12; unknown are the states at
//! the ends of all panels, which Newton's method finds at once.

use nalgebra::{DMatrix, DVector};

/// Rates of `y`.
pub type Rates<'a> = &'a dyn Fn(&[f64]) -> Vec<f64>;

/// Nodes of Gauss and Legendre on [−1, 1] with six points, both signs.
const NODES: [f64; 3] = [0.238_619_186_083_196_9, 0.661_209_386_466_264_5, 0.932_469_514_203_152];
const WEIGHTS: [f64; 3] = [0.467_913_934_572_691_1, 0.360_761_573_048_138_6, 0.171_324_492_379_170_4];

fn nodes() -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for (x, w) in NODES.into_iter().zip(WEIGHTS) {
        all.extend([(0.5 * (1.0 - x), 0.5 * w), (0.5 * (1.0 + x), 0.5 * w)]);
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// One panel of length `h`.
fn panel(rates: Rates, y: &[f64], h: f64) -> Vec<f64> {
    let nodes = nodes();
    let c: Vec<f64> = nodes.iter().map(|node| node.0).collect();
    // ∫₀^c_i of Lagrange's polynomials, from their values in powers
    let powers = DMatrix::from_fn(6, 6, |i, j| c[i].powi(j as i32));
    let integrals = DMatrix::from_fn(6, 6, |i, j| c[i].powi(j as i32 + 1) / (j + 1) as f64);
    let a = integrals * powers.try_inverse().expect("six nodes");
    let mut k = vec![rates(y); 6];
    for _ in 0..60 {
        let stage = |i: usize| -> Vec<f64> {
            let add = |n: usize| (0..6).map(|j| a[(i, j)] * k[j][n]).sum::<f64>();
            (0..y.len()).map(|n| y[n] + h * add(n)).collect()
        };
        let next: Vec<Vec<f64>> = (0..6).map(|i| rates(&stage(i))).collect();
        let moved = next.iter().flatten().zip(k.iter().flatten()).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
        k = next;
        if moved < 1e-15 {
            break;
        }
    }
    (0..y.len()).map(|n| y[n] + h * (0..6).map(|i| nodes[i].1 * k[i][n]).sum::<f64>()).collect()
}

/// `y` after the time `t`.
pub fn flow(rates: Rates, y: &[f64], t: f64, panels: usize) -> Vec<f64> {
    (0..panels).fold(y.to_vec(), |y, _| panel(rates, &y, t / panels as f64))
}

/// The states at the start with `q(0)` and `q(t)`, the first half of `y`, from states at ends of panels on.
pub fn two_points(rates: Rates, ends: [&[f64]; 2], t: f64, mut guess: Vec<Vec<f64>>) -> Vec<f64> {
    let (panels, n) = (guess.len() - 1, guess[0].len());
    let h = t / panels as f64;
    for _ in 0..20 {
        let size = n * (panels + 1);
        let (mut matrix, mut right) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for k in 0..panels {
            let reached = panel(rates, &guess[k], h);
            for i in 0..n {
                right[k * n + i] = reached[i] - guess[k + 1][i];
                matrix[(k * n + i, (k + 1) * n + i)] = -1.0;
            }
            for j in 0..n {
                let step = 1e-5 * (1.0 + guess[k][j].abs());
                let moved = |by: f64| {
                    let mut y = guess[k].clone();
                    y[j] += by;
                    panel(rates, &y, h)
                };
                let (after, before) = (moved(step), moved(-step));
                (0..n).for_each(|i| matrix[(k * n + i, k * n + j)] = (after[i] - before[i]) / (2.0 * step));
            }
        }
        for (end, place) in ends.into_iter().zip([0, panels]) {
            for (i, q) in end.iter().enumerate() {
                let row = n * panels + i + if place == 0 { 0 } else { n / 2 };
                matrix[(row, place * n + i)] = 1.0;
                right[row] = guess[place][i] - q;
            }
        }
        let change = matrix.lu().solve(&right).expect("regular");
        for (i, change) in change.iter().enumerate() {
            guess[i / n][i % n] -= change;
        }
        if change.norm() < 1e-11 {
            return guess.swap_remove(0);
        }
    }
    panic!("Newton's method does not end");
}
