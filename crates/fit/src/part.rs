//! One film with its motion: residuals and their derivatives.

use motion::{Choice, Model, Settings};
use scene::Scene;
use symbolic::Symbol;

use crate::film::expression;
use crate::observation::Observation;
use crate::unknown::CLOCK;
use crate::{Film, FitError, Unknown};

/// One film, and the motion that it shows.
#[derive(Clone)]
pub(crate) struct Part {
    pub(crate) film: Film,
    pub(crate) model: Model,
    /// Where the numbers of the model come from.
    pub(crate) places: Vec<Place>,
    /// Places of the parameters of columns among the numbers of the model.
    pub(crate) parameters: Vec<usize>,
    pub(crate) seen: Observation,
    /// By how much its clock is slow, where that is not known.
    pub(crate) clock: Option<Place>,
    /// The start, from which its clock runs.
    start: f64,
}

/// Where a number comes from.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    Unknown(usize),
    Known(f64),
}

impl Place {
    pub(crate) fn value(&self, theta: &[f64]) -> f64 {
        match *self {
            Place::Unknown(i) => theta[i],
            Place::Known(x) => x,
        }
    }
}

/// Why a residual or its derivatives cannot be squared and added up.
fn unusable(r: f64, by: &[(usize, f64)]) -> Option<String> {
    if !r.is_finite() {
        return Some("has no value".into());
    }
    if r.abs() > FARTHEST {
        return Some(format!("is {r:.1e} standard deviations off; at most {FARTHEST:.0e} are possible"));
    }
    by.iter().any(|(_, slope)| !slope.is_finite()).then(|| "has no derivative".into())
}

/// The largest residual: squares of as many as there may be have a sum.
const FARTHEST: f64 = 1e100;

/// What is done with a cell, given by row and column: with `r`, and its derivatives by unknowns.
type Reader<'a> = dyn FnMut((usize, usize), f64, &[(usize, f64)]) + 'a;

impl Part {
    /// Film `number`, as a motion of `choice`.
    pub(crate) fn new(
        scene: &Scene,
        choice: &Choice,
        film: &Film,
        number: usize,
        unknowns: &[Unknown],
        settings: &Settings,
    ) -> Result<Part, FitError> {
        let own = |name: &str| unknowns.iter().any(|u| u.name == name && u.film == Some(number));
        let mut names: Vec<&str> = Vec::new();
        let (mut places, mut clock) = (Vec::new(), None);
        let is_clock = |name: &str| name == CLOCK && scene.system.graph.find_symbol(CLOCK).is_none();
        for (i, unknown) in unknowns.iter().enumerate() {
            let applies = unknown.film.map_or(!own(&unknown.name), |film| film == number);
            if applies && is_clock(&unknown.name) {
                clock = Some(Place::Unknown(i));
            } else if applies {
                names.push(&unknown.name);
                places.push(Place::Unknown(i));
            }
        }
        for (name, value) in &film.known {
            if !names.contains(&name.as_str()) {
                names.push(name);
                places.push(Place::Known(*value));
            }
        }
        let model = Model::new(scene, choice, &names, &film.t, settings)?;
        let symbol = |name: &str| scene.system.graph.find_symbol(name);
        let is_parameter = |s: &Symbol| scene.system.parameters.iter().any(|p| p.symbol == *s);
        let varied: Vec<(usize, Symbol)> =
            names.iter().enumerate().filter_map(|(i, name)| Some((i, symbol(name).filter(is_parameter)?))).collect();
        let (parameters, symbols): (Vec<usize>, Vec<Symbol>) = varied.into_iter().unzip();
        let expressions = film.columns.iter().map(|column| Ok((&column.name[..], expression(scene, &column.name)?)));
        let expressions = expressions.collect::<Result<Vec<_>, FitError>>()?;
        let seen = Observation::new(&scene.system, &expressions, &symbols)?;
        Ok(Part { film: film.clone(), model, places, parameters, seen, clock, start: scene.start.t })
    }

    /// The numbers of the model.
    pub(crate) fn row(&self, theta: &[f64]) -> Vec<f64> {
        self.places.iter().map(|place| place.value(theta)).collect()
    }

    /// All places that numbers have.
    pub(crate) fn all_places(&mut self) -> impl Iterator<Item = &mut Place> {
        self.places.iter_mut().chain(&mut self.clock)
    }

    /// Times of a film on the clock of the scene.
    fn times(&self, film: &Film, slow: f64) -> Vec<f64> {
        film.t.iter().map(|t| self.start + (1.0 + slow) * (t - self.start)).collect()
    }

