//! The best design of a film: numbers d of the motion, each between two bounds, that
//!
//! ```text
//! tell two formulations apart:   max over d of  min over θ of  χ²(d, θ) ,
//! show a number θ_j:             min over d of  σ_j ,   σ² = diag (JᵀJ)⁻¹ .
//! ```
//!
//! `χ²(d, θ)` is that of the second formulation with the unknowns θ on a film of the first one without noise,
//! priors included: what it lies above the number of residuals on average. Each inner minimum is the least
//! that several starts found. The search over d: the scene's own numbers, corners, and points that fill the
//! box evenly; then from the best of these along the axes, by steps that become shorter.

use std::cell::RefCell;
use std::str::FromStr;

use equations::Formulation;
use motion::shooting::least_from;
use motion::{CHETAEV, Choice, choices_among};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::known::beside_chetaev;
use crate::least::{Stage, least};
use crate::profile::LAST;
use crate::question::{LAW, has_constants, is_constant, is_of_a_law, problem_of};
use crate::search::search;
use crate::{EXCLUDED, Film, Fit, FitError, Problem, Question, Unknown, quantity, standard_errors};

/// Lengths over that of the film, at which a film that tells is looked for.
const LENGTHS: [f64; 7] = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0];

/// A number that can be chosen, `NAME=LOW:HIGH`, `NAME@2=LOW:HIGH` for the second film alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Its name in the scene.
    pub name: String,
    /// The film, from 0; otherwise each film has its own start value, and all share a parameter.
    pub film: Option<usize>,
    /// The bounds.
    pub ends: [f64; 2],
}

impl FromStr for Range {
    type Err = FitError;

    fn from_str(text: &str) -> Result<Self, FitError> {
        let refused = |reason: &str| FitError::Choose { text: text.into(), reason: reason.into() };
        let parts = text.split_once('=').and_then(|(name, ends)| Some((name, ends.split_once(':')?)));
        let (name, (low, high)) = parts.ok_or_else(|| refused("it is not NAME=LOW:HIGH"))?;
        let unknown: Unknown = name.parse()?;
        let ends = [quantity(low)?, quantity(high)?];
        if ends[0] >= ends[1] {
            return Err(refused("the first bound has to be below the second"));
        }
        Ok(Range { name: unknown.name, film: unknown.film, ends })
    }
}

/// The aim of a film.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// To show that the first formulation is right and the second is not.
    Tell(&'static Formulation, &'static Formulation),
    /// To estimate a number: with the first-order law if its numbers are unknown, else with Chetaev's.
    Estimate(String),
}

/// Films that can be chosen.
#[derive(Clone)]
pub struct Design {
    aim: Aim,
    scene: Scene,
    /// The formulations.
    choices: Vec<Choice>,
    truth: Side,
    /// The wrong formulation, which the films have to exclude.
    rival: Option<Side>,
    /// Place of the number that is to be estimated.
    unknown: usize,
    chosen: Vec<Chosen>,
    starts: usize,
    /// Time from the start to the last sample.
    length: f64,
}

/// A number that is chosen.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Chosen {
    /// As it is written: `x@2`.
    #[serde(rename = "name")]
    pub label: String,
    /// The bounds.
    #[serde(flatten, serialize_with = "crate::json::ends")]
    #[schemars(with = "crate::json::Ends")]
    pub ends: [f64; 2],
    /// The scene's own number.
    pub own: f64,
}

/// What films of one d show.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Point {
    /// The chosen numbers.
    pub at: Vec<f64>,
    /// The least χ² of the second formulation, or the standard error; infinite where films do not show it.
    #[schemars(with = "Option<f64>")]
    pub value: f64,
    /// Numbers of the second formulation at its least χ².
    #[serde(serialize_with = "crate::json::numbers")]
    #[schemars(with = "Vec<crate::json::Number>")]
    pub numbers: Vec<(String, f64)>,
    /// Minima that the search for it saw.
    pub minima: usize,
    /// The least χ² from half of the starts, all, and twice as many if tried; empty for a standard error.
    #[serde(serialize_with = "crate::json::by_starts")]
    #[schemars(with = "Vec<crate::json::ByStarts>")]
    pub by_starts: Vec<(usize, f64)>,
    /// Combinations of unknowns that such films do not show.
    pub hidden: Vec<String>,
}

