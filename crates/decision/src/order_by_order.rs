//! Power series of the unknowns of linear equations, one order after the other.

use symbolic::go_on;

use crate::exact::{Coefficient, Exact, Flaw, Jet, inverse, subtract_product};

/// Why there are no series.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum NoSeries {
    /// A number of it has no image.
    #[error("{0}")]
    Flaw(#[from] Flaw),
    /// A matrix of an instant has the determinant zero.
    #[error("the equations of the {of} are singular at the start")]
    Singular { of: &'static str },
    /// A number is missing.
    #[error("the start of `{name}` is not written")]
    Unwritten { name: String },
}

pub(crate) fn sound<C: Coefficient>(values: &[Jet<C>]) -> Result<(), NoSeries> {
    match values.iter().find_map(Jet::flaw) {
        Some(flaw) => Err(flaw.into()),
        None => Ok(()),
    }
}

pub(crate) fn one<C: Coefficient>() -> Result<C, Flaw> {
    C::of(Exact::ONE)
}

/// The order-k coefficients of a row of series.
pub(crate) fn order<C: Coefficient>(values: &[Jet<C>], k: usize) -> Vec<C> {
    values.iter().map(|x| x.coefficient(k)).collect()
}

/// `J Z = −R` order by order: what is known of `J`, and `Z` so far.
pub(crate) struct SeriesSolve<C> {
    over: Vec<C>,
    pub(crate) determinant: C,
    size: usize,
    width: usize,
    pub(crate) solved: Vec<Vec<C>>,
}

impl<C: Coefficient> SeriesSolve<C> {
    pub(crate) fn new(matrix: &[Jet<C>], size: usize, width: usize, of: &'static str) -> Result<Self, NoSeries> {
        let (over, determinant) = inverse(&order(matrix, 0), size, one()?).ok_or(NoSeries::Singular { of })?;
        Ok(SeriesSolve { over, determinant, size, width, solved: Vec::new() })
    }

    /// The next order of `Z` (size×width), from `R` at that order.
    pub(crate) fn next(&mut self, matrix: &[Jet<C>], rest: &[C]) {
        go_on();
        let k = self.solved.len();
        let mut right: Vec<C> = rest.iter().map(|&r| -r).collect();
        for j in 1..=k {
            subtract_product(&mut right, &order(matrix, j), &self.solved[k - j], self.size, self.width);
        }
        let mut z = vec![C::ZERO; right.len()];
        subtract_product(&mut z, &self.over, &right, self.size, self.width);
        self.solved.push(z.into_iter().map(|x| -x).collect());
    }
}
