//! Members of an ensemble, from a file, from ranges, or from both.

use std::path::Path;

use anyhow::{Result, bail, ensure};
use motion::{Choice, costate_names};
use scene::{MOST_ROWS, Scene, Table, table_text};

use crate::cli::{EnsembleArguments, Range};

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
        parse(&path.display().to_string(), &table_text(path)?)
    }

    fn combine(&mut self, range: &Range) -> Result<()> {
        let place = format!("--vary {}={}..{}:{}", range.name, range.from, range.to, range.count);
        if let Some(i) = self.names.iter().position(|name| *name == range.name) {
            bail!("{place}: `{}` varies already: {}", range.name, self.places[i]);
        }
        let count = self.count.saturating_mul(range.count);
        ensure!(count <= MOST_ROWS, "{place}: that makes {count} members; at most {MOST_ROWS} are possible");
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

fn parse(file: &str, text: &str) -> Result<Members> {
    let table = Table::read(file, text)?;
    let places: Vec<String> = (0..table.columns.len()).map(|i| table.place(0, i)).collect();
    ensure!(!places.is_empty(), "{file}: no line that names what varies");
    if let Some((_, place)) = table.columns.iter().zip(&places).find(|(name, _)| name.is_empty()) {
        bail!("{place}: a name is missing between the commas");
    }
    let count = table.rows().len();
    ensure!(count > 0, "{}: no members below the names", places[0]);
    let cells = table.rows().flat_map(|row| (0..places.len()).map(move |column| (row, column)));
    let listed = cells.map(|(row, column)| table.number(row, column)).collect::<Result<_, _>>()?;
    Ok(Members { names: table.columns, places, listed, ranges: Vec::new(), count })
}
