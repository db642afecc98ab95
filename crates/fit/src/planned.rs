//! Predictions for films that are not yet made.

use std::str::FromStr;

use scene::Scene;

use crate::film::column;
use crate::quantity::unit_of;
use crate::{Deviations, Film, FitError, quantity};

/// Most numbers of all films: with them a fit takes minutes.
pub(crate) const MOST_NUMBERS: usize = 300_000;

/// When a film looks: `60Hz,0.5mm,10s` is 600 times in ten seconds, with a standard deviation of 0.5 mm where
/// a column has no other.
///
/// ```
/// let times: fit::Sampling = "60Hz, 0.5mm, 10s".parse()?;
/// assert_eq!((times.rate, times.seconds, times.sigma), (60.0, 10.0, Some(0.5e-3)));
/// # Ok::<(), fit::FitError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// Samples per unit of time, above 0.
    pub rate: f64,
    /// The length, above 0.
    pub seconds: f64,
    /// Standard deviation of columns that have no other, and the unit it is written in.
    pub sigma: Option<f64>,
}

impl FromStr for Sampling {
    type Err = FitError;

    fn from_str(text: &str) -> Result<Self, FitError> {
        let refused = |reason: String| FitError::Sampling { text: text.into(), reason };
        let above = |what: &str, x: f64| match x > 0.0 && x.is_finite() {
            true => Ok(x),
            false => Err(refused(format!("the {what} is {x}; it must be above 0"))),
        };
        let (mut rate, mut seconds, mut sigma) = (None, None, None);
        for part in text.split(',').map(str::trim) {
            let (place, what, value) = if let Some(number) = part.strip_suffix("Hz") {
                (&mut rate, "rate", quantity(number)?)
            } else if part.ends_with('s') {
                (&mut seconds, "length", quantity(part)?)
            } else {
                (&mut sigma, "standard deviation", quantity(part)?)
            };
            if place.replace(above(what, value)?).is_some() {
                return Err(refused(format!("the {what} is there twice")));
            }
        }
        let needed = |x: Option<f64>, what: &str| x.ok_or_else(|| refused(format!("there is no {what}")));
        let (rate, seconds) = (needed(rate, "rate, as in 60Hz")?, needed(seconds, "length, as in 10s")?);
        let samples = (rate * seconds).round();
        if !(1.0..=MOST_NUMBERS as f64).contains(&samples) {
            return Err(refused(format!("it has {samples} samples; 1 to {MOST_NUMBERS} are possible")));
        }
        Ok(Sampling { rate, seconds, sigma })
    }
}

impl Film {
    /// A film to be made of a scene: `times.rate·times.seconds` samples, the first a step after the start; of
    /// these columns, or those of `[film]`, or the coordinates.
    ///
    /// # Errors
    /// [`FitError`] for columns that are not expressions, or have no standard deviation.
    pub fn planned(
        scene: &Scene,
        columns: &[String],
        times: Sampling,
        deviations: &Deviations,
    ) -> Result<Film, FitError> {
        if times.sigma.is_some() {
            // it was read in m, s, rad and kg
            unit_of(scene, "σ of the film to be made", "m")?;
        }
        let others = deviations.others.or(times.sigma);
        let deviations = Deviations { others, ..deviations.clone() };
        let names: Vec<String> = match (columns, &scene.film[..]) {
            ([], []) => scene.system.coordinates.iter().map(|c| c.name.clone()).collect(),
            ([], filmed) => filmed.iter().map(|filmed| filmed.name.clone()).collect(),
            (named, _) => named.to_vec(),
        };
        let columns = names.iter().map(|name| column(scene, name, &deviations)).collect::<Result<Vec<_>, _>>()?;
        if let Some(column) = columns.iter().find(|column| column.estimated) {
            return Err(FitError::NothingToEstimate(column.name.clone()));
        }
        let samples = (times.rate * times.seconds).round() as usize;
        let t: Vec<f64> = (1..=samples).map(|k| scene.start.t + k as f64 / times.rate).collect();
        let rows = vec![vec![Some(0.0); columns.len()]; samples];
        let lines = (2..).take(samples).collect();
        Ok(Film { name: "film".into(), t, columns, rows, lines, ..Film::default() })
    }
}
