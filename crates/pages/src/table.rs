//! Tables, in Markdown and as CSV.

use std::fmt;

use crate::markdown::{inert, plain};

/// A table, filled row by row: Markdown when displayed, CSV when it belongs to the data of a page.
///
/// ```
/// use pages::Table;
/// let mut table = Table::new(["scene", ">steps"]);
/// table.row(&[&"sledge", &12]);
/// assert_eq!(table.to_string(), "| scene | steps |\n|---|---:|\n| sledge | 12 |\n");
/// assert_eq!(table.csv(), "scene,steps\nsledge,12\n");
/// ```
#[derive(Clone, Debug, Default)]
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows. The name of a column with numbers, flush right, begins with `>`.
    pub fn new<S: AsRef<str>>(columns: impl IntoIterator<Item = S>) -> Table {
        Table { columns: columns.into_iter().map(|column| column.as_ref().to_owned()).collect(), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: &[&dyn fmt::Display]) {
        self.cells(cells.iter().map(ToString::to_string));
    }

    /// Adds a row whose cells are as many as there are columns, however many these are.
    pub fn cells(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// The same with its first rows only.
    #[must_use]
    pub fn first(&self, rows: usize) -> Table {
        Table { columns: self.columns.clone(), rows: self.rows.iter().take(rows).cloned().collect() }
    }

    /// The same with these columns only, by their names without `>`.
    #[must_use]
    pub fn only(&self, columns: &[&str]) -> Table {
        let named = |name: &&str| self.columns.iter().position(|own| own.trim_start_matches('>') == *name);
        let kept: Vec<usize> = columns.iter().filter_map(named).collect();
        let of = |row: &Vec<String>| kept.iter().filter_map(|&i| row.get(i).cloned()).collect();
        Table { columns: of(&self.columns), rows: self.rows.iter().map(of).collect() }
    }

    /// Adds the rows of another one under a name, which stands in a first column.
    pub fn append(&mut self, name: &str, other: Table) {
        if self.columns.is_empty() {
            self.columns = ["part".into()].into_iter().chain(other.columns).collect();
        }
        self.rows.extend(other.rows.into_iter().map(|row| [name.to_owned()].into_iter().chain(row).collect()));
    }

    /// Names of the columns, and whether each holds numbers only, as CSV has them. A name that came before
    /// has its place behind it.
    pub(crate) fn fields(&self) -> Vec<(String, bool)> {
        let name = |i: usize| plain(self.columns[i].trim_start_matches('>'));
        let is_number = |i: usize| {
            let mut cells = self.rows.iter().filter_map(|row| row.get(i)).map(|cell| plain(cell)).peekable();
            cells.peek().is_some() && cells.all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok())
        };
        let unique =
            |i: usize| if (0..i).any(|j| name(j) == name(i)) { format!("{} {}", name(i), i + 1) } else { name(i) };
        (0..self.columns.len()).map(|i| (unique(i), is_number(i))).collect()
    }

    /// Comma-separated values (RFC 4180): cells without marks of Markdown, empty where there is a dash.
    pub fn csv(&self) -> String {
        let head: Vec<String> = self.fields().into_iter().map(|(name, _)| name).collect();
        let rows = self.rows.iter().map(|row| row.iter().map(|cell| plain(cell)).collect());
        let quoted = |cell: &String| match cell.contains([',', '"', '\n']) {
            true => format!("\"{}\"", cell.replace('"', "\"\"")),
            false => cell.clone(),
        };
        let line = |cells: Vec<String>| cells.iter().map(quoted).collect::<Vec<_>>().join(",") + "\n";
        [head].into_iter().chain(rows).map(line).collect()
    }
}

fn line(cells: &[String]) -> String {
    let cell = |cell: &String| if cell.is_empty() { " |".into() } else { format!(" {cell} |") };
    format!("|{}\n", cells.iter().map(cell).collect::<String>())
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = self.columns.iter().map(|name| name.trim_start_matches('>').to_owned()).collect();
        let rule = self.columns.iter().map(|name| if name.starts_with('>') { "---:|" } else { "---|" });
        f.write_str(&line(&names))?;
        writeln!(f, "|{}", rule.collect::<String>())?;
        let cell = |cell: &String| inert(cell).replace('|', "\\|").replace('\n', " ");
        self.rows.iter().try_for_each(|row| f.write_str(&line(&row.iter().map(cell).collect::<Vec<_>>())))
    }
}