/// A formulation, its unknowns, and which of these are chosen.
#[derive(Clone)]
struct Side {
    problem: Problem,
    /// By unknown: its place among the chosen numbers.
    places: Vec<Option<usize>>,
    /// Unknowns that are known in fact: chosen, and not free.
    known: Vec<usize>,
}

impl Side {
    fn new(
        scene: &Scene,
        choice: &Choice,
        films: &[Film],
        question: &Question,
        over: &[Range],
    ) -> Result<(Side, Vec<Chosen>), FitError> {
        let is_free = |name: &str, film: Option<usize>| {
            question.unknowns.iter().any(|u| u.name == name && (u.film.is_none() || u.film == film))
        };
        let mut unknowns = question.unknowns.to_vec();
        for range in over.iter().filter(|range| !is_free(&range.name, range.film)) {
            unknowns.push(Unknown { film: range.film, ..Unknown::named(&range.name) });
        }
        let asked = Question { unknowns: &unknowns, ..question.clone() };
        let problem = problem_of(scene, choice, films, &asked)?;
        let (mut chosen, mut places, mut known): (Vec<Chosen>, _, _) = (Vec::new(), Vec::new(), Vec::new());
        for (i, unknown) in problem.unknowns().iter().enumerate() {
            let of =
                |range: &&Range| range.name == unknown.name && (range.film.is_none() || range.film == unknown.film);
            let Some(range) = over.iter().rev().find(of) else {
                places.push(None);
                continue;
            };
            places.push(Some(chosen.len()));
            chosen.push(Chosen { label: unknown.label(), ends: range.ends, own: problem.start()[i] });
            if !is_free(&unknown.name, unknown.film) {
                known.push(i);
            }
        }
        Ok((Side { problem, places, known }, chosen))
    }

    /// The unknowns where the truth is d.
    fn theta(&self, d: &[f64]) -> Vec<f64> {
        let own = self.problem.start().iter().zip(&self.places);
        own.map(|(own, place)| place.map_or(*own, |i| d[i])).collect()
    }

    /// The problem where the truth is d.
    fn at(&self, d: &[f64]) -> Problem {
        let theta = self.theta(d);
        let chosen: Vec<usize> = (0..theta.len()).filter(|&i| self.places[i].is_some()).collect();
        let mut problem = self.problem.true_at(&theta, &chosen);
        for &i in self.known.iter().rev() {
            problem = problem.without(i, theta[i]);
        }
        problem
    }
}

