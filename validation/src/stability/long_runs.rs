//! A million steps: what a long run loses of its energy, of its constraints and of its way.

use anyhow::{Context, Result};
use discrete::Composition;
use equations::Formulation;
use integrate::Method;
use mechanics::ConstantsRule;
use motion::{
    CERTAINTY, CHETAEV, Choice, Metric, Motion, REMOVED_CONSTRAINT, Setting, Settings, Stepping, Steps, VAKONOMIC,
    derive_at, solve, solve_by_steps,
};
use scene::Scene;
use serde::{Serialize, Serializer};
use symbolic::Evaluator;

use super::cases::{choice, sledge_reference};
use super::judge::{Allowance, FLOOR, Verdict, judge};
use super::question::tolerance;
use super::reference::{MILLION, Reference};
use program::parallel;

/// What the long runs are called, on the command line and in reports.
pub const LONG_RUNS: &str = "million-steps";

/// Number of times at which energy and constraints are evaluated, less one: every 50th node of a million.
const SAMPLES: usize = 20_000;

/// Parts of a run whose mean energies are compared.
const PARTS: usize = 10;

/// How the long runs are stepped.
pub const COMPARED: [Stepping; 3] =
    [Stepping::Leapfrog, Stepping::Adaptive(Some(Method::Taylor)), Stepping::Adaptive(Some(Method::Dop853))];

fn name<S: Serializer>(stepping: &Stepping, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(stepping.name())
}

/// A motion over a long time.
pub struct Long {
    /// A scene of the catalogue.
    pub scene: &'static str,
    /// Its formulation.
    pub formulation: &'static Formulation,
    /// How long.
    pub duration: f64,
    /// Every free constant, where it is not that of the scene.
    pub constants: Option<f64>,
    /// What is known of it, in a formulation.
    pub reference: Option<fn(&Formulation) -> Reference>,
}

/// The long motions: those of the sledge have a reference. Its vakonomic and its removed-constraint motion
/// turn ever faster, as `g t/k`, so that equal steps do for a time only.
pub const LONG: [Long; 4] = [
    sledge(CHETAEV, 20_000.0),
    sledge(VAKONOMIC, 50.0),
    sledge(REMOVED_CONSTRAINT, 50.0),
    Long { scene: "disc", formulation: VAKONOMIC, duration: 5_000.0, constants: Some(0.1), reference: None },
];

const fn sledge(formulation: &'static Formulation, duration: f64) -> Long {
    Long { scene: "sledge", formulation, duration, constants: None, reference: Some(sledge_reference) }
}

/// What became of a long run.
#[derive(Clone, Debug, Serialize)]
pub struct LongRun {
    /// The scene.
    pub scene: &'static str,
    /// Title of the formulation.
    pub formulation: String,
    /// How long it was to be.
    pub duration: f64,
    /// How it was stepped.
    #[serde(rename = "method")]
    #[serde(serialize_with = "name")]
    pub stepping: Stepping,
    /// Steps of the kept run.
    pub steps: usize,
    /// Largest `|E − E₀|`, in parts of the largest `v·Mv`.
    pub energy: f64,
    /// Spread of the mean energies of ten parts of the run, same unit: drift in `energy`, not oscillation.
    pub trend: f64,
    /// Largest `|f_i|/(|∂f_i/∂v| |v|)`.
    pub constraint: f64,
    /// Whether places are judged, by a reference; or else energy and constraint.
    pub by_place: bool,
    /// Accurate, admitted, refused or wrong.
    #[serde(flatten)]
    pub verdict: Verdict,
}

/// Every stepping on every long motion.
///
/// # Errors
/// Where a scene or a reference is missing.
pub fn long_runs(quiet: bool) -> Result<Vec<LongRun>> {
    let asked: Vec<(&Long, Stepping)> =
        LONG.iter().flat_map(|long| COMPARED.into_iter().map(move |stepping| (long, stepping))).collect();
    let name = |(long, _): &(&Long, Stepping)| format!("{}, {}", long.scene, long.formulation.name);
    parallel::try_map(&asked, quiet, name, |asked| asked.0.run(asked.1).with_context(|| name(asked)))
}

impl Long {
    /// The motion, stepped in one way.
    ///
    /// # Errors
    /// Where the scene or the reference is missing.
    pub fn run(&self, stepping: Stepping) -> Result<LongRun> {
        let scene = scene::catalogue::find(self.scene, &[("duration".into(), self.duration.into())])?;
        let mut choice = choice(&scene, self.formulation).map_err(anyhow::Error::msg)?;
        if let Some(each) = self.constants {
            choice.constants = ConstantsRule::Given(vec![each; scene.system.constraints.len()]);
        }
        let mut run = LongRun {
            scene: self.scene,
            formulation: self.formulation.title.into(),
            duration: self.duration,
            stepping,
            steps: 0,
            energy: f64::NAN,
            trend: f64::NAN,
            constraint: f64::NAN,
            by_place: self.reference.is_some(),
            verdict: Verdict::Refused { t: None, cause: String::new() },
        };
        let mut motion = match motion(&scene, &choice, stepping) {
            Ok(motion) => motion,
            Err(cause) => return Ok(LongRun { verdict: Verdict::Refused { t: None, cause }, ..run }),
        };
        run.steps = motion.work.steps;
        let mut metric = Metric::new(&scene.system)?;
        let loss = Loss::of(&scene, &mut motion, &mut metric)?;
        (run.energy, run.trend, run.constraint) = (loss.energy, loss.trend, loss.constraint);
        run.verdict = match &self.reference {
            None => loss.verdict(&motion),
            Some(reference) => {
                let reference = reference(self.formulation);
                let mut known = reference.up_to(motion.start(), motion.end()).map_err(anyhow::Error::msg)?;
                judge(
                    &mut motion,
                    &mut metric,
                    &mut known,
                    Allowance { floor: FLOOR, asked: 0.0, end: self.duration, compared: usize::MAX, each: false },
                )?
            }
        };
        Ok(run)
    }
}

