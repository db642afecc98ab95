//! The page about realizations.

use anyhow::{Context, Result};
use equations::Formulation;
use mechanics::ConstantsRule;
use motion::{
    CHETAEV, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, SolveError, VAKONOMIC, choices, setting, solve,
    solve_choice,
};
use scene::Scene;
use serde_json::{Map, Value, json};

use super::law_rows;
use comparison::words::short;
use pages::{DataPackage, Table, fill};
use picture::{Axis, Curve, Picture, Style};
use program::File;
use program::parallel;
use random::realization::{Realization, distance, realize, realize_removal, with_kappa};
use random::{Case, Kind, VISIBLE, draw_recipe, equations, free_constants};

use crate::casadi_job::RANDOM_SYSTEMS;

/// `N`.
const STRENGTHS: [f64; 4] = [1e2, 1e3, 1e4, 1e5];

/// Scenes on the page, each up to this time, with multipliers `μ₀` where the scene has none.
const SCENES: [(&str, f64); 3] = [("sledge", 3.0), ("disc", 3.0), ("ball-in-cone", 1.0)];

/// Multipliers of the start where a scene has none, one after the other.
const MULTIPLIERS: [f64; 2] = [0.4, -0.3];

/// Friction over mass where both act, in 1/s.
const KAPPA: f64 = 0.5;

/// Seed of the random systems on the page.
const SEED: u64 = 8;

/// Kinds of them: constrained, linear in the velocities and well conditioned, not integrable.
const KINDS: [Kind; 4] = [Kind::PartlyIntegrable, Kind::Linear, Kind::Affine, Kind::TimeDependent];

/// Rates that count as 1.
const RATE: std::ops::RangeInclusive<f64> = 0.95..=1.05;

/// Words where there is no rate.
const TOO_CLOSE: &str = "too close to tell";
const STOPS: &str = "stops";

/// What a realization tends to, and the distances from it.
#[derive(Clone, Debug)]
pub struct Approach {
    /// The realization, and what it tends to.
    pub name: &'static str,
    /// How it is drawn.
    pub style: Style,
    /// Distances at strengths `N` of 10² to 10⁵; NaN where a run stopped early.
    pub distances: Vec<f64>,
}

impl Approach {
    /// Whether a run that tells the rate stopped early.
    fn stops(&self) -> bool {
        self.distances[1].is_nan() || self.distances[2].is_nan()
    }

    /// Why there is no rate, or how near it is to 1.
    pub fn word(&self) -> &'static str {
        match self.rate() {
            Some(rate) if RATE.contains(&rate) => "rate 1",
            Some(_) => "other rate",
            None if self.stops() => STOPS,
            None => TOO_CLOSE,
        }
    }

    /// `log₁₀` of the distance at `N = 10³` over that at `10⁴`; `None` where the distance is too small.
    fn rate(&self) -> Option<f64> {
        let rate = (self.distances[1] / self.distances[2]).log10();
        (self.distances[1] > VISIBLE && rate.is_finite()).then_some(rate)
    }
}

/// What was found on realizations.
pub struct RealizationReport {
    /// Names of scenes with their realizations.
    pub scenes: Vec<(String, Vec<Approach>)>,
    /// Realizations of random systems.
    pub random: Vec<Vec<Approach>>,
    /// The family `kappa` beside the law of first order.
    pub law: Vec<law_rows::Row>,
}

/// Name of the realization by friction.
pub const FRICTION: &str = "friction, to Chetaev";
/// Name of the realization by added mass.
pub const ADDED_MASS: &str = "added mass, to vakonomic";
/// Name of the realization by both together.
pub const BOTH: &str = "mass and friction, to κ = 0.5";
const AUGMENTED: &str = "added mass on the augmented system, to removed constraint";

impl RealizationReport {
    /// Runs all realizations.
    ///
    /// # Errors
    /// Where a motion cannot be computed.
    pub fn new(quiet: bool) -> Result<RealizationReport> {
        let scene = |(name, _): &(&str, f64)| format!("realizations of `{name}`");
        let scenes = parallel::try_map(&SCENES, quiet, scene, |asked| -> Result<_> {
            Ok((asked.0.to_string(), of_scene(asked.0, asked.1).with_context(|| scene(asked))?))
        })?;
        let indices: Vec<u64> = (0..RANDOM_SYSTEMS as u64).collect();
        let system = |index: &u64| format!("realizations of random system {index}");
        let random =
            parallel::try_map(&indices, quiet, system, |index| of_random(*index).with_context(|| system(index)))?;
        Ok(RealizationReport { scenes, random, law: law_rows::rows(quiet)? })
    }

