//! `deltaq compare --sweep`: where two motions part, over one or two numbers.

use anyhow::{Context, Result, bail, ensure};
use deltaq::{Settings, Sweep, SweepPoint};

use crate::cli::{CompareArguments, MOST_MEMBERS, Range};
use crate::columns::{header, quoted};
use crate::sink::Sink;
use crate::solve_command::limited;
use pages::{Swept, sweep_files};
use program::write_all;
use program::{Lines, parallel};

/// Points computed before they are written down.
const CHUNK: usize = 64;

const COLUMNS: [&str; 9] =
    ["verdict", "apart", "largest", "limit", "answer", "order", "dimension", "mismatch", "cause"];

/// A table, one row per point; of a file that was cut off the rest is computed.
pub(crate) fn run(arguments: &CompareArguments, quiet: bool) -> Result<String> {
    let settings = limited(Settings { tolerance: arguments.tolerance, ..Settings::protocol() }, &arguments.limits)?;
    let [name] = &arguments.scenes[..] else { bail!("--sweep is for one scene, not for {}", arguments.scenes.len()) };
    let grid = Grid::of(&arguments.sweep)?;
    if let Some((fixed, _)) = arguments.set.overrides.iter().find(|(set, _)| grid.names().any(|name| name == set)) {
        bail!("--sweep: `{fixed}` varies, and --set fixes it");
    }
    let formulations = match &arguments.formulation[..] {
        [] => None,
        [first, second] => Some([*first, *second]),
        other => bail!("--sweep compares two formulations, not {}", other.len()),
    };
    // a name that means nothing is a fault of the call, a start that there is not an answer
    let text = catalogue::source(name)?;
    let scene = catalogue::read(name, &text, &arguments.set.overrides)?;
    let names: Vec<String> = grid.names().map(String::from).collect();
    let sweep = Sweep::new(&scene.name, &text, &arguments.set.overrides, &names, formulations, &settings)?;

    let computed = |index: usize| grid.begin(index) + &row(&sweep.point(&grid.point(index)));
    let path = arguments.output.out.as_ref().map(|folder| folder.join(format!("{}-sweep.csv", scene.name)));
    let mut done = 0;
    let (mut sink, mut reads_on) = Sink::open(path.as_deref(), &grid.head(), "sweep", |lines, is_ours| {
        done = whole_rows(lines, is_ours, &grid, &computed)?;
        Ok(())
    })?;
    let bar = parallel::progress(grid.count, quiet);
    while reads_on && done < grid.count {
        bar.set_position(done as u64);
        let next: Vec<usize> = (done..grid.count.min(done + CHUNK)).collect();
        let rows = parallel::map(&next, |&index| computed(index));
        done += rows.len();
        reads_on = sink.write(&rows.concat())?;
    }
    bar.finish_and_clear();
    if !reads_on {
        return Ok(String::new());
    }
    let told = sink.close(&format!("{} points", grid.count))?;
    let (Some(path), Some(folder)) = (&path, &arguments.output.out) else { return Ok(told) };
    let table = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    write_all(folder, &sweep_files(&scene.name, &scene.title, sweep.titles(), &grid.swept(), &table)?)?;
    Ok(told)
}

fn row(point: &SweepPoint) -> String {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| format!("{x:?}"));
    let count = |n: Option<usize>| n.map_or(String::new(), |n| n.to_string());
    let SweepPoint { verdict, apart, largest, limit, answer, order, dimension, mismatch, cause } = point;
    let cells = [
        verdict.to_string(),
        number(*apart),
        number(*largest),
        number(*limit),
        answer.to_string(),
        count(*order),
        count(*dimension),
        number(*mismatch),
        quoted(cause),
    ];
    cells.join(",") + "\n"
}

/// All combinations of some ranges; the last one changes fastest.
struct Grid<'a> {
    ranges: &'a [Range],
    count: usize,
}

impl<'a> Grid<'a> {
    fn of(ranges: &'a [Range]) -> Result<Self> {
        for (i, range) in ranges.iter().enumerate() {
            ensure!(ranges[..i].iter().all(|other| other.name != range.name), "--sweep: `{}` varies twice", range.name);
        }
        match Range::combinations(ranges) {
            Some(count) => Ok(Grid { ranges, count }),
            None => bail!("--sweep makes more than {MOST_MEMBERS} points"),
        }
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.ranges.iter().map(|range| range.name.as_str())
    }

    fn point(&self, index: usize) -> Vec<f64> {
        Range::combined(self.ranges, index).0
    }

    fn swept(&self) -> Vec<Swept> {
        self.ranges.iter().map(|Range { name, from, to, count }| (name.clone(), *from, *to, *count)).collect()
    }

    fn head(&self) -> String {
        header(&self.names().chain(COLUMNS).map(String::from).collect::<Vec<_>>())
    }

    /// How the row of a point begins.
    fn begin(&self, index: usize) -> String {
        self.point(index).iter().map(|x| format!("{x:?},")).collect()
    }
}

/// The rows that a file has already, which are kept. The first one has to be what is computed now.
fn whole_rows(
    lines: &mut Lines,
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
