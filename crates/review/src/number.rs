//! Numbers of a field of residues, or floats with bands, by which equations are compared.

use decision::exact::{Coefficient, Exact, Flaw, Jet, Modular};
use mechanics::elimination::{self, largest, open};
use symbolic::{Bounded, Evaluator, Scalar, SplitMix};

/// A number at a point, with its exact value where sines of it are asked for.
pub(crate) type At<C> = Jet<C, 2>;

/// What equations are compared in.
pub(crate) trait Number: Coefficient {
    /// Whether what is not zero here is proved not to be zero.
    const PROVES: bool;
    /// Whether it is zero, or may be within its band.
    fn vanishes(self) -> bool;
    /// Whether it is a number.
    fn is_sound(self) -> bool;
    /// A random value: an integer of so many bits in a field, a float near `centre`, for no bits itself.
    fn draw(random: &mut SplitMix, bits: u32, centre: f64) -> At<Self>;
    /// The value, its history forgotten.
    fn fresh(self) -> Self;
    /// The simple fraction that it is, if it is one.
    fn fraction(self) -> Option<f64>;
}

impl Number for Modular {
    const PROVES: bool = true;

    fn vanishes(self) -> bool {
        self.is_zero()
    }

    fn is_sound(self) -> bool {
        true
    }

    fn draw(random: &mut SplitMix, bits: u32, _: f64) -> At<Self> {
        let x = random.bits();
        let n = i128::from(x % (1 << bits)) + 1;
        let exact = Exact::ratio(if x >> 63 == 0 { n } else { -n }, 1).unwrap_or(Exact::ONE);
        Jet::constant(Modular::fraction(exact).unwrap_or(Modular::one()), Some(exact))
    }

    fn fresh(self) -> Self {
        self
    }

    fn fraction(self) -> Option<f64> {
        self.small_fraction().map(Exact::to_f64)
    }
}

impl Number for Bounded {
    const PROVES: bool = false;

    fn vanishes(self) -> bool {
        self.may_be_zero()
    }

    fn is_sound(self) -> bool {
        self.is_finite()
    }

    fn draw(random: &mut SplitMix, bits: u32, centre: f64) -> At<Self> {
        if bits == 0 {
            return Jet::constant(Self::from_f64(centre), None);
        }
        // what is round-off at the start is drawn like 0
        let size = if centre.abs() < 1e-12 { 1.0 } else { centre.abs() };
        Jet::constant(Self::from_f64(centre + 0.4 * size * (2.0 * random.unit() - 1.0)), None)
    }

    fn fresh(self) -> Self {
        Self::from_f64(self.value)
    }

    fn fraction(self) -> Option<f64> {
        (1..=12)
            .map(|d| (self.value * f64::from(d)).round() / f64::from(d))
            .find(|x| (self - Self::from_f64(*x)).may_be_zero())
            .filter(|_| self.round_off() < 0.01)
    }
}

/// The outputs of a tape at `inputs`.
///
/// # Errors
/// The [`Flaw`] of the first output that has no image.
pub(crate) fn values<C: Number>(program: &mut Evaluator<At<C>>, inputs: &[At<C>]) -> Result<Vec<C>, Flaw> {
    let outputs = program.evaluate(inputs);
    let value = |x: &At<C>| match x.flaw() {
        None if x.coefficient(0).is_sound() => Ok(x.coefficient(0)),
        flaw => Err(flaw.unwrap_or(Flaw::Zero)),
    };
    outputs.iter().map(value).collect()
}

/// Numbers as inputs.
pub(crate) fn constants<C: Number>(x: &[C]) -> Vec<At<C>> {
    x.iter().map(|&x| Jet::constant(x, None)).collect()
}

/// [`elimination::eliminate`] by pivots in the first `columns`, the largest first: the rows with pivots come
/// first, in the order of the columns that are returned.
pub(crate) fn eliminate<C: Number>(rows: &mut [Vec<C>], columns: usize) -> Vec<usize> {
    elimination::eliminate(rows, |rows, done| {
        largest(rows, open(rows, done, columns).rev().filter(|&(i, j)| !rows[i][j].vanishes()))
    })
}
