//! The page about error against run time.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::Result;
use integrate::Method;
use motion::Settings;
use serde_json::{Value, json};

use crate::{Bench, Entry, Fastest, MEMBERS, Measurements, Series, TARGETS, Throughput, Time};
use comparison::words::{enumerate, short};
use pages::markdown::link;
use pages::{DataPackage, Table};
use picture::{Axis, Curve, Panel, Picture, PictureError, Style};
use program::File;

/// The first line of the page.
pub fn bench_headline(benches: &[Bench]) -> String {
    let all: Vec<&Measurements> =
        benches.iter().flat_map(|b| &b.entries).filter_map(|e| e.outcome.as_ref().ok()).collect();
    let winners: Vec<Fastest> = all.iter().filter_map(|m| m.fastest(Settings::default().tolerance, None)).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    winners.iter().for_each(|winner| *counts.entry(winner.method.name()).or_default() += 1);
    let mut names: Vec<(&str, usize)> = counts.into_iter().collect();
    names.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let words: Vec<String> = names.iter().map(|(name, count)| format!("{name} on {count}")).collect();
    format!(
        "An error of at most {:.0e} is reached on {} of {} motions; fastest there: {}.",
        Settings::default().tolerance,
        winners.len(),
        all.len(),
        enumerate(&words)
    )
}

/// Pictures of the page; of all scenes there are tables.
const SHOWN: usize = 5;

