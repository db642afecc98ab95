//! A number with its error, and what two of them say of a difference.

use std::fmt::{self, Display, Formatter};

use super::limits::{CERTAINTY, ROUND_OFF};
use crate::metric::larger;

/// A number of a motion and how wrong it may be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Known {
    /// The number.
    pub value: f64,
    /// Largest difference of the two runs so far.
    pub error: f64,
    /// Largest size so far.
    pub size: f64,
    /// What its round-off is a part of: at least its size.
    pub reach: f64,
}

/// Why nothing is known of a number, or of its error relative to its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoInformation {
    /// It has been zero so far: there is no size that an error could be a part of.
    ZeroSize,
    /// No way from the start is larger than its error.
    AtRest,
    /// A run gives no number.
    NotFinite,
    /// The difference of the runs is not an error ([`crate::Doubt`]).
    Doubted,
}

impl Display for NoInformation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            NoInformation::ZeroSize => "it has no size",
            NoInformation::AtRest => "at rest, as far as can be told",
            NoInformation::NotFinite => "NaN",
            NoInformation::Doubted => "the difference of the runs is not an error",
        })
    }
}

impl Known {
    /// The largest change since the first instant of a quantity that has these values in both runs of a
    /// motion, the kept one first; `terms` is the largest sum of its terms without signs.
    pub fn change(values: &[[f64; 2]], terms: f64) -> Known {
        let most = |of: &dyn Fn(&[f64; 2]) -> f64| values.iter().map(of).fold(0.0, |most, x| larger(most, x.abs()));
        let (value, error) = (most(&|x| x[0] - values[0][0]), most(&|x| x[0] - x[1]));
        Known { value, error, size: value, reach: terms }
    }

    /// Whether it is certainly not zero, as a single quantity.
    pub fn is_certain(&self) -> bool {
        ask_alone(self.value, Some(self.bound())) == Answer::Apart
    }

    /// The value as a part of what its round-off is a part of; 0 for 0.
    pub fn of_terms(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { self.value.abs() / self.reach }
    }

    /// The same, or that round-off where it is more: a smaller part has no digits.
    pub fn with_digits(&self) -> f64 {
        larger(self.of_terms(), ROUND_OFF)
    }

    /// The error, with the round-off that both runs may share.
    pub fn bound(&self) -> f64 {
        self.error + ROUND_OFF * self.reach
    }

    /// The error as a part of the size; 0 where it is round-off.
    ///
    /// # Errors
    /// [`NoInformation::ZeroSize`], [`NoInformation::NotFinite`].
    pub fn part(&self) -> Result<f64, NoInformation> {
        match self {
            Known { error, .. } if error.is_nan() => Err(NoInformation::NotFinite),
            Known { error, reach, .. } if *error <= ROUND_OFF * reach => Ok(0.0),
            Known { size, .. } if *size > 0.0 => Ok(self.error / self.size),
            _ => Err(NoInformation::ZeroSize),
        }
    }
}

/// The answer to a difference of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// It is over [`CERTAINTY`] times the sum of their bounds.
    Apart,
    /// It is not.
    Within,
    /// Neither can be said.
    Undecided(NoInformation),
}

/// The answer to this difference of two numbers whose bounds have this sum; `None` where nothing is known.
pub fn ask(difference: f64, bounds: Option<f64>) -> Answer {
    let Some(bounds) = bounds else { return Answer::Undecided(NoInformation::Doubted) };
    match difference.abs() {
        d if d.is_nan() || bounds.is_nan() => Answer::Undecided(NoInformation::NotFinite),
        d if d > CERTAINTY * bounds => Answer::Apart,
        _ => Answer::Within,
    }
}

/// [`ask()`] of a single quantity, whose error is estimated less well: the difference counts from as many
/// times as much on again.
pub fn ask_alone(difference: f64, bounds: Option<f64>) -> Answer {
    ask(difference / CERTAINTY, bounds)
}
