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

#[cfg(test)]
mod tests {
    //! A symmetric step is `exp(h A₁ + h³ A₃ + h⁵ A₅ + …)`, no two `A_j` commuting. So order p means `Π
    //! exp(γ_i A₁ + γ_i³ A₃ + γ_i⁵ A₅ + …) = exp(A₁)` for all words in `A_j` of grade (sum of `j`) ≤ p.

    use super::*;
    use std::collections::BTreeMap;

    /// Coefficients by word.
    type Series = BTreeMap<Vec<u32>, f64>;

    fn grade(word: &[u32]) -> u32 {
        word.iter().sum()
    }

    fn product(a: &Series, b: &Series, highest: u32) -> Series {
        let mut out = Series::new();
        for (u, x) in a {
            for (v, y) in b.iter().filter(|(v, _)| grade(u) + grade(v) <= highest) {
                *out.entry([&u[..], v].concat()).or_default() += x * y;
            }
        }
        out
    }

    fn exponential(letters: &Series, highest: u32) -> Series {
        let mut sum = Series::from([(Vec::new(), 1.0)]);
        let mut term = sum.clone();
        for k in 1..=highest {
            term = product(&term, letters, highest);
            term.values_mut().for_each(|x| *x /= f64::from(k));
            for (word, x) in &term {
                *sum.entry(word.clone()).or_default() += x;
            }
        }
        sum
    }

    /// Largest violation among words of exactly that grade.
    fn violations(lengths: &[f64], highest: u32) -> Vec<f64> {
        let mut composed = Series::from([(Vec::new(), 1.0)]);
        for &length in lengths {
            let letters = (1..=highest).step_by(2).map(|j| (vec![j], length.powi(j as i32))).collect();
            composed = product(&composed, &exponential(&letters, highest), highest);
        }
        for (word, x) in exponential(&Series::from([(vec![1], 1.0)]), highest) {
            *composed.entry(word).or_default() -= x;
        }
        let of_grade = |k: u32| composed.iter().filter(move |(word, _)| grade(word) == k);
        (1..=highest).map(|k| of_grade(k).fold(0.0, |m, (_, x)| f64::max(m, x.abs()))).collect()
    }

    #[test]
    fn every_composition_has_its_order_and_no_more() {
        for composition in Composition::ALL {
            let order = composition.order();
            let found = violations(composition.lengths(), order + 1);
            assert!(found[..order as usize].iter().all(|&x| x < 4e-15), "{composition:?}: {found:?}");
            assert!(found[order as usize] > 1e-6, "{composition:?}: {found:?}");
        }
    }

    #[test]
    fn there_are_as_many_words_as_there_should_be() {
        // compositions of k into odd parts are Fibonacci numbers
        let letters = (1..=9).step_by(2).map(|j| (vec![j], 1.0)).collect();
        let words = exponential(&letters, 9);
        let counts: Vec<usize> = (1..=9).map(|k| words.keys().filter(|w| grade(w) == k).count()).collect();
        assert_eq!(counts, [1, 1, 2, 3, 5, 8, 13, 21, 34]);
    }
}
