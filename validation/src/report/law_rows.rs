//! The family `kappa` beside the law of first order, scene by scene.

use anyhow::{Context, Result};
use comparison::words::short;
use equations::Formulation;
use mechanics::ConstantsRule;
use motion::{CHETAEV, FIRST_ORDER, KAPPA, Metric, Motion, Settings, choices, solve_choice};
use pages::Table;
use program::parallel;
use random::realization::distance;
use scene::Scene;

/// Scenes, each up to this time.
const SCENES: [(&str, f64); 5] =
    [("sledge", 1.0), ("turntable", 1.0), ("sleigh", 1.0), ("trailer", 1.0), ("ball-in-cone", 0.2)];

/// `κ`; `ε` and the slip `1/N` are one over it.
const KAPPAS: [f64; 3] = [20.0, 80.0, 320.0];

/// Distances of one scene at one `κ`.
pub struct Row {
    /// Name of the scene.
    pub scene: &'static str,
    /// `κ`, 1/s.
    pub kappa: f64,
    /// Of the family from Chetaev, of the family from the law, of slip from Chetaev.
    pub distances: [f64; 3],
}

/// All rows.
///
/// # Errors
/// Where a motion cannot be computed.
pub fn rows(quiet: bool) -> Result<Vec<Row>> {
    let asked: Vec<(&'static str, f64, f64)> =
        SCENES.iter().flat_map(|&(name, end)| KAPPAS.map(|kappa| (name, end, kappa))).collect();
    let words = |(name, _, kappa): &(&str, f64, f64)| format!("law of first order, `{name}`, {kappa} 1/s");
    parallel::try_map(&asked, quiet, words, |&(name, end, kappa)| row(name, end, kappa).with_context(|| name))
}

fn row(name: &'static str, end: f64, kappa: f64) -> Result<Row> {
    let epsilon = 1.0 / kappa;
    let motion = |(parameter, value): (&str, f64), formulation: &Formulation, multipliers: Option<Vec<f64>>| {
        let numbers = [("duration", end), (parameter, value)].map(|(name, x)| (name.to_string(), x.into()));
        let scene: Scene = scene::catalogue::find(name, &numbers)?;
        let choice = choices(&scene).into_iter().find(|choice| choice.formulation == formulation);
        let mut choice = choice.context("no such formulation")?;
        if let Some(multipliers) = multipliers {
            choice.constants = ConstantsRule::Given(multipliers);
        }
        let motion = solve_choice(&scene, &choice, &Settings::default())?;
        Ok::<(Scene, Motion), anyhow::Error>((scene, motion))
    };
    let (scene, mut law) = motion(("epsilon", epsilon), FIRST_ORDER, None)?;
    let (_, mut chetaev) = motion(("epsilon", epsilon), CHETAEV, None)?;
    // on the slow manifold from the start: μ = −ε λ
    let start = law.at(law.start())?.multipliers.iter().map(|lambda| -epsilon * lambda).collect();
    let (_, mut family) = motion(("kappa", kappa), KAPPA, Some(start))?;
    let (_, mut slip) = motion(("slip", epsilon), FIRST_ORDER, None)?;
    let mut metric = Metric::new(&scene.system)?;
    let distances = [
        distance(&mut chetaev, &mut family, &mut metric)?,
        distance(&mut law, &mut family, &mut metric)?,
        distance(&mut chetaev, &mut slip, &mut metric)?,
    ];
    Ok(Row { scene: name, kappa, distances })
}

/// Powers of ten of a distance over those of κ, from one `κ` to the next; none for the first of a scene.
pub fn exponents(before: Option<&Row>, row: &Row) -> [String; 3] {
    let Some(before) = before.filter(|before| before.scene == row.scene) else { return Default::default() };
    let rate = |i: usize| (before.distances[i] / row.distances[i]).ln() / (row.kappa / before.kappa).ln();
    [0, 1, 2].map(|i| if row.distances[i].is_finite() { format!("{:.2}", rate(i)) } else { String::new() })
}

/// The table of these rows, with exponents.
pub fn table(rows: &[Row]) -> Table {
    let columns = ["scene", ">kappa", ">Chetaev – family", ">as", ">law – family", ">as", ">Chetaev – slip", ">as"];
    let mut table = Table::new(columns);
    for (i, row) in rows.iter().enumerate() {
        let power = exponents(i.checked_sub(1).map(|i| &rows[i]), row);
        let cells = row.distances.iter().zip(power).flat_map(|(d, power)| [short(*d), power]);
        table.cells([row.scene.to_string(), short(row.kappa)].into_iter().chain(cells));
    }
    table
}
