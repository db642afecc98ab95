//! Members of an ensemble, from a file, from ranges, or from both.

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use deltaq::{Choice, costate_names};
use scene::Scene;

use crate::cli::{EnsembleArguments, MOST_MEMBERS, Range};

/// Values of what varies, one row per member. Rows are made where they are needed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Members {
    /// What varies.
    pub names: Vec<String>,
    /// Where each name is from, for complaints.
    places: Vec<String>,
    /// What the file says, row by row.
    listed: Vec<f64>,
    ranges: Vec<Range>,
    count: usize,
}

impl Members {
    /// Those of the file, each combined with all values of the ranges; the last one changes fastest.
    pub(crate) fn of(arguments: &EnsembleArguments, scene: &Scene, choice: &Choice) -> Result<Members> {
        let mut members = match &arguments.members {
            Some(path) => Members::read(path)?,
            None if arguments.vary.is_empty() => {
                bail!("nothing varies: give --vary NAME=FROM:TO:COUNT, --members FILE, or both")
            }
            None => Members { count: 1, ..Members::default() },
        };
        for range in &arguments.vary {
            members.combine(range)?;
        }
        let known = known(scene, choice);
        for (name, place) in members.names.iter().zip(&members.places) {
            if name == "duration" || name == "time" {
                bail!("{place}: `{name}` is the same for all members; see --set");
            }
            if !known.contains(name) {
                bail!("{place}: the scene has no `{name}` that could vary; it has {}", known.join(", "));
            }
            if arguments.motion.scene.set.overrides.iter().any(|(set, _)| set == name) {
                bail!("{place}: `{name}` varies, and --set fixes it");
            }
        }
        Ok(members)
    }

    fn read(path: &Path) -> Result<Members> {
        let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
        parse(&path.display().to_string(), &text)
    }

    fn combine(&mut self, range: &Range) -> Result<()> {
        let place = format!("--vary {}={}..{}:{}", range.name, range.from, range.to, range.count);
        if let Some(i) = self.names.iter().position(|name| *name == range.name) {
            bail!("{place}: `{}` varies already: {}", range.name, self.places[i]);
        }
        let count = self.count.saturating_mul(range.count);
        ensure!(count <= MOST_MEMBERS, "{place}: that makes {count} members; at most {MOST_MEMBERS} are possible");
        self.count = count;
        self.ranges.push(range.clone());
        self.names.push(range.name.clone());
        self.places.push(place);
        Ok(())
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    /// One value per name.
    pub(crate) fn row(&self, member: usize) -> Vec<f64> {
        let (varied, line) = Range::combined(&self.ranges, member);
        let listed = self.names.len() - self.ranges.len();
        [&self.listed[line * listed..][..listed], &varied].concat()
    }

    /// Where a name is from that the scene does not know.
    pub(crate) fn place(&self, name: &str) -> &str {
        self.names.iter().position(|known| known == name).map_or("--set", |i| &self.places[i])
    }
}

/// What can vary.
fn known(scene: &Scene, choice: &Choice) -> Vec<String> {
    let system = &scene.system;
    let parameters = system.parameters.iter().map(|p| system.graph.name(p.symbol));
    let coordinates = system.coordinates.iter().map(|c| c.name.clone());
    let velocities = system.coordinates.iter().map(|c| format!("{}'", c.name));
    let multipliers = scene.multiplier_names();
    let costates = choice.removal.iter().flat_map(|removal| costate_names(scene, removal));
    parameters.chain(coordinates).chain(velocities).chain(multipliers).chain(costates).collect()
}

/// The cells of a line with their columns, in characters from 1, without blanks and quotation marks.
fn cells(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut column = 1;
    line.split(',').map(move |cell| {
        let blanks = cell.chars().take_while(|c| c.is_whitespace()).count();
        let place = column + blanks;
        column += cell.chars().count() + 1;
        let inner = cell.trim();
        (place, inner.strip_prefix('"').and_then(|x| x.strip_suffix('"')).unwrap_or(inner).trim())
    })
}

fn parse(file: &str, text: &str) -> Result<Members> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let numbered = text.lines().zip(1..).map(|(line, number)| (number, line));
    let mut lines = numbered.filter(|(_, line)| !line.trim().is_empty() && !line.trim_start().starts_with('#'));
    let Some((number, header)) = lines.next() else { bail!("{file}: no line that names what varies") };
    let (mut names, mut places) = (Vec::new(), Vec::<String>::new());
    for (column, name) in cells(header) {
        let place = format!("{file}:{number}:{column}");
        ensure!(!name.is_empty(), "{place}: a name is missing between the commas");
        if let Some(i) = names.iter().position(|known| known == name) {
            bail!("{place}: `{name}` stands at {} already", places[i]);
        }
        names.push(name.to_string());
        places.push(place);
    }
    let (mut listed, mut count) = (Vec::new(), 0);
    for (number, line) in lines {
        let first = listed.len();
        for (column, cell) in cells(line) {
            let place = format!("{file}:{number}:{column}");
            let Some(name) = names.get(listed.len() - first) else {
                bail!("{place}: more numbers than the {} that the first line names", names.len());
            };
            match cell.parse::<f64>() {
                Ok(value) if value.is_finite() => listed.push(value),
                Ok(value) => bail!("{place}: `{name}` is {value}; it must be finite"),
                Err(_) => bail!("{place}: `{cell}` is not a number, for `{name}`"),
            }
        }
        let column = line.chars().count() + 1;
        let (found, expected) = (listed.len() - first, names.len());
        ensure!(found == expected, "{file}:{number}:{column}: {found} numbers; the first line names {expected}");
        count += 1;
        ensure!(count <= MOST_MEMBERS, "{file}:{number}:1: more than {MOST_MEMBERS} members");
    }
    ensure!(count > 0, "{file}:{}:1: no members below the names", number + 1);
    Ok(Members { names, places, listed, ranges: Vec::new(), count })
}
