//! Throughput of ensembles: sledges with random starts one by one, in lanes, and in lanes over all cores.
//!
//! All ways take the same members, the same equations compiled once, the same method, tolerance and projection. One by one is the ordinary time
//! loop, which keeps the ends of a run only ([`integrate::Dense::EndOnly`]).

use std::time::Instant;

use anyhow::{Result, bail, ensure};
use deltaq::{
    Choice, Ensemble, EnsembleMember, EnsembleOptions, EnsembleStart, Settings, choices, ready_to_run, setting,
};
use integrate::{Dense, Method, Options, Status};
use mechanics::{ConstantsRule, Scene, State};

use crate::catalogue;

/// Members of an ensemble whose throughput is measured.
pub const MEMBERS: usize = 4096;

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
    /// Seconds for all members one by one, in lanes on one core, and in lanes on `threads` cores; each the least of several.
    pub seconds: [f64; 3],
    /// Cores of the last of these.
    pub threads: usize,
    /// Steps of all members, one by one and in lanes.
    pub steps: [usize; 2],
    /// Largest difference of a state at the end between a member in lanes and the same member one by one, over the larger of 1 and that state.
    pub difference: f64,
    /// The same, on one core and on all of them: zero.
    pub over_cores: f64,
}

impl Throughput {
    /// Throughput in lanes over that one by one.
    pub fn over_single(&self) -> f64 {
        self.seconds[0] / self.seconds[1]
    }

    /// Throughput on all cores over that on one.
    pub fn over_one_core(&self) -> f64 {
        self.seconds[1] / self.seconds[2]
    }
}

/// Sledges that start anywhere on the slope, in any direction, at up to 2 m/s along the blade and 2 rad/s: on the constraint exactly.
fn starts(count: usize) -> Vec<State> {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut number = |from: f64, to: f64| {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        from + (to - from) * ((seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
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
    let scene = catalogue::find("sledge", &[])?;
    let starts = starts(count);
    let wanted = ["chetaev", "vakonomic", "removed-constraint"];
    let all = choices(&scene);
    let first = |name: &&str| all.iter().find(|choice| choice.formulation == *name).cloned();
    wanted.iter().filter_map(first).map(|choice| throughput(&scene, choice, &starts, tolerance, repeats)).collect()
}

fn throughput(scene: &Scene, choice: Choice, starts: &[State], tolerance: f64, repeats: usize) -> Result<Throughput> {
    let settings = Settings { method: Method::Taylor, tolerance, ..Settings::default() };
    let end = setting(scene).end;
    // Natural constants belong to the horizon and the parameters, not to the start: those of the scene serve for all.
    let equations = deltaq::derive_at(&scene.system, &scene.start, &choice)?;
    let mut ready = ready_to_run(setting(scene), equations, &choice.constants, &settings)?;
    let choice = Choice { constants: ConstantsRule::Given(ready.constants.clone()), ..choice };
    let mut ensemble = Ensemble::new(scene, &choice, &[], &settings)?;
    let clock = Instant::now();
    let start = |state| EnsembleStart { state, end, parameters: &[], constants: &choice.constants };
    let members: Vec<EnsembleMember> =
        starts.iter().map(|state| ensemble.member_at(start(state))).collect::<Result<_, _>>()?;
    let prepare = clock.elapsed().as_secs_f64();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
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
        seconds: [f64::INFINITY; 3],
        threads,
        steps: [0; 2],
        difference: 0.0,
        over_cores: 0.0,
    };
    for _ in 0..repeats.max(1) {
        let clock = Instant::now();
        let mut single = Vec::with_capacity(members.len());
        let mut steps = 0;
        for member in &members {
            ready.start.copy_from_slice(member.start());
            let mut run = ready.integrate(end, &options)?;
            if let Status::Stopped { t, cause } = &run.status {
                bail!("{}: a member stops at t = {t:.3}: {cause}", choice.label);
            }
            let mut y = vec![0.0; member.start().len()];
            run.states_at(&mut ready, end, &mut y)?;
            steps += run.work.steps;
            single.push(y);
        }
        result.seconds[0] = result.seconds[0].min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        let lanes = ensemble.run(&members, &[end], &one);
        result.seconds[1] = result.seconds[1].min(clock.elapsed().as_secs_f64());
        let clock = Instant::now();
        let cores = ensemble.run(&members, &[end], &many);
        result.seconds[2] = result.seconds[2].min(clock.elapsed().as_secs_f64());
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

/// A table of them.
pub fn ensemble_table(measured: &[Throughput]) -> String {
    let mut text = format!(
        "{:<36} {:>9} {:>8} {:>11} {:>11} {:>11} {:>7} {:>7} {:>9} {:>6}\n",
        "formulation", "tolerance", "members", "one by one", "lanes", "all cores", "ratio", "cores", "differ", "alone"
    );
    for m in measured {
        let per_member = m.seconds.map(|s| format!("{:.2} µs", 1e6 * s / m.members as f64));
        text += &format!(
            "{:<36} {:>9.0e} {:>8} {:>11} {:>11} {:>11} {:>7.2} {:>7.2} {:>9.1e} {:>6}\n",
            m.label,
            m.tolerance,
            m.members,
            per_member[0],
            per_member[1],
            per_member[2],
            m.over_single(),
            m.over_one_core(),
            m.difference,
            m.alone.0
        );
        if let Some(why) = &m.alone.1 {
            text += &format!("  alone, the first of them: {why}\n");
        }
    }
    text
}
