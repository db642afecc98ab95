//! Places where something can go wrong, and reasons why that is not noticed.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use symbolic::faults::Chance;
use toml::de::DeTable;

/// A line of a source, and what goes wrong there. The text of the line is what is compared, so that lines may
/// move.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    file: String,
    line: u32,
    column: u32,
    what: &'static str,
}

impl Place {
    pub fn new(chance: &Chance) -> Place {
        let at = chance.at;
        Place { file: at.file().replace('\\', "/"), line: at.line(), column: at.column(), what: chance.what }
    }

    fn text(&self) -> String {
        let source = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(&self.file));
        let source = source.unwrap_or_default();
        source.lines().nth(self.line as usize - 1).unwrap_or_default().trim().to_owned()
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{} {}: {}", self.file, self.line, self.column, self.what, self.text())
    }
}

/// Why a fault is not noticed.
#[derive(Debug)]
struct Reason {
    /// The end of the file's path.
    file: String,
    line: String,
    /// What goes wrong there, or `anything`.
    what: String,
    reason: String,
}

fn reasons() -> Vec<Reason> {
    let table = DeTable::parse(include_str!("explained.toml")).unwrap_or_else(|e| panic!("explained.toml: {e}"));
    let Some(list) = table.get_ref().get("explained").and_then(|list| list.get_ref().as_array()) else { return vec![] };
    let entry = |number: usize| {
        let text = |key: &str| {
            let value = list[number].get_ref().as_table().and_then(|table| table.get(key));
            let text = value.and_then(|value| value.get_ref().as_str()).filter(|text| !text.is_empty());
            text.unwrap_or_else(|| panic!("explained.toml: entry {} has no `{key}`", number + 1)).to_owned()
        };
        Reason { file: text("file"), line: text("line"), what: text("what"), reason: text("reason") }
    };
    (0..list.len()).map(entry).collect()
}

/// Survivors without a reason, and reasons without a survivor.
pub fn explain(survivors: &BTreeMap<Place, Vec<String>>) -> Vec<String> {
    let reasons = reasons();
    let mut used = vec![false; reasons.len()];
    let mut wrong = Vec::new();
    for (place, words) in survivors {
        let explains = |reason: &Reason| {
            let same = place.file.ends_with(&reason.file) && place.text() == reason.line;
            same && (reason.what == "anything" || reason.what == place.what)
        };
        match reasons.iter().position(explains) {
            Some(i) => {
                println!("explained, {} times: {place}: {}", words.len(), reasons[i].reason);
                used[i] = true;
            }
            None => wrong.push(format!("not noticed: {place}\n   {}", words.join("\n   "))),
        }
    }
    let stale = reasons.iter().zip(used).filter(|(_, used)| !used).map(|(reason, _)| format!("stale: {reason:?}"));
    wrong.into_iter().chain(stale).collect()
}
