//! Columns of a motion's table: one per coordinate, per velocity and per multiplier.

use std::collections::HashSet;

use anyhow::{Result, bail};
use equations::{Equations, Outputs};
use indexmap::IndexMap;
use motion::{ErrorEstimate, Sensitivities};
use scene::{Scene, table_cell};
use schemars::JsonSchema;
use serde::Serialize;

/// Most numbers of an answer that are in memory at once: with their JSON they fit into 2 GB.
pub const MOST_NUMBERS: usize = 12_000_000;

/// Names of the columns.
pub struct Columns {
    coordinates: Vec<String>,
    multipliers: Vec<String>,
}

impl Columns {
    /// Those of a scene in one formulation.
    pub fn of(scene: &Scene, equations: &Equations) -> Columns {
        Columns {
            coordinates: scene.system.coordinates.iter().map(|c| c.name.clone()).collect(),
            multipliers: equations.multipliers.iter().map(|m| m.name.clone()).collect(),
        }
    }

    /// In the order of [`row`], the time first.
    pub fn names(&self) -> Vec<String> {
        let velocities = self.coordinates.iter().map(|name| format!("{name}'"));
        let time = std::iter::once("t".to_string());
        time.chain(self.coordinates.iter().cloned()).chain(velocities).chain(self.multipliers.iter().cloned()).collect()
    }

    /// Those of [`error_row`].
    pub fn error_names(&self) -> Vec<String> {
        self.names()[1..].iter().map(|name| format!("error {name}")).collect()
    }

    /// The columns: one list of numbers per name.
    pub fn table(&self, rows: &[Outputs]) -> Table<Vec<f64>> {
        self.lists(rows, [|r| &r.coordinates, |r| &r.velocities, |r| &r.multipliers])
    }

    /// The error estimates up to each time, in the same way.
    pub fn errors(&self, rows: &[ErrorEstimate]) -> Table<Vec<f64>> {
        self.lists(rows, [|r| &r.coordinates, |r| &r.velocities, |r| &r.multipliers])
    }

    fn lists<R>(&self, rows: &[R], [q, v, multipliers]: [fn(&R) -> &[f64]; 3]) -> Table<Vec<f64>> {
        Table {
            coordinates: named_columns(&self.coordinates, rows, q),
            velocities: named_columns(&self.coordinates, rows, v),
            multipliers: named_columns(&self.multipliers, rows, multipliers),
        }
    }

    /// The error estimates of one whole motion: one number per name.
    pub fn whole_errors(&self, estimate: &ErrorEstimate) -> Table<f64> {
        Table {
            coordinates: named(&self.coordinates, &estimate.coordinates),
            velocities: named(&self.coordinates, &estimate.velocities),
            multipliers: named(&self.multipliers, &estimate.multipliers),
        }
    }

    /// Those of [`derivative_row`]: `dx/dm`, `error dx/dm`.
    pub fn derivative_names(&self, derived: &Sensitivities) -> Vec<String> {
        let own = &self.names()[1..];
        let by = |name: &String| {
            let derivatives = own.iter().map(move |own| format!("d{own}/d{name}"));
            derivatives.clone().chain(derivatives.map(|name| format!("error {name}"))).collect::<Vec<_>>()
        };
        derived.names.iter().flat_map(by).collect()
    }

    /// The derivatives by each number and their error estimates, by its name.
    pub fn derivatives(&self, derived: &Sensitivities) -> IndexMap<String, Derivatives> {
        let of =
            |rows: &[Vec<Outputs>], k: usize| self.table(&rows.iter().map(|row| row[k].clone()).collect::<Vec<_>>());
        let both = |k: usize| Derivatives { of: of(&derived.derivatives, k), error_estimates: of(&derived.errors, k) };
        derived.names.iter().enumerate().map(|(k, name)| (name.clone(), both(k))).collect()
    }
}

/// Numbers by name.
pub type Numbers = IndexMap<String, f64>;

/// Something for each column of a motion: a list, a number a time, or one number.
#[derive(Serialize, JsonSchema)]
pub struct Table<T> {
    /// By coordinate.
    coordinates: IndexMap<String, T>,
    /// Rates of coordinates.
    velocities: IndexMap<String, T>,
    /// Multipliers or costates of the formulation.
    multipliers: IndexMap<String, T>,
}

/// Derivatives of all columns by a number.
#[derive(Serialize, JsonSchema)]
pub struct Derivatives {
    #[serde(flatten)]
    of: Table<Vec<f64>>,
    /// What the two runs differ by up to each time.
    error_estimates: Table<Vec<f64>>,
}

/// The derivatives at one time by each number, and their error estimates, each after a comma.
pub fn derivative_row(derived: &Sensitivities, i: usize) -> String {
    let all = |outputs: &Outputs| [&outputs.coordinates[..], &outputs.velocities, &outputs.multipliers].concat();
    let pairs = derived.derivatives[i].iter().zip(&derived.errors[i]);
    pairs.map(|(derivatives, errors)| format!(",{},{}", print(&all(derivatives)), print(&all(errors)))).collect()
}

/// One list of numbers per name.
pub fn named_columns<R>(names: &[String], rows: &[R], row: fn(&R) -> &[f64]) -> IndexMap<String, Vec<f64>> {
    let column = |i: usize| rows.iter().map(|r| row(r)[i]).collect();
    names.iter().enumerate().map(|(i, name)| (name.clone(), column(i))).collect()
}

/// One number per name.
pub fn named(names: impl IntoIterator<Item = impl ToString>, numbers: &[f64]) -> Numbers {
    names.into_iter().map(|name| name.to_string()).zip(numbers.iter().copied()).collect()
}

/// The error estimates up to one time, between commas.
pub fn error_row(estimate: &ErrorEstimate) -> String {
    print(&[&estimate.coordinates[..], &estimate.velocities, &estimate.multipliers].concat())
}

/// The numbers at one time, between commas.
pub fn row(t: f64, now: &Outputs) -> String {
    print(&[&[t], &now.coordinates[..], &now.velocities, &now.multipliers].concat())
}

/// Numbers with all their digits, between commas.
pub fn print(numbers: &[f64]) -> String {
    numbers.iter().map(|x| format!("{x:?}")).collect::<Vec<_>>().join(",")
}

/// The first line of a table.
///
/// # Errors
/// Two columns of one name: nobody could read the table.
pub fn header(names: &[String]) -> Result<String> {
    let mut known = HashSet::new();
    if let Some(twice) = names.iter().find(|name| !known.insert(*name)) {
        bail!("two columns of the table are called `{twice}`: give one of them another name in the scene");
    }
    Ok(names.iter().map(|name| table_cell(name)).collect::<Vec<_>>().join(",") + "\n")
}

/// A cause as a cell of a table: in one line and quotation marks; empty without one.
pub fn quoted(cause: &str) -> String {
    if cause.is_empty() { String::new() } else { format!("\"{}\"", cause.replace('"', "\"\"").replace('\n', " ")) }
}