fn motion(scene: &Scene, choice: &Choice, stepping: Stepping) -> Result<Motion, String> {
    let settings = Settings { max_steps: MILLION, ..Settings::default() };
    match stepping {
        Stepping::Leapfrog => {
            let steps = Steps { step: scene.duration / MILLION as f64, composition: Composition::Second };
            solve_by_steps(scene, choice, steps, &settings)
        }
        Stepping::Adaptive(method) => {
            let settings = Settings { method, tolerance: tolerance(method), ..settings };
            let setting = Setting { system: &scene.system, start: &scene.start, end: scene.start.t + scene.duration };
            derive_at(&scene.system, &scene.start, choice)
                .and_then(|equations| solve(setting, equations, &choice.constants, &settings))
        }
    }
    .map_err(|error| error.to_string())
}

/// What a motion lost, and what the second run makes of its energy.
struct Loss {
    energy: f64,
    trend: f64,
    constraint: f64,
    /// Largest difference of the energies of the two runs.
    difference: f64,
}

impl Loss {
    fn of(scene: &Scene, motion: &mut Motion, metric: &mut Metric) -> Result<Loss> {
        let Some(place) = motion.equations.invariants.iter().position(|i| i.name == "energy") else {
            anyhow::bail!("the equations do not say what the energy is");
        };
        let mut constraint = Constraint::new(scene)?;
        let start = motion.at(motion.start())?.invariants[place];
        let (mut size, mut energy, mut difference, mut residual) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut means = vec![(0.0, 0.0); PARTS];
        for (i, t) in motion.grid(SAMPLES).into_iter().enumerate() {
            let (kept, looser) = motion.at_in_both_runs(t)?;
            let error = kept.invariants[place] - start;
            size = size.max(metric.length(t, &kept.coordinates, &kept.velocities, &kept.velocities).powi(2));
            energy = energy.max(error.abs());
            difference = difference.max((kept.invariants[place] - looser.invariants[place]).abs());
            residual = residual.max(constraint.residual(t, &kept.coordinates, &kept.velocities));
            let (sum, count) = &mut means[(i * PARTS / SAMPLES).min(PARTS - 1)];
            (*sum, *count) = (*sum + error, *count + 1.0);
        }
        let means = means.into_iter().map(|(sum, count)| sum / count);
        let (low, high) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), e: f64| (a.min(e), b.max(e)));
        Ok(Loss {
            energy: energy / size,
            trend: (high - low) / size,
            constraint: residual,
            difference: difference / size,
        })
    }

    /// Where nothing else is known, energy and constraint are judged as places are.
    fn verdict(&self, motion: &Motion) -> Verdict {
        let (error, estimate) = (self.energy.max(self.constraint), self.difference);
        let off = error > (CERTAINTY * estimate).max(FLOOR) || error.is_nan() || estimate.is_nan();
        match &motion.ending {
            _ if off && motion.doubt.is_none() => Verdict::Wrong { error, estimate, t: motion.end() },
            motion::Ending::Stopped { t, cause } => Verdict::Refused { t: Some(*t), cause: cause.clone() },
            motion::Ending::Completed if estimate <= motion::TRUSTED && motion.doubt.is_none() => {
                Verdict::Accurate { error, estimate }
            }
            motion::Ending::Completed => Verdict::Admitted { error, estimate },
        }
    }
}

/// `f` and `∂f/∂v` at `(t, q, v)`.
struct Constraint {
    evaluator: Evaluator<f64>,
    inputs: Vec<f64>,
    count: usize,
}

impl Constraint {
    fn new(scene: &Scene) -> Result<Constraint> {
        let system = &scene.system;
        let velocities = system.velocities();
        let inputs = [vec![system.time], system.positions(), velocities.clone()].concat();
        let jacobian = system.graph.jacobian(&system.constraints, &velocities);
        let outputs = [&system.constraints[..], jacobian.entries()].concat();
        let evaluator = system.evaluator(&inputs, &outputs)?;
        Ok(Constraint { evaluator, inputs: Vec::new(), count: system.constraints.len() })
    }

    /// Largest `|f_i|/(|∂f_i/∂v| |v|)`.
    fn residual(&mut self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.inputs.clear();
        self.inputs.extend(std::iter::once(&t).chain(q).chain(v));
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (values, rows) = self.evaluator.evaluate(&self.inputs).split_at(self.count);
        let parts = values.iter().zip(rows.chunks_exact(v.len())).map(|(f, row)| f.abs() / (norm(row) * norm(v)));
        parts.fold(0.0, f64::max)
    }
}
