//! Markdown tables.

use std::fmt;

use crate::markdown::inert;

/// A table in Markdown, written row by row.
///
/// ```
/// use pages::Table;
/// let mut table = Table::new(["scene", ">steps"]);
/// table.row(&[&"sledge", &12]);
/// assert_eq!(table.to_string(), "| scene | steps |\n|---|---:|\n| sledge | 12 |\n");
/// ```
pub struct Table {
    text: String,
    rows: usize,
}

impl Table {
    /// A table without rows. The name of a column with numbers, flush right, begins with `>`.
    pub fn new<S: AsRef<str>>(columns: impl IntoIterator<Item = S>) -> Table {
        let (mut names, mut rule) = (Vec::new(), String::from("|"));
        for column in columns {
            let column = column.as_ref();
            let name = column.strip_prefix('>');
            rule += if name.is_some() { "---:|" } else { "---|" };
            names.push(name.unwrap_or(column).to_string());
        }
        Table { text: line(&names) + &rule + "\n", rows: 0 }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: &[&dyn fmt::Display]) {
        self.cells(cells.iter().map(ToString::to_string));
    }

    /// Adds a row whose cells are as many as there are columns, however many these are.
    pub fn cells(&mut self, cells: impl IntoIterator<Item = String>) {
        let cell = |cell: String| inert(&cell).replace('|', "\\|").replace('\n', " ");
        let cells: Vec<String> = cells.into_iter().map(cell).collect();
        self.text += &line(&cells);
        self.rows += 1;
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }
}

fn line(cells: &[String]) -> String {
    let cell = |cell: &String| if cell.is_empty() { " |".into() } else { format!(" {cell} |") };
    format!("|{}\n", cells.iter().map(cell).collect::<String>())
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
