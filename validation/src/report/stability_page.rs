//! The page about stiff and extreme cases.

use anyhow::Result;
use diffsol_methods::EVERY;
use serde_json::{Map, Value, json};

use crate::stability::{
    Answering, CASES, Case, Cell, LONG_RUNS, LongRun, MAX_STEPS, MILLION, Texts, Verdict, long_runs, run, tolerance,
};
use comparison::words::{enumerate, short};
use pages::{DataPackage, Table, fill};
use picture::{Axis, Curve, Picture, Style};
use program::File;

/// Cases that are drawn, the formulation that is, what becomes hard, and the axis.
const DRAWN: [(&str, &str, &str, &str); 5] = [
    ("viscous", "Newton, with friction", "Friction of strength N", "friction N over mass (1/s)"),
    ("added-mass", "Newton, with added mass", "Added mass of strength N", "added mass N over mass"),
    ("cone-apex", "Chetaev", "Ball that passes the apex of its cone at distance d", "distance d (m)"),
    ("dependent", "Chetaev", "Constraints that differ by d", "difference d of two constraints, relative"),
    ("sledge-k", "vakonomic", "Vakonomic sledge of radius of gyration k", "radius of gyration k (m)"),
];

/// Every method on some cases.
pub struct StabilityReport {
    /// Answers to the questions of the cases.
    pub cells: Vec<Cell>,
    /// Runs of a million steps.
    pub runs: Vec<LongRun>,
}

impl StabilityReport {
    /// Runs the cases that are chosen by name, [`LONG_RUNS`] among them.
    ///
    /// # Errors
    /// Where a reference cannot be computed.
    pub fn new(chosen: impl Fn(&str) -> bool, quiet: bool) -> Result<StabilityReport> {
        let cases: Vec<&Case> = CASES.iter().filter(|case| chosen(case.name)).collect();
        let cells = run(&cases, quiet)?;
        Ok(StabilityReport { cells, runs: if chosen(LONG_RUNS) { long_runs(quiet)? } else { Vec::new() } })
    }

    /// Number of answers.
    pub fn answers(&self) -> usize {
        self.cells.len() + self.runs.len()
    }

    /// Number of answers with that verdict.
    pub fn count(&self, word: &str) -> usize {
        let verdicts = self.cells.iter().map(|cell| &cell.verdict).chain(self.runs.iter().map(|run| &run.verdict));
        verdicts.filter(|verdict| verdict.word() == word).count()
    }

    /// What a command complains of where an answer is wrong.
    pub fn complaint(&self) -> Option<String> {
        let (wrong, answers) = (self.count("wrong"), self.answers());
        (wrong > 0).then(|| format!("{wrong} of {answers} cells are wrong"))
    }

    /// Every answer with its figures, a line each.
    pub fn text(&self) -> String {
        let line = |place: &str, point: f64, formulation: &str, method: &str, verdict: &Verdict| {
            let figures = figures(verdict);
            format!("{place:<15} {point:>9.2e} {formulation:<24} {method:<9} {:<9}{figures}", verdict.word())
        };
        let cells = self
            .cells
            .iter()
            .map(|cell| line(cell.case, cell.point, &cell.formulation, cell.method.name(), &cell.verdict) + "\n");
        let runs = self.runs.iter().map(|run| {
            let line = line(run.scene, run.duration, &run.formulation, run.stepping.name(), &run.verdict);
            let LongRun { steps, energy, trend, constraint, .. } = run;
            format!("{line}; {steps} steps, energy {energy:.1e}, its trend {trend:.1e}, constraint {constraint:.1e}\n")
        });
        cells.chain(runs).collect()
    }

    /// Every answer with its figures, for machines.
    pub fn json(&self) -> Value {
        let runs = self.runs.iter().map(|run| {
            let mut value = json!(run);
            value["case"] = LONG_RUNS.into();
            value
        });
        self.cells.iter().map(|cell| json!(cell)).chain(runs).collect()
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let wrong = match self.count("wrong") {
            0 => "No answer is silently wrong".to_owned(),
            1 => "One answer is silently wrong".to_owned(),
            wrong => format!("{wrong} answers are silently wrong"),
        };
        format!(
            "{wrong}: of {} answers of {} methods and of structure-preserving steps on stiff and extreme cases, {} are accurate, {} inaccurate but flagged, {} stopped with a reason.",
            self.answers(),
            EVERY.len(),
            self.count("accurate"),
            self.count("admitted"),
            self.count("refused")
        )
    }

    /// The verdicts for machines: one word per cell.
    pub fn verdicts(&self) -> Value {
        let mut cases = Map::new();
        for cell in &self.cells {
            let line = format!("{} = {:e}, {}", variable(cell.case), cell.point, cell.formulation);
            let words = &mut cases.entry(cell.case).or_insert_with(|| json!({}))[line];
            words[cell.method.name()] = cell.verdict.word().into();
        }
        let mut runs = Map::new();
        for run in &self.runs {
            let line = format!("{}, {:e}, {}", run.scene, run.duration, run.formulation);
            runs.entry(line).or_insert_with(|| json!({}))[run.stepping.name()] = run.verdict.word().into();
        }
        json!({ "wrong": self.count("wrong"), "cases": cases, "million_steps": runs })
    }

