//! The tableau of Radau IIA.

use integrate::radau5_tableau::{T, T_INVERSE, inverse, product};

#[test]
fn the_transformation_diagonalizes_the_inverse_of_the_collocation_matrix() {
    let s = 6.0_f64.sqrt();
    // Hairer & Wanner II, table IV.5.6
    let a = [
        [(88.0 - 7.0 * s) / 360.0, (296.0 - 169.0 * s) / 1800.0, (-2.0 + 3.0 * s) / 225.0],
        [(296.0 + 169.0 * s) / 1800.0, (88.0 + 7.0 * s) / 360.0, (-2.0 - 3.0 * s) / 225.0],
        [(16.0 - s) / 36.0, (16.0 + s) / 36.0, 1.0 / 9.0],
    ];
    for (what, found) in [("A A⁻¹", product(&a, &inverse())), ("T T⁻¹", product(&T, &T_INVERSE))] {
        for (i, row) in found.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((x - unit).abs() < 2e-14, "{what}: {found:?}");
            }
        }
    }
}
