//! What the paper's constants of integration are: numbers for it.

use anyhow::{Context as _, Result};
use comparison::{best_fit, compare_motions};
use equations::Formulation;
use mechanics::{ConstantsRule, Removal};
use motion::{CHETAEV, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, VAKONOMIC, setting, solve};
use scene::Scene;

use random::equations;
use random::realization::augmented_start;

/// What was found on the constants.
#[derive(Clone, Debug)]
pub struct Constants {
    /// Numbers by the name that the page has for them.
    pub numbers: Vec<(&'static str, f64)>,
    /// Sledge: `t₁`, `C = P_x(t₀) = g t₁ sin α`, multiplier of and gap to the closest vakonomic motion found.
    pub horizons: Vec<[f64; 4]>,
    /// The natural constants at `t₁` = [`HORIZONS`], as the boundary-value problem finds them.
    pub natural: Vec<[f64; 2]>,
    /// Bridge to augmented systems: scene, `C_i = P_i(t₀)` as given, largest difference of a coordinate.
    pub augmented: Vec<(&'static str, Vec<f64>, f64)>,
}

/// Horizons at which natural constants are taken.
pub const HORIZONS: [f64; 2] = [3.0, 10.0];

/// Seconds of the sledge's motions.
const DURATION: f64 = 3.0;

impl Constants {
    /// Integrates everything.
    ///
    /// # Errors
    /// Where a motion cannot be computed.
    pub fn new() -> Result<Constants> {
        let sledge = scene::catalogue::find("sledge", &[("duration".into(), DURATION.into())])?;
        let metric = &mut Metric::new(&sledge.system)?;
        let arc = removal(&sledge, "arc-length")?;
        let pull = parameter(&sledge, "g")? * parameter(&sledge, "alpha")?.sin();
        let (v, phi) = (&sledge.start.v, sledge.start.q[2]);
        let matching = -(v[0] * phi.cos() + v[1] * phi.sin()) / (pull * phi.cos());
        let multiplier = pull * matching * phi.sin();
        let vakonomic = |mu: f64| motion(&sledge, VAKONOMIC, None, ConstantsRule::Given(vec![mu]));
        let with = |c: f64| motion(&sledge, REMOVED_CONSTRAINT, Some(arc), ConstantsRule::Given(vec![c]));
        let gap = compare_motions(&mut with(pull * matching)?, &mut vakonomic(multiplier)?, metric)?.largest;
        let family = equations(&sledge.system, VAKONOMIC, None)?;
        let mut horizons = Vec::new();
        for horizon in [matching, matching + 0.2, 0.0, DURATION, 10.0] {
            let mut target = with(pull * horizon)?;
            let guesses: Vec<Vec<f64>> = [0.0, 1.0, -1.0, 12.0].map(|mu| vec![mu]).to_vec();
            let settings = Settings::default();
            let fitted = best_fit(setting(&sledge), &family, &mut target, &guesses, metric, &settings)?;
            let mut fitted = fitted.context("no fit")?;
            let gap = compare_motions(&mut target, &mut fitted, metric)?.largest;
            horizons.push([horizon, pull * horizon, fitted.constants[0], gap]);
        }
        let (mut one, mut two) = (with(0.0)?, with(pull * DURATION)?);
        let (start, other) = (one.at(0.0)?, two.at(0.0)?);
        let together = |o: &equations::Outputs| [&o.coordinates[..], &o.velocities[..]].concat();
        let apart = difference(&together(&start), &together(&other));
        let two_gap = compare_motions(&mut one, &mut two, metric)?.largest;
        let mut natural_motions = Vec::new();
        for horizon in HORIZONS {
            natural_motions.push(motion(&sledge, REMOVED_CONSTRAINT, Some(arc), ConstantsRule::Natural { horizon })?);
        }
        let natural = HORIZONS.iter().zip(&natural_motions).map(|(&t, m)| [t, m.constants[0]]).collect();
        let [first, second] = &mut natural_motions[..] else { anyhow::bail!("two horizons") };
        let natural_gap = compare_motions(first, second, metric)?.largest;
        let (body_zero, body_right) = planar_body()?;
        let mut augmented = Vec::new();
        for (name, removal, constants) in [
            ("sledge", "arc-length", [4.0, 0.0]),
            ("ball-in-cone", "paper", [0.3, 0.0]),
            ("planar-body", "turning-frame", [0.2, -0.1]),
        ] {
            augmented.push(on_augmented(name, removal, &constants)?);
        }
        let numbers = vec![
            ("duration", DURATION),
            // t₁ = −u̇₀/(g sin α cos φ₀), g t₁ sin α sin φ₀ there, and the gap of the two motions with these
            ("matching", matching),
            ("multiplier", multiplier),
            ("gap", gap),
            // two values of C, how far their starts are apart, and the gap
            ("one", 0.0),
            ("two", pull * DURATION),
            ("apart", apart),
            ("gap_two", two_gap),
            ("t_one", HORIZONS[0]),
            ("t_two", HORIZONS[1]),
            ("gap_natural", natural_gap),
            // P(t₀) = 0: gap to Newton's motion, rotation off at the end; P(t₀) = −(ẋ₀, ẏ₀): gap
            ("body", body_zero[0]),
            ("rotation", body_zero[1]),
            ("body_right", body_right),
        ];
        Ok(Constants { numbers, horizons, natural, augmented })
    }
}

fn planar_body() -> Result<([f64; 2], f64)> {
    let body = scene::catalogue::find("planar-body", &[])?;
    let metric = &mut Metric::new(&body.system)?;
    let frame = removal(&body, "turning-frame")?;
    let mut newton = motion(&body, CHETAEV, None, ConstantsRule::Zero)?;
    let v = &body.start.v;
    let mut zero = motion(&body, REMOVED_CONSTRAINT, Some(frame), ConstantsRule::Zero)?;
    let mut right = motion(&body, REMOVED_CONSTRAINT, Some(frame), ConstantsRule::Given(vec![-v[0], -v[1]]))?;
    let end = newton.end();
    let rotation = (zero.at(end)?.coordinates[2] - newton.at(end)?.coordinates[2]).abs();
    let off = compare_motions(&mut newton, &mut zero, metric)?.largest;
    Ok(([off, rotation], compare_motions(&mut newton, &mut right, metric)?.largest))
}

/// The removed-constraint motion of `P(t₀)` against the augmented vakonomic motion of `μ = −P − L_ẇ`.
fn on_augmented(name: &'static str, of: &str, costates: &[f64]) -> Result<(&'static str, Vec<f64>, f64)> {
    let scene = scene::catalogue::find(name, &[("duration".into(), 1.0.into())])?;
    let removal = removal(&scene, of)?;
    let setting = setting(&scene);
    let rule = ConstantsRule::Given(costates.to_vec());
    let mut removed = motion(&scene, REMOVED_CONSTRAINT, Some(removal), rule)?;
    let (system, start, multipliers) = augmented_start(setting, removal, costates)?;
    let large = Setting { system: &system, start: &start, end: setting.end };
    let bridge = equations(&system, VAKONOMIC, None)?;
    let mut bridge = solve(large, bridge, &ConstantsRule::Given(multipliers), &Settings::default())?;
    let mut gap = 0.0_f64;
    for t in removed.grid(50) {
        let small = removed.at(t)?.coordinates;
        gap = gap.max(difference(&small, &bridge.at(t)?.coordinates[..small.len()]));
    }
    Ok((name, removed.constants, gap))
}

fn motion(
    scene: &Scene,
    formulation: &'static Formulation,
    removal: Option<&Removal>,
    rule: ConstantsRule,
) -> Result<Motion> {
    let equations = equations(&scene.system, formulation, removal)?;
    let motion = solve(setting(scene), equations, &rule, &Settings::default())?;
    anyhow::ensure!(motion.is_complete(), "{} on {}: {:?}", formulation.name, scene.name, motion.ending);
    Ok(motion)
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

pub(crate) fn removal<'a>(scene: &'a Scene, name: &str) -> Result<&'a Removal> {
    let found = scene.removals.iter().find(|r| r.name == name);
    found.with_context(|| format!("{} has no removal `{name}`", scene.name))
}

fn parameter(scene: &Scene, name: &str) -> Result<f64> {
    let found = scene.system.parameters.iter().find(|p| scene.system.graph.name(p.symbol) == name);
    Ok(found.with_context(|| format!("{} has no parameter `{name}`", scene.name))?.value)
}