    /// Rates of one realization on the random systems, sorted; how many are too close to tell, and how many
    /// stop.
    pub fn random_rates(&self, name: &str) -> (Vec<f64>, [usize; 2]) {
        let all = self.random.iter().flatten().filter(|a| a.name == name);
        let mut rates: Vec<f64> = all.clone().filter_map(Approach::rate).collect();
        rates.sort_by(f64::total_cmp);
        (rates, [TOO_CLOSE, STOPS].map(|word| all.clone().filter(|a| a.word() == word).count()))
    }

    /// Every rate that is measured on the page.
    fn rates(&self) -> Vec<f64> {
        self.scenes.iter().flat_map(|(_, a)| a).chain(self.random.iter().flatten()).filter_map(Approach::rate).collect()
    }

    /// The first line of the page.
    pub fn headline(&self) -> String {
        let rates = self.rates();
        let within = rates.iter().filter(|r| RATE.contains(r)).count();
        let (least, most) = rates.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &r| (a.min(r), b.max(r)));
        format!(
            "Viscous friction converges to Chetaev's motion where A M⁻¹ Aᵀ is positive, added mass to a vakonomic one; added mass on the augmented system to a \
             removed-constraint one, and both together to the family `kappa`. In {within} of {} cases the distance falls as 1/N \
             (fitted exponents {} to {}).",
            rates.len(),
            short(least),
            short(most)
        )
    }

    /// The verdicts for machines.
    pub fn verdicts(&self) -> Value {
        let scene = |approaches: &[Approach]| -> Map<String, Value> {
            approaches.iter().map(|a| (a.name.to_string(), a.word().into())).collect()
        };
        let scenes: Map<String, Value> =
            self.scenes.iter().map(|(name, a)| (name.clone(), Value::Object(scene(a)))).collect();
        let off = self.random.iter().flatten().filter(|a| a.rate().is_some_and(|r| !RATE.contains(&r))).count();
        json!({ "scenes": scenes, "random systems off rate 1": off })
    }

    /// Page and pictures.
    ///
    /// # Errors
    /// Where a picture cannot be drawn.
    pub fn files(&self) -> Result<Vec<File>> {
        let mut files = Vec::new();
        for (name, approaches) in &self.scenes {
            let path = format!("evidence/realization-{name}.svg").into();
            files.push(File { path, text: picture(name, approaches)? });
        }
        let data = self.data();
        files.push(File { path: "evidence/realization.md".into(), text: self.page(&data) });
        Ok(files.into_iter().chain(data.files()).collect())
    }

    /// Distances on scenes, and the family beside the first-order law.
    fn data(&self) -> DataPackage {
        let columns = ["scene", "realization", ">distance at N = 1e2", ">at 1e3", ">at 1e4", ">at 1e5", "rate"];
        let mut scenes = Table::new(columns);
        for (name, a) in self.scenes.iter().flat_map(|(name, all)| all.iter().map(move |a| (name, a))) {
            let cells = a.distances.iter().map(|d| if d.is_nan() { STOPS.into() } else { short(*d) });
            let rate = a.rate().map_or(a.word().into(), short);
            scenes.cells([name.clone(), a.name.to_string()].into_iter().chain(cells).chain([rate]));
        }
        let mut data = DataPackage::new("data/realization", "Friction and added mass of strength N");
        data.table("scenes", "Distances from the limit at each strength, and the rate from 1e3 to 1e4", &scenes);
        data.table("first-order", "The family kappa beside the first-order law", &law_rows::table(&self.law));
        data
    }

    fn page(&self, data: &DataPackage) -> String {
        let columns = ["realization", ">least rate", ">median", ">largest", ">systems", ">too close to tell", ">stop"];
        let mut random = Table::new(columns);
        for name in [FRICTION, ADDED_MASS, BOTH, AUGMENTED] {
            let (rates, [close, stop]) = self.random_rates(name);
            if let (Some(least), Some(most)) = (rates.first(), rates.last()) {
                let [least, median, most] = [*least, rates[rates.len() / 2], *most].map(short);
                random.row(&[&name, &least, &median, &most, &rates.len(), &close, &stop]);
            }
        }
        fill(
            include_str!("pages/realization.md"),
            &[
                ("headline", &self.headline()),
                ("count", &RANDOM_SYSTEMS),
                ("seed", &SEED),
                ("random", &random),
                ("data", &data.list(1)),
            ],
        )
    }
}

/// Distances at every strength.
fn approach(
    name: &'static str,
    style: Style,
    limit: &mut Motion,
    metric: &mut Metric,
    realized: &dyn Fn(f64) -> Result<Motion, SolveError>,
) -> Result<Approach> {
    let mut distances = Vec::new();
    for strength in STRENGTHS {
        distances.push(distance(limit, &mut realized(strength)?, metric)?);
    }
    Ok(Approach { name, style, distances })
}

