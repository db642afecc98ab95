//! Every Butcher order condition of the tableau, by walking the rooted trees.
//!
//! For a rooted tree τ, `Φ_i(τ) = Π_children Σ_j a_ij Φ_j(child)` and `γ(τ) = |τ| Π γ(child)`. Order p means
//! `Σ_i b_i Φ_i(τ) = 1/γ(τ)` for all |τ| ≤ p; in a dense output, `Σ_i b_i(θ) Φ_i(τ) = θ^|τ|/γ(τ)`.

use integrate::dense::{Basis, evaluate_segment};
use integrate::dop853_tableau::*;

struct Tree {
    size: usize,
    density: f64,
    stages: [f64; STAGES],
}

/// The stages' matrix a_ij; stage 12 is the end of the step.
fn matrix() -> [[f64; STAGES]; STAGES] {
    [
        [0.0; STAGES],
        weights(&STAGE_1),
        weights(&STAGE_2),
        weights(&STAGE_3),
        weights(&STAGE_4),
        weights(&STAGE_5),
        weights(&STAGE_6),
        weights(&STAGE_7),
        weights(&STAGE_8),
        weights(&STAGE_9),
        weights(&STAGE_10),
        weights(&STAGE_11),
        weights(&STEP),
        weights(&STAGE_13),
        weights(&STAGE_14),
        weights(&STAGE_15),
    ]
}

fn weights<const M: usize>(row: &Row<M>) -> [f64; STAGES] {
    let mut b = [0.0; STAGES];
    for (j, w) in row.from.iter().zip(row.weight) {
        b[*j] = w;
    }
    b
}

/// All rooted trees of at most `order` vertices.
fn trees(order: usize) -> Vec<Tree> {
    let a = matrix();
    let mut trees = vec![Tree { size: 1, density: 1.0, stages: [1.0; STAGES] }];
    for size in 2..=order {
        let smaller = trees.len();
        // Children are chosen with non-increasing index, so that each multiset comes once.
        let mut forests = vec![(size - 1, smaller - 1, size as f64, [1.0; STAGES])];
        while let Some((left, largest, density, stages)) = forests.pop() {
            if left == 0 {
                trees.push(Tree { size, density, stages });
                continue;
            }
            for (index, child) in trees.iter().enumerate().take(largest + 1) {
                if child.size <= left {
                    let mut product = stages;
                    for (i, p) in product.iter_mut().enumerate() {
                        *p *= (0..STAGES).map(|j| a[i][j] * child.stages[j]).sum::<f64>();
                    }
                    forests.push((left - child.size, index, density * child.density, product));
                }
            }
        }
    }
    trees
}

/// Largest violation among trees of exactly `size` vertices at θ.
fn violation(trees: &[Tree], size: usize, b: &[f64; STAGES], theta: f64) -> f64 {
    let of_size = trees.iter().filter(|tree| tree.size == size);
    of_size
        .map(|tree| {
            let sum: f64 = b.iter().zip(tree.stages).map(|(b, phi)| b * phi).sum();
            (sum - theta.powi(size as i32) / tree.density).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn there_are_as_many_trees_as_there_should_be() {
    let trees = trees(8);
    let counts: Vec<usize> = (1..=8).map(|size| trees.iter().filter(|tree| tree.size == size).count()).collect();
    assert_eq!(counts, [1, 1, 2, 4, 9, 20, 48, 115]);
}

#[test]
fn row_sums_are_the_nodes() {
    for (i, row) in matrix().iter().enumerate() {
        let sum: f64 = row.iter().sum();
        let size: f64 = row.iter().map(|a| a.abs()).sum();
        assert!((sum - NODES[i]).abs() <= 4e-16 * size.max(1.0), "stage {i}: {sum} instead of {}", NODES[i]);
    }
}

#[test]
fn the_step_has_order_eight_and_no_more() {
    let (trees, b) = (trees(9), weights(&STEP));
    for size in 1..=8 {
        let violation = violation(&trees, size, &b, 1.0);
        assert!(violation < 2e-14, "order {size}: {violation:e}");
    }
    assert!(violation(&trees, 9, &b, 1.0) > 1e-8);
}

#[test]
fn the_embedded_formulas_have_orders_five_and_three_and_no_more() {
    let trees = trees(6);
    let (step, error) = (weights(&STEP), weights(&ERROR_5));
    let mut fifth = step;
    for (b, e) in fifth.iter_mut().zip(error) {
        *b -= e;
    }
    for (b, order) in [(fifth, 5), (weights(&EMBEDDED_3), 3)] {
        for size in 1..=order {
            let violation = violation(&trees, size, &b, 1.0);
            assert!(violation < 1e-14, "formula of order {order}, trees of size {size}: {violation:e}");
        }
        assert!(violation(&trees, order + 1, &b, 1.0) > 1e-6);
    }
}

#[test]
fn the_dense_output_has_order_seven_and_no_more() {
    let trees = trees(8);
    let step = weights(&STEP);
    let rows = [weights(&DENSE_4), weights(&DENSE_5), weights(&DENSE_6), weights(&DENSE_7)];
    let mut first = [0.0; STAGES];
    let mut last = [0.0; STAGES];
    (first[0], last[12]) = (1.0, 1.0);
    let mut eighth = 0.0f64;
    for theta in [0.1, 0.25, 0.5, 0.8, 1.0] {
        // b_i(θ) by the same nested basis as the states.
        let mut coefficients = vec![0.0; 8 * STAGES];
        for i in 0..STAGES {
            let bend = first[i] - step[i];
            coefficients[STAGES + i] = step[i];
            coefficients[2 * STAGES + i] = bend;
            coefficients[3 * STAGES + i] = step[i] - last[i] - bend;
            for (j, row) in rows.iter().enumerate() {
                coefficients[(4 + j) * STAGES + i] = row[i];
            }
        }
        let mut b = [0.0; STAGES];
        evaluate_segment(Basis::Nested, &coefficients, theta, &mut b);
        for size in 1..=7 {
            let violation = violation(&trees, size, &b, theta);
            assert!(violation < 1e-13, "θ = {theta}, trees of size {size}: {violation:e}");
        }
        eighth = eighth.max(violation(&trees, 8, &b, theta));
    }
    assert!(eighth > 1e-8);
}
