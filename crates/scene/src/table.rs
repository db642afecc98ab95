//! Tables, CSV by RFC 4180: films, motions that programs made, members of ensembles, sweeps.
//!
//! Read by hand, and by nothing else in the project: a cell is looked up in the text where it is asked for,
//! so that a million rows take little more than their text, and every fault has its line and column.

use std::borrow::Cow;
use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use symbolic::excerpt;

/// Bytes of the largest table that is read.
pub const TABLE_SIZE: usize = 400_000_000;
/// Most rows of a table, and members of an ensemble.
pub const MOST_ROWS: usize = 1_000_000;
const MOST_COLUMNS: usize = 10_000;
const LONGEST_NAME: usize = 1_000;

/// A table: a header, which is row 0, and rows of as many cells, between commas. Cells may stand in quotation
/// marks, those in them doubled; blanks around cells, empty lines and lines that begin with `#` do not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Table<'t> {
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The line of each row, from 1, the header first.
    pub lines: Vec<usize>,
    file: &'t str,
    text: &'t str,
    /// Where cells begin, row by row.
    cells: Vec<u32>,
}

/// A table that cannot be read: the place, `FILE:LINE:COLUMN`, in lines and characters from 1, and why.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {fault}")]
#[expect(missing_docs, reason = "the sentence above says what fields are")]
pub struct TableError {
    pub place: String,
    pub fault: TableFault,
}

/// Why a table cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the messages say what variants and fields are")]
pub enum TableFault {
    #[error("cannot be read: {0}")]
    Unreadable(String),
    #[error("the table has more than {limit} {of}, the most that is read")]
    TooLarge { limit: usize, of: &'static str },
    #[error("this is not text in UTF-8")]
    NoText,
    #[error("cells are separated by {0}; they must be separated by commas")]
    Separator(&'static str),
    #[error("the quotation mark is not closed")]
    Unclosed,
    #[error("a quotation mark within a cell: the whole cell has to stand in quotation marks, those in it doubled")]
    Quote,
    #[error("the column `{column}` is there already, at {first}")]
    Twice { column: String, first: String },
    #[error("{found} cells, and the header has {expected}")]
    Ragged { found: usize, expected: usize },
    #[error("there is no column `{0}`")]
    ColumnMissing(String),
    #[error("column `{column}`: `{text}` is not a finite number")]
    NotANumber { column: String, text: String },
    #[error("column `{0}`: the cell is empty, and a number is needed")]
    Gap(String),
    #[error("t = {t} is not later than t = {before} of the row before")]
    TimesNotGrowing { t: f64, before: f64 },
}

/// The text of a file with a table; beyond [`TABLE_SIZE`] one byte more, which [`Table::read`] refuses.
///
/// # Errors
/// [`TableFault::Unreadable`] and [`TableFault::NoText`].
pub fn table_text(path: &Path) -> Result<String, TableError> {
    let file = path.display().to_string();
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|input| input.take(TABLE_SIZE as u64 + 1).read_to_end(&mut bytes));
    read.map_err(|error| TableError { place: file.clone(), fault: TableFault::Unreadable(error.to_string()) })?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = String::from_utf8_lossy(&error.as_bytes()[..error.utf8_error().valid_up_to()]);
        TableError { place: place(&file, &valid, valid.len()), fault: TableFault::NoText }
    })
}

/// The place of a byte.
fn place(file: &str, text: &str, at: usize) -> String {
    let before = &text[..at];
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    let column = before[line..].trim_start_matches('\u{feff}').chars().count() + 1;
    format!("{file}:{}:{column}", before.matches('\n').count() + 1)
}

/// The beginning of a text, for messages.
fn short(text: &str) -> String {
    let [shown, _] = excerpt(text, 1, 1);
    shown
}

