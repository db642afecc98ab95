//! The page about the benchmark bicycle.

use anyhow::{Context, Result, bail};
use linear::{Eigenvalue, Sweep, SweepPoint, sweep};
use motion::{CHETAEV, Choice, default_constants};
use nalgebra::Complex;
use serde_json::{Value, json};

use comparison::words::short;
use pages::{Table, fill};
use pages::{pairs, sweep_picture};
use program::File;

/// Speed or name, real and imaginary part, in 25 digits.
const REFERENCE: &str = include_str!("../../linear/bicycle.csv");

/// Speeds in the picture, m/s; every tenth of them is in the table, too.
const DRAWN: (f64, f64, usize) = (0.0, 10.0, 101);
const IN_TABLE: usize = 10;

/// So close eigenvalues and speeds have to be.
const LIMIT: f64 = 1e-12;

/// The eigenvalues of the upright bicycle over its speed, and how far they are from the reference.
pub struct BicycleReport {
    drawn: Sweep,
    /// At each speed in the table.
    differences: Vec<f64>,
    /// What changes, the speed, and its difference.
    changes: Vec<(&'static str, f64, f64)>,
}

impl BicycleReport {
    /// Linearizes at all speeds.
    ///
    /// # Errors
    /// Where there is no linearization, or the reference has another number of eigenvalues.
    pub fn new() -> Result<BicycleReport> {
        let (drawn, rows) = (bicycle(DRAWN)?, reference()?);
        let differences = in_table(&drawn).map(|point| difference(point, &rows)).collect::<Result<Vec<f64>>>()?;
        let [weave, capsize] = &drawn.changes[..] else {
            bail!("{} changes of stability in the place of two", drawn.changes.len());
        };
        let changes = [("weave", weave), ("capsize", capsize)].map(|(name, change)| {
            let known = rows.iter().find(|(of, _)| of == name).with_context(|| format!("no speed of {name}"))?;
            Ok((name, change.value, (change.value - known.1.re).abs()))
        });
        let changes = changes.into_iter().collect::<Result<Vec<_>>>()?;
        Ok(BicycleReport { drawn, differences, changes })
    }

    fn largest(&self) -> f64 {
        self.differences.iter().fold(0.0_f64, |a, &b| a.max(b))
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        format!(
            "The linearized benchmark bicycle (eight coordinates, five constraints) reproduces the 44 published eigenvalues \
             at eleven speeds to {:.0e}, and is linearly stable from {:.6} to {:.6} m/s.",
            self.largest(),
            self.changes[0].1,
            self.changes[1].1
        )
    }

    /// The verdicts for machines.
    pub fn verdicts(&self) -> Value {
        let word = |difference: f64| if difference <= LIMIT { "agree" } else { "differ" };
        let speeds = self.changes.iter().fold(0.0_f64, |a, change| a.max(change.2));
        json!({ "eigenvalues": word(self.largest()), "speeds": word(speeds) })
    }

    /// Page and picture.
    ///
    /// # Errors
    /// Where the picture cannot be drawn.
    pub fn files(&self) -> Result<Vec<File>> {
        let mut table = Table::new([">v, m/s", ">s1", ">s2", ">s3", ">s4", ">estimated error", ">difference"]);
        for (point, difference) in in_table(&self.drawn).zip(&self.differences) {
            let error = point.part.eigenvalues.iter().fold(0.0_f64, |a, e| a.max(e.error));
            let rounded = |e: &Eigenvalue| Eigenvalue { error: e.error.max(1e-9), ..*e };
            let mut cells = pairs(&point.part.eigenvalues.iter().map(rounded).collect::<Vec<_>>());
            cells.resize(4, String::new());
            let rest = [format!("{error:.0e}"), format!("{difference:.0e}")];
            table.cells([short(point.value)].into_iter().chain(cells).chain(rest));
        }
        let mut speeds = Table::new(["stability changes by", ">v, m/s", ">difference"]);
        for (name, value, difference) in &self.changes {
            speeds.row(&[name, &format!("{value:.12}"), &format!("{difference:.0e}")]);
        }
        let SweepPoint { linearization, part, .. } = &self.drawn.points[0];
        let of: Vec<&str> = part.states.iter().map(|&i| &linearization.states[i][..]).collect();
        let page = fill(
            include_str!("pages/bicycle.md"),
            &[
                ("headline", &self.headline()),
                ("table", &table),
                ("speeds", &speeds),
                ("of", &of.join(", ")),
                ("form", &linearization.form),
            ],
        );
        let [low, high] = [self.changes[0].1, self.changes[1].1];
        let title =
            format!("The bicycle is linearly stable from {low:.2} to {high:.2} m/s: eigenvalues over its speed");
        Ok(vec![
            File { path: "evidence/bicycle.md".into(), text: page },
            File { path: "evidence/bicycle.svg".into(), text: sweep_picture(&title, "speed v (m/s)", &self.drawn)? },
        ])
    }
}

fn in_table(drawn: &Sweep) -> impl Iterator<Item = &SweepPoint> {
    drawn.points.iter().step_by(IN_TABLE)
}

/// Lean and steer of the upright bicycle at these speeds.
fn bicycle((from, to, count): (f64, f64, usize)) -> Result<Sweep> {
    let scene = scene::catalogue::find("bicycle", &[])?;
    let constants = default_constants(CHETAEV, &scene);
    let choice = Choice { label: CHETAEV.title.into(), formulation: CHETAEV, removal: None, constants };
    Ok(sweep(
        &scene,
        &choice,
        &["lean", "steer"],
        ("v", &motion::equidistant(from, to, count).collect::<Vec<_>>()),
        false,
    )?)
}

/// First column, eigenvalue.
fn reference() -> Result<Vec<(String, Complex<f64>)>> {
    let row = |line: &str| -> Result<(String, Complex<f64>)> {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |text: &str| if text.is_empty() { Ok(0.0) } else { text.parse() };
        match cells[..] {
            [of, re, im] => Ok((of.into(), Complex::new(number(re)?, number(im)?))),
            _ => bail!("`{line}` has no three columns"),
        }
    };
    REFERENCE.lines().skip(1).map(row).collect()
}

/// The largest difference of an eigenvalue from the nearest one of the reference, each taken once.
fn difference(point: &SweepPoint, rows: &[(String, Complex<f64>)]) -> Result<f64> {
    let speed = point.value.to_string();
    let mut known: Vec<Complex<f64>> = rows.iter().filter(|(of, _)| *of == speed).map(|(_, value)| *value).collect();
    if known.len() != point.part.eigenvalues.len() {
        bail!("v = {speed}: {} eigenvalues in the place of {}", point.part.eigenvalues.len(), known.len());
    }
    let mut largest = 0.0_f64;
    for found in &point.part.eigenvalues {
        let away = |z: &Complex<f64>| (z - found.value).norm();
        let nearest = (0..known.len()).min_by(|&a, &b| away(&known[a]).total_cmp(&away(&known[b])));
        let nearest = known.swap_remove(nearest.context("no eigenvalue is left")?);
        largest = largest.max(away(&nearest));
    }
    Ok(largest)
}
