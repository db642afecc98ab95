//! Films of motions, fitted.

use fit::{
    Aim, Design, Designed, Deviations, Film, FitError, Fitted, Question, ROBUST, Range, Row, Sampling, Unknown,
    fit_formulations, profile,
};
use integrate::Interrupt;
use motion::Settings;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use stubs::stubbed;

use crate::answer::typed;
use crate::arrays::{Array, Floats, array};
use crate::background::whole;
use crate::shared::Shared;
use crate::system::System;
use crate::{arguments, background, errors};

#[stubbed]
pub(crate) struct _Fitted {
    rows: Shared<Vec<Row>>,
    #[pyo3(get)]
    answer: String,
    #[pyo3(get)]
    films: Vec<Seen>,
}

/// A film as Python reads it: its name, times, and columns: name, standard deviation, values; NaN for a gap.
type Seen = (String, Vec<f64>, Vec<(String, f64, Vec<f64>)>);

fn refused(error: FitError) -> PyErr {
    match error {
        FitError::Motion(error) => errors::solve(error),
        other => PyValueError::new_err(other.to_string()),
    }
}

fn read<T>(list: &[String]) -> PyResult<Vec<T>>
where
    T: std::str::FromStr<Err = FitError>,
{
    list.iter().map(|text| text.parse::<T>().map_err(refused)).collect()
}

impl _Fitted {
    /// χ² of formulation `place` at these unknowns, and half its slopes; none where there is no motion.
    fn squares(&self, py: Python<'_>, place: usize, theta: &[f64], slopes: bool) -> PyResult<Option<(f64, Vec<f64>)>> {
        let found = self.ask(py, |rows| {
            let problem = rows[place].problem.as_mut().ok_or_else(|| "it was not fitted".to_owned())?;
            if theta.len() != problem.unknowns().len() {
                let (found, needed) = (theta.len(), problem.unknowns().len());
                return Err(format!("theta has {found} entries; {needed} are needed"));
            }
            let found = problem.weighed(theta, slopes).ok();
            Ok(found.map(|(values, jacobian)| {
                let by = if slopes { jacobian.tr_mul(&values).iter().copied().collect() } else { Vec::new() };
                (values.norm_squared(), by)
            }))
        })?;
        found.map_err(PyValueError::new_err)
    }

    /// An answer of the fits, which can take long or be waited for long.
    fn ask<T: Send>(&self, py: Python<'_>, ask: impl FnOnce(&mut Vec<Row>) -> T + Send) -> PyResult<T> {
        py.detach(|| self.rows.with(ask))
    }
}

#[stubbed]
impl _Fitted {
    fn __repr__(&self) -> String {
        format!("<deltaq._Fitted, {} films>", self.films.len())
    }

    fn unknowns(&self, py: Python<'_>, place: usize) -> PyResult<Vec<(String, Option<f64>)>> {
        self.ask(py, |rows| {
            let problem = rows[place].problem.as_ref();
            problem.map_or(Vec::new(), |problem| problem.unknowns().iter().map(|u| (u.label(), u.bound)).collect())
        })
    }

    fn chi_squared(&self, py: Python<'_>, place: usize, theta: Floats<'_>) -> PyResult<f64> {
        let theta: Vec<f64> = theta.as_array().iter().copied().collect();
        let found = self.squares(py, place, &theta, false)?;
        Ok(found.map_or(f64::INFINITY, |(value, _)| value))
    }

    fn slopes<'py>(&self, py: Python<'py>, place: usize, theta: Floats<'py>) -> Array<'py> {
        let theta: Vec<f64> = theta.as_array().iter().copied().collect();
        let found = self.squares(py, place, &theta, true)?;
        let slopes = found.map_or(vec![0.0; theta.len()], |(_, by)| by.into_iter().map(|x| 2.0 * x).collect());
        let width = slopes.len();
        array(py, slopes, None, &[width])
    }

    fn rises(&self, py: Python<'_>, place: usize, name: &str, at: Vec<f64>) -> PyResult<Option<Vec<f64>>> {
        self.ask(py, |rows| {
            let (problem, fit) = (rows[place].problem.as_ref()?, rows[place].fit.as_ref().ok()?);
            profile(problem, fit, name, &at)
        })
    }

    fn residuals(&self, py: Python<'_>, place: usize) -> PyResult<Vec<(usize, usize, f64, f64)>> {
        self.ask(py, |rows| {
            let fit = rows[place].fit.as_ref().ok();
            fit.map_or(Vec::new(), |fit| fit.residuals.iter().map(|r| (r.film, r.column, r.t, r.value)).collect())
        })
    }
}

