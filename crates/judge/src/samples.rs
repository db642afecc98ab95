//! A motion as a table: times, coordinates, perhaps rates.
//!
//! The table is read by hand: cells are numbers, and names of columns need no quotes, so that nothing of a
//! crate for CSV would be used but the comma.

use mechanics::System;

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
    /// columns are not looked at.
    ///
    /// # Errors
    /// [`JudgeError`] where a column is missing or a cell is no number, with its place.
    pub fn read(system: &System, text: &str) -> Result<Samples, JudgeError> {
        let cells =
            |line: &str| -> Vec<String> { line.split(',').map(|c| c.trim().trim_matches('"').into()).collect() };
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let header = lines.next().map(|(_, line)| cells(line.trim_start_matches('\u{feff}'))).unwrap_or_default();
        let column = |name: &str| header.iter().position(|h| h == name);
        let needed = |name: &str| column(name).ok_or_else(|| JudgeError::ColumnMissing(name.into()));
        let time = needed("t")?;
        let names = || system.coordinates.iter().map(|c| &c.name);
        let places = names().map(|name| needed(name)).collect::<Result<Vec<_>, _>>()?;
        let rates: Vec<Option<usize>> = names().map(|name| column(&format!("{name}'"))).collect();
        let given = rates.iter().flatten().count();
        if let (1.., Some(i)) = (given, rates.iter().position(Option::is_none)) {
            let missing = format!("{}'", system.coordinates[i].name);
            return Err(JudgeError::SomeRates { given, of: rates.len(), missing });
        }
        let rates: Option<Vec<usize>> = rates.into_iter().collect();
        let mut samples = Samples { t: Vec::new(), q: Vec::new(), v: rates.is_some().then(Vec::new) };
        for (index, line) in lines {
            let (line, row) = (index + 1, cells(line));
            if row.len() != header.len() {
                return Err(JudgeError::Ragged { line, found: row.len(), expected: header.len() });
            }
            let number = |&i: &usize| {
                let wrong = || JudgeError::NotANumber { line, column: header[i].clone(), text: row[i].clone() };
                row[i].parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong)
            };
            let t = number(&time)?;
            if let Some(&before) = samples.t.last().filter(|&&before| before >= t) {
                return Err(JudgeError::TimesNotGrowing { line, t, before });
            }
            samples.t.push(t);
            samples.q.push(places.iter().map(number).collect::<Result<_, _>>()?);
            if let (Some(v), Some(rates)) = (&mut samples.v, &rates) {
                v.push(rates.iter().map(number).collect::<Result<_, _>>()?);
            }
        }
        Ok(samples)
    }

    /// Mean distance of two times, in `T`.
    pub fn step(&self) -> f64 {
        (self.t[self.t.len() - 1] - self.t[0]) / (self.t.len() - 1) as f64
    }
}
