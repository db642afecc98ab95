//! Small linear systems over any coefficients.

use super::Coefficient;

/// The inverse of a square matrix, and its determinant; `None` where it is singular.
pub(crate) fn inverse<C: Coefficient>(matrix: &[C], size: usize, one: C) -> Option<(Vec<C>, C)> {
    let mut left = matrix.to_vec();
    let mut right = vec![C::ZERO; size * size];
    for i in 0..size {
        right[i * size + i] = one;
    }
    let mut determinant = one;
    for column in 0..size {
        let weight = |row: usize| left[row * size + column].weight();
        let pivot = (column..size).max_by(|&a, &b| weight(a).total_cmp(&weight(b)).then(b.cmp(&a)))?;
        let value = left[pivot * size + column];
        let over = value.inverse()?;
        if pivot != column {
            determinant = -determinant;
            for j in 0..size {
                left.swap(pivot * size + j, column * size + j);
                right.swap(pivot * size + j, column * size + j);
            }
        }
        determinant = determinant * value;
        for half in [&mut left, &mut right] {
            for j in 0..size {
                half[column * size + j] = half[column * size + j] * over;
            }
        }
        for row in (0..size).filter(|&row| row != column) {
            let factor = left[row * size + column];
            if factor.weight() == 0.0 {
                continue;
            }
            for half in [&mut left, &mut right] {
                for j in 0..size {
                    half[row * size + j] = half[row * size + j] - factor * half[column * size + j];
                }
            }
        }
    }
    Some((right, determinant))
}

/// `matrix · columns`, of sizes rows×inner and inner×width, added to `into` with a sign.
pub(crate) fn subtract_product<C: Coefficient>(
    into: &mut [C],
    matrix: &[C],
    columns: &[C],
    inner: usize,
    width: usize,
) {
    for (row, into) in into.chunks_exact_mut(width).enumerate() {
        for j in 0..inner {
            let factor = matrix[row * inner + j];
            if factor.weight() != 0.0 {
                for (x, &c) in into.iter_mut().zip(&columns[j * width..(j + 1) * width]) {
                    *x = *x - factor * c;
                }
            }
        }
    }
}
