//! Tables over time, CSV: motions that programs made, films.
//!
//! Read by hand: cells are numbers, and names of columns need no quotes, so that nothing of a crate for CSV
//! would be used but the comma.

/// A table over time: a header, and rows of as many cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The line of each row, the header being the first.
    pub lines: Vec<usize>,
    rows: Vec<Vec<String>>,
}

/// A table that cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[expect(missing_docs, reason = "the messages say what fields are")]
pub enum TableError {
    /// There is no such column.
    #[error("there is no column `{0}`")]
    ColumnMissing(String),
    /// A cell is no finite number.
    #[error("line {line}, column `{column}`: `{text}` is no finite number")]
    NotANumber {
        /// Line of the file, the header being the first.
        line: usize,
        column: String,
        text: String,
    },
    /// A line has another number of cells than the header.
    #[error("line {line} has {found} cells, and the header has {expected}")]
    Ragged { line: usize, found: usize, expected: usize },
    /// Times do not grow.
    #[error("line {line}: t = {t} is not later than t = {before} of the row before")]
    TimesNotGrowing { line: usize, t: f64, before: f64 },
}

/// Cells that show nothing.
const EMPTY: [&str; 3] = ["", "nan", "na"];

impl Table {
    /// Reads a table; empty lines do not count.
    ///
    /// # Errors
    /// [`TableError::Ragged`].
    pub fn read(text: &str) -> Result<Table, TableError> {
        let cells =
            |line: &str| -> Vec<String> { line.split(',').map(|c| c.trim().trim_matches('"').into()).collect() };
        let mut all = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let columns = all.next().map(|(_, line)| cells(line.trim_start_matches('\u{feff}'))).unwrap_or_default();
        let (mut lines, mut rows) = (Vec::new(), Vec::new());
        for (index, line) in all {
            let (line, row) = (index + 1, cells(line));
            if row.len() != columns.len() {
                return Err(TableError::Ragged { line, found: row.len(), expected: columns.len() });
            }
            lines.push(line);
            rows.push(row);
        }
        Ok(Table { columns, lines, rows })
    }

    /// The place of a column.
    ///
    /// # Errors
    /// [`TableError::ColumnMissing`].
    pub fn column(&self, name: &str) -> Result<usize, TableError> {
        let place = self.columns.iter().position(|own| own == name);
        place.ok_or_else(|| TableError::ColumnMissing(name.into()))
    }

    /// A cell as a finite number.
    ///
    /// # Errors
    /// [`TableError::NotANumber`].
    pub fn number(&self, row: usize, column: usize) -> Result<f64, TableError> {
        let text = &self.rows[row][column];
        let (line, name) = (self.lines[row], &self.columns[column]);
        let wrong = || TableError::NotANumber { line, column: name.clone(), text: text.clone() };
        text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(wrong)
    }

    /// The same; none where the cell is empty, `nan` or `na`.
    ///
    /// # Errors
    /// As [`Table::number`].
    pub fn number_or_gap(&self, row: usize, column: usize) -> Result<Option<f64>, TableError> {
        let is_gap = EMPTY.contains(&self.rows[row][column].to_lowercase().as_str());
        if is_gap { Ok(None) } else { self.number(row, column).map(Some) }
    }

    /// A column of times, growing.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn times(&self, column: usize) -> Result<Vec<f64>, TableError> {
        let mut times: Vec<f64> = Vec::new();
        for (row, &line) in self.lines.iter().enumerate() {
            let t = self.number(row, column)?;
            if let Some(&before) = times.last().filter(|&&before| before >= t) {
                return Err(TableError::TimesNotGrowing { line, t, before });
            }
            times.push(t);
        }
        Ok(times)
    }
}