    /// Times of the model are those of this film on a clock that is so slow.
    fn set_clock(&mut self, slow: f64) -> Result<(), String> {
        let times = self.times(&self.film, slow);
        self.model.set_times(&times).map_err(|error| error.to_string())
    }

    /// The motion at `theta` at the times of `film`.
    pub(crate) fn seen_at(&self, film: &Film, theta: &[f64]) -> Result<Vec<Vec<f64>>, String> {
        let times = self.times(film, self.clock.map_or(0.0, |clock| clock.value(theta)));
        let mut model = self.model.with_times(&times).map_err(|error| error.to_string())?;
        self.values(&mut model, &times, theta)
    }

    /// Values of the columns at the times of `model`.
    fn values(&self, model: &mut Model, times: &[f64], theta: &[f64]) -> Result<Vec<Vec<f64>>, String> {
        let row = self.row(theta);
        let read = model.outputs(&row);
        if let Some(reason) = read.ended {
            return Err(reason);
        }
        let parameters: Vec<f64> = self.parameters.iter().map(|&i| row[i]).collect();
        let mut seen = self.seen.clone();
        let each = times.iter().zip(&read.outputs);
        Ok(each.map(|(t, at)| seen.at(*t, at, &parameters).iter().map(|(value, _)| *value).collect()).collect())
    }

    /// Derivatives of the values by its clock, unknown `j`.
    fn by_clock(&self, theta: &[f64], j: usize) -> Result<Vec<Vec<f64>>, String> {
        // central differences lose least there
        let change = f64::EPSILON.cbrt();
        let ends = [change, -change].map(|step| {
            let mut moved = theta.to_vec();
            moved[j] += step;
            self.seen_at(&self.film, &moved)
        });
        let [high, low] = ends;
        let slope = |(a, b): (&f64, &f64)| (a - b) / (2.0 * change);
        Ok(high?.iter().zip(&low?).map(|(a, b)| a.iter().zip(b).map(slope).collect()).collect())
    }

    /// Calls `with` for every cell that is not empty: its row and column, `r`, and by which unknowns it
    /// moves.
    pub(crate) fn evaluate(&mut self, theta: &[f64], derivatives: bool, with: &mut Reader) -> Result<(), String> {
        let row = self.row(theta);
        if let Some(clock) = self.clock {
            self.set_clock(clock.value(theta))?;
        }
        let unknown_clock = match self.clock {
            Some(Place::Unknown(j)) if derivatives => Some(j),
            _ => None,
        };
        let by_clock = unknown_clock.map(|j| self.by_clock(theta, j)).transpose()?;
        let times = self.model.times().to_vec();
        let read = if derivatives { self.model.derivatives(&row) } else { self.model.outputs(&row) };
        if let Some(reason) = read.ended {
            return Err(reason);
        }
        let parameters: Vec<f64> = self.parameters.iter().map(|&i| row[i]).collect();
        let n = read.outputs.first().map_or(0, |outputs| outputs.coordinates.len());
        let mut by = Vec::new();
        for (k, outputs) in read.outputs.iter().enumerate() {
            for (c, (value, slopes)) in self.seen.at(times[k], outputs, &parameters).into_iter().enumerate() {
                let Some(seen) = self.film.rows[k][c] else { continue };
                let sigma = self.film.columns[c].sigma;
                by.clear();
                for (l, place) in self.places.iter().enumerate().filter(|_| derivatives) {
                    let Place::Unknown(j) = *place else { continue };
                    let moved = &read.derivatives[k][l];
                    let moves = moved.coordinates.iter().chain(&moved.velocities);
                    let along: f64 = slopes.iter().zip(moves).map(|(s, m)| s * m).sum();
                    let own = self.parameters.iter().position(|&p| p == l).map_or(0.0, |p| slopes[2 * n + p]);
                    by.push((j, (along + own) / sigma));
                }
                by.extend(unknown_clock.zip(by_clock.as_ref()).map(|(j, slopes)| (j, slopes[k][c] / sigma)));
                let r = (value - seen) / sigma;
                if let Some(what) = unusable(r, &by) {
                    let (name, line) = (&self.film.columns[c].name, self.film.lines[k]);
                    return Err(format!("`{name}` {what} at t = {}, line {line} of the film", times[k]));
                }
                with((k, c), r, &by);
            }
        }
        Ok(())
    }
}
