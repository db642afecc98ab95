//! Tables over one or more numbers.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail, ensure};
use pages::Swept;
use program::{AtomicWriter, ResumableFile, parallel};
use scene::{MOST_ROWS, Number};

use crate::cli::Range;
use crate::columns::header;

/// Points computed before they are written down.
const CHUNK: usize = 64;

/// All combinations of some ranges; the last one changes fastest.
pub(crate) struct Grid<'a> {
    ranges: &'a [Range],
    pub(crate) count: usize,
}

impl<'a> Grid<'a> {
    pub(crate) fn of(ranges: &'a [Range]) -> Result<Self> {
        for (i, range) in ranges.iter().enumerate() {
            ensure!(ranges[..i].iter().all(|other| other.name != range.name), "--sweep: `{}` varies twice", range.name);
        }
        match Range::combinations(ranges) {
            Some(count) => Ok(Grid { ranges, count }),
            None => bail!("--sweep makes more than {MOST_ROWS} points"),
        }
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.ranges.iter().map(|range| range.name.as_str())
    }

    pub(crate) fn point(&self, index: usize) -> Vec<f64> {
        Range::combined(self.ranges, index).0
    }

    pub(crate) fn swept(&self) -> Vec<Swept> {
        self.ranges.iter().map(|Range { name, from, to, count }| (name.clone(), *from, *to, *count)).collect()
    }

    /// # Errors
    /// One of these names varies.
    pub(crate) fn is_free_in(&self, set: &[(String, Number)]) -> Result<()> {
        match set.iter().find(|(fixed, _)| self.names().any(|name| name == fixed)) {
            Some((fixed, _)) => bail!("--sweep: `{fixed}` varies, and --set fixes it"),
            None => Ok(()),
        }
    }

    /// A table, one row per point, to a file or to the terminal; of a file that was cut off the rest is
    /// computed. `row` is what stands behind the values of a point. Says what is written; `None` where nobody
    /// reads on.
    pub(crate) fn write(
        &self,
        path: Option<&Path>,
        columns: &[&str],
        quiet: bool,
        row: impl Fn(&[f64]) -> String + Sync,
    ) -> Result<Option<String>> {
        let head = header(&self.names().chain(columns.iter().copied()).map(String::from).collect::<Vec<_>>())?;
        let computed = |index: usize| self.begin(index) + &row(&self.point(index));
        let mut done = 0;
        let resume = |lines: &mut ResumableFile, is_ours: &dyn Fn(bool) -> Result<()>| {
            done = whole_rows(lines, is_ours, self, &computed)?;
            Ok(())
        };
        let (mut sink, mut reads_on) = AtomicWriter::open(path, &head, "sweep", Some(resume))?;
        let bar = parallel::progress(self.count, quiet);
        while reads_on && done < self.count {
            bar.set_position(done as u64);
            let next: Vec<usize> = (done..self.count.min(done + CHUNK)).collect();
            let rows = parallel::map(&next, |&index| computed(index));
            done += rows.len();
            reads_on = sink.write(&rows.concat())?;
        }
        bar.finish_and_clear();
        let told = |path: PathBuf| format!("{} points in {}\n", self.count, path.display());
        if reads_on { Ok(Some(sink.close()?.map_or(String::new(), told))) } else { Ok(None) }
    }

    /// How the row of a point begins.
    fn begin(&self, index: usize) -> String {
        self.point(index).iter().map(|x| format!("{x:?},")).collect()
    }
}

/// The rows that a file has already, which are kept. The first one has to be what is computed now.
fn whole_rows(
    lines: &mut ResumableFile,
    is_ours: &dyn Fn(bool) -> Result<()>,
    grid: &Grid,
    computed: &dyn Fn(usize) -> String,
) -> Result<usize> {
    let mut rows = 0;
    while let Some(line) = lines.next_line()? {
        let next = rows < grid.count && line.starts_with(&grid.begin(rows));
        is_ours(next && (rows > 0 || line == computed(0)))?;
        lines.keep(lines.at());
        rows += 1;
    }
    Ok(rows)
}
