//! The eigenvalues of one block other than zero.

use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector, Schur};
use num_complex::Complex;
use symbolic::limits::ITERATIONS;

use crate::discs::Discs;
use crate::matrix::balanced;
use crate::weyl::Weyl;

/// Axes in which it is tried.
const TURNS: usize = 5;

/// A block without its null space, and its eigenvalues.
pub struct Core {
    pub values: Vec<Complex<f64>>,
    /// How far arithmetic lets entries of the block be off.
    pub(crate) arithmetic: DMatrix<f64>,
    /// Without the null space, balanced, and how far its entries are off.
    matrix: DMatrix<f64>,
    error: DMatrix<f64>,
}

impl Core {
    /// `None` where the QR algorithm does not converge.
    pub fn of(block: DMatrix<f64>, noise: DMatrix<f64>) -> Option<Core> {
        let n = block.nrows();
        if n == 1 {
            // one number is what it is
            let is_zero = block[(0, 0)].abs() <= noise[(0, 0)];
            let values = if is_zero { Vec::new() } else { vec![block[(0, 0)].into()] };
            return Some(Core { values, arithmetic: DMatrix::zeros(1, 1), matrix: block, error: noise });
        }
        let (own, noise, units) = balanced(block, noise);
        let (limit, size) = (allowed(&own, &noise), own.norm());
        let [matrix, noise] = without_null_space(own, noise, limit);
        let (values, left) = eigenvalues(matrix.clone())?;
        let off = f64::EPSILON * size + left;
        let arithmetic = DMatrix::from_fn(n, n, |i, j| off * units[i] / units[j]);
        Some(Core { values, arithmetic, matrix, error: noise.map(|x| x + off) })
    }

    /// Discs of the eigenvalues, if the zeros are zero.
    pub(crate) fn discs(self) -> Discs {
        let all = (0..self.matrix.nrows()).collect();
        Discs::new(&self.matrix, self.error, self.values, vec![all])
    }
}

/// The error of a matrix as a length: its own, and that of arithmetic.
pub(crate) fn allowed(matrix: &DMatrix<f64>, noise: &DMatrix<f64>) -> f64 {
    4.0 * f64::EPSILON * matrix.norm() + noise.norm()
}

/// How many singular values count as zero.
pub(crate) fn nullity(svd: &SingularValues, error: f64) -> usize {
    let limit = svd.values.len() as f64 * error;
    svd.values.iter().filter(|&&s| s <= limit).count()
}

/// Most entries that are not zero with no two in a row or column: the rank of almost all matrices with these.
pub(crate) fn structural_rank(entries: &DMatrix<bool>) -> usize {
    fn place(row: usize, entries: &DMatrix<bool>, seen: &mut [bool], row_of: &mut [Option<usize>]) -> bool {
        (0..entries.ncols()).any(|j| {
            let fits = entries[(row, j)] && !std::mem::replace(&mut seen[j], true);
            let found = fits && row_of[j].is_none_or(|other| place(other, entries, seen, row_of));
            if found {
                row_of[j] = Some(row);
            }
            found
        })
    }
    let mut row_of = vec![None; entries.ncols()];
    (0..entries.nrows()).filter(|&i| place(i, entries, &mut vec![false; entries.ncols()], &mut row_of)).count()
}

/// `Q₁ᵀ B Q₁` with `Q₁` orthogonal to the null space of `B`, until there is none: one zero less per vector.
/// And the same of errors, by their sizes.
fn without_null_space(mut block: DMatrix<f64>, mut noise: DMatrix<f64>, error: f64) -> [DMatrix<f64>; 2] {
    loop {
        let svd = SingularValues::of(&block);
        let rank = block.nrows() - nullity(&svd, error);
        if rank == block.nrows() {
            return [block, noise];
        }
        let kept = svd.right.rows(0, rank);
        block = kept * &block * kept.transpose();
        noise = kept.abs() * noise * kept.transpose().abs();
    }
}

/// Eigenvalues, and how far from the matrix that has them exactly the given one is: the QR algorithm in its
/// own axes, or, where it does not converge, in turned ones.
fn eigenvalues(matrix: DMatrix<f64>) -> Option<(Vec<Complex<f64>>, f64)> {
    let n = matrix.nrows();
    if n == 0 {
        return Some((Vec::new(), 0.0));
    }
    let mut random = Weyl::default();
    (0..TURNS).find_map(|turn| {
        let normal = DVector::from_fn(n, |_, _| if turn == 0 { 0.0 } else { random.number() });
        let turned = reflected(&reflected(&matrix, &normal).transpose(), &normal).transpose();
        let schur = Schur::try_new(turned.clone(), f64::EPSILON, ITERATIONS * n)?;
        let values = schur.complex_eigenvalues().iter().copied().collect();
        let (axes, triangle) = schur.unpack();
        Some((values, (turned - &axes * triangle * axes.transpose()).norm()))
    })
}

/// `(1 − 2 n nᵀ/|n|²) A`; `A` where `n` is zero.
fn reflected(matrix: &DMatrix<f64>, normal: &DVector<f64>) -> DMatrix<f64> {
    let square = normal.norm_squared();
    if square == 0.0 { matrix.clone() } else { matrix - normal * (normal.transpose() * matrix) * (2.0 / square) }
}