/// Where the cell that begins at `from` ends: a comma, an end of line or of the text; or a fault in it.
fn end(text: &[u8], from: usize) -> Result<usize, (usize, TableFault)> {
    let behind_blanks = |at: usize| at + text[at..].iter().take_while(|b| matches!(b, b' ' | b'\t' | b'\r')).count();
    let next = |at: usize, marks: &[u8]| text[at..].iter().position(|b| marks.contains(b)).map(|found| at + found);
    let first = behind_blanks(from);
    if text.get(first) != Some(&b'"') {
        let end = next(first, b",\n\"").unwrap_or(text.len());
        return if text.get(end) == Some(&b'"') { Err((end, TableFault::Quote)) } else { Ok(end) };
    }
    let mut at = first + 1;
    loop {
        let mark = next(at, b"\"").ok_or((first, TableFault::Unclosed))?;
        if text.get(mark + 1) != Some(&b'"') {
            let end = behind_blanks(mark + 1);
            let ends = text.get(end).is_none_or(|byte| matches!(byte, b',' | b'\n'));
            return if ends { Ok(end) } else { Err((end, TableFault::Quote)) };
        }
        at = mark + 2;
    }
}

impl<'t> Table<'t> {
    /// Reads a table; `file` stands for it in errors.
    ///
    /// # Errors
    /// [`TableError`] for what is not a table, or too large a one.
    pub fn read(file: &'t str, text: &'t str) -> Result<Table<'t>, TableError> {
        let too_large = |limit, of| TableFault::TooLarge { limit, of };
        let refused = |at, fault| Err(TableError { place: place(file, text, at), fault });
        if text.len() > TABLE_SIZE {
            return refused(0, too_large(TABLE_SIZE, "bytes"));
        }
        // as numbers they take as much memory as their text
        let most_cells = TABLE_SIZE / size_of::<f64>();
        let mut table = Table { columns: Vec::new(), lines: Vec::new(), file, text, cells: Vec::new() };
        let (mut at, mut line, mut width) = (text.len() - text.trim_start_matches('\u{feff}').len(), 1, MOST_COLUMNS);
        while at < text.len() {
            let (begin, all) = (at, text[at..].split_inclusive('\n').next().unwrap_or_default());
            if all.trim().is_empty() || all.trim_start().starts_with('#') {
                (at, line) = (at + all.len(), line + 1);
                continue;
            }
            let (mut found, mut cell, mut goes_on) = (0, at, true);
            while goes_on && found <= width {
                (cell, found) = (at, found + 1);
                table.cells.push(at as u32);
                match end(text.as_bytes(), at) {
                    Ok(end) => (at, goes_on) = (end + 1, text[end..].starts_with(',')),
                    Err((at, fault)) => return refused(at, fault),
                }
            }
            match table.lines.len() {
                0 if found > width => return refused(cell, too_large(width, "columns")),
                0 => (width, table.columns) = (found, table.header(found)?),
                _ if found != width => return refused(cell, TableFault::Ragged { found, expected: width }),
                rows if rows > MOST_ROWS => return refused(cell, too_large(MOST_ROWS, "rows")),
                _ if table.cells.len() > most_cells => return refused(cell, too_large(most_cells, "cells")),
                _ => {}
            }
            table.lines.push(line);
            line += text[begin..text.len().min(at)].matches('\n').count();
        }
        Ok(table)
    }

    /// The names in the header.
    fn header(&self, width: usize) -> Result<Vec<String>, TableError> {
        let columns: Vec<String> = (0..width).map(|i| self.text(0, i).into_owned()).collect();
        let mark = [(';', "semicolons"), ('\t', "tabs")].into_iter().find(|(mark, _)| columns[0].contains(*mark));
        if let (1, Some((_, name))) = (width, mark) {
            return self.refused(0, 0, TableFault::Separator(name));
        }
        if let Some(i) = columns.iter().position(|name| name.len() > LONGEST_NAME) {
            return self.refused(0, i, TableFault::TooLarge { limit: LONGEST_NAME, of: "bytes in a name" });
        }
        let mut known = HashMap::new();
        for (i, name) in columns.iter().enumerate().filter(|(_, name)| !name.is_empty()) {
            if let Some(first) = known.insert(name, i) {
                return self.refused(0, i, TableFault::Twice { column: short(name), first: self.place(0, first) });
            }
        }
        Ok(columns)
    }

    fn refused<T>(&self, row: usize, column: usize, fault: TableFault) -> Result<T, TableError> {
        Err(TableError { place: self.place(row, column), fault })
    }

    /// `FILE:LINE:COLUMN` of a cell.
    pub fn place(&self, row: usize, column: usize) -> String {
        let from = self.cells.get(row * self.columns.len() + column).map_or(0, |from| *from as usize);
        let behind = &self.text[from..];
        place(self.file, self.text, self.text.len() - behind.trim_start_matches([' ', '\t']).len())
    }

    /// The place of a column among the others.
    ///
    /// # Errors
    /// [`TableFault::ColumnMissing`].
    pub fn column(&self, name: &str) -> Result<usize, TableError> {
        let place = self.columns.iter().position(|own| own == name);
        place.map_or_else(|| self.refused(0, 0, TableFault::ColumnMissing(name.into())), Ok)
    }

    /// The rows below the header.
    pub fn rows(&self) -> std::ops::Range<usize> {
        1..self.lines.len().max(1)
    }

    /// What a cell says, without blanks around it or without its quotation marks.
    pub fn text(&self, row: usize, column: usize) -> Cow<'t, str> {
        let from = self.cells[row * self.columns.len() + column] as usize;
        let cell = self.text[from..end(self.text.as_bytes(), from).unwrap_or(from)].trim();
        match cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"')) {
            Some(inner) if inner.contains('"') => inner.replace("\"\"", "\"").into(),
            inner => inner.unwrap_or(cell).into(),
        }
    }

    /// A cell as a finite number.
    ///
    /// # Errors
    /// [`TableFault::NotANumber`] and [`TableFault::Gap`].
    pub fn number(&self, row: usize, column: usize) -> Result<f64, TableError> {
        let text = self.text(row, column);
        if let Some(x) = text.trim().parse::<f64>().ok().filter(|x| x.is_finite()) {
            return Ok(x);
        }
        let (name, is_empty) = (short(&self.columns[column]), text.trim().is_empty());
        let wrong = TableFault::NotANumber { column: name.clone(), text: short(&text) };
        self.refused(row, column, if is_empty { TableFault::Gap(name) } else { wrong })
    }

    /// The same; none where the cell is empty, `nan` or `na`.
    ///
    /// # Errors
    /// [`TableFault::NotANumber`].
    pub fn number_or_gap(&self, row: usize, column: usize) -> Result<Option<f64>, TableError> {
        let text = self.text(row, column);
        let is_gap = ["", "nan", "na"].iter().any(|gap| text.trim().eq_ignore_ascii_case(gap));
        if is_gap { Ok(None) } else { self.number(row, column).map(Some) }
    }

    /// A column of times, growing.
    ///
    /// # Errors
    /// [`TableError`].
    pub fn times(&self, column: usize) -> Result<Vec<f64>, TableError> {
        let mut times: Vec<f64> = Vec::with_capacity(self.lines.len());
        for row in self.rows() {
            let t = self.number(row, column)?;
            if let Some(&before) = times.last().filter(|&&before| before >= t) {
                return self.refused(row, column, TableFault::TimesNotGrowing { t, before });
            }
            times.push(t);
        }
        Ok(times)
    }
}

/// A text as a cell, which [`Table`] reads as it was.
pub fn table_cell(text: &str) -> Cow<'_, str> {
    let is_plain = text.trim() == text && !text.starts_with('#') && !text.contains([',', '"', '\n', '\r']);
    if is_plain { text.into() } else { format!("\"{}\"", text.replace('"', "\"\"")).into() }
}
