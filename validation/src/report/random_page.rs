//! The page about random systems.

use anyhow::Result;
use serde_json::{Map, Value, json};

use comparison::words::{enumerate, or_dash, short};
use pages::{DataPackage, Table, fill};
use picture::{Axis, Curve, Panel, Picture, Style};
use program::File;
use random::{Batch, Count, DIVERGES, DURATION, NEAREST, Record, Summary, theorem_title};

/// The part of the verdicts on a theorem that may be undecided.
const UNDECIDED: f64 = 0.02;

/// Bins of the histogram of exponents, and their width.
const BINS: usize = 31;
const WIDTH: f64 = 0.1;

/// Where bin `k` begins: the first is round an exponent of 1.
fn edge(k: usize) -> f64 {
    1.0 + WIDTH * (k as f64 - 0.5)
}

/// A page, its pictures, and the shrunk counterexamples as scene files.
///
/// # Errors
/// Where a picture cannot be drawn.
pub fn random_files(batch: &Batch, records: &[Record]) -> Result<Vec<File>> {
    let summary = Summary::of(records);
    let mut files = vec![
        File { path: "evidence/random-times.svg".into(), text: times(&summary)? },
        File { path: "evidence/random-exponents.svg".into(), text: exponents(&summary)? },
    ];
    let mut counterexamples = Vec::new();
    for (theorem, scene) in batch.counterexamples(records) {
        let path = format!("evidence/counterexamples/{}.toml", scene.name);
        files.push(File { path: path.clone().into(), text: scene.to_toml() });
        counterexamples.push((theorem, path.trim_start_matches("evidence/").to_owned()));
    }
    let data = data(&summary, &open(batch, records));
    let text = page(batch, &summary, &counterexamples, &data);
    files.push(File { path: "evidence/random.md".into(), text });
    Ok(files.into_iter().chain(data.files()).collect())
}

/// The verdicts for machines: a word a theorem.
pub fn random_verdicts(batch: &Batch, records: &[Record]) -> Value {
    let summary = Summary::of(records);
    let theorems: Map<String, Value> =
        summary.theorems.iter().map(|(theorem, count)| (label(*theorem), word(*count).into())).collect();
    json!({ "seed": batch.seed, "systems": summary.systems, "theorems": theorems })
}

/// The word on a theorem with these verdicts: one in fifty may be undecided, and none may fail.
pub fn word(count: Count) -> &'static str {
    match count.fails {
        0 if count.undecided as f64 <= UNDECIDED * count.total() as f64 => "holds",
        0 => "undecided",
        _ => "fails",
    }
}

/// What a command complains of where a claim fails.
pub fn random_complaint(total: Count) -> Option<String> {
    (total.fails > 0).then(|| format!("{} of {} verdicts on theorems: a claim fails", total.fails, total.total()))
}

fn label(theorem: u8) -> String {
    if theorem == 0 { "within".into() } else { format!("T{theorem}") }
}

/// The first line of the page, which the overview repeats.
pub fn random_headline(records: &[Record]) -> String {
    headline(&Summary::of(records))
}

fn headline(summary: &Summary) -> String {
    let total = summary.total();
    let failing: Vec<String> = summary
        .theorems
        .iter()
        .filter(|(_, c)| c.fails > 0)
        .map(|(t, c)| format!("{} on {}", label(*t), c.fails))
        .collect();
    let verdict = match failing.as_slice() {
        [] => "no claim fails".to_string(),
        some => format!("claims fail: {}", enumerate(some)),
    };
    let undecided = 100.0 * total.undecided as f64 / total.total().max(1) as f64;
    format!(
        "On {} random systems {verdict} (T1 to T18); {} of {} verdicts ({} %) are undecided.",
        summary.systems,
        total.undecided,
        total.total(),
        short(undecided)
    )
}

/// How many verdicts are on systems on which the formulations have something to dispute.
fn at_stake(summary: &Summary) -> String {
    let (total, at_stake) = (summary.total().total(), summary.total_at_stake());
    let share = 100.0 * at_stake as f64 / total.max(1) as f64;
    format!(
        "{at_stake} of the {total} verdicts ({} %) concern systems on which at least two of Chetaev's, the vakonomic and the \
         coordinate-removal motion differ (*at stake*; the others are easier).",
        short(share)
    )
}