#[stubbed]
impl System {
    /// Tables (name, text) fitted: see `fit`.
    fn _fit(
        &self,
        py: Python<'_>,
        tables: Vec<(String, String)>,
        free: Vec<String>,
        law: Vec<String>,
        sigma: Vec<String>,
        known: Vec<(usize, String, f64)>,
        formulations: Vec<String>,
        starts: usize,
        robust: bool,
        tolerance: f64,
        max_steps: usize,
    ) -> PyResult<_Fitted> {
        let scene = self.scene()?;
        let deviations = Deviations::written(&sigma).map_err(refused)?;
        let film =
            |(name, text): &(String, String)| whole(|| Film::read(&scene, name, text, &deviations))?.map_err(refused);
        let mut films = tables.iter().map(film).collect::<PyResult<Vec<_>>>()?;
        for (film, name, value) in known {
            let count = films.len();
            let film = film.checked_sub(1).and_then(|film| films.get_mut(film));
            let film =
                film.ok_or_else(|| PyValueError::new_err(format!("known: there are {count} films, from 1 on")))?;
            film.known.push((name, value));
        }
        let unknowns: Vec<Unknown> = read(&free)?;
        let law: Vec<Unknown> = read(&law)?;
        let wanted = fit::formulations(&formulations).map_err(|error| errors::unknown(error.to_string()))?;
        let settings = settings(tolerance, max_steps)?;
        let interrupt = Interrupt::default();
        let robust = robust.then_some(ROBUST);
        let work = move || {
            let mut own = films;
            let question = Question { unknowns: &unknowns, law: &law, starts, robust, settings, threads: 0 };
            let rows = fit_formulations(&scene, &mut own, &question, &wanted).map_err(refused)?;
            let answer = typed(&Fitted::of(&scene, &own, &rows))?;
            Ok::<_, PyErr>((rows, answer, own))
        };
        let (rows, answer, films) = background::run(py, &interrupt, work)??;
        let seen = |film: &Film| -> Seen {
            let column = |c: usize| film.rows.iter().map(|row| row[c].unwrap_or(f64::NAN)).collect();
            let columns = film.columns.iter().enumerate().map(|(c, own)| (own.name.clone(), own.sigma, column(c)));
            (film.name.clone(), film.t.clone(), columns.collect())
        };
        Ok(_Fitted { rows: Shared::new(rows), answer, films: films.iter().map(seen).collect() })
    }

    /// The film that would show most, as JSON: see `design`.
    fn _design(
        &self,
        py: Python<'_>,
        aim: Vec<String>,
        over: Vec<String>,
        film: &str,
        films: usize,
        columns: Vec<String>,
        sigma: Vec<String>,
        free: Vec<String>,
        law: Vec<String>,
        starts: usize,
        points: usize,
        tolerance: f64,
        max_steps: usize,
        threads: usize,
    ) -> PyResult<String> {
        let scene = self.scene()?;
        let law: Vec<Unknown> = read(&law)?;
        let deviations = Deviations::written(&sigma).map_err(refused)?;
        let times: Sampling = film.parse().map_err(refused)?;
        let film = whole(|| Film::planned(&scene, &columns, times, &deviations))?.map_err(refused)?;
        let films = vec![film; films.max(1)];
        let (unknowns, over): (Vec<Unknown>, Vec<Range>) = (read(&free)?, read(&over)?);
        let settings = settings(tolerance, max_steps)?;
        let aim = match &aim[..] {
            [name] => Aim::Estimate(name.clone()),
            [truth, rival] => Aim::Tell(arguments::formulation(truth)?, arguments::formulation(rival)?),
            _ => return Err(PyValueError::new_err("two formulations are needed")),
        };
        let work = move || {
            let question = Question { unknowns: &unknowns, law: &law, starts, robust: None, settings, threads: 0 };
            let design = Design::new(&scene, &films, &question, &over, &aim).map_err(refused)?;
            let best = design.best(points, threads).map_err(refused)?;
            typed(&Designed::of(&scene, &films, &design, &best))
        };
        background::run(py, &Interrupt::default(), work)?
    }
}

fn settings(tolerance: f64, max_steps: usize) -> PyResult<Settings> {
    let settings = Settings { tolerance, max_steps, ..Settings::default() };
    settings.check().map_err(errors::solve)?;
    Ok(settings)
}
