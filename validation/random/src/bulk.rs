//! Many random systems over all processors, and what becomes of one that breaks a claim.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Write;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Error, Result, anyhow, ensure};
use proptest::strategy::ValueTree;
use scene::Scene;
use serde::{Deserialize, Serialize};

use super::claims::{CHECKS, broken_null_test, make};
use super::recipe::draw;
use super::record::{Record, THOROUGH};
use super::{Case, Fault, Finding, Kind, NullTest, Recipe};
use program::{ResumableFile, parallel};

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

    /// The index of the `i`-th system of the first kind that is put to the thorough checks.
    pub fn thorough(&self, i: u64) -> u64 {
        i * THOROUGH * self.kinds.len().max(1) as u64
    }

    /// Puts one system to the test.
    pub fn record(&self, index: u64) -> Record {
        self.faulty_record(index, &Fault::NONE)
    }

    /// [`Batch::record`] with something wrong on purpose.
    pub fn faulty_record(&self, index: u64, fault: &Fault) -> Record {
        self.record_of(draw(self.seed, index, &self.kinds).current(), index, fault)
    }

    /// [`Batch::faulty_record`] with another recipe instead of that with this index.
    pub fn record_of(&self, recipe: Recipe, index: u64, fault: &Fault) -> Record {
        let thorough = self.is_thorough(index);
        let null = thorough.then(|| NullTest::draw(self.seed, index).current());
        Record::of(recipe, index, thorough, null.as_ref(), fault)
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

    /// Puts the systems with these indices to the test. With a log, those that it holds already are taken
    /// from it, and the others are added to it one by one: a run that was cut off goes on where it was.
    ///
    /// # Errors
    /// Where the log cannot be read or written, is of another batch or being written by another run.
    pub fn run(&self, indices: Range<u64>, log: Option<&Path>, quiet: bool) -> Result<Vec<Record>> {
        let (mut records, log) = match log {
            None => (Vec::new(), None),
            Some(path) => {
                let (records, file) = self.open_log(path)?;
                (records, Some((path, Mutex::new(file))))
            }
        };
        records.retain(|record| indices.contains(&record.index));
        let known: BTreeSet<u64> = records.iter().map(|record| record.index).collect();
        let indices: Vec<u64> = indices.filter(|index| !known.contains(index)).collect();
        let name = |&index: &u64| format!("random systems, {}", self.kinds[index as usize % self.kinds.len()]);
        let new = parallel::try_map(&indices, quiet, name, |&index| -> Result<Record> {
            let record = self.record(index);
            if let Some((path, log)) = &log {
                let line = serde_json::to_string(&record)? + "\n";
                let mut file = log.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                file.write_all(line.as_bytes()).with_context(|| format!("cannot write {}", path.display()))?;
            }
            Ok(record)
        })?;
        records.extend(new);
        records.sort_by_key(|record| record.index);
        Ok(records)
    }

    /// The batch of some logs, and the records of all of them, each system once.
    ///
    /// # Errors
    /// Where a log cannot be read, or the logs are not of the same batch.
    pub fn merged(logs: &[PathBuf]) -> Result<(Batch, Vec<Record>)> {
        let mut batch = None;
        let mut records = BTreeMap::new();
        for path in logs {
            let place = || format!("log {}", path.display());
            let text = fs::read(path).with_context(place)?;
            // a last line that was cut off does not count
            let whole = text.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
            let text = std::str::from_utf8(&text[..whole]).with_context(place)?;
            let mut lines = text.lines();
            let own = lines.next().and_then(|head| serde_json::from_str(head).ok());
            let own: Batch = own.with_context(|| format!("{}: not a log of random systems", place()))?;
            batch.get_or_insert_with(|| own.clone()).is_of(&own, path)?;
            for line in lines {
                let record: Record = serde_json::from_str(line).with_context(place)?;
                records.insert(record.index, record);
            }
        }
        Ok((batch.context("no log to merge")?, records.into_values().collect()))
    }

    /// `other`, read from `path`, has to be this batch.
    fn is_of(&self, other: &Batch, path: &Path) -> Result<()> {
        let (path, kinds) = (path.display(), other.kinds.len());
        ensure!(self == other, "log {path} is of seed {} and {kinds} kinds; take another file", other.seed);
        Ok(())
    }

    /// Records of an earlier run, and the file to go on with. A last line that was cut off is dropped.
    fn open_log(&self, path: &Path) -> Result<(Vec<Record>, File)> {
        let place = || format!("log {}", path.display());
        let foreign = |first: &str| match serde_json::from_str(first) {
            Ok(other) => self.is_of(&other, path).err().unwrap_or_else(|| anyhow!("{} is in other words", place())),
            Err(_) => Error::msg(format!("{}: not a log of random systems", place())),
        };
        let mut lines = ResumableFile::open(path, &(serde_json::to_string(self)? + "\n"), foreign)?;
        let mut records = Vec::new();
        while let Some(line) = lines.next_line()? {
            records.push(serde_json::from_str(&line).with_context(place)?);
            lines.keep(lines.at());
        }
        Ok((records, lines.go_on()?))
    }

    /// Of each theorem that fails the first failure, shrunk; others mostly have the same cause.
    pub fn counterexamples(&self, records: &[Record]) -> Vec<(u8, Scene)> {
        let failures = first_failures(records).into_iter();
        failures.filter_map(|(theorem, index)| Some((theorem, self.counterexample(index, theorem)?))).collect()
    }

    /// The smallest system on which a claim of `theorem` still fails; `None` where the system itself passes.
    pub fn counterexample(&self, index: u64, theorem: u8) -> Option<Scene> {
        self.faulty_counterexample(index, theorem, &Fault::NONE, SHRINKING)
    }

    /// [`Batch::counterexample`] with something wrong on purpose, after at most `steps` steps of shrinking.
    pub fn faulty_counterexample(&self, index: u64, theorem: u8, fault: &Fault, steps: usize) -> Option<Scene> {
        let null = |numbers: &NullTest| broken_null_test(numbers, fault);
        let drawn = |recipe: &Recipe| failing(recipe, theorem, fault);
        let found = match theorem {
            13 => shrink_within(steps, &mut NullTest::draw(self.seed, index), &null),
            _ => shrink_within(steps, &mut draw(self.seed, index, &self.kinds), &drawn),
        };
        let (scene, Finding { claim, figure, limit, note, .. }) = found?;
        let figures =
            if limit.is_nan() { String::new() } else { format!(" measured {figure:.3e}, limit {limit:.3e}.") };
        let note = if note.is_empty() { note } else { format!(" {note}.") };
        let from = self.name(index);
        let notes = format!("T{theorem} fails: {claim}.{figures}{note} Shrunk from {from}.");
        Some(Scene { name: format!("{from}-T{theorem}"), notes, ..scene })
    }
}

