//! Symmetric compositions: a symmetric step of order 2 in, a symmetric step of higher order out.

/// How many steps of order 2, lengths `γ_i h`, `γ_i = γ_{s+1−i}`, `Σ γ_i = 1`, make one step of length `h`.
///
/// The composition is symplectic, keeps a quadratic invariant or maps a discrete constraint into another if
/// the base step does. Some `γ_i` are negative, time runs back there (unavoidable beyond order 2).
///
/// ```
/// use discrete::Composition;
/// let fourth = Composition::of_order(4).unwrap();
/// assert_eq!((fourth.order(), fourth.lengths().len()), (4, 5));
/// assert!(Composition::of_order(5).is_none());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Composition {
    /// The base step itself.
    Second,
    /// Five steps: M. Suzuki, Phys. Lett. A 146 (1990), `γ = 1/(4 − 4^{1/3})`, in the middle `1 − 4γ`.
    Fourth,
    /// Nine steps: W. Kahan, R.-C. Li, Math. Comp. 66 (1997).
    Sixth,
    /// Seventeen steps: W. Kahan, R.-C. Li, Math. Comp. 66 (1997).
    Eighth,
}

/// `γ_1, …, γ_s` from those up to the middle.
const fn mirrored<const HALF: usize, const ALL: usize>(half: [f64; HALF]) -> [f64; ALL] {
    let (mut all, mut i) = ([0.0; ALL], 0);
    while i < HALF {
        (all[i], all[ALL - 1 - i]) = (half[i], half[i]);
        i += 1;
    }
    all
}

const SECOND: [f64; 1] = [1.0];

/// `1/(4 − 4^{1/3})`
const SUZUKI: f64 = 0.414_490_771_794_375_7;
const FOURTH: [f64; 5] = mirrored([SUZUKI, SUZUKI, 1.0 - 4.0 * SUZUKI]);

/// Digits as in E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, (V.3.12).
const SIXTH: [f64; 9] = mirrored([
    0.392_161_444_007_314_1,
    0.332_599_136_789_359_43,
    -0.706_246_172_557_639_3,
    0.082_213_596_293_550_8,
    0.798_543_990_934_83,
]);

/// Digits as there, (V.3.13).
const EIGHTH: [f64; 17] = mirrored([
    0.130_202_483_088_890_07,
    0.561_162_981_775_108_4,
    -0.389_474_962_644_847_27,
    0.158_841_906_555_155_6,
    -0.395_903_894_133_237_57,
    0.184_539_640_978_315_7,
    0.258_374_387_686_322_04,
    0.295_011_723_609_310_3,
    -0.605_508_533_830_034_6,
]);

impl Composition {
    /// Every composition there is, by rising order.
    pub const ALL: [Composition; 4] =
        [Composition::Second, Composition::Fourth, Composition::Sixth, Composition::Eighth];

    /// The composition of that order: 2, 4, 6 or 8.
    pub fn of_order(order: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|composition| composition.order() == order)
    }

    /// The order of the composed step.
    pub fn order(self) -> u32 {
        match self {
            Composition::Second => 2,
            Composition::Fourth => 4,
            Composition::Sixth => 6,
            Composition::Eighth => 8,
        }
    }

    /// `γ_1, …, γ_s`.
    pub fn lengths(self) -> &'static [f64] {
        match self {
            Composition::Second => &SECOND,
            Composition::Fourth => &FOURTH,
            Composition::Sixth => &SIXTH,
            Composition::Eighth => &EIGHTH,
        }
    }
}
