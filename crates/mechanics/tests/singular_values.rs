//! Singular values of matrices with entries of very different sizes, and of wide ones.

use mechanics::SingularValues;
use nalgebra::{DMatrix, DVector};

#[test]
fn entries_of_very_different_sizes_are_no_matter() {
    let a = DMatrix::from_row_slice(
        3,
        3,
        &[
            0.015462747453407684,
            0.8202154230234239,
            0.029964096162762688,
            0.0,
            0.0,
            1.0309254949068154,
            1.0309254949068154,
            0.0,
            0.0,
        ],
    );
    let x = DVector::from_row_slice(&[-1.09375, -0.625, 0.15625]);
    let svd = SingularValues::of(&a);
    assert!((svd.solve(&(&a * &x), 1e-12) - &x).amax() < 1e-14);
    let again = &svd.left * DMatrix::from_diagonal(&svd.values) * &svd.right;
    assert!((again - &a).amax() < 1e-15);
    assert!((svd.right.tr_mul(&svd.right) - DMatrix::identity(3, 3)).amax() < 1e-15);
}

#[test]
fn small_singular_values_and_wide_matrices() {
    let wide = DMatrix::from_row_slice(2, 3, &[1.0, 1.0, 1.0, 1.0, 1.0, 1.0 + 1e-12]);
    let svd = SingularValues::of(&wide);
    // det(A Aᵀ) = 2 δ² with δ the difference that the entry has in f64
    let delta: f64 = (1.0 + 1e-12) - 1.0;
    assert!((svd.values[0] * svd.values[1] / (delta * 2.0_f64.sqrt()) - 1.0).abs() < 1e-3);
    assert_eq!((svd.left.shape(), svd.right.shape()), ((2, 2), (2, 3)));
    assert_eq!(SingularValues::of(&DMatrix::zeros(0, 2)).right.shape(), (0, 2));
}
