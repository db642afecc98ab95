//! The page about stiff and extreme cases.

use std::collections::BTreeMap;
use std::fmt::Write;

use anyhow::Result;
use integrate::Method;
use serde_json::{Map, Value, json};

use crate::report::numbers::short;
use crate::report::{File, Table};
use crate::stability::{CASES, Case, Cell, LONG_RUNS, LongRun, MAX_STEPS, MILLION, Verdict, long_runs, run, tolerance};
use picture::{Axis, Curve, Picture, Style};

/// Lines of the pictures, method by method.
const STYLES: [Style; 4] = [Style::Chetaev, Style::Vakonomic, Style::RemovedConstraint, Style::Substituted];

/// Cases that are drawn, with the formulation that is.
const DRAWN: [(&str, &str); 2] = [("viscous", "Newton, with friction"), ("added-mass", "Newton, with added mass")];

/// Every method on some cases.
pub struct StabilityReport {
    cells: Vec<Cell>,
    runs: Vec<LongRun>,
}

impl StabilityReport {
    /// Runs the cases that are chosen by name, [`LONG_RUNS`] among them.
    ///
    /// # Errors
    /// Where a reference cannot be had.
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
            Method::ALL.len(),
            self.count("accurate"),
            self.count("admitted"),
            self.count("refused"),
            self.count("wrong")
        )
    }

    /// The verdicts for machines: a word a cell.
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
        let tolerances: Vec<String> =
            Method::ALL.iter().map(|&method| format!("{} {:.0e}", method.name(), tolerance(method))).collect();
        let mut page = format!("# Stiff and extreme cases\n\n**{}**\n\n", self.headline());
        let _ = writeln!(
            page,
            "Does a wrong trajectory ever come back in silence? Every method answers every question; each answer is compared, at 201 times, with a reference that \
             does not share the failure that the case is about.\n\n\
             - a number: *accurate*, the largest true error over the largest distance from the start. The error is under ten times the motion's own estimate (or under \
             1e-7, or under ten times the tolerance), and that estimate is under 1e-3.\n\
             - a number, *said so*: the same, but the estimate is over 1e-3, or the run says that it is no estimate: `deltaq solve` ends with exit code 3 and the reason.\n\
             - *to t = …*: stopped there, with a cause; what comes before is accurate in the same sense. *refused*: an error before the start.\n\
             - **wrong**: anything else.\n\n\
             A run may take {MAX_STEPS} steps, and is refused where it needs more: that is the budget of this page, not a limit of the methods. Tolerances of the looser of the two \
             runs: {}. Errors are distances in the kinetic metric. `deltaq stability --case NAME` prints every answer with its cause.",
            tolerances.join(", ")
        );
        for case in CASES.iter().filter(|case| self.has(case.name)) {
            self.section(&mut page, case);
        }
        if !self.runs.is_empty() {
            self.long_runs(&mut page);
        }
        page
    }

    fn has(&self, case: &str) -> bool {
        self.cells.iter().any(|cell| cell.case == case)
    }

    fn long_runs(&self, page: &mut String) {
        let _ = writeln!(
            page,
            "\n## million-steps\n\nWhat a long run loses. *Leapfrog* takes {MILLION} equal steps of order 2 that keep the structure of the motion (`--method leapfrog`); the others go as far, \
             with projection, in as many steps as their tolerance asks for. The \
             vakonomic and the removed-constraint sledge turn ever faster, so that equal steps do for a time only.\n\n\
             *Energy*: largest |E − E₀|, in parts of the largest v·Mv. *Trend*: how far the mean energies of ten parts of the run are apart; what is left of the energy error is \
             an oscillation. *Constraint*: largest |f|/(|∂f/∂v||v|). All read off at 20001 times, where the other methods have polynomials that no projection was applied to. *Places* have a verdict as above for the \
             sledge, whose *reference* is that of `sledge-long`. None reaches as far for the vakonomic disc: there the verdict is on *energy and constraint*, whose error has to be under ten times \
             the difference of the two runs' energies (or under 1e-7).\n"
        );
        let columns = ["scene", "formulation", ">duration", "method", ">steps", ">energy", ">trend", ">constraint"];
        let mut table = Table::new(columns.into_iter().chain(["judged", ">error", ">estimate"]));
        for run in &self.runs {
            let estimate = match run.verdict {
                Verdict::Accurate { estimate, .. }
                | Verdict::Admitted { estimate, .. }
                | Verdict::Wrong { estimate, .. } => short(estimate),
                Verdict::Refused { .. } => String::new(),
            };
            let run_of = [run.scene.into(), run.formulation.clone(), short(run.duration), run.stepping.name().into()];
            let lost = [run.energy, run.trend, run.constraint].map(short);
            let judged = if run.by_place { "places" } else { "energy, constraint" };
            let judgement = [judged.into(), words(&run.verdict), estimate];
            table.cells(run_of.into_iter().chain([run.steps.to_string()]).chain(lost).chain(judgement));
        }
        *page += &table.to_string();
    }

    fn section(&self, page: &mut String, case: &Case) {
        let cells: Vec<&Cell> = self.cells.iter().filter(|cell| cell.case == case.name).collect();
        let _ =
            writeln!(page, "\n## {}\n\n{}\n\n*Reference*: {}.\n", case.name, case.texts.about, case.texts.reference);
        if DRAWN.iter().any(|(name, _)| *name == case.name) {
            let _ = writeln!(page, "![Error over {}]({})\n", case.texts.variable, picture_name(case.name));
        }
        let methods = Method::ALL.iter().map(|method| format!(">{}", method.name()));
        let mut table =
            Table::new([format!(">{}", case.texts.variable), "formulation".into()].into_iter().chain(methods));
        for line in cells.chunks(Method::ALL.len()) {
            let words = line.iter().map(|cell| words(&cell.verdict));
            table.cells([short(line[0].point), line[0].formulation.clone()].into_iter().chain(words));
        }
        *page += &table.to_string();
        let mut causes: BTreeMap<String, usize> = BTreeMap::new();
        for cell in &cells {
            if let Verdict::Refused { cause, .. } = &cell.verdict {
                *causes.entry(kind_of(cause)).or_default() += 1;
            }
        }
        if !causes.is_empty() {
            let list: Vec<String> = causes.iter().map(|(cause, count)| format!("{count} × {cause}")).collect();
            let _ = writeln!(page, "\nCauses: {}.", list.join("; "));
        }
    }

    fn picture(&self, name: &str, formulation: &str) -> Result<String> {
        let curve = |(i, method): (usize, &Method)| {
            let cells =
                self.cells.iter().filter(|c| c.case == name && c.formulation == formulation && c.method == *method);
            let points = cells.map(|cell| match cell.verdict {
                Verdict::Accurate { error, .. } | Verdict::Admitted { error, .. } | Verdict::Wrong { error, .. } => {
                    (cell.point, error)
                }
                Verdict::Refused { .. } => (cell.point, f64::NAN),
            });
            Curve { label: method.name().into(), style: STYLES[i % STYLES.len()], points: points.collect() }
        };
        let title = format!("{name}: true error of what is not refused");
        let (x, y) = (Axis::log(variable(name)), Axis::log("error over distance"));
        let curves = Method::ALL.iter().enumerate().map(curve).collect();
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
        Verdict::Admitted { error, .. } => format!("{}, *said so*", short(*error)),
        Verdict::Refused { t: Some(t), .. } => format!("to t = {}", short(*t)),
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

/// A cause without its place and its figures.
fn kind_of(cause: &str) -> String {
    let first = cause.lines().next().unwrap_or_default();
    let kind = first.split_once(": ").filter(|(place, _)| place.contains(':')).map_or(first, |(_, rest)| rest);
    let figure = |word: &str| word.starts_with(|c: char| c.is_ascii_digit());
    let words: Vec<&str> = kind.split(' ').map(|word| if figure(word) { "…" } else { word }).collect();
    words.join(" ")
}
