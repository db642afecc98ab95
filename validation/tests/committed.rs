//! The committed reports: no page is too long, and tables are what their data packages say.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

/// Words of a page, at most.
const WORDS: usize = 1_500;

/// All files below the folder of reports with this name or ending.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path());
    let of = |path: PathBuf| match path.is_dir() {
        true => files(&path, ending),
        false => {
            if path.to_string_lossy().ends_with(ending) {
                vec![path]
            } else {
                Vec::new()
            }
        }
    };
    entries.flat_map(of).collect()
}

fn reports() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports")
}

#[test]
fn no_page_is_longer_than_1500_words() {
    let pages = files(&reports(), ".md");
    let words = |path: &Path| fs::read_to_string(path).expect("a page").split_whitespace().count();
    let long: Vec<String> = pages
        .iter()
        .filter(|path| words(path) > WORDS)
        .map(|path| format!("{}: {} words", path.display(), words(path)))
        .collect();
    assert!(pages.len() > 30 && long.is_empty(), "{} pages; too long:\n{}", pages.len(), long.join("\n"));
}

/// The records of a CSV (RFC 4180).
fn records(text: &str) -> Vec<Vec<String>> {
    let (mut records, mut quoted) = (vec![vec![String::new()]], false);
    for c in text.trim_end_matches('\n').chars() {
        let record = records.last_mut().expect("a record");
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => record.push(String::new()),
            '\n' if !quoted => records.push(vec![String::new()]),
            c => record.last_mut().expect("a cell").push(c),
        }
    }
    records
}

/// What is wrong with a data package.
fn faults(package: &Path) -> Vec<String> {
    let about: Value = serde_json::from_str(&fs::read_to_string(package).expect("a package")).expect("JSON");
    let (folder, mut faults) = (package.parent().expect("a folder"), Vec::new());
    let resources = about["resources"].as_array().expect("resources");
    for resource in resources {
        let name = resource["path"].as_str().expect("a path");
        let mut fault = |what: &str| faults.push(format!("{}/{name}: {what}", folder.display()));
        let Ok(text) = fs::read_to_string(folder.join(name)) else {
            fault("is not there");
            continue;
        };
        let (fields, records) = (resource["schema"]["fields"].as_array().expect("fields"), records(&text));
        let names: Vec<&str> = fields.iter().filter_map(|field| field["name"].as_str()).collect();
        if records[0] != names {
            fault("other columns than its package says");
        }
        if (1..names.len()).any(|i| names[..i].contains(&names[i])) {
            fault("two columns of one name");
        }
        if records.len() < 2 || records.iter().any(|record| record.len() != names.len()) {
            fault("no records, or not all of one length");
            continue;
        }
        for (i, _) in fields.iter().enumerate().filter(|(_, field)| field["type"] == "number") {
            if records[1..].iter().any(|record| !record[i].is_empty() && record[i].parse::<f64>().is_err()) {
                fault(&format!("`{}` is not all numbers", names[i]));
            }
        }
    }
    let tables = files(folder, ".csv").into_iter().filter(|path| path.parent() == Some(folder)).count();
    if tables != resources.len() {
        faults.push(format!("{}: {tables} tables, {} described", folder.display(), resources.len()));
    }
    faults
}

#[test]
fn tables_are_what_their_packages_say() {
    let packages = files(&reports(), "datapackage.json");
    let faults: Vec<String> = packages.iter().flat_map(|package| faults(package)).collect();
    assert!(packages.len() > 20 && faults.is_empty(), "{} packages:\n{}", packages.len(), faults.join("\n"));
}

#[test]
fn a_false_table_is_noticed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut table = pages::Table::new([">n", "word"]);
    table.row(&[&1, &"a, b"]);
    let mut data = pages::DataPackage::new("data", "Mine");
    data.table("mine", "A table of mine", &table);
    for file in data.files() {
        let path = folder.path().join(file.path);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, file.text).expect("written");
    }
    let (package, csv) = (folder.path().join("data/datapackage.json"), folder.path().join("data/mine.csv"));
    assert_eq!(faults(&package), Vec::<String>::new());
    for false_text in ["n,other\n1,a\n", "n,word\none,a\n", "n,word\n1\n", "n,word\n"] {
        fs::write(&csv, false_text).expect("written");
        assert_eq!(faults(&package).len(), 1, "{false_text}: {:?}", faults(&package));
    }
}