/// Page, pictures and tables, with those of ensembles where any were measured.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn bench_files(benches: &[Bench], ensembles: &[Throughput]) -> Result<Vec<File>> {
    let (mut files, mut shown) = (Vec::new(), String::new());
    for bench in benches.iter().take(SHOWN) {
        let path = format!("error-vs-time/{}.svg", bench.scene);
        match picture(bench) {
            Ok(text) => {
                let _ = writeln!(shown, "!{}\n", link(&title(bench), &path));
                files.push(File { path: path.into(), text });
            }
            Err(PictureError::NothingToDraw { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    let mut data = DataPackage::new("data/error-vs-time", "Error against run time of every method");
    let (usual, sentence) = usual(benches);
    data.table("default", "The default run at tolerance 1e-10 beside the fastest single run", &usual);
    data.table("fastest", "For each motion and error, what reaches it first", &fastest_settings(benches));
    data.table("motions", "What was measured, and the references", &motions(benches));
    data.table("settings", "For each motion, method and error: milliseconds and evaluations", &settings(benches));
    data.table("failures", "Settings that failed, with the cause", &failed(benches));
    let [times, ratios] = ensemble_tables(ensembles);
    let many = format!(
        "Many motions at once: microseconds per member (`evidence bench --ensemble 1e-10` measures {MEMBERS} members)"
    );
    data.table("ensembles", &many, &times);
    data.table("ensemble-ratios", "Many motions at once: ratios", &ratios);
    let columns = ["scene", "formulation", "both runs (ms)", "error", "single (ms)", "ratio"];
    let page = format!(
        "# Error against run time\n\n**{}**\n\n{INTRODUCTION}\n## Without options\n\n{sentence}\n\n{}\n## Pictures\n\n\
         Work–precision diagrams, lower left is better. Colour and dash: method. The black or white dot is the default run.\n\n{shown}## Data\n\n{}",
        bench_headline(benches),
        usual.only(&columns),
        data.list(0)
    );
    files.push(File { path: "error-vs-time.md".into(), text: page });
    Ok(files.into_iter().chain(data.files()).collect())
}

const INTRODUCTION: &str = "A time is one run of the integrator from compiled equations, dense output included: the least of several runs on one processor. \
    Set-up time is listed separately, in `fastest.csv`. The error is the largest distance from the reference in the kinetic metric \
    $\\sqrt{\\Delta q^T M \\Delta q}$ at 20 times. Times differ from machine to machine and from run to run; numbers of evaluations do not.\n";

/// Allowed ratio of both runs to the fastest single one.
const WANTED: f64 = 2.5;

/// The default run, with only the tolerance given, beside the fastest single run of all forms and settings,
/// and a sentence about it.
fn usual(benches: &[Bench]) -> (Table, String) {
    let columns = ["scene", "formulation", "form, method", ">both runs (ms)", ">error", ">estimate"];
    let mut table = Table::new(columns.into_iter().chain([">single (ms)", ">ratio"]));
    let (mut within, mut all, mut below) = (0, 0, 0);
    for bench in benches {
        for entry in
            bench.entries.iter().filter(|entry| entry.formulation == entry.motion || entry.motion == entry.label)
        {
            let Ok(m) = &entry.outcome else { continue };
            let usual = match &m.usual {
                Ok(usual) => usual,
                Err(reason) => {
                    table.cells([&bench.scene[..], &entry.label, reason, "", "", "", "", ""].map(String::from));
                    continue;
                }
            };
            // nothing is known below the error of the reference
            let reached = usual.error.max(m.reference_error).max(f64::EPSILON);
            let single = bench.fastest(&entry.motion, reached);
            let ratio = single.map(|single| usual.seconds / single.seconds);
            all += 1;
            within += usize::from(ratio.is_none_or(|ratio| ratio <= WANTED));
            below += usize::from(usual.estimate.max(f64::EPSILON) < usual.error);
            table.cells([
                bench.scene.clone(),
                entry.label.clone(),
                format!("{}, {}", usual.form, usual.method.map_or("", Method::name)),
                short(1e3 * usual.seconds),
                if usual.error < reached { format!("< {reached:.0e}") } else { short(usual.error) },
                short(usual.estimate),
                single.map_or("none so accurate".into(), |single| short(1e3 * single.seconds)),
                ratio.map_or(String::new(), |ratio| format!("{ratio:.2}")),
            ]);
        }
    }
    let sentence = format!(
        "With tolerance 1e-10 and no other option deltaq chooses form, method and plan, and makes both runs. On {within} of {all} motions this takes at most {WANTED} \
         times as long as the fastest single run with this error. The error exceeds its estimate on {below}."
    );
    (table, sentence)
}

/// What was measured, motion by motion.
fn motions(benches: &[Bench]) -> Table {
    let columns = ["scene", "motion", ">states", ">from (s)", ">to (s)", "shortened", "reference", ">its error"];
    let mut table = Table::new(columns.into_iter().chain(["not measured because"]));
    for (bench, entry) in benches.iter().flat_map(|bench| bench.entries.iter().map(move |entry| (bench, entry))) {
        let named = [bench.scene.clone(), entry.label.clone()];
        let rest = match &entry.outcome {
            Ok(m) => {
                let shortened = if m.shortened { "a little before the motion's own end" } else { "" };
                let (from, to, error) = (short(m.span.0), short(m.span.1), format!("{:.1e}", m.reference_error));
                [m.states.to_string(), from, to, shortened.into(), m.reference.clone(), error, String::new()]
            }
            Err(reason) => ["", "", "", "", "", "", reason].map(String::from),
        };
        table.cells(named.into_iter().chain(rest));
    }
    table
}

/// For each method and error, milliseconds and evaluations.
fn settings(benches: &[Bench]) -> Table {
    let targets =
        TARGETS.iter().flat_map(|target| [format!(">ms to {target:.0e}"), format!(">evaluations to {target:.0e}")]);
    let columns = ["scene", "motion", "method"].map(String::from).into_iter();
    let mut table = Table::new(columns.chain(targets).chain([">least error".to_string()]));
    for (bench, entry) in benches.iter().flat_map(|bench| bench.entries.iter().map(move |entry| (bench, entry))) {
        let Ok(m) = &entry.outcome else { continue };
        for series in &m.series {
            let found = TARGETS.iter().flat_map(|&target| match m.fastest(target, Some(series.method)) {
                Some(f) => [short(1e3 * f.seconds), f.work.evaluations.to_string()],
                None => ["–"; 2].map(String::from),
            });
            let least = series.points.iter().filter_map(|p| Some(p.outcome.as_ref().ok()?.error)).reduce(f64::min);
            let least = least.map_or("–".into(), |e| format!("{e:.1e}"));
            let named = [bench.scene.clone(), entry.label.clone(), series.method.name().to_string()];
            table.cells(named.into_iter().chain(found).chain([least]));
        }
    }
    table
}

/// Settings that failed, those of a method with the same cause together.
fn failed(benches: &[Bench]) -> Table {
    let mut table = Table::new(["scene", "motion", "what failed"]);
    for (bench, entry) in benches.iter().flat_map(|bench| bench.entries.iter().map(move |entry| (bench, entry))) {
        let Ok(m) = &entry.outcome else { continue };
        m.series.iter().flat_map(failures).for_each(|what| table.row(&[&bench.scene, &entry.label, &what]));
    }
    table
}

/// The fastest setting for every error, for a terminal.
pub fn bench_table(benches: &[Bench]) -> String {
    fastest_settings(benches).to_string()
}

/// The fastest setting for every error, scene by scene.
fn fastest_settings(benches: &[Bench]) -> Table {
    let columns = ["scene", "formulation", ">read, derive, compile (ms)"].map(String::from);
    let mut table = Table::new(columns.into_iter().chain(TARGETS.map(|target| format!("error ≤ {target:.0e}"))));
    for bench in benches {
        for entry in &bench.entries {
            let (setup, found) = match &entry.outcome {
                Ok(m) => {
                    let setup = [bench.parse, m.derive, m.compile].map(|s| short(1e3 * s)).join(", ");
                    (setup, TARGETS.map(|target| fastest(m.fastest(target, None))))
                }
                Err(reason) => {
                    let mut found = [""; TARGETS.len()].map(String::from);
                    found[0] = format!("not measured: {reason}");
                    ("–".into(), found)
                }
            };
            table.cells([bench.scene.clone(), entry.label.clone(), setup].into_iter().chain(found));
        }
    }
    table
}

fn fastest(found: Option<Fastest>) -> String {
    found.map_or("not reached".into(), |f| {
        format!("{} ms, {} at {:.0e}", short(1e3 * f.seconds), f.method.name(), f.tolerance)
    })
}

/// Throughput of ensembles: what was measured, and how.
pub fn ensemble_text(measured: &[Throughput]) -> String {
    let Some(first) = measured.first() else { return String::new() };
    let mut text = format!(
        "Sledges with random starts, {} of each formulation, by `taylor` at {:.0e} over the time of the scene: one by one, eight at a time in the lanes of \
         the processor's vectors, and in lanes over {} cores. Compiled once, states at the end only. *Start* is the time to find what a member starts from, in no other column. \
         *Lanes* is the throughput in lanes over that one by one, *cores* that over all cores \
         over that on one. *Processor time* is that spent in lanes on one core over that spent together on all: 1 where dividing the work costs nothing, whatever else runs on \
         the machine. *Difference* is the largest of a state at the end, one by one and in lanes; over the cores there is none, to the last bit{}.\n\n",
        first.members,
        first.tolerance,
        first.threads,
        if measured.iter().all(|m| m.over_cores == 0.0) { "" } else { " (**not so here**)" },
    );
    let [times, ratios] = ensemble_tables(measured);
    let _ = write!(text, "Microseconds per member:\n\n{times}\nRatios:\n\n{ratios}");
    for (label, why) in measured.iter().filter_map(|m| Some((&m.label, m.alone.1.as_ref()?))) {
        let _ = writeln!(text, "\n{label}, the first that went alone: {why}.");
    }
    text
}

/// Microseconds per member, and ratios.
fn ensemble_tables(measured: &[Throughput]) -> [Table; 2] {
    let columns = ["formulation", ">members", ">steps, one by one and in lanes", ">start", ">one by one", ">lanes"];
    let mut times = Table::new(columns.into_iter().chain([">all cores"]));
    let columns = ["formulation", ">lanes", ">cores", ">processor time", ">difference", ">alone"];
    let mut ratios = Table::new(columns);
    for m in measured {
        let steps = m.mean_steps().map(|steps| format!("{steps:.1}")).join(", ");
        let [single, lanes, cores] = m.microseconds();
        let each = [1e6 * m.prepare / m.members as f64, single, lanes, cores].map(short);
        times.cells([m.label.clone(), m.members.to_string(), steps].into_iter().chain(each));
        let over = [m.over_single(), m.over_one_core()].map(|ratio| format!("{ratio:.2}"));
        let efficiency = m.efficiency().map_or("–".into(), |e| format!("{e:.2}"));
        let rest = [efficiency, format!("{:.1e}", m.difference), m.alone.0.to_string()];
        ratios.cells([m.label.clone()].into_iter().chain(over).chain(rest));
    }
    [times, ratios]
}

/// Failed settings of a method, those with the same cause together.
fn failures(series: &Series) -> Vec<String> {
    let mut causes: Vec<(&str, Vec<String>)> = Vec::new();
    for point in &series.points {
        if let Err(cause) = &point.outcome {
            let tolerance = format!("{:.0e}", point.tolerance);
            match causes.iter_mut().find(|(known, _)| known == cause) {
                Some((_, tolerances)) => tolerances.push(tolerance),
                None => causes.push((cause, vec![tolerance])),
            }
        }
    }
    let name = series.method.name();
    causes.into_iter().map(|(cause, tolerances)| format!("{name} at {}: {cause}", enumerate(&tolerances))).collect()
}

/// Which method is fastest on most motions of a scene.
fn title(bench: &Bench) -> String {
    let measured = bench.entries.iter().filter_map(|entry| entry.outcome.as_ref().ok());
    let winners: Vec<&str> = measured
        .filter_map(|m| m.fastest(Settings::default().tolerance, None))
        .map(|fastest| fastest.method.name())
        .collect();
    let wins = |name: &str| winners.iter().filter(|other| **other == name).count();
    match winners.iter().max_by_key(|name| wins(name)) {
        Some(first) => format!(
            "{}: {first} is fastest to {:.0e} on {} of {} motions",
            bench.title,
            Settings::default().tolerance,
            wins(first),
            winners.len()
        ),
        None => format!("{}: error against run time", bench.title),
    }
}

fn picture(bench: &Bench) -> Result<String, PictureError> {
    let panel = |entry: &Entry| -> Option<Panel> {
        let m = entry.outcome.as_ref().ok()?;
        let mut curves: Vec<Curve> = m.series.iter().enumerate().map(|(i, series)| curve(i, series)).collect();
        if let Ok(usual) = &m.usual {
            let points = vec![(1e3 * usual.seconds, usual.error)];
            curves.push(Curve { label: "default, both runs".into(), style: Style::Ink, points });
        }
        let drawn = curves.iter().any(|curve| !curve.points.is_empty());
        let panel = Panel::new(Axis::log("error (m √kg)"), curves);
        drawn.then(|| Panel { title: entry.label.clone(), ..panel })
    };
    let panels = bench.entries.iter().filter_map(panel).collect();
    Picture::panels(title(bench), Axis::log("run time (ms)"), panels, 2).to_svg()
}

fn curve(index: usize, series: &Series) -> Curve {
    let points = series.points.iter().filter_map(|p| {
        let m = p.outcome.as_ref().ok()?;
        Some((1e3 * m.seconds, m.error))
    });
    Curve { label: series.method.name().into(), style: Style::Member(index as u8), points: points.collect() }
}

/// Everything that was measured, for machines.
pub fn bench_json(benches: &[Bench]) -> Value {
    let point = |p: &crate::Point| match &p.outcome {
        Ok(m) => json!({
            "tolerance": p.tolerance, "seconds": m.seconds, "error": m.error, "steps": m.work.steps,
            "rejected": m.work.rejected, "evaluations": m.work.evaluations, "jacobians": m.work.jacobians, "orders": m.work.orders,
        }),
        Err(cause) => json!({ "tolerance": p.tolerance, "failed": cause }),
    };
    let series =
        |s: &Series| json!({ "method": s.method.name(), "points": s.points.iter().map(point).collect::<Vec<_>>() });
    let entry = |e: &Entry| match &e.outcome {
        Ok(m) => json!({
            "label": e.label, "formulation": e.formulation, "derive": m.derive, "compile": m.compile,
            "states": m.states, "start": m.span.0, "end": m.span.1, "reference": m.reference,
            "reference error": m.reference_error, "series": m.series.iter().map(series).collect::<Vec<_>>(),
        }),
        Err(reason) => json!({ "label": e.label, "formulation": e.formulation, "not measured": reason }),
    };
    let bench = |b: &Bench| json!({ "scene": b.scene, "parse": b.parse, "motions": b.entries.iter().map(entry).collect::<Vec<_>>() });
    json!({ "unit of times": "s", "scenes": benches.iter().map(bench).collect::<Vec<_>>() })
}

/// Throughput of ensembles for machines, times in seconds.
pub fn ensemble_json(measured: &[Throughput]) -> Value {
    let time = |t: &Time| json!({ "clock": t.clock, "processors": t.processors });
    let of = |m: &Throughput| {
        json!({
            "label": m.label, "tolerance": m.tolerance, "members": m.members, "alone": m.alone,
            "prepare": m.prepare, "one_by_one": time(&m.one_by_one), "lanes": time(&m.lanes), "cores": time(&m.cores),
            "threads": m.threads, "steps": m.steps, "difference": m.difference, "over_cores": m.over_cores,
        })
    };
    json!({ "formulations": measured.iter().map(of).collect::<Vec<_>>() })
}
