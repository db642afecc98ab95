//! The pages about the paper's equations.

use std::fmt::Display;

use anyhow::Result;
use serde_json::{Map, Value, json};
use symbolic::Vanishing;
use symbolic::limits::HALF_THE_DIGITS;

use crate::audit::{
    Constants, Example, Finding, Form, Paper, STATEMENT, Stationarity, Variant, Verdict, cone, refusal,
};
use comparison::words::{enumerate, short};
use pages::{DataPackage, Table, fill};
use program::File;

/// What the audit found.
pub struct AuditReport {
    findings: Vec<Finding>,
    stationarity: Stationarity,
    constants: Constants,
    cone: Example,
    written: Vec<Variant>,
    refusal: String,
}

impl AuditReport {
    /// Checks every equation.
    ///
    /// # Errors
    /// Where the paper's formulas cannot be read or a motion cannot be computed.
    pub fn new() -> Result<AuditReport> {
        let paper = Paper::new()?;
        let findings = paper.numbers().into_iter().map(|number| paper.check(number)).collect::<Result<_>>()?;
        Ok(AuditReport {
            findings,
            stationarity: Stationarity::new(&paper)?,
            constants: Constants::new()?,
            cone: cone()?,
            written: paper.written()?,
            refusal: refusal()?,
        })
    }

    /// Numbers of the equations with a verdict.
    fn with(&self, verdict: Verdict) -> Vec<String> {
        self.findings.iter().filter(|f| f.verdict == verdict).map(|f| f.number.clone()).collect()
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let [holds, misprint, incomplete, open] =
            [Verdict::Holds, Verdict::Misprint, Verdict::Incomplete, Verdict::Open].map(|v| self.with(v).len());
        let left = if open == 0 { String::new() } else { format!(", {open} are open") };
        format!(
            "Of {} equations of the paper {holds} hold as printed, {misprint} after a misprint is corrected, {incomplete} are incomplete{left}.",
            holds + misprint + incomplete + open
        )
    }

    /// The verdicts for machines.
    pub fn verdicts(&self) -> Value {
        let equations: Map<String, Value> =
            self.findings.iter().map(|f| (f.number.clone(), f.verdict.word().into())).collect();
        let answer = |v: &Variant| Value::from(if v.form.holds() { "holds" } else { "does not hold" });
        let readings: Map<String, Value> = self
            .findings
            .iter()
            .flat_map(|f| f.variants.iter().map(move |v| (format!("{}: {}", f.number, v.words), answer(v))))
            .collect();
        let stationary: Map<String, Value> = self
            .stationarity
            .readings
            .iter()
            .map(|r| (r.name.into(), (r.largest() < HALF_THE_DIGITS).into()))
            .collect();
        json!({ "equations": equations, "readings": readings, "stationary": stationary })
    }

    /// The pages and their tables.
    pub fn files(&self) -> Vec<File> {
        let data = self.data();
        let pages = [("paper/audit.md", self.page(&data)), ("paper/examples.md", self.examples())];
        let pages = pages.map(|(path, text)| File { path: path.into(), text });
        pages.into_iter().chain(data.files()).collect()
    }

    /// Every equation with its formulas, and every reading that was tried.
    fn data(&self) -> DataPackage {
        let columns = ["equation", "about", "verdict", "note", "scan", "as printed", "corrected", "residual, printed"];
        let along = ["residual, corrected", "checked", "along a motion, printed", "along a motion, corrected"];
        let mut equations = Table::new(columns.into_iter().chain(along));
        let mut readings = Table::new(["equation", "also tried", "holds", "residual"]);
        for f in &self.findings {
            let [printed, corrected] = [&f.printed, &f.corrected].map(|form| {
                let lines = form.lines.iter().map(|l| &l.latex).chain(&form.integrals);
                lines.map(|latex| format!("${latex}$")).collect::<Vec<_>>().join("; ")
            });
            let residuals = [&f.printed, &f.corrected].map(form_residual);
            let along = f.along.as_ref().map_or(Default::default(), |along| [list(&along[0]), list(&along[1])]);
            let said = [&f.number, &f.title, f.verdict.word(), &f.note, &f.scan].map(String::from);
            let checked = [checked(f).to_owned()];
            equations.cells(said.into_iter().chain([printed, corrected]).chain(residuals).chain(checked).chain(along));
            for v in &f.variants {
                let word = if v.form.holds() { "yes" } else { "no" };
                readings.row(&[&f.number, &v.words, &word, &form_residual(&v.form)]);
            }
        }
        let mut data = DataPackage::new("data/paper", "The equations of Gao 2017, each checked");
        data.table("equations", "Every equation as printed and as corrected, with residuals and notes", &equations);
        data.table("readings", "Other readings of an equation that were tried", &readings);
        data
    }

