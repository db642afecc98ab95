//! Throughput of ensembles: sledges with random starts one by one, in lanes, and in lanes over all cores.
//!
//! All ways take the same members, equations compiled once, method, tolerance and projection. One by one is
//! the ordinary time loop, which keeps the ends of a run only ([`integrate::Dense::EndOnly`]).

use equations::Formulation;
use std::time::Instant;

use anyhow::{Result, bail, ensure};
use integrate::{Dense, Method, Options, Status};
use mechanics::{ConstantsRule, State};
pub use motion::band::CHUNK as MEMBERS;
use motion::{
    CHETAEV, Choice, Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, Prepared, REMOVED_CONSTRAINT, Settings,
    VAKONOMIC, choices, prepare, setting,
};
use scene::Scene;
use symbolic::SplitMix;

/// The scene whose members they are.
pub const ENSEMBLE_SCENE: &str = "sledge";

/// Members of an ensemble in the main job, which has other things to do as well; for throughput [`MEMBERS`].
pub const FEW_MEMBERS: usize = 256;

/// What was measured of one formulation.
#[derive(Clone, Debug)]
pub struct Throughput {
    /// What the reader sees.
    pub label: String,
    /// Tolerance of every run.
    pub tolerance: f64,
    /// Number of members.
    pub members: usize,
    /// Members that were integrated alone, and why the first of them was.
    pub alone: (usize, Option<String>),
    /// Seconds to find starts of the members' states, which no way of integrating them includes.
    pub prepare: f64,
    /// All members one by one, in lanes on one core, and in lanes on `threads` cores.
    pub one_by_one: Time,
    /// See above.
    pub lanes: Time,
    /// See above.
    pub cores: Time,
    /// Cores of the last of these.
    pub threads: usize,
    /// Accepted steps of all members, one by one and in lanes.
    pub steps: [usize; 2],
    /// Largest difference of a state at the end, in lanes and one by one, over `max(1, |state|)`.
    pub difference: f64,
    /// The same, on one core and on all of them: zero.
    pub over_cores: f64,
}

/// What something took, the least of several times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Time {
    /// Seconds of the clock.
    pub clock: f64,
    /// Seconds of all processors for this process alone, where the system tells.
    pub processors: Option<f64>,
}

impl Time {
    const NEVER: Time = Time { clock: f64::INFINITY, processors: Some(f64::INFINITY) };

    /// Runs `work`, and keeps its time if it is less.
    fn of<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let (clock, before) = (Instant::now(), processor_seconds());
        let result = work();
        let spent = processor_seconds().zip(before).map(|(now, before)| now - before);
        self.processors = self.processors.zip(spent).map(|(least, spent)| least.min(spent));
        self.clock = self.clock.min(clock.elapsed().as_secs_f64());
        result
    }
}

#[cfg(unix)]
fn processor_seconds() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

#[cfg(not(unix))]
fn processor_seconds() -> Option<f64> {
    None
}

impl Throughput {
    /// Throughput in lanes over that one by one.
    pub fn over_single(&self) -> f64 {
        self.one_by_one.clock / self.lanes.clock
    }

    /// Throughput on all cores over that on one.
    pub fn over_one_core(&self) -> f64 {
        self.lanes.clock / self.cores.clock
    }

    /// Processor time in lanes on one core over that on all: 1 where dividing the work costs nothing. Times
    /// the cores, it is [`Throughput::over_one_core`] if they did nothing else and none waited for another.
    pub fn efficiency(&self) -> Option<f64> {
        Some(self.lanes.processors? / self.cores.processors?)
    }

    /// Microseconds of the clock for a member, in the order of the fields.
    pub fn microseconds(&self) -> [f64; 3] {
        [self.one_by_one, self.lanes, self.cores].map(|time| 1e6 * time.clock / self.members as f64)
    }

    /// Accepted steps of a member on average, one by one and in lanes.
    pub fn mean_steps(&self) -> [f64; 2] {
        self.steps.map(|steps| steps as f64 / self.members as f64)
    }
}

/// Sledges anywhere on the slope, any heading, ≤ 2 m/s along the blade, ≤ 2 rad/s: on the constraint exactly.
fn starts(count: usize) -> Vec<State> {
    let mut random = SplitMix::new(1);
    let mut number = |from: f64, to: f64| from + (to - from) * random.unit();
    let mut start = || {
        let (x, y, phi) = (number(-1.0, 1.0), number(-1.0, 1.0), number(-1.2, 1.2));
        let (speed, rate) = (number(-2.0, 2.0), number(-2.0, 2.0));
        State { t: 0.0, q: vec![x, y, phi], v: vec![speed * phi.cos(), speed * phi.sin(), rate] }
    };
    (0..count).map(|_| start()).collect()
}

