//! The page about stiff and extreme cases.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::Result;
use diffsol_methods::EVERY;
use discrete::Composition;
use integrate::Method;
use serde_json::{Map, Value, json};

use crate::stability::{
    Answering, CASES, Case, Cell, LONG_RUNS, LongRun, MAX_STEPS, MILLION, Texts, Verdict, long_runs, run, tolerance,
};
use comparison::words::short;
use pages::markdown::folded;
use pages::{Table, fill};
use picture::{Axis, Curve, Picture, Style};
use program::File;

/// Cases that are drawn, with the formulation that is.
const DRAWN: [(&str, &str); 2] = [("viscous", "Newton, with friction"), ("added-mass", "Newton, with added mass")];

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
        format!(
            "Stiff and extreme cases, {} answers of {} methods and of structure-preserving steps: {} accurate, {} inaccurate and said so, {} refused with time and cause, {} wrong.",
            self.answers(),
            EVERY.len(),
            self.count("accurate"),
            self.count("admitted"),
            self.count("refused"),
            self.count("wrong")
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

    /// The page and its pictures.
    ///
    /// # Errors
    /// Where a picture cannot be drawn.
    pub fn files(&self) -> Result<Vec<File>> {
        let mut files = vec![File { path: "stability.md".into(), text: self.page() }];
        for (name, formulation) in DRAWN.into_iter().filter(|(name, _)| self.has(name)) {
            files.push(File { path: picture_name(name).into(), text: self.picture(name, formulation)? });
        }
        Ok(files)
    }

    fn page(&self) -> String {
        let asked = Answering::methods().filter_map(|by| match by {
            Answering::Method(method) => Some(format!("{} {:.0e}", by.name(), tolerance(method))),
            Answering::Steps(_) => None,
        });
        let tolerances: Vec<String> = asked.collect();
        let cases = CASES.iter().filter(|case| self.has(case.name)).map(|case| self.section(case));
        fill(
            include_str!("pages/stability.md"),
            &[
                ("headline", &self.headline()),
                ("max_steps", &MAX_STEPS),
                ("tolerances", &tolerances.join(", ")),
                ("summary", &self.summary()),
                ("cases", &cases.collect::<String>()),
                ("long_runs", &self.long_runs()),
            ],
        )
    }

    fn has(&self, case: &str) -> bool {
        self.cells.iter().any(|cell| cell.case == case)
    }

    fn long_runs(&self) -> String {
        if self.runs.is_empty() {
            return String::new();
        }
        let columns = ["motion", "method", ">steps", ">energy", ">trend", ">constraint"];
        let mut table = Table::new(columns.into_iter().chain([">error", ">estimate"]));
        for run in &self.runs {
            let estimate = match run.verdict {
                Verdict::Accurate { estimate, .. }
                | Verdict::Admitted { estimate, .. }
                | Verdict::Wrong { estimate, .. } => short(estimate),
                Verdict::Refused { .. } => String::new(),
            };
            let motion = format!("{}, {}, {} s", run.scene, run.formulation, short(run.duration));
            let run_of = [motion, run.stepping.name().into()];
            let lost = [run.energy, run.trend, run.constraint].map(short);
            let judgement = [words(&run.verdict), estimate];
            table.cells(run_of.into_iter().chain([run.steps.to_string()]).chain(lost).chain(judgement));
        }
        fill(include_str!("pages/million-steps.md"), &[("million", &MILLION), ("table", &table)])
    }

    fn section(&self, case: &Case) -> String {
        let cells: Vec<&Cell> = self.cells.iter().filter(|cell| cell.case == case.name).collect();
        let Texts { about, reference, variable } = &case.texts;
        let mut page = format!("\n## {}\n\n{about}\n\n*Reference*: {reference}.\n\n", case.name);
        if DRAWN.iter().any(|(name, _)| *name == case.name) {
            let _ = writeln!(page, "![Error over {variable}]({})\n", picture_name(case.name));
        }
        let count = if matches!(cells[0].method, Answering::Method(_)) {
            Answering::methods().count()
        } else {
            Composition::ALL.len()
        };
        let mut answers = String::new();
        let mut lines: Vec<&[&Cell]> = cells.chunks(count).collect();
        let order: Vec<&str> = lines.iter().map(|line| &line[0].formulation[..]).collect();
        lines.sort_by_key(|line| order.iter().position(|name| *name == line[0].formulation));
        for lines in lines.chunk_by(|a, b| a[0].formulation == b[0].formulation) {
            let methods = cells[..count].iter().map(|cell| format!(">{}", cell.method.name()));
            let mut table = Table::new([format!(">{variable}")].into_iter().chain(methods));
            for line in lines {
                let words = line.iter().map(|cell| words(&cell.verdict));
                table.cells([short(line[0].point)].into_iter().chain(words));
            }
            let _ = writeln!(answers, "{}\n\n{table}", lines[0][0].formulation);
        }
        let mut causes: BTreeMap<String, (usize, &str)> = BTreeMap::new();
        for cell in &cells {
            if let Verdict::Refused { cause, .. } = &cell.verdict {
                causes.entry(kind_of(cause)).or_insert((0, clause_of(cause))).0 += 1;
            }
        }
        if !causes.is_empty() {
            let of = |(count, first): (usize, &str)| match count {
                1 => format!("- once: {first}\n"),
                _ => format!("- {count} times, first: {first}\n"),
            };
            let _ = write!(answers, "Causes of refusals:\n\n{}", causes.into_values().map(of).collect::<String>());
        }
        let _ = writeln!(page, "{}", folded(&format!("{} answers", cells.len()), &answers));
        page
    }

    /// How many answers of each case have which verdict.
    fn summary(&self) -> Table {
        let words = ["accurate", "admitted", "refused", "wrong"];
        let columns = ["case", ">answers", ">accurate", ">said so", ">refused", ">wrong", ">`auto` accurate"];
        let mut table = Table::new(columns);
        let mut row = |case: &str, answers: &[(&Verdict, bool)]| {
            let of = |word: &str| answers.iter().filter(|(verdict, _)| verdict.word() == word).count().to_string();
            let auto = answers.iter().filter(|(_, auto)| *auto).collect::<Vec<_>>();
            let accurate = auto.iter().filter(|(verdict, _)| verdict.word() == words[0]).count();
            let auto = if auto.is_empty() { "–".into() } else { format!("{accurate} of {}", auto.len()) };
            let counts = [answers.len().to_string()].into_iter().chain(words.map(of));
            table.cells([format!("[{case}](#{case})")].into_iter().chain(counts).chain([auto]));
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

    fn picture(&self, name: &str, formulation: &str) -> Result<String> {
        let of = |(i, method): (usize, &Method)| {
            let cells = self.cells.iter().filter(|c| {
                c.case == name && c.formulation == formulation && c.method == Answering::Method(Some(*method))
            });
            let points = cells.map(|cell| match cell.verdict {
                Verdict::Accurate { error, .. } | Verdict::Admitted { error, .. } | Verdict::Wrong { error, .. } => {
                    Some((cell.point, error))
                }
                Verdict::Refused { .. } => None,
            });
            // a line breaks where an answer is refused
            let points: Vec<Option<(f64, f64)>> = points.collect();
            let curve = |points: &[Option<(f64, f64)>]| Curve {
                label: method.name().into(),
                style: Style::Member(i as u8),
                points: points.iter().copied().flatten().collect(),
            };
            points.split(Option::is_none).map(curve).collect::<Vec<Curve>>()
        };
        let title = format!("{name}: true error, lines where nothing is refused");
        let (x, y) = (Axis::log(variable(name)), Axis::log("error over distance"));
        let curves = EVERY.iter().enumerate().flat_map(of).collect();
        Ok(Picture::new(title, x, y, curves).to_svg()?)
    }
}

fn picture_name(case: &str) -> String {
    format!("stability-{case}.svg")
}

fn variable(case: &str) -> &'static str {
    CASES.iter().find(|c| c.name == case).map_or("", |c| &c.texts.variable)
}

fn words(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Accurate { error, .. } => short(*error),
        Verdict::Admitted { error, .. } => format!("*{}*", short(*error)),
        Verdict::Refused { t: Some(t), .. } => format!("to {}", short(*t)),
        Verdict::Refused { t: None, .. } => "refused".into(),
        Verdict::Wrong { error, estimate, .. } => {
            format!("**wrong**: {}, estimate {}", short(*error), short(*estimate))
        }
    }
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

/// The first clause of a cause, without the place in a scene.
fn clause_of(cause: &str) -> &str {
    let first = cause.lines().next().unwrap_or_default();
    let clause = first.split_once(": ").filter(|(place, _)| place.contains(':')).map_or(first, |(_, rest)| rest);
    clause.split("; ").next().unwrap_or_default()
}

/// The first clause of a cause without its figures: what causes of one kind have in common.
fn kind_of(cause: &str) -> String {
    let figure = |word: &&str| !word.starts_with(|c: char| c.is_ascii_digit());
    clause_of(cause).split(' ').filter(figure).collect::<Vec<_>>().join(" ")
}
