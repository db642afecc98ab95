//! A film as a table: times, and observed columns.

use scene::{Scene, Table};
use schemars::JsonSchema;
use serde::Serialize;
use symbolic::Expr;

use crate::FitError;
use crate::quantity::{split, unit_of};

/// A column of a film.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Column {
    /// Its name: that of an entry of `[film]`, or an expression in `(q, v, t)` and parameters.
    pub name: String,
    /// Standard deviation of its errors, positive.
    pub sigma: f64,
    /// Whether that is estimated from what the best formulation leaves: then it is a first guess here.
    pub estimated: bool,
}

/// A film of one motion of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Film {
    /// Its name for messages.
    pub name: String,
    /// Times, growing, on the clock of the scene.
    pub t: Vec<f64>,
    /// The columns.
    pub columns: Vec<Column>,
    /// One row per time, one value per column; `None` for a gap.
    pub rows: Vec<Vec<Option<f64>>>,
    /// Lines of the file, the header being the first; one per time.
    pub lines: Vec<usize>,
    /// Numbers of the scene with another, known value in this film: `("psi'", 6.0)`.
    pub known: Vec<(String, f64)>,
    /// Columns that are added to the table of a motion and that no film shows.
    pub left_out: Vec<String>,
}

/// Standard deviations of columns: by name, or of all that have no other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviations {
    /// Of columns by name.
    pub by_name: Vec<(String, f64)>,
    /// Of the others.
    pub others: Option<f64>,
    /// Those that are written with a unit, `1mm`, by the name of a column or of all others.
    pub with_units: Vec<(Option<String>, String)>,
    /// Whether columns that have none are estimated.
    pub free: bool,
}

/// What stands for a standard deviation that is estimated.
const FREE: &str = "free";

impl Deviations {
    /// From `0.5mm` of all columns that have no other, `x=0.5mm` of one; `free` for those to be estimated.
    ///
    /// # Errors
    /// [`FitError::Quantity`].
    pub fn written(list: &[String]) -> Result<Deviations, FitError> {
        let mut deviations = Deviations::default();
        for text in list {
            let (name, sigma) =
                text.split_once('=').map_or((None, &text[..]), |(name, sigma)| (Some(name.trim()), sigma));
            if name.is_none() && sigma.trim() == FREE {
                deviations.free = true;
                continue;
            }
            match (split(sigma)?, name) {
                ((_, Some(_)), _) => deviations.with_units.push((name.map(str::to_owned), sigma.trim().into())),
                ((value, None), Some(name)) => deviations.by_name.push((name.into(), value)),
                ((value, None), None) => deviations.others = Some(value),
            }
        }
        Ok(deviations)
    }

    /// That of a column, in the units of the scene; none where it is to be estimated.
    fn of(&self, scene: &Scene, name: &str, written: Option<f64>) -> Result<Option<f64>, FitError> {
        let with_unit = |of: Option<&str>| -> Result<Option<f64>, FitError> {
            let Some((_, text)) = self.with_units.iter().find(|(known, _)| known.as_deref() == of) else {
                return Ok(None);
            };
            let (value, unit) = split(text)?;
            Ok(Some(value * unit.map_or(Ok(1.0), |unit| unit_of(scene, name, unit))?))
        };
        let named = self.by_name.iter().find(|(known, _)| known == name).map(|(_, sigma)| *sigma);
        let named = named.map_or_else(|| with_unit(Some(name)), |sigma| Ok(Some(sigma)))?.or(written).or(self.others);
        let found = named.map_or_else(|| with_unit(None), |sigma| Ok(Some(sigma)))?;
        match found {
            None if self.free => Ok(None),
            None => Err(FitError::NoDeviation(name.into())),
            Some(found) => positive(name, found).map(Some),
        }
    }
}

/// A standard deviation that makes sense: squares of residuals by it are finite.
pub(crate) fn positive(of: &str, found: f64) -> Result<f64, FitError> {
    match (1e-100..=1e100).contains(&found) {
        true => Ok(found),
        false => Err(FitError::Deviation { of: of.into(), found }),
    }
}

impl Film {
    /// A thousandth of the least standard deviation, over the size of its column.
    pub(crate) fn finest(&self) -> f64 {
        let size = |c: usize| self.rows.iter().filter_map(|row| row[c]).fold(0.0, |a: f64, x| a.max(x.abs()));
        let each = self.columns.iter().enumerate().map(|(c, column)| 1e-3 * column.sigma / size(c));
        each.fold(f64::INFINITY, f64::min)
    }