impl Design {
    /// Films of `scene` whose columns and times are those of `films`; what is filled in there does not
    /// matter. Free are `question.unknowns`, and the constants that formulations start from.
    ///
    /// # Errors
    /// [`FitError`]: of [`Problem::new`]; a formulation that the scene does not have, or the same formulation
    /// twice; a number that is chosen and is none of the scene; an unknown to be estimated that is not free.
    pub fn new(
        scene: &Scene,
        films: &[Film],
        question: &Question,
        over: &[Range],
        aim: &Aim,
    ) -> Result<Design, FitError> {
        let mut law = question.law.to_vec();
        let estimated = match aim {
            Aim::Estimate(name) => Some(Unknown::named(name).of_law()),
            Aim::Tell(..) => None,
        };
        let is_free = |unknown: &Unknown| question.unknowns.iter().any(|own| own.name == unknown.name);
        law.extend(estimated.clone().filter(|unknown| is_of_a_law(&unknown.name) && !is_free(unknown)));
        let (scene, law, unknowns) = Question { law: &law, ..question.clone() }.prepared(scene)?;
        let (scene, question) = (&scene, &Question { unknowns: &unknowns, law: &law, ..question.clone() });
        let first = |wanted: &'static Formulation| {
            let choice = choices_among(scene, |f| *f == *wanted).into_iter().next();
            choice.ok_or(FitError::NoMotionOf(wanted.name))
        };
        let choices = match aim {
            Aim::Tell(truth, rival) if truth == rival => return Err(FitError::ToldFromItself(truth.name)),
            Aim::Tell(truth, rival) => vec![first(truth)?, first(rival)?],
            Aim::Estimate(_) => {
                let is_law = law.iter().chain(&unknowns).any(|unknown| is_of_a_law(&unknown.name));
                vec![first(if is_law { LAW } else { CHETAEV })?]
            }
        };
        let (choice, rival) = (&choices[0], choices.get(1));
        let (truth, chosen) = Side::new(scene, choice, films, question, over)?;
        let missing = |range: &&Range| {
            let of = |u: &Unknown| u.name == range.name && (range.film.is_none() || range.film == u.film);
            !truth.problem.unknowns().iter().any(of)
        };
        if let Some(range) = over.iter().find(missing) {
            let reason = "it is not a number of this formulation".to_string();
            return Err(FitError::Choose { text: range.name.clone(), reason });
        }
        let mut unknown = 0;
        if let Some(Unknown { name, .. }) = estimated {
            let of = |i: &usize| truth.problem.unknowns()[*i].label() == name && !truth.known.contains(i);
            let place = (0..truth.problem.unknowns().len()).find(of).ok_or_else(|| FitError::Unknown {
                text: name.clone(),
                reason: "it is not free, so that no film has to show it".into(),
            })?;
            unknown = place - truth.known.iter().filter(|known| **known < place).count();
        }
        let rival = rival.map(|rival| Side::new(scene, rival, films, question, over)).transpose()?;
        let rival = rival.map(|(side, others)| {
            // in the order of the first formulation
            let place = |i: usize| chosen.iter().position(|own| own.label == others[i].label);
            Side { places: side.places.iter().map(|at| at.and_then(place)).collect(), ..side }
        });
        let ends = films.iter().filter_map(|film| film.t.last());
        let length = ends.fold(0.0, |length: f64, end| length.max(end - scene.start.t));
        let scene = scene.clone();
        Ok(Design { aim: aim.clone(), scene, choices, truth, rival, unknown, chosen, starts: question.starts, length })
    }

    /// What films are to show.
    pub fn aim(&self) -> &Aim {
        &self.aim
    }

    /// Labels of the formulations: the right one, then the one to be excluded.
    pub fn labels(&self) -> Vec<&str> {
        self.choices.iter().map(|choice| choice.label.as_str()).collect()
    }

    /// The numbers that are chosen, in the order of [`Point::at`].
    pub fn chosen(&self) -> &[Chosen] {
        &self.chosen
    }

    /// What films of the motion with the numbers d show.
    ///
    /// # Errors
    /// [`FitError::NoMotion`].
    pub fn point(&self, d: &[f64]) -> Result<Point, FitError> {
        self.tried(d, 1.0, self.starts, None)
    }

    /// The same by twice as many starts: the least χ² that is found is less or equal.
    ///
    /// # Errors
    /// As [`Design::point`].
    pub fn point_again(&self, d: &[f64]) -> Result<Point, FitError> {
        self.tried(d, 1.0, 2 * self.starts, None)
    }

    fn tried(&self, d: &[f64], longer: f64, starts: usize, near: Option<&[f64]>) -> Result<Point, FitError> {
        let Some(rival) = &self.rival else {
            let problem = self.truth.at(d);
            let shown = standard_errors(&problem, problem.start())?;
            let value = shown.errors[self.unknown];
            let (numbers, by_starts) = (Vec::new(), Vec::new());
            return Ok(Point { at: d.to_vec(), value, numbers, minima: 1, by_starts, hidden: shown.hidden });
        };
        let films = self.truth.problem.foreseen(&self.truth.theta(d), longer);
        let films = films.map_err(|reason| FitError::NoMotion { starts: 1, reason })?;
        let mut problem = rival.at(d).of_films(films)?;
        near.into_iter().for_each(|near| problem.begin_at(near));
        if let [truth, rival] = &self.choices[..]
            && *truth.formulation == *CHETAEV
            && has_constants(rival)
        {
            let labels = self.truth.problem.unknowns().iter().map(Unknown::label);
            let numbers = labels.zip(self.truth.theta(d)).collect();
            problem.known = beside_chetaev(&self.scene, rival, &problem, (&self.truth.problem, truth, &numbers));
        }
        let spread = |name: &str| is_constant(name) || is_of_a_law(name);
        let found = search(&problem, &spread, starts, false)?;
        let labels = problem.unknowns().iter().map(Unknown::label);
        let mut counts = vec![self.starts.div_ceil(2), self.starts, 2 * self.starts];
        counts.retain(|count| *count <= starts);
        counts.dedup();
        let by_starts = counts.into_iter().map(|count| (count, least_from(count, &found.minima))).collect();
        let (value, minima) = (found.best.value, found.minima.len());
        let numbers = labels.zip(found.best.unknowns).collect();
        Ok(Point { at: d.to_vec(), value, numbers, minima, by_starts, hidden: Vec::new() })
    }

    /// Whether a is better than b.
    pub(crate) fn is_better(&self, a: &Point, b: &Point) -> bool {
        if self.rival.is_some() { a.value > b.value } else { a.value < b.value }
    }

    /// The length of the shortest film, of the motion with the numbers d, that excludes the second
    /// formulation, χ² ≥ [`EXCLUDED`], to 2 %, up to eight times as long as the films, and what it shows by
    /// twice as many starts; `None` where no such length is found. If these find a smaller χ² at this length,
    /// the search is repeated with them.
    pub fn shortest(&self, d: &[f64]) -> Option<(f64, Point)> {
        self.rival.as_ref()?;
        // what fits a film is a start for a longer one
        let near: RefCell<Option<Vec<f64>>> = RefCell::new(None);
        let tells = |longer: f64, starts: usize| {
            let found = self.tried(d, longer, starts, near.borrow().as_deref()).ok()?;
            let tells = found.value >= EXCLUDED;
            if !tells {
                near.replace(Some(found.numbers.iter().map(|(_, x)| *x).collect()));
            }
            Some((tells, found))
        };
        let least = |starts: usize| shortest(&|longer| tells(longer, starts).map(|(tells, _)| tells));
        let twice = 2 * self.starts;
        let found = least(self.starts)?;
        let (sure, point) = tells(found, twice)?;
        if sure {
            return Some((found * self.length, point));
        }
        let found = least(twice)?;
        Some((found * self.length, tells(found, twice)?.1))
    }
}