/// Measures ensembles of `count` sledges at `tolerance`, each way `repeats` times in turn.
///
/// # Errors
/// Where the scene or a start is at fault, or a member stops before its end.
pub fn ensemble_throughput(count: usize, tolerance: f64, repeats: usize) -> Result<Vec<Throughput>> {
    let scene = scene::catalogue::find(ENSEMBLE_SCENE, &[])?;
    let starts = starts(count);
    let wanted = [CHETAEV, VAKONOMIC, REMOVED_CONSTRAINT];
    let all = choices(&scene);
    let first = |own: &&Formulation| all.iter().find(|choice| choice.formulation == *own).cloned();
    wanted.iter().filter_map(first).map(|choice| throughput(&scene, choice, &starts, tolerance, repeats)).collect()
}

fn throughput(scene: &Scene, choice: Choice, starts: &[State], tolerance: f64, repeats: usize) -> Result<Throughput> {
    let settings = Settings { method: Some(Method::Taylor), tolerance, ..Settings::default() };
    let end = setting(scene).end;
    // Natural constants belong to horizon and parameters, not to the start: the scene's serve for all.
    let (equations, _) = motion::derive_in_form(&scene.system, &scene.start, &choice, settings.form)?;
    let mut ready = prepare(setting(scene), equations, &choice.constants, &settings)?;
    let choice = Choice { constants: ConstantsRule::Given(ready.constants.clone()), ..choice };
    let mut ensemble = Ensemble::new(scene, &choice, &[], &settings)?;
    let clock = Instant::now();
    let constants = &choice.constants;
    let start = |state: &State| EnsembleStart {
        state: state.clone(),
        end,
        parameters: Vec::new(),
        constants: constants.clone(),
    };
    let members: Vec<EnsembleMember> =
        starts.iter().map(|state| ensemble.member_at(&start(state))).collect::<Result<_, _>>()?;
    let prepare = clock.elapsed().as_secs_f64();
    let threads = program::parallel::threads();
    let mut options = Options::with_tolerance(tolerance);
    (options.method, options.dense) = (Method::Taylor, Dense::EndOnly);
    let one = EnsembleOptions { threads: 1, estimate: false };
    let many = EnsembleOptions { threads, ..one };
    let mut result = Throughput {
        label: choice.label.clone(),
        tolerance,
        members: members.len(),
        alone: (0, None),
        prepare,
        one_by_one: Time::NEVER,
        lanes: Time::NEVER,
        cores: Time::NEVER,
        threads,
        steps: [0; 2],
        difference: 0.0,
        over_cores: 0.0,
    };
    for _ in 0..repeats.max(1) {
        let (single, steps) = result.one_by_one.of(|| one_by_one(&mut ready, &members, end, &options))?;
        let lanes = result.lanes.of(|| ensemble.run(&members, &[end], &one));
        let cores = result.cores.of(|| ensemble.run(&members, &[end], &many));
        result.steps = [steps, 0];
        result.alone = (0, None);
        for ((single, lanes), cores) in single.iter().zip(lanes).zip(cores) {
            let (lanes, cores) = (lanes?, cores?);
            ensure!(lanes.states.len() == 1 && cores.states.len() == 1, "{}: a member is not complete", choice.label);
            let by = |a: &[f64], b: &[f64]| {
                a.iter().zip(b).map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).fold(0.0, f64::max)
            };
            result.difference = result.difference.max(by(single, &lanes.states[0]));
            result.over_cores = result.over_cores.max(by(&lanes.states[0], &cores.states[0]));
            result.steps[1] += lanes.work.steps;
            if let Some(why) = lanes.alone {
                result.alone.0 += 1;
                result.alone.1.get_or_insert(why);
            }
        }
    }
    ensure!(result.difference.is_finite(), "{}: a member is not finite", choice.label);
    Ok(result)
}

/// States at the end, and accepted steps.
fn one_by_one(
    ready: &mut Prepared,
    members: &[EnsembleMember],
    end: f64,
    options: &Options,
) -> Result<(Vec<Vec<f64>>, usize)> {
    let (mut states, mut steps) = (Vec::with_capacity(members.len()), 0);
    for member in members {
        ready.start.copy_from_slice(member.start());
        let run = ready.integrate(end, options)?;
        if let Status::Stopped { t, cause } = &run.solution.status {
            bail!("a member stops at t = {t:.3}: {cause}");
        }
        let mut y = vec![0.0; member.start().len()];
        run.states_at(&mut ready.compiled, end, &mut y)?;
        steps += run.solution.work.steps;
        states.push(y);
    }
    Ok((states, steps))
}