    fn page(&self, data: &DataPackage) -> String {
        let mut verdicts = Table::new(["equation", "about", "verdict", ">residual, printed"]);
        for f in &self.findings {
            let word = if f.verdict == Verdict::Holds { "holds".into() } else { format!("**{}**", f.verdict.word()) };
            verdicts.row(&[&f.number, &f.title, &word, &form_residual(&f.printed)]);
        }
        let (c, s) = (&self.constants, &self.stationarity);
        let natural = c.natural.iter().map(|[t, x]| format!("$C = {}$ for $t_1 = {}$ s", short(*x), short(*t)));
        let augmented = c.augmented.iter().map(|(scene, constants, gap)| {
            let constants: Vec<String> = constants.iter().map(|x| short(*x)).collect();
            format!("{} for `{}`, $C = ({})$", short(*gap), scene, constants.join(", "))
        });
        let mut horizons = Table::new([">$t_1$, s", ">$C$", ">best $\\mu_0$", ">gap that is left"]);
        c.horizons.iter().for_each(|h| horizons.cells(h.map(short)));
        let columns = ["motion of", ">order in $u$", "$dI/d\\varepsilon$, four $\\delta u$", "stationary"];
        let mut readings = Table::new(columns);
        for r in &s.readings {
            let word = if r.largest() < HALF_THE_DIGITS { "yes" } else { "**no**" };
            readings.row(&[&r.name, &r.order, &list(&r.derivatives), &word]);
        }
        let columns = [">$dI/d\\varepsilon$ measured", ">from $\\delta I$ as printed", ">as corrected"];
        let mut sledge = Table::new(columns);
        s.sledge.iter().for_each(|numbers| sledge.cells(numbers.map(|x| format!("{x:.8}"))));
        let headline = self.headline();
        let natural = enumerate(&natural.collect::<Vec<_>>());
        let augmented = enumerate(&augmented.collect::<Vec<_>>());
        // within the item of the list
        let horizons = horizons.to_string().lines().map(|line| format!("  {line}\n")).collect::<String>();
        let gap_derived = short(s.gap);
        let list_of_data = data.list(1);
        let numbers: Vec<(&str, String)> = c.numbers.iter().map(|&(name, x)| (name, short(x))).collect();
        let mut values: Vec<(&str, &dyn Display)> = numbers.iter().map(|(name, text)| (*name, text as _)).collect();
        values.extend::<[(&str, &dyn Display); 10]>([
            ("headline", &headline),
            ("verdicts", &verdicts),
            ("natural", &natural),
            ("augmented", &augmented),
            ("horizons", &horizons),
            ("readings", &readings),
            ("statement", &STATEMENT),
            ("gap_derived", &gap_derived),
            ("sledge", &sledge),
            ("data", &list_of_data),
        ]);
        fill(include_str!("pages/audit.md"), &values)
    }

    fn examples(&self) -> String {
        let quantities = self.cone.quantities.iter().map(|(name, meaning)| math(&format!("{name} = {meaning}")));
        let written = self.written.iter().map(|group| {
            let head = format!("\n{} (left minus right: {}):\n\n", group.words, form_residual(&group.form));
            let shown = !group.words.starts_with("The paper's three");
            head + &group.form.lines.iter().filter(|_| shown).map(|line| math(&line.latex)).collect::<String>()
        });
        fill(
            include_str!("pages/examples.md"),
            &[
                ("quantities", &quantities.collect::<String>()),
                ("cone", &self.cone.equations.iter().map(|line| math(line)).collect::<String>()),
                ("residuals", &residuals(&self.cone.residuals)),
                ("refusal", &self.refusal),
                ("written", &written.collect::<String>()),
            ],
        )
    }
}

fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|x| two_digits(*x)).collect::<Vec<_>>().join(", ")
}

fn math(latex: &str) -> String {
    format!("```math\n{latex}\n```\n")
}

/// How an equation was checked.
fn checked(f: &Finding) -> &'static str {
    let all = || f.printed.lines.iter().chain(&f.corrected.lines);
    match (f.verdict, f.along.is_some()) {
        (Verdict::Definition, _) => "–",
        (_, true) => "identically; along a motion",
        _ if all().any(|l| matches!(l.residual, Vanishing::Numerically { .. })) => "at random points",
        _ => "identically",
    }
}

/// The residual that is farthest from zero, of all lines.
fn form_residual(form: &Form) -> String {
    if form.lines.is_empty() {
        return "–".into();
    }
    residuals(&form.lines.iter().map(|l| l.residual).collect::<Vec<_>>())
}

fn residuals(all: &[Vanishing]) -> String {
    let values = all.iter().filter_map(|r| if let Vanishing::No { value, .. } = r { Some(value.abs()) } else { None });
    if let Some(largest) = values.reduce(f64::max) {
        return two_digits(largest);
    }
    if all.iter().all(|r| matches!(r, Vanishing::Exactly)) {
        return "0".into();
    }
    let points = all.iter().find_map(|r| if let Vanishing::Numerically { points } = r { Some(*points) } else { None });
    points.map_or("undecided".into(), |points| format!("0 at {points} points"))
}

fn two_digits(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    if (0.01..100.0).contains(&x.abs()) {
        let digits = (1 - x.abs().log10().floor() as i32).max(0) as usize;
        return format!("{x:.digits$}");
    }
    format!("{x:.1e}")
}