/// The index of the first record with a failure of each theorem.
pub fn first_failures(records: &[Record]) -> BTreeMap<u8, u64> {
    let failures = records.iter().flat_map(|record| record.failures().into_iter().map(|t| (t, record.index)));
    failures.rev().collect()
}

/// The scene of a recipe on which a claim of `theorem` fails, and the failure.
fn failing(recipe: &Recipe, theorem: u8, fault: &Fault) -> Option<(Scene, Finding)> {
    let mut case = Case::new(recipe.clone(), "counterexample").ok()?;
    (fault.case)(&mut case).ok()?;
    for check in CHECKS.iter().filter(|check| check.theorem == theorem) {
        make(check, &mut case);
    }
    let failure = case.found.failures().find(|failure| failure.theorem == theorem)?.clone();
    Some((case.scene, failure))
}

/// Shrinks what a tree holds as long as `test` finds something in it; the last thing found.
pub fn shrink<V: ValueTree, T>(tree: &mut V, test: &dyn Fn(&V::Value) -> Option<T>) -> Option<T> {
    shrink_within(SHRINKING, tree, test)
}

fn shrink_within<V: ValueTree, T>(steps: usize, tree: &mut V, test: &dyn Fn(&V::Value) -> Option<T>) -> Option<T> {
    let mut best = test(&tree.current())?;
    let mut simpler = tree.simplify();
    for _ in 0..steps {
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
