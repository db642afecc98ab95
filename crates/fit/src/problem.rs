//! Residuals of films and their derivatives by the unknowns.

use motion::{Choice, Settings, is_costate};
use nalgebra::{DMatrix, DVector};
use scene::Scene;
use symbolic::limits::SAME;

use crate::identifiability::{Identifiability, identifiability};
use crate::part::{Part, Place};
use crate::unknown::CLOCK;
use crate::{Film, FitError, Unknown};

/// Residuals of this length, or a change of theirs, are none.
pub(crate) const NOTHING: f64 = 1e-3;

/// Another formulation that fits, its numbers and their scales.
pub(crate) type Beside = (Problem, [Vec<f64>; 2]);

/// Films of motions of one scene in one formulation, and what is not known of it: residuals
///
/// ```text
/// r = (c(t, q(t; θ), v(t; θ), θ) − seen)/σ ,     (θ − mean)/deviation for each prior,
/// ```
///
/// and `∂r/∂θ`, by derivatives that are carried with the motions.
#[derive(Clone)]
pub struct Problem {
    parts: Vec<Part>,
    unknowns: Vec<Unknown>,
    start: Vec<f64>,
    /// By unknown, whether it is a parameter of the scene.
    parameters: Vec<bool>,
    /// Number of the first start of a search.
    pub(crate) first: usize,
    /// Starts that are known before, beside the first one.
    pub(crate) known: Vec<Vec<f64>>,
    /// Beside it parts of the films may exclude this one.
    pub(crate) beside: Option<Box<Beside>>,
    robust: Option<f64>,
    /// `(θ − mean)/deviation` of unknowns that are held.
    held: Vec<f64>,
}

/// One residual.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Number of the film, from 0.
    pub film: usize,
    /// Number of the column.
    pub column: usize,
    /// Line of the file.
    pub line: usize,
    /// The time.
    pub t: f64,
    /// `(c − seen)/σ`.
    pub value: f64,
}

impl Problem {
    /// The films as motions of `choice`.
    ///
    /// # Errors
    /// [`FitError`]: an unknown that the scene does not have, one twice, too few numbers.
    pub fn new(
        scene: &Scene,
        choice: &Choice,
        films: &[Film],
        unknowns: &[Unknown],
        settings: &Settings,
    ) -> Result<Problem, FitError> {
        let unknowns = expanded(scene, unknowns, films.len())?;
        let found: usize = films.iter().map(Film::count).sum();
        if unknowns.is_empty() {
            return Err(FitError::NoUnknown);
        }
        if found <= unknowns.len() {
            return Err(FitError::TooShort { found, unknowns: unknowns.len() });
        }
        let mut parts = Vec::new();
        for (number, film) in films.iter().enumerate() {
            parts.push(Part::new(scene, choice, film, number, &unknowns, settings)?);
        }
        let value = |unknown: &Unknown| unknown.start.unwrap_or_else(|| value_of(scene, &unknown.name));
        let start = unknowns.iter().map(value).collect();
        let parameters = unknowns.iter().map(|unknown| is_parameter(scene, &unknown.name)).collect();
        let (known, held) = (Vec::new(), Vec::new());
        Ok(Problem { parts, unknowns, start, parameters, first: 0, known, beside: None, robust: None, held })
    }

    /// Residuals above this size count linearly (Huber); 1.345 costs 5 % where errors are normal.
    #[must_use]
    pub fn robust(self, limit: Option<f64>) -> Self {
        Problem { robust: limit, ..self }
    }

    /// Whether large residuals count linearly.
    pub(crate) fn is_robust(&self) -> bool {
        self.robust.is_some()
    }

    /// The unknowns: those that each film has of its own are there once per film.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// Where the search begins.
    pub fn start(&self) -> &[f64] {
        &self.start
    }

    /// How far a parameter may be from where the search begins for another start: its own size, or three
    /// deviations of what is known before; 0 for another unknown.
    pub(crate) fn doubt(&self, i: usize) -> f64 {
        match self.unknowns[i].prior {
            _ if !self.parameters[i] => 0.0,
            Some(prior) => self.start[i].abs().min(3.0 * prior.deviation),
            None => self.start[i].abs(),
        }
    }

    /// Sets where the search begins.
    ///
    /// # Panics
    /// If there are not as many numbers as unknowns.
    pub fn begin_at(&mut self, start: &[f64]) {
        assert_eq!(start.len(), self.unknowns.len(), "numbers");
        self.start = start.to_vec();
    }

    /// The films.
    pub fn films(&self) -> impl Iterator<Item = &Film> {
        self.parts.iter().map(|part| &part.film)
    }

    /// The same of the beginnings of the films, `samples` of each, and no prior is left out.
    ///
    /// # Errors
    /// [`FitError::Motion`] where so short a motion makes no sense.
    pub fn beginning(&self, samples: usize) -> Result<Problem, FitError> {
        let mut films: Vec<Film> = self.films().cloned().collect();
        for film in &mut films {
            film.t.truncate(samples);
            film.rows.truncate(samples);
            film.lines.truncate(samples);
        }
        self.of_films(films)
    }

