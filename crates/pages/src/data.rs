//! The tables of a page as CSV, described by a data package (Frictionless).

use std::path::PathBuf;

use program::File;
use serde_json::json;

use crate::markdown::link;
use crate::table::Table;

/// A folder of tables beside a page: one CSV each, and `datapackage.json`, which names files, columns and
/// types.
///
/// ```
/// use pages::{DataPackage, Table};
/// let mut table = Table::new(["pair", ">gap, m"]);
/// table.row(&[&"Chetaev – vakonomic", &0.5]);
/// let mut data = DataPackage::new("data/mine", "A comparison of mine");
/// data.table("gaps", "The largest gap of each pair", &table);
/// let files = data.files();
/// assert_eq!(files[0].path.to_str(), Some("data/mine/gaps.csv"));
/// assert!(files[1].text.contains("\"type\": \"number\""));
/// ```
pub struct DataPackage {
    folder: PathBuf,
    title: String,
    resources: Vec<serde_json::Value>,
    files: Vec<File>,
}

impl DataPackage {
    /// No tables yet.
    pub fn new(folder: impl Into<PathBuf>, title: impl Into<String>) -> DataPackage {
        DataPackage { folder: folder.into(), title: title.into(), resources: Vec::new(), files: Vec::new() }
    }

    /// Adds a table, unless it has no rows: `name.csv`, about which one sentence is said.
    pub fn table(&mut self, name: &str, about: &str, table: &Table) {
        if table.is_empty() {
            return;
        }
        let field =
            |(name, number): (String, bool)| json!({ "name": name, "type": if number { "number" } else { "string" } });
        self.resources.push(json!({
            "name": name,
            "title": about,
            "path": format!("{name}.csv"),
            "profile": "tabular-data-resource",
            "format": "csv",
            "encoding": "utf-8",
            "schema": { "fields": table.fields().into_iter().map(field).collect::<Vec<_>>() },
        }));
        self.files.push(File { path: self.folder.join(format!("{name}.csv")), text: table.csv() });
    }

    /// A list of the tables for a page that lies at this depth below the folder of reports: a line each.
    pub fn list(&self, depth: usize) -> String {
        let up = "../".repeat(depth);
        let line = |resource: &serde_json::Value| {
            let text = |key: &str| resource[key].as_str().unwrap_or_default().to_owned();
            let address = format!("{up}{}/{}", self.folder.display(), text("path"));
            format!("- {}: {}\n", text("title"), link(&text("path"), &address))
        };
        self.resources.iter().map(line).collect()
    }

    /// The tables and their description; nothing if there is no table.
    pub fn files(self) -> Vec<File> {
        if self.files.is_empty() {
            return Vec::new();
        }
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        let name: String = self.folder.to_string_lossy().chars().map(plain).collect();
        let package = json!({
            "profile": "tabular-data-package",
            "name": name.trim_start_matches("data-"),
            "title": self.title,
            "licenses": [{ "name": "MIT" }, { "name": "Apache-2.0" }],
            "resources": self.resources,
        });
        let text = format!("{package:#}\n");
        self.files.into_iter().chain([File { path: self.folder.join("datapackage.json"), text }]).collect()
    }
}