fn page(batch: &Batch, summary: &Summary, counterexamples: &[(u8, String)], data: &DataPackage) -> String {
    let mut claims = Table::new(["", "claim", ">holds", ">fails", ">undecided", ">at stake"]);
    for (theorem, Count { holds, fails, undecided }) in &summary.theorems {
        let at_stake = summary.at_stake.get(theorem).unwrap_or(&0);
        claims.row(&[&label(*theorem), &theorem_title(*theorem), holds, fails, undecided, at_stake]);
    }
    let (flagged, wrong) = counted(summary, "the wrong formulation is wrong, and flagged");
    let right = summary.claims.get(&12).and_then(|claims| claims.get("right in Chaplygin's integrable form"));
    let right = right.copied().unwrap_or_default();
    let worst = |what: &str, exponent: f64| {
        let values = observed(summary, what);
        let off = values.iter().fold(0.0_f64, |a, x| a.max((x - exponent).abs()));
        format!("{} systems, off by at most {}", values.len(), short(off))
    };
    let kinds: Vec<String> = summary.kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    fill(
        include_str!("pages/random.md"),
        &[
            ("headline", &headline(summary)),
            ("at_stake", &at_stake(summary)),
            ("claims", &claims),
            ("wrong", &wrong),
            ("flagged", &flagged),
            ("part", &short(100.0 * flagged as f64 / wrong.max(1) as f64)),
            ("right", &right.total()),
            ("right_called", &right.holds),
            ("three", &worst("growth exponent, mu0 = 0", 3.0)),
            ("two", &worst("growth exponent, mu0 not zero", 2.0)),
            ("open", &counterexample_words(counterexamples)),
            ("seed", &batch.seed),
            ("kinds", &enumerate(&kinds)),
            ("duration", &DURATION),
            ("shortened", &summary.shortened),
            ("data", &data.list(1)),
        ],
    )
}

/// The tables beside the page.
fn data(summary: &Summary, open: &Table) -> DataPackage {
    let mut pairs = Table::new(["pair", ">differ", ">of", ">median time of the gap 1e-3 (s)", ">passed by the end"]);
    for names in &DIVERGES {
        let (differ, of) = counted(summary, names.differs);
        let times = observed(summary, names.passes);
        let median = or_dash(times.get(times.len() / 2).copied());
        let pair = names.passes.trim_start_matches("tau(1e-3), ");
        pairs.row(&[&pair, &differ, &of, &median, &times.len()]);
    }
    let mut others = Table::new(["theorem", "what", ">so on", ">of"]);
    for (theorem, what, values) in counts(summary) {
        let so = values.iter().filter(|x| **x == 1.0).count();
        others.row(&[&label(theorem), &what, &so, &values.len()]);
    }
    let mut features = Table::new(["feature", ">systems"]);
    for (name, count) in &summary.features {
        features.row(&[name, count]);
    }
    let mut sizes = Table::new([">coordinates", ">constraints", ">systems"]);
    for (size, count) in &summary.sizes {
        let (n, h) = size.split_once(", ").unwrap_or((size, ""));
        sizes.row(&[&n, &h, count]);
    }
    let mut data = DataPackage::new("data/random", "Random systems");
    data.table("open", "Verdicts that are undecided or fail, system by system", open);
    data.table("pairs", "When motions differ, pair by pair", &pairs);
    data.table("counts", "Further counts, about which nothing is claimed", &others);
    data.table("measured", "Further figures: least, median, largest", &measured(summary));
    data.table("features", "Features of the systems, each drawn alone", &features);
    data.table("sizes", "Systems by numbers of coordinates and constraints", &sizes);
    data
}

/// Observations that are counted: 0 or 1. What the table of pairs shows already is left out.
fn counts(summary: &Summary) -> Vec<(u8, &str, &[f64])> {
    let shown = |what: &str| what == NEAREST || DIVERGES.iter().any(|names| names.differs == what);
    let all =
        summary.observed.iter().flat_map(|(t, by)| by.iter().map(|(what, values)| (*t, what.as_str(), &values[..])));
    all.filter(|(_, what, values)| !shown(what) && values.iter().all(|x| *x == 0.0 || *x == 1.0)).collect()
}

fn observed<'a>(summary: &'a Summary, what: &str) -> &'a [f64] {
    summary.observed.values().find_map(|by| by.get(what)).map_or(&[], |values| values)
}

fn counted(summary: &Summary, what: &str) -> (usize, usize) {
    let values = observed(summary, what);
    (values.iter().filter(|x| **x == 1.0).count(), values.len())
}