    /// Film `number` alone, and the places of its unknowns.
    pub(crate) fn only(&self, number: usize) -> (Problem, Vec<usize>) {
        let is_own = |i: &usize| self.unknowns[*i].film.is_none_or(|film| film == number);
        let (own, others): (Vec<usize>, Vec<usize>) = (0..self.unknowns.len()).partition(is_own);
        let mut one = Problem { parts: vec![self.parts[number].clone()], beside: None, ..self.clone() };
        for i in others.into_iter().rev() {
            one = one.without(i, self.start[i]);
        }
        one.held.clear();
        (one, own)
    }

    /// From now on motions may take no more than `times` the steps of those at `theta`: a search that goes
    /// where they take more comes back.
    #[must_use]
    pub fn limited(&self, theta: &[f64], times: usize) -> Problem {
        let mut limited = self.clone();
        for part in &mut limited.parts {
            let row = part.row(theta);
            part.model.limit_steps(&row, times);
        }
        limited
    }

    /// With motions whose errors are small beside standard deviations, and no smaller.
    #[must_use]
    pub(crate) fn coarse(&self) -> Problem {
        let mut coarse = self.clone();
        coarse.parts.iter_mut().for_each(|part| part.model.coarsen(part.film.finest().min(SAME)));
        coarse
    }

    /// The most samples of a film.
    pub fn samples(&self) -> usize {
        self.films().map(|film| film.t.len()).max().unwrap_or(0)
    }

    /// The films that the motions at `theta` would give at the times of their films and at as many more with
    /// the same mean distance as make them `longer` times as long: without noise.
    ///
    /// # Errors
    /// Why there is no such motion.
    pub(crate) fn foreseen(&self, theta: &[f64], longer: f64) -> Result<Vec<Film>, String> {
        let mut films = Vec::new();
        for part in &self.parts {
            let mut film = part.film.lengthened(longer);
            let seen = part.seen_at(&film, theta)?;
            film.rows = seen.into_iter().map(|row| row.into_iter().map(Some).collect()).collect();
            films.push(film);
        }
        Ok(films)
    }

    /// The same unknowns and other films, of the same motions.
    ///
    /// # Errors
    /// [`FitError::Motion`] for times that make no sense.
    pub(crate) fn of_films(&self, films: Vec<Film>) -> Result<Problem, FitError> {
        let mut other = self.clone();
        for (part, film) in other.parts.iter_mut().zip(films) {
            part.model = part.model.with_times(&film.t)?;
            part.film = film;
        }
        Ok(other)
    }

    /// Where the truth is at `theta`: priors of the unknowns in `at` have their means there.
    pub(crate) fn true_at(&self, theta: &[f64], at: &[usize]) -> Problem {
        let mut moved = self.clone();
        moved.begin_at(theta);
        for &i in at {
            if let Some(prior) = &mut moved.unknowns[i].prior {
                prior.mean = theta[i];
            }
        }
        moved
    }

    /// With this bound for the unknown `i`.
    pub(crate) fn bounded(&self, i: usize, bound: f64) -> Problem {
        let mut bounded = self.clone();
        bounded.unknowns[i].bound = Some(bound);
        bounded
    }

    /// Without the unknown `i`, which has this value.
    pub(crate) fn without(&self, i: usize, value: f64) -> Problem {
        let mut less = self.clone();
        let prior = less.unknowns.remove(i).prior;
        less.held.extend(prior.map(|prior| (value - prior.mean) / prior.deviation));
        less.start.remove(i);
        for known in &mut less.known {
            known.remove(i);
        }
        less.parameters.remove(i);
        for place in less.parts.iter_mut().flat_map(Part::all_places) {
            *place = match *place {
                Place::Unknown(j) if j == i => Place::Known(value),
                Place::Unknown(j) if j > i => Place::Unknown(j - 1),
                other => other,
            };
        }
        less
    }

    /// Whether films of these columns can show the unknowns at all, these being motions of `choice`.
    pub fn identifiability(&self, scene: &Scene, choice: &Choice) -> Identifiability {
        identifiability(scene, choice, &self.parts, &self.unknowns)
    }

    /// How far the columns of the films go from their means, over σ, as the length of a vector; as far as
    /// noise does at least.
    pub(crate) fn extent(&self) -> f64 {
        let mut sum = 0.0;
        for film in self.films() {
            for (c, column) in film.columns.iter().enumerate() {
                let seen: Vec<f64> = film.rows.iter().filter_map(|row| row[c]).collect();
                let mean = seen.iter().sum::<f64>() / seen.len().max(1) as f64;
                sum += seen.iter().map(|x| ((x - mean) / column.sigma).powi(2)).sum::<f64>();
            }
        }
        sum.max(self.count() as f64).sqrt()
    }