/// How many times as long a film has to be, where `truth` is the formulation and its best fit are the
/// numbers, until χ² of `rival` is [`EXCLUDED`] at least, without noise; of a few lengths.
pub(crate) fn length_that_tells(truth: (&Problem, &Fit), rival: (&Problem, &Fit)) -> Option<f64> {
    // a slip at its bound is no unknown of the problem: it is the last estimate
    let own = |problem: &Problem, of: Vec<f64>| of[..problem.unknowns().len()].to_vec();
    let [at, mut start] = [truth, rival].map(|(problem, fit)| own(problem, fit.numbers()));
    let scale = own(rival.0, rival.1.scales());
    for longer in &LENGTHS[1..] {
        let films = truth.0.foreseen(&at, *longer).ok()?;
        let found = least(&rival.0.of_films(films).ok()?, &start, &scale, Stage::Profile).ok()?;
        if found.value >= EXCLUDED {
            return Some(*longer);
        }
        start = found.unknowns;
    }
    None
}

/// The least length over that of the films at which these tell, none where there is no motion.
fn shortest(tells: &dyn Fn(f64) -> Option<bool>) -> Option<f64> {
    let (mut low, mut high) = (0.0, None);
    for longer in LENGTHS {
        if tells(longer)? {
            high = Some(longer);
            break;
        }
        low = longer;
    }
    let mut high = high?;
    while high - low > LAST * high {
        // a film that is too short for its unknowns does not tell
        let middle = if low > 0.0 { 0.5 * (low + high) } else { high / 1.5 };
        match tells(middle).unwrap_or(false) {
            true => high = middle,
            false => low = middle,
        }
    }
    Some(high)
}