    /// The page, its pictures, and every answer as a table.
    ///
    /// # Errors
    /// Where a picture cannot be drawn.
    pub fn files(&self) -> Result<Vec<File>> {
        let data = self.data();
        let mut files = vec![File { path: "evidence/stability.md".into(), text: self.page(&data) }];
        for (case, ..) in DRAWN.iter().filter(|(name, ..)| self.has(name)) {
            files.push(File { path: format!("evidence/{}", picture_name(case)).into(), text: self.picture(case)? });
        }
        Ok(files.into_iter().chain(data.files()).collect())
    }

    fn page(&self, data: &DataPackage) -> String {
        let asked = Answering::methods().filter_map(|by| match by {
            Answering::Method(method) => Some(format!("{} {:.0e}", by.name(), tolerance(method))),
            Answering::Steps(_) => None,
        });
        let tolerances: Vec<String> = asked.collect();
        let drawn = DRAWN.iter().filter(|(name, ..)| self.has(name));
        let images = drawn.map(|(name, ..)| format!("![{}]({})\n\n", self.title(name), picture_name(name)));
        let auto = |word: Option<&str>| {
            let auto = self.cells.iter().filter(|cell| cell.method == Answering::Method(None));
            auto.filter(|cell| word.is_none_or(|word| cell.verdict.word() == word)).count()
        };
        let flagged = auto(Some("admitted")) + auto(Some("refused"));
        fill(
            include_str!("pages/stability.md"),
            &[
                ("headline", &self.headline()),
                ("auto_accurate", &auto(Some("accurate"))),
                ("auto", &auto(None)),
                ("auto_flagged", &flagged),
                ("auto_wrong", &auto(Some("wrong"))),
                ("max_steps", &MAX_STEPS),
                ("million", &MILLION),
                ("tolerances", &tolerances.join(", ")),
                ("pictures", &images.collect::<String>()),
                ("summary", &self.summary()),
                ("data", &data.list(1)),
            ],
        )
    }

    fn has(&self, case: &str) -> bool {
        self.cells.iter().any(|cell| cell.case == case)
    }

    /// Every answer, every long run, and what each case is about.
    fn data(&self) -> DataPackage {
        let columns = ["case", "variable", ">value", "formulation", "method", "verdict", ">error", ">estimate"];
        let mut answers = Table::new(columns.into_iter().chain([">stopped at (s)", "cause"]));
        for cell in &self.cells {
            let asked = [cell.case, variable(cell.case)].map(String::from).into_iter().chain([short(cell.point)]);
            let by = [cell.formulation.clone(), cell.method.name().into()];
            answers.cells(asked.chain(by).chain(judged(&cell.verdict)));
        }
        let columns = ["scene", "formulation", ">duration (s)", "method", ">steps", ">energy", ">trend", ">constraint"];
        let judgement = ["verdict", ">error", ">estimate", ">stopped at (s)", "cause"];
        let mut long = Table::new(columns.into_iter().chain(judgement));
        for run in &self.runs {
            let asked = [run.scene.to_owned(), run.formulation.clone(), short(run.duration)];
            let by = [run.stepping.name().to_owned(), run.steps.to_string()];
            let lost = [run.energy, run.trend, run.constraint].map(short);
            long.cells(asked.into_iter().chain(by).chain(lost).chain(judged(&run.verdict)));
        }
        let mut cases = Table::new(["case", "variable", "about", "reference"]);
        for case in CASES.iter().filter(|case| self.has(case.name)) {
            let Texts { about, reference, variable } = &case.texts;
            cases.row(&[&case.name, variable, about, reference]);
        }
        let mut data = DataPackage::new("data/stability", "Stiff and extreme cases: every answer of every method");
        data.table("answers", "Every answer, with error, estimate and cause of a stop", &answers);
        data.table("cases", "What each case is about, and its reference", &cases);
        data.table("million-steps", "Drift of energy and constraint over long runs", &long);
        data
    }

    /// How many answers of each case have which verdict.
    fn summary(&self) -> Table {
        let words = ["accurate", "admitted", "refused", "wrong"];
        let columns = ["case", ">answers", ">accurate", ">flagged", ">stopped", ">wrong", ">`auto` accurate"];
        let mut table = Table::new(columns);
        let mut row = |case: &str, answers: &[(&Verdict, bool)]| {
            let of = |word: &str| answers.iter().filter(|(verdict, _)| verdict.word() == word).count().to_string();
            let auto = answers.iter().filter(|(_, auto)| *auto).collect::<Vec<_>>();
            let accurate = auto.iter().filter(|(verdict, _)| verdict.word() == words[0]).count();
            let auto = if auto.is_empty() { "–".into() } else { format!("{accurate} of {}", auto.len()) };
            let counts = [answers.len().to_string()].into_iter().chain(words.map(of));
            table.cells([case.to_owned()].into_iter().chain(counts).chain([auto]));
        };
        for case in CASES.iter().filter(|case| self.has(case.name)) {
            let cells = self.cells.iter().filter(|cell| cell.case == case.name);
            let answers = cells.map(|cell| (&cell.verdict, cell.method == Answering::Method(None)));
            row(case.name, &answers.collect::<Vec<_>>());
        }
        if !self.runs.is_empty() {
            row(LONG_RUNS, &self.runs.iter().map(|run| (&run.verdict, false)).collect::<Vec<_>>());
        }
        table
    }

