//! Unknowns of a scene or a film.

use std::str::FromStr;

use motion::{Choice, costate_names};
use scene::Scene;

use crate::film::positive;
use crate::{FitError, quantity};

/// A normal prior distribution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub deviation: f64,
}

/// Name of the relative error of a film's clock, unless the scene has a parameter of this name.
pub(crate) const CLOCK: &str = "clock";

/// An unknown number of a scene (a parameter, a start value, `mu0_1`, `P0_w`) or of a film: the relative
/// error `clock` of its clock. Time `t` of the film is `t₀ + (1 + clock)(t − t₀)` in the scene.
///
/// Written `NAME`, `NAME@2` for the second film alone, `NAME~VALUE` with a value at which the search begins,
/// `NAME~MEAN±DEVIATION` with a prior; `NAME>=BOUND`.
///
/// ```
/// use fit::{Prior, Unknown};
/// let unknown: Unknown = "Omega@2~0.7±0.01".parse()?;
/// assert_eq!((unknown.name.as_str(), unknown.film), ("Omega", Some(1)));
/// assert_eq!(unknown.prior, Some(Prior { mean: 0.7, deviation: 0.01 }));
/// # Ok::<(), fit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its name in the scene.
    pub name: String,
    /// The film, from 0, whose own number it is. Otherwise all films share a parameter, and each has its own
    /// start value, multiplier or costate.
    pub film: Option<usize>,
    /// Where the search begins; at the scene's value if left out.
    pub start: Option<f64>,
    /// The prior.
    pub prior: Option<Prior>,
    /// Its lower bound.
    pub bound: Option<f64>,
}

impl Unknown {
    /// A number of this name, nothing known before.
    pub fn named(name: &str) -> Self {
        Unknown { name: name.into(), film: None, start: None, prior: None, bound: None }
    }

    /// As a number of the law of first order: `eps` is `epsilon`, not below 0; `slip`, not below 0, begins at
    /// 0.01.
    #[must_use]
    pub fn of_law(&self) -> Self {
        let mut unknown = self.clone();
        match unknown.name.as_str() {
            "eps" => (unknown.name, unknown.bound) = ("epsilon".into(), unknown.bound.or(Some(0.0))),
            "slip" => (unknown.start, unknown.bound) = (unknown.start.or(Some(0.01)), unknown.bound.or(Some(0.0))),
            _ => {}
        }
        unknown
    }

    /// As it is written: `x@2`.
    pub fn label(&self) -> String {
        self.film.map_or_else(|| self.name.clone(), |film| format!("{}@{}", self.name, film + 1))
    }
}

/// `start` among the unknowns of a scene stands for its coordinates and the start velocities that it gives,
/// but those that are named beside it.
pub(crate) fn with_start(scene: &Scene, unknowns: &[Unknown]) -> Vec<Unknown> {
    let Some(start) = unknowns.iter().find(|u| u.name == "start") else { return unknowns.to_vec() };
    let coordinates = scene.system.coordinates.iter().map(|c| c.name.clone());
    let each = coordinates.chain(scene.completion.given.iter().cloned());
    let others = each.filter(|name| unknowns.iter().all(|u| u.name != *name));
    let others = others.map(|name| Unknown { film: start.film, ..Unknown::named(&name) });
    unknowns.iter().filter(|u| u.name != "start").cloned().chain(others).collect()
}

impl FromStr for Unknown {
    type Err = FitError;

    fn from_str(text: &str) -> Result<Self, FitError> {
        let refused = |reason: String| FitError::Unknown { text: text.into(), reason };
        let (rest, bound) = match text.split_once(">=") {
            Some((rest, bound)) => (rest, Some(quantity(bound)?)),
            None => (text, None),
        };
        let (rest, known) = match rest.split_once('~') {
            Some((rest, known)) => (rest, Some(known)),
            None => (rest, None),
        };
        let (name, film) = match rest.split_once('@') {
            Some((name, film)) => (name, Some(film)),
            None => (rest, None),
        };
        let number = |film: &str| {
            let number = film.trim().parse::<usize>().ok().and_then(|film| film.checked_sub(1));
            number.ok_or_else(|| refused(format!("`{film}` is not a number of a film, which count from 1")))
        };
        let film = film.map(number).transpose()?;
        let name = name.trim();
        if name.is_empty() {
            return Err(refused("it has no name".into()));
        }
        let pair = |known: &str| {
            known.split_once('±').or_else(|| known.split_once("+-")).map(|(a, b)| (a.to_string(), b.to_string()))
        };
        let (start, prior) = match known.map(|known| (known, pair(known))) {
            None => (None, None),
            Some((_, Some((mean, deviation)))) => {
                let (mean, deviation) = (quantity(&mean)?, positive(name, quantity(&deviation)?)?);
                (Some(mean), Some(Prior { mean, deviation }))
            }
            Some((start, None)) => (Some(quantity(start)?), None),
        };
        Ok(Unknown { name: name.into(), film, start, prior, bound })
    }
}

/// Names of the constants that motions of `choice` start from.
pub(crate) fn constant_names(scene: &Scene, choice: &Choice) -> Vec<String> {
    choice.removal.as_ref().map_or_else(|| scene.multiplier_names(), |removal| costate_names(scene, removal))
}
