//! One film and the motion that it shows: residuals with their derivatives.

use deltaq::{Choice, Model, Settings};
use scene::Scene;
use symbolic::Symbol;

use crate::film::expression;
use crate::observation::Observation;
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
}

/// Where a number comes from.
#[derive(Clone, Copy)]
pub(crate) enum Place {
    Unknown(usize),
    Known(f64),
}

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
        let mut places = Vec::new();
        for (i, unknown) in unknowns.iter().enumerate() {
            let applies = unknown.film.map_or(!own(&unknown.name), |film| film == number);
            if applies {
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
        Ok(Part { film: film.clone(), model, places, parameters, seen })
    }

    /// The numbers of the model.
    pub(crate) fn row(&self, theta: &[f64]) -> Vec<f64> {
        let value = |place: &Place| match *place {
            Place::Unknown(i) => theta[i],
            Place::Known(x) => x,
        };
        self.places.iter().map(value).collect()
    }

    /// Calls `with` for every cell that is not empty: its row and column, `r`, and by which unknowns it
    /// moves.
    pub(crate) fn evaluate(&mut self, theta: &[f64], derivatives: bool, with: &mut Reader) -> Result<(), String> {
        let row = self.row(theta);
        let read = if derivatives { self.model.derivatives(&row) } else { self.model.outputs(&row) };
        if let Some(reason) = read.ended {
            return Err(reason);
        }
        let parameters: Vec<f64> = self.parameters.iter().map(|&i| row[i]).collect();
        let n = read.outputs.first().map_or(0, |outputs| outputs.coordinates.len());
        let mut by = Vec::new();
        for (k, outputs) in read.outputs.iter().enumerate() {
            for (c, (value, slopes)) in self.seen.at(self.film.t[k], outputs, &parameters).into_iter().enumerate() {
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
                with((k, c), (value - seen) / sigma, &by);
            }
        }
        Ok(())
    }
}