fn of_scene(name: &str, duration: f64) -> Result<Vec<Approach>> {
    let mut scene: Scene = scene::catalogue::find(name, &[("duration".into(), duration.into())])?;
    if scene.multipliers.iter().all(|mu| *mu == 0.0) {
        scene.multipliers = (0..scene.multipliers.len()).map(|i| MULTIPLIERS[i % 2]).collect();
    }
    let settings = motion::Settings::default();
    let choice =
        |own: &Formulation| choices(&scene).into_iter().find(|c| c.formulation == own).context("no such formulation");
    let mut metric = Metric::new(&scene.system)?;
    let setting = setting(&scene);
    let mut chetaev = solve_choice(&scene, &choice(CHETAEV)?, &settings)?;
    let mut vakonomic = solve_choice(&scene, &choice(VAKONOMIC)?, &settings)?;
    let mut removed = choice(REMOVED_CONSTRAINT)?;
    removed.constants = ConstantsRule::Zero;
    let mut limit = solve_choice(&scene, &removed, &settings)?;
    let removal = removed.removal.context("no removal")?;
    let costates = vec![0.0; removal.memory.len()];
    approaches(
        setting,
        &scene.multipliers,
        &mut chetaev,
        &mut vakonomic,
        (&mut limit, &removal, &costates),
        &mut metric,
    )
}

fn of_random(index: u64) -> Result<Vec<Approach>> {
    let mut case = Case::new(draw_recipe(SEED, index, &KINDS), "random")?;
    let (scene, removed) = (&case.scene, &mut case.removed[0]);
    let setting = Setting { system: &scene.system, start: &scene.start, end: scene.start.t + scene.duration };
    let removal = removed.removal.clone();
    debug_assert_eq!(removed.motion.constants, free_constants(&removed.motion.equations, &removed.costates));
    let limit = (&mut removed.motion, &removal, &removed.costates[..]);
    approaches(setting, &scene.multipliers, &mut case.chetaev, &mut case.vakonomic, limit, &mut case.metric)
}

fn approaches(
    setting: Setting,
    multipliers: &[f64],
    chetaev: &mut Motion,
    vakonomic: &mut Motion,
    (removed, removal, costates): (&mut Motion, &mechanics::Removal, &[f64]),
    metric: &mut Metric,
) -> Result<Vec<Approach>> {
    let plain = |kind| move |strength| realize(kind, strength, setting, multipliers);
    let system = with_kappa(setting.system, KAPPA);
    let (rule, settings) = (ConstantsRule::Given(multipliers.to_vec()), Settings::default());
    let mut between =
        solve(Setting { system: &system, ..setting }, equations(&system, motion::KAPPA, None)?, &rule, &settings)?;
    Ok(vec![
        approach(FRICTION, Style::Chetaev, chetaev, metric, &plain(Realization::Friction))?,
        approach(ADDED_MASS, Style::Vakonomic, vakonomic, metric, &plain(Realization::AddedMass))?,
        approach(BOTH, Style::Substituted, &mut between, metric, &plain(Realization::Both { kappa: KAPPA }))?,
        approach(AUGMENTED, Style::RemovedConstraint, removed, metric, &|strength| {
            realize_removal(strength, setting, removal, costates)
        })?,
    ])
}

fn picture(name: &str, approaches: &[Approach]) -> Result<String> {
    let curve = |a: &Approach| Curve {
        label: a.name.into(),
        style: a.style,
        // a realization that stops has no distance
        points: STRENGTHS.iter().copied().zip(a.distances.iter().copied()).filter(|(_, d)| d.is_finite()).collect(),
    };
    let first = approaches.iter().find_map(|a| a.distances.first().copied().filter(|d| d.is_finite()));
    // a line of slope -1 below the others
    let guide = first.map(|d| STRENGTHS.map(|n| (n, 0.1 * d * STRENGTHS[0] / n)).to_vec());
    let guide = guide.map(|points| Curve { label: "∝ 1/N".into(), style: Style::Threshold, points });
    let (x, y) =
        (Axis::log("strength N (s⁻¹ of friction, kg/kg of mass)"), Axis::log("distance from the limit (m √kg)"));
    let rates: Vec<f64> = approaches.iter().filter_map(Approach::rate).collect();
    let falls = rates.len() == approaches.len() && rates.iter().all(|rate| RATE.contains(rate));
    let title = match falls {
        true => format!("{name}: every realization converges to its formulation as 1/N"),
        false => format!("{name}: distance of the realizations from their formulations"),
    };
    let curves = approaches.iter().map(curve).chain(guide).collect();
    Ok(Picture::new(title, x, y, curves).to_svg()?)
}