/// Figures that are neither counts nor shown in a picture.
fn measured(summary: &Summary) -> Table {
    let mut table = Table::new(["theorem", "what", ">least", ">median", ">largest", ">of"]);
    for (theorem, by) in &summary.observed {
        let is_shown = |what: &str| *theorem == 8 || *theorem == 9 || what == NEAREST;
        let is_count = |values: &[f64]| values.iter().all(|x| *x == 0.0 || *x == 1.0);
        for (what, values) in by.iter().filter(|(what, values)| is_shown(what) && !is_count(values)) {
            let [least, median, most] = [0, values.len() / 2, values.len() - 1].map(|i| short(values[i]));
            table.row(&[&label(*theorem), what, &least, &median, &most, &values.len()]);
        }
    }
    table
}

/// Verdicts that are not *holds*, system by system.
fn open(batch: &Batch, records: &[Record]) -> Table {
    let columns = ["system", "kind", "theorem", "claim", "verdict", ">figure", ">limit", "note"];
    let mut table = Table::new(columns);
    for (record, open) in records.iter().flat_map(|record| record.open.iter().map(move |open| (record, open))) {
        let [figure, limit] = open.figure.map_or(Default::default(), |(x, limit)| [x, limit].map(short));
        let (name, word) = (batch.name(record.index), open.word.to_string());
        table.row(&[&name, &record.kind, &label(open.theorem), &open.claim, &word, &figure, &limit, &open.note]);
    }
    table
}

/// The smallest systems on which a theorem fails.
fn counterexample_words(counterexamples: &[(u8, String)]) -> String {
    if counterexamples.is_empty() {
        return "No counterexample was found; deltaq would shrink one and write it as a scene file.\n".into();
    }
    let line = |(theorem, path): &(u8, String)| {
        format!("- Smallest system found on which {} fails: [{path}]({path}).\n", label(*theorem))
    };
    counterexamples.iter().map(line).collect()
}

const STYLES: [Style; 4] =
    [Style::ChetaevVakonomic, Style::ChetaevRemovedConstraint, Style::VakonomicRemovedConstraint, Style::Substituted];

/// Cumulative distribution of `τ(1e-3)`.
fn times(summary: &Summary) -> Result<String> {
    let curves = DIVERGES.iter().zip(STYLES).map(|(names, style)| {
        let (_, of) = counted(summary, names.differs);
        let mut points = vec![(0.0, 0.0)];
        let mut part = 0.0;
        for (k, &t) in observed(summary, names.passes).iter().enumerate() {
            points.push((t, part));
            part = (k + 1) as f64 / of as f64;
            points.push((t, part));
        }
        points.push((DURATION, part));
        Curve { label: names.passes.trim_start_matches("tau(1e-3), ").into(), style, points }
    });
    let x = Axis { range: Some((0.0, DURATION)), ..Axis::linear("t (s)") };
    let y = Axis { range: Some((0.0, 1.0)), ..Axis::linear("part of the systems") };
    let title = "Most pairs of formulations differ by 1e-3 within a second (nonholonomic random systems)";
    Ok(Picture::new(title, x, y, curves.collect()).to_svg()?)
}

/// Histograms of the growth exponents, as outlines.
fn exponents(summary: &Summary) -> Result<String> {
    let panels = DIVERGES.iter().zip(STYLES).map(|(names, style)| {
        let mut bins = [0_u32; BINS];
        for x in observed(summary, names.grows) {
            let bin = ((x - edge(0)) / WIDTH).floor();
            if bin >= 0.0 && bin < BINS as f64 {
                bins[bin as usize] += 1;
            }
        }
        let mut points = vec![(edge(0), 0.0)];
        for (k, &count) in bins.iter().enumerate() {
            let left = edge(k);
            points.extend([(left, f64::from(count)), (edge(k + 1), f64::from(count))]);
        }
        points.push((edge(BINS), 0.0));
        let highest = bins.iter().copied().max().unwrap_or(0).max(1);
        let y = Axis { range: Some((0.0, 1.05 * f64::from(highest))), ..Axis::linear("systems") };
        let label = names.grows.trim_start_matches("growth exponent, ").into();
        Panel::new(y, vec![Curve { label, style, points }])
    });
    let x = Axis { range: Some((edge(0), edge(BINS))), ..Axis::linear("exponent of t") };
    let title = "Gaps begin as t² or t³ (nonholonomic random systems)";
    Ok(Picture::panels(title, x, panels.collect(), 2).to_svg()?)
}