    /// The cells of a case that is drawn, by method.
    fn drawn<'a>(&'a self, name: &str) -> Vec<(Answering, Vec<&'a Cell>)> {
        let formulation = DRAWN.iter().find(|(case, ..)| *case == name).map_or("", |(_, formulation, ..)| formulation);
        let of = |by: Answering| {
            let cells = self.cells.iter().filter(|c| c.case == name && c.formulation == formulation && c.method == by);
            (by, cells.collect())
        };
        Answering::methods().map(of).collect()
    }

    /// What a picture shows: how often the default reaches the end, and which methods always do.
    fn title(&self, name: &str) -> String {
        let what = DRAWN.iter().find(|(case, ..)| *case == name).map_or(name, |(_, _, what, _)| what);
        let all = self.drawn(name);
        let ends = |cells: &[&Cell]| cells.iter().filter(|c| !matches!(c.verdict, Verdict::Refused { .. })).count();
        let (_, of_default) = &all[0];
        let own = format!("{what}: the default reaches the end at {} of {} values", ends(of_default), of_default.len());
        let others = all[1..].iter().filter(|(_, cells)| ends(cells) == cells.len());
        let others: Vec<String> = others.map(|(by, _)| by.name().to_owned()).collect();
        match others.len() {
            0 => format!("{own}, no method at all of them"),
            _ => format!("{own}, {} at all", enumerate(&others)),
        }
    }

    fn picture(&self, name: &str) -> Result<String> {
        let all = self.drawn(name);
        let error = |cell: &Cell| match cell.verdict {
            Verdict::Accurate { error, .. } | Verdict::Admitted { error, .. } | Verdict::Wrong { error, .. } => {
                // what is under round-off stands on the axis
                Some((cell.point, error.max(f64::EPSILON)))
            }
            Verdict::Refused { .. } => None,
        };
        let (mut curves, mut stops) = (Vec::new(), Vec::new());
        for (i, (by, cells)) in all.iter().enumerate() {
            let style = if i == 0 { Style::Ink } else { Style::Member(i as u8 - 1) };
            let label = if i == 0 { "auto (default)" } else { by.name() };
            let points: Vec<Option<(f64, f64)>> = cells.iter().map(|cell| error(cell)).collect();
            stops.extend(points.windows(2).filter_map(|pair| pair[0].xor(pair[1])));
            // a line breaks where an answer is refused
            let lines =
                points.split(Option::is_none).map(|points| points.iter().copied().flatten().collect::<Vec<_>>());
            let curve = |points| Curve { label: label.into(), style, points };
            curves.extend(lines.filter(|points| !points.is_empty()).map(curve));
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        if !stops.is_empty() {
            curves.push(Curve { label: "stops beyond, with a reason".into(), style: Style::Stops, points: stops });
        }
        let axis = DRAWN.iter().find(|(case, ..)| *case == name).map_or(name, |(.., axis)| axis);
        let (x, y) = (Axis::log(axis), Axis::log("largest error over distance travelled"));
        Ok(Picture::new(self.title(name), x, y, curves).to_svg()?)
    }
}

fn picture_name(case: &str) -> String {
    format!("stability-{case}.svg")
}

fn variable(case: &str) -> &'static str {
    CASES.iter().find(|c| c.name == case).map_or("", |c| &c.texts.variable)
}

/// Verdict, error, estimate, time and cause of a stop: the last columns of a table.
fn judged(verdict: &Verdict) -> [String; 5] {
    let (numbers, cause) = match verdict {
        Verdict::Accurate { error, estimate } | Verdict::Admitted { error, estimate } => {
            ([Some(*error), Some(*estimate), None], "")
        }
        Verdict::Refused { t, cause } => ([None, None, *t], &cause[..]),
        Verdict::Wrong { error, estimate, t } => ([Some(*error), Some(*estimate), Some(*t)], ""),
    };
    let [error, estimate, t] = numbers.map(|x| x.map_or(String::new(), short));
    let word = match verdict.word() {
        "admitted" => "flagged",
        "refused" => "stopped",
        word => word,
    };
    [word.into(), error, estimate, t, cause.lines().next().unwrap_or_default().into()]
}

fn figures(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Accurate { error, estimate } | Verdict::Admitted { error, estimate } => {
            format!("error {error:.1e}, estimate {estimate:.1e}")
        }
        Verdict::Refused { t: None, cause } => cause.clone(),
        Verdict::Refused { t: Some(t), cause } => format!("at t = {t:.6e}: {cause}"),
        Verdict::Wrong { error, estimate, t } => format!("at t = {t:.3e}: error {error:.1e}, estimate {estimate:.1e}"),
    }
}
