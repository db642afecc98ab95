//! Radau IIA with three stages: nodes, error weights and the transformation of the stages.
//!
//! E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, IV.8, and their code RADAU5.

/// √6
const ROOT_6: f64 = 2.449_489_742_783_178;
/// `c_i`.
pub const NODES: [f64; 3] = [(4.0 - ROOT_6) / 10.0, (4.0 + ROOT_6) / 10.0, 1.0];
/// The error estimate, `h⁻¹ Σ e_i z_i + F`, is solved with the real factors.
pub const ERROR: [f64; 3] = [-(13.0 + 7.0 * ROOT_6) / 3.0, (-13.0 + 7.0 * ROOT_6) / 3.0, -1.0 / 3.0];
/// `A⁻¹ = T diag(γ, [α −β; β α]) T⁻¹`.
pub const T: [[f64; 3]; 3] = [
    [9.123_239_487_089_295e-2, -0.141_255_295_020_954_2, -3.002_919_410_514_742_4e-2],
    [0.241_717_932_707_107, 0.204_129_352_293_799_94, 0.382_942_112_757_261_9],
    [0.966_048_182_615_093, 1.0, 0.0],
];
pub const T_INVERSE: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_84, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_44],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605, -0.596_039_204_828_224_9],
];

/// `γ`, `α`, `β`: the eigenvalues of `A⁻¹` are `γ` and `α ± iβ`.
pub fn eigenvalues() -> [f64; 3] {
    let (a, b) = (81.0_f64.cbrt(), 9.0_f64.cbrt());
    let (alpha, beta) = ((12.0 - a + b) / 60.0, (a + b) * 3.0_f64.sqrt() / 60.0);
    let size = alpha * alpha + beta * beta;
    [30.0 / (6.0 + a - b), alpha / size, beta / size]
}

/// `A⁻¹`.
pub fn inverse() -> [[f64; 3]; 3] {
    let [gamma, alpha, beta] = eigenvalues();
    product(&product(&T, &[[gamma, 0.0, 0.0], [0.0, alpha, -beta], [0.0, beta, alpha]]), &T_INVERSE)
}

pub fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}
