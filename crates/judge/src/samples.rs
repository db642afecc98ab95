//! A motion as a table: times, coordinates, perhaps rates.

use mechanics::System;
use scene::{Table, TableError};

use crate::JudgeError;

/// Samples of one motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Times, growing.
    pub t: Vec<f64>,
    /// `q` at each time.
    pub q: Vec<Vec<f64>>,
    /// `v` at each time, where the table has rates.
    pub v: Option<Vec<Vec<f64>>>,
}

impl Samples {
    /// Reads a table with the columns `t`, one of each coordinate, and of each rate, `x'`, or of none. Other
    /// columns are not looked at. `file` stands for the table in errors.
    ///
    /// # Errors
    /// [`JudgeError`] where a column is missing or a cell is not a number, with its place.
    pub fn read(system: &System, file: &str, text: &str) -> Result<Samples, JudgeError> {
        let table = Table::read(file, text)?;
        let time = table.column("t")?;
        let names = || system.coordinates.iter().map(|c| &c.name);
        let places = names().map(|name| table.column(name)).collect::<Result<Vec<_>, _>>()?;
        let rates: Vec<Option<usize>> = names().map(|name| table.column(&format!("{name}'")).ok()).collect();
        let given = rates.iter().flatten().count();
        if let (1.., Some(i)) = (given, rates.iter().position(Option::is_none)) {
            let missing = format!("{}'", system.coordinates[i].name);
            let place = table.place(0, places[i]);
            return Err(JudgeError::SomeRates { place, given, of: rates.len(), missing });
        }
        let rates: Option<Vec<usize>> = rates.into_iter().collect();
        let rows = |places: &[usize]| -> Result<Vec<Vec<f64>>, TableError> {
            let row = |row| places.iter().map(|&place| table.number(row, place)).collect();
            table.rows().map(row).collect()
        };
        let v = rates.map(|rates| rows(&rates)).transpose()?;
        Ok(Samples { t: table.times(time)?, q: rows(&places)?, v })
    }

    /// Mean distance of two times, in `T`.
    pub fn step(&self) -> f64 {
        (self.t[self.t.len() - 1] - self.t[0]) / (self.t.len() - 1) as f64
    }
}
