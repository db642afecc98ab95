//! Small linear systems over any entries, and rows modulo a prime.

use symbolic::go_on;

use super::{Entry, Modular};

/// The inverse of a square matrix, and its determinant; `None` where it is singular.
pub fn inverse<E: Entry>(matrix: &[E], size: usize, one: E) -> Option<(Vec<E>, E)> {
    let mut right = vec![E::ZERO; size * size];
    right.iter_mut().step_by(size + 1).for_each(|x| *x = one);
    let determinant = solve(&mut matrix.to_vec(), &mut right, size, size, one)?;
    Some((right, determinant))
}

/// Makes `right` (size×width) `matrix⁻¹ · right`, and says the determinant; `None` where that is zero.
pub(crate) fn solve<E: Entry>(matrix: &mut [E], right: &mut [E], size: usize, width: usize, one: E) -> Option<E> {
    let mut determinant = one;
    let mut over_pivots = Vec::with_capacity(size);
    for column in 0..size {
        go_on();
        let weight = |row: usize| matrix[row * size + column].weight();
        let pivot = (column..size).max_by(|&a, &b| weight(a).total_cmp(&weight(b)).then(b.cmp(&a)))?;
        let value = matrix[pivot * size + column];
        let over = value.inverse()?;
        over_pivots.push(over);
        if pivot != column {
            determinant = -determinant;
            (0..size).for_each(|j| matrix.swap(pivot * size + j, column * size + j));
            (0..width).for_each(|j| right.swap(pivot * width + j, column * width + j));
        }
        determinant = determinant * value;
        for row in column + 1..size {
            let factor = matrix[row * size + column] * over;
            if factor.weight() != 0.0 {
                subtract_row(matrix, size, column, row, column, factor);
                subtract_row(right, width, 0, row, column, factor);
            }
        }
    }
    for (column, over) in over_pivots.into_iter().enumerate().rev() {
        right[column * width..(column + 1) * width].iter_mut().for_each(|x| *x = *x * over);
        (0..column).for_each(|row| subtract_row(right, width, 0, row, column, matrix[row * size + column]));
    }
    Some(determinant)
}

/// Subtracts `factor` times `row` from the row `from`, in the columns from `begin` on.
fn subtract_row<E: Entry>(matrix: &mut [E], width: usize, begin: usize, from: usize, row: usize, factor: E) {
    let (low, high) = (from.min(row), from.max(row));
    let (above, below) = matrix.split_at_mut(high * width);
    let (above, below) = (&mut above[low * width + begin..(low + 1) * width], &mut below[begin..width]);
    let (into, of) = if from < row { (above, below) } else { (below, above) };
    into.iter_mut().zip(of).for_each(|(x, y)| *x = *x - factor * *y);
}

/// Subtracts `matrix · columns`, of sizes rows×inner and inner×width, from `into`.
pub(crate) fn subtract_product<E: Entry>(into: &mut [E], matrix: &[E], columns: &[E], inner: usize, width: usize) {
    for (factors, into) in matrix.chunks_exact(inner.max(1)).zip(into.chunks_exact_mut(width)) {
        E::subtract_multiples(into, factors, columns);
    }
}

/// Rows that are independent modulo `p`, each with its pivot: what comes first in it is 1, and stands there.
#[derive(Default)]
pub struct Echelon(pub Vec<(usize, Vec<Modular>)>);

impl Echelon {
    /// Takes `row` in where it is independent of the rows so far, and says whether it is.
    pub fn add(&mut self, row: Vec<Modular>) -> bool {
        let mut row = self.rest(row);
        let pivot = row.iter().position(|x| !x.is_zero());
        let Some((pivot, over)) = pivot.and_then(|pivot| Some((pivot, row[pivot].inverse()?))) else { return false };
        row.iter_mut().for_each(|x| *x = *x * over);
        self.0.push((pivot, row));
        true
    }

    /// Whether `row` is a combination of the rows so far.
    pub fn spans(&self, row: Vec<Modular>) -> bool {
        self.rest(row).iter().all(|x| x.is_zero())
    }

    /// What is left of `row` beside the rows so far.
    fn rest(&self, mut row: Vec<Modular>) -> Vec<Modular> {
        go_on();
        for (pivot, other) in &self.0 {
            let factor = row[*pivot];
            if !factor.is_zero() {
                row[*pivot..].iter_mut().zip(&other[*pivot..]).for_each(|(x, &y)| *x = *x - factor * y);
            }
        }
        row
    }

    /// Columns of `width` without a pivot, and for each the vector of the kernel that has 1 there and 0 in
    /// the others.
    pub(crate) fn kernel(self, width: usize) -> (Vec<usize>, Vec<Vec<Modular>>) {
        let mut pivots = self.0;
        pivots.sort_by_key(|(pivot, _)| *pivot);
        let free: Vec<usize> = (0..width).filter(|j| pivots.iter().all(|(pivot, _)| pivot != j)).collect();
        let solve = |&j: &usize| {
            let mut x = vec![Modular::ZERO; width];
            x[j] = Modular::one();
            for (pivot, row) in pivots.iter().rev() {
                let sum = (pivot + 1..width).fold(Modular::ZERO, |sum, k| sum + row[k] * x[k]);
                x[*pivot] = -sum;
            }
            x
        };
        let kernel = free.iter().map(solve).collect();
        (free, kernel)
    }
}

/// How many of the first `fresh` columns are free, and all relations `Σ x_j column_j = 0`.
pub fn nullspace(columns: &[Vec<Modular>], fresh: usize) -> (usize, Vec<Vec<Modular>>) {
    let height = columns.first().map_or(0, Vec::len);
    let width = columns.len();
    let mut rows = Echelon::default();
    for i in 0..height {
        if rows.0.len() == width {
            break;
        }
        rows.add(columns.iter().map(|column| column[i]).collect());
    }
    let (free, kernel) = rows.kernel(width);
    (free.iter().filter(|&&j| j < fresh).count(), kernel)
}
