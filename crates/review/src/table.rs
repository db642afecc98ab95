//! A table of states with accelerations.

use mechanics::System;
use scene::{Table, TableError};
use symbolic::limits::POINTS;

use crate::ReviewError;
use crate::review::Row;

/// Some rows, spread over a table with columns `x`, `x'` and `x''` of each coordinate, and of `t`, or 0.
///
/// # Errors
/// [`ReviewError::Table`] with the place.
pub(crate) fn rows(system: &System, file: &str, text: &str) -> Result<Vec<Row>, ReviewError> {
    let table = Table::read(file, text)?;
    let time = table.column("t").ok();
    let places = |primes: &str| -> Result<Vec<usize>, TableError> {
        system.coordinates.iter().map(|c| table.column(&format!("{}{primes}", c.name))).collect()
    };
    let (q, v, a) = (places("")?, places("'")?, places("''")?);
    let rows = table.rows();
    let step = rows.len().div_ceil(POINTS).max(1);
    let row = |row: usize| -> Result<Row, TableError> {
        let of =
            |places: &[usize]| places.iter().map(|&place| table.number(row, place)).collect::<Result<Vec<f64>, _>>();
        let t = time.map_or(Ok(0.0), |time| table.number(row, time))?;
        Ok(Row { t, q: of(&q)?, v: of(&v)?, a: of(&a)? })
    };
    let rows: Vec<Row> = rows.step_by(step).map(row).collect::<Result<_, _>>()?;
    if rows.len() < 2 {
        let what = format!("{} rows are too few: at least 2 are needed", rows.len());
        return Err(ReviewError::Unreadable { place: file.into(), what });
    }
    Ok(rows)
}