    /// The number of residuals: those of films, then one per prior.
    pub fn count(&self) -> usize {
        let priors = self.unknowns.iter().filter(|u| u.prior.is_some()).count();
        self.films().map(Film::count).sum::<usize>() + priors + self.held.len()
    }

    /// The residuals of the films at `theta`, as they are.
    ///
    /// # Errors
    /// Why a motion does not reach the end of its film.
    pub fn residuals(&mut self, theta: &[f64]) -> Result<Vec<Residual>, String> {
        let mut all = Vec::new();
        for (number, part) in self.parts.iter_mut().enumerate() {
            let mut cells = Vec::new();
            part.evaluate(theta, false, &mut |cell, value, _| cells.push((cell, value)))?;
            all.extend(cells.into_iter().map(|((row, column), value)| {
                let (t, line) = (part.film.t[row], part.film.lines[row]);
                Residual { film: number, column, line, t, value }
            }));
        }
        Ok(all)
    }

    /// What is minimised: residuals with priors, robust ones where that is asked for, and their derivatives.
    ///
    /// # Errors
    /// Why a motion does not reach the end of its film.
    pub fn weighed(&mut self, theta: &[f64], derivatives: bool) -> Result<(DVector<f64>, DMatrix<f64>), String> {
        let (count, width) = (self.count(), theta.len());
        let mut values = Vec::with_capacity(count);
        let mut jacobian = DMatrix::zeros(if derivatives { count } else { 0 }, width);
        let robust = self.robust;
        for part in &mut self.parts {
            part.evaluate(theta, derivatives, &mut |_, value, by: &[(usize, f64)]| {
                let (value, slope) = huber(value, robust);
                for (j, derivative) in by {
                    jacobian[(values.len(), *j)] += slope * derivative;
                }
                values.push(value);
            })?;
        }
        for (j, unknown) in self.unknowns.iter().enumerate() {
            if let Some(prior) = unknown.prior {
                if derivatives {
                    jacobian[(values.len(), j)] = 1.0 / prior.deviation;
                }
                values.push((theta[j] - prior.mean) / prior.deviation);
            }
        }
        values.extend(&self.held);
        Ok((DVector::from_vec(values), jacobian))
    }
}

/// `r̃` with `r̃² = 2ρ(r)` of Huber's ρ, and `∂r̃/∂r`.
fn huber(r: f64, limit: Option<f64>) -> (f64, f64) {
    match limit {
        Some(limit) if r.abs() > limit => {
            let size = (2.0 * limit * r.abs() - limit * limit).sqrt();
            (r.signum() * size, limit / size)
        }
        _ => (r, 1.0),
    }
}

/// Whether all films share a number of this name.
fn is_parameter(scene: &Scene, name: &str) -> bool {
    name == CLOCK || scene.system.parameters.iter().any(|p| scene.system.graph.name(p.symbol) == name)
}

/// Each film has its own start values, multipliers and costates; all share a parameter.
fn expanded(scene: &Scene, unknowns: &[Unknown], films: usize) -> Result<Vec<Unknown>, FitError> {
    let mut all: Vec<Unknown> = Vec::new();
    for unknown in unknowns {
        if let Some(film) = unknown.film.filter(|film| *film >= films) {
            let reason = format!("there is no film {}, there are {films}", film + 1);
            return Err(FitError::Unknown { text: unknown.label(), reason });
        }
        let named = |film: usize| unknowns.iter().any(|u| u.name == unknown.name && u.film == Some(film));
        if unknown.film.is_some() || films == 1 || is_parameter(scene, &unknown.name) {
            let film = unknown.film.filter(|_| films > 1);
            all.push(Unknown { film, ..unknown.clone() });
        } else {
            let others = (0..films).filter(|film| !named(*film));
            all.extend(others.map(|film| Unknown { film: Some(film), ..unknown.clone() }));
        }
    }
    let twice = |i: &usize| all[..*i].iter().any(|u| (&u.name, u.film) == (&all[*i].name, all[*i].film));
    match (0..all.len()).find(twice) {
        Some(i) => Err(FitError::Twice(all[i].label())),
        None => Ok(all),
    }
}

/// The scene's own value of a number; 0 for a costate.
fn value_of(scene: &Scene, name: &str) -> f64 {
    let system = &scene.system;
    if is_costate(name) {
        return 0.0;
    }
    if let Some(i) = scene.multiplier_names().iter().position(|own| own == name) {
        return scene.multipliers[i];
    }
    let Some(symbol) = system.graph.find_symbol(name) else { return 0.0 };
    let states = system.positions().into_iter().chain(system.velocities());
    let values = scene.start.q.iter().chain(&scene.start.v).copied();
    let parameter = system.parameters.iter().find(|p| p.symbol == symbol).map(|p| p.value);
    parameter.or_else(|| states.zip(values).find(|(s, _)| *s == symbol).map(|(_, x)| x)).unwrap_or(0.0)
}
