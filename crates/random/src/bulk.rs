//! Many random systems over all processors, and what becomes of one that breaks a claim.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::Mutex;

use anyhow::{Context, Result, bail};
use proptest::strategy::ValueTree;
use scene::Scene;
use serde::{Deserialize, Serialize};

use super::claims::{CHECKS, make};
use super::recipe::{draw, draw_null_test};
use super::record::{Record, THOROUGH};
use super::{Case, Kind, Recipe};
use crate::parallel;

/// Steps after which shrinking is content with what it has.
const SHRINKING: usize = 600;

/// Which systems: each a pure function of seed, index and kinds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Batch {
    /// Seed.
    pub seed: u64,
    /// Kinds that take turns.
    pub kinds: Vec<Kind>,
}

impl Batch {
    /// Whether a system is put to the thorough checks too: every [`THOROUGH`]-th of each kind.
    pub fn is_thorough(&self, index: u64) -> bool {
        (index / self.kinds.len().max(1) as u64).is_multiple_of(THOROUGH)
    }

    /// Puts one system to the test.
    pub fn record(&self, index: u64) -> Record {
        let thorough = self.is_thorough(index);
        let null = thorough.then(|| draw_null_test(self.seed, index));
        Record::of(draw(self.seed, index, &self.kinds).current(), index, thorough, null.as_ref())
    }

    /// Name of a system.
    pub fn name(&self, index: u64) -> String {
        match &self.kinds[..] {
            [kind] => format!("random-{}-{kind}-{index}", self.seed),
            _ => format!("random-{}-{index}", self.seed),
        }
    }

    /// One system as a scene.
    pub fn scene(&self, index: u64) -> Scene {
        draw(self.seed, index, &self.kinds).current().scene(&self.name(index))
    }

    /// Puts `count` systems to the test. With a log, those that it holds already are taken from it, and the
    /// others are added to it one by one: a run that was cut off goes on where it was.
    ///
    /// # Errors
    /// Where the log cannot be read or written, or is of another batch.
    pub fn run(&self, count: u64, log: Option<&Path>, quiet: bool) -> Result<Vec<Record>> {
        let (mut records, log) = match log {
            None => (Vec::new(), None),
            Some(path) => {
                let (records, file) = self.open_log(path)?;
                (records, Some(Mutex::new(file)))
            }
        };
        records.retain(|record| record.index < count);
        let known: std::collections::BTreeSet<u64> = records.iter().map(|record| record.index).collect();
        let indices: Vec<u64> = (0..count).filter(|index| !known.contains(index)).collect();
        let name = |&index: &u64| format!("random systems, {}", self.kinds[index as usize % self.kinds.len()]);
        let new = parallel::try_map(&indices, quiet, name, |&index| -> Result<Record> {
            let record = self.record(index);
            if let Some(log) = &log {
                let line = serde_json::to_string(&record)? + "\n";
                let mut file = log.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                file.write_all(line.as_bytes()).context("cannot write the log")?;
            }
            Ok(record)
        })?;
        records.extend(new);
        records.sort_by_key(|record| record.index);
        Ok(records)
    }

    /// Records of an earlier run, and the file to go on with. A last line that was cut off is dropped.
    fn open_log(&self, path: &Path) -> Result<(Vec<Record>, File)> {
        let place = || format!("log {}", path.display());
        let mut file =
            OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path).with_context(place)?;
        let (mut records, mut end, mut first) = (Vec::new(), 0_u64, true);
        let mut reader = BufReader::new(&file);
        let mut line = String::new();
        loop {
            line.clear();
            let length = reader.read_line(&mut line).with_context(place)?;
            if length == 0 || !line.ends_with('\n') {
                break;
            }
            if first {
                let other: Batch =
                    serde_json::from_str(&line).with_context(|| format!("{}: not a log of random systems", place()))?;
                if other != *self {
                    bail!("{} is of seed {} and {} kinds; take another file", place(), other.seed, other.kinds.len());
                }
            } else {
                records.push(serde_json::from_str(&line).with_context(place)?);
            }
            first = false;
            end += length as u64;
        }
        if first && line.trim() != "" {
            bail!("{}: not a log of random systems", place());
        }
        file.set_len(end).with_context(place)?;
        file.seek(SeekFrom::Start(end)).with_context(place)?;
        if first {
            let header = serde_json::to_string(self)? + "\n";
            file.write_all(header.as_bytes()).with_context(place)?;
        }
        Ok((records, file))
    }

    /// The smallest system on which a claim of `theorem` still fails; `None` where the system itself passes.
    pub fn counterexample(&self, index: u64, theorem: u8) -> Option<Scene> {
        let mut tree = draw(self.seed, index, &self.kinds);
        let scene = |recipe: &Recipe| failing(recipe, theorem);
        shrink(&mut tree, &scene).map(|scene| Scene {
            name: format!("{}-T{theorem}", self.name(index)),
            notes: format!("{} Shrunk from {}.", scene.notes, self.name(index)),
            ..scene
        })
    }
}

/// The scene of a recipe on which a claim of `theorem` fails, with the failure in its notes.
fn failing(recipe: &Recipe, theorem: u8) -> Option<Scene> {
    let mut case = Case::new(recipe.clone(), "counterexample").ok()?;
    for check in CHECKS.iter().filter(|check| check.theorem == theorem) {
        make(check, &mut case);
    }
    let failure = case.found.failures().next()?;
    let (claim, figure, limit) = (failure.claim, failure.figure, failure.limit);
    let notes = format!("T{theorem} fails: {claim}; measured {figure:.3e}, limit {limit:.3e}. {}", failure.note);
    Some(Scene { notes: notes.trim().into(), ..case.scene })
}

/// Shrinks what a tree holds as long as `test` finds something in it; the last thing found.
pub fn shrink<T>(tree: &mut impl ValueTree<Value = Recipe>, test: &dyn Fn(&Recipe) -> Option<T>) -> Option<T> {
    let mut best = test(&tree.current())?;
    let mut simpler = tree.simplify();
    for _ in 0..SHRINKING {
        if !simpler {
            break;
        }
        simpler = match test(&tree.current()) {
            Some(found) => {
                best = found;
                tree.simplify()
            }
            None => tree.complicate(),
        };
    }
    Some(best)
}