    /// Reads a table, CSV, with a column `t`. Every other column has the name of an entry of `[film]` or of
    /// `[observables]`, or is an expression of coordinates, velocities and parameters: `x`, `x'`,
    /// `a*theta`. A unit may follow: `x [mm]`. Empty cells and `nan` are gaps; a row of gaps only is left
    /// out, and so are multipliers, errors, derivatives and invariants in the table of a motion.
    ///
    /// # Errors
    /// [`FitError`] with its place.
    pub fn read(scene: &Scene, name: &str, text: &str, deviations: &Deviations) -> Result<Film, FitError> {
        let table = Table::read(name, text)?;
        let at = |i: usize, error| FitError::At { place: table.place(0, i), error: Box::new(error) };
        let head = |i: usize| head(scene, &table.columns[i]).map_err(|error| at(i, error));
        let heads = (0..table.columns.len()).map(head).collect::<Result<Vec<_>, _>>()?;
        let time = heads.iter().position(|(name, _)| *name == "t");
        let time = time.map_or_else(|| table.column("t"), Ok)?;
        let is_seen = |&i: &usize| expression(scene, heads[i].0).is_ok() || !is_added(scene, heads[i].0);
        let others = (0..heads.len()).filter(|&i| i != time);
        let (seen, added): (Vec<usize>, Vec<usize>) = others.partition(is_seen);
        let left_out = added.iter().map(|&i| heads[i].0.to_owned()).collect();
        let column = |&i: &usize| column(scene, heads[i].0, deviations).map_err(|error| at(i, error));
        let columns = seen.iter().map(column).collect::<Result<Vec<_>, _>>()?;
        if columns.is_empty() {
            return Err(at(0, FitError::NoColumn));
        }
        let times = table.times(time)?;
        let mut film = Film { name: name.into(), columns, left_out, ..Film::default() };
        for (row, t) in table.rows().zip(times) {
            let t = t * heads[time].1;
            if t < scene.start.t {
                let error = FitError::BeforeTheStart { t, start: scene.start.t }.into();
                return Err(FitError::At { place: table.place(row, time), error });
            }
            let value = |&i: &usize| Ok(table.number_or_gap(row, i)?.map(|x| x * heads[i].1));
            let values = seen.iter().map(value).collect::<Result<Vec<_>, FitError>>()?;
            if values.iter().any(Option::is_some) {
                film.t.push(t);
                film.rows.push(values);
                film.lines.push(table.lines[row]);
            }
        }
        film.guess_deviations();
        Ok(film)
    }

    /// First guesses of standard deviations that are estimated: by third differences of neighbours, of which
    /// a smooth motion leaves little.
    fn guess_deviations(&mut self) {
        for (c, column) in self.columns.iter_mut().enumerate().filter(|(_, column)| column.estimated) {
            let seen: Vec<f64> = self.rows.iter().filter_map(|row| row[c]).collect();
            let third = |w: &[f64]| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).powi(2) / 20.0;
            let squares: Vec<f64> = seen.windows(4).map(third).collect();
            let size = seen.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
            let least = 1e-9 * if size > 0.0 { size } else { 1.0 };
            let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
            column.sigma = if squares.is_empty() { 1e-2 * least / 1e-9 } else { mean.sqrt().max(least) };
        }
    }

    /// Times of a film that is this many times as long, further ones at the mean distance; no rows.
    pub(crate) fn lengthened(&self, longer: f64) -> Film {
        let (first, last) = (self.t[0], self.t[self.t.len() - 1]);
        let step = (last - first) / (self.t.len() - 1).max(1) as f64;
        let more = ((longer - 1.0) * (last - first) / step).round().max(0.0) as usize;
        let kept = self.t.iter().copied().filter(|t| longer >= 1.0 || *t <= first + longer * (last - first));
        let t: Vec<f64> = kept.chain((1..=more).map(|k| last + k as f64 * step)).collect();
        let lines = (2..).take(t.len()).collect();
        Film { t, lines, rows: Vec::new(), ..self.clone() }
    }

    /// Cells that are not empty.
    pub fn count(&self) -> usize {
        self.rows.iter().flatten().flatten().count()
    }

    /// Cells that are empty, of rows that are not.
    pub fn gaps(&self) -> usize {
        self.rows.iter().flatten().filter(|cell| cell.is_none()).count()
    }
}

/// The name and the unit of a cell of the header.
fn head<'t>(scene: &Scene, cell: &'t str) -> Result<(&'t str, f64), FitError> {
    match cell.strip_suffix(']').and_then(|cell| cell.rsplit_once('[')) {
        Some((name, of)) if named(scene, cell).is_none() => Ok((name.trim(), unit_of(scene, name.trim(), of.trim())?)),
        _ => Ok((cell, 1.0)),
    }
}

/// Whether `deltaq solve` or the Python module adds such a column to a motion: errors, multipliers,
/// derivatives, what should stay constant.
fn is_added(scene: &Scene, name: &str) -> bool {
    let begins = |with: &&str| name.starts_with(with);
    ["error ", "lambda_", "mu_", "p_", "P_", "momentum "].iter().any(begins)
        || name.starts_with('d') && name.contains("/d")
        || name == "energy"
        || scene.system.watched.iter().any(|watched| watched.is_constant() && watched.name == name)
}

pub(crate) fn column(scene: &Scene, name: &str, deviations: &Deviations) -> Result<Column, FitError> {
    expression(scene, name)?;
    let written = scene.film.iter().find(|filmed| filmed.name == name).and_then(|filmed| filmed.sigma);
    let sigma = deviations.of(scene, name, written)?;
    Ok(Column { name: name.into(), sigma: sigma.unwrap_or(1.0), estimated: sigma.is_none() })
}

/// What has this name in `[film]` or among what is watched.
fn named(scene: &Scene, name: &str) -> Option<Expr> {
    let filmed = scene.film.iter().map(|filmed| (&filmed.name, filmed.expression));
    let watched = scene.system.watched.iter().map(|watched| (&watched.name, watched.expression));
    filmed.chain(watched).find(|(own, _)| *own == name).map(|(_, expression)| expression)
}

/// What a column shows, in the graph of this reading of the scene.
pub(crate) fn expression(scene: &Scene, name: &str) -> Result<Expr, FitError> {
    let refused = |error: symbolic::ParseError| FitError::Column { column: name.into(), reason: error.to_string() };
    named(scene, name).map_or_else(|| scene.system.expression(name).map_err(refused), Ok)
}
