//! Error over estimate of systems drawn from a seed, by coordinate, velocity, multiplier and time: against
//! motions in double-double arithmetic, alone and as members of an ensemble.

mod families;

use equations::Outputs;
use families::{Draw, FAMILIES, Family};
use motion::{CHETAEV, Ensemble, EnsembleOptions, Metric, Motion, Settings, choices, derive, error_estimates, setting};
use reference::{DoubleDouble, Entry, Question, Reference, ReferenceError, reference};
use scene::Scene;
use symbolic::Scalar;

/// Systems; `SYSTEMS` asks for more.
const COUNT: usize = 48;
/// Times at which errors are looked at.
const TIMES: usize = 8;
/// What no estimate goes under, over the size of what it is of: round-off of a run.
const FLOOR: f64 = 1e-14;
/// Errors over their estimates: the largest, and the part that may be over 1.
const LARGEST: f64 = 10.0;
const OVER: f64 = 0.01;
/// Accuracy of the judge, over how far the motion goes.
const ACCURACY: f64 = 1e-19;
/// Largest fraction of the motions in well-conditioned families that may be untrusted or stop.
const TOLD: f64 = 0.05;
/// Largest fraction of all systems whose motion the judge may know too inaccurately.
const UNKNOWN: f64 = 0.02;

/// Errors over estimates of one family.
#[derive(Default)]
struct Tally {
    systems: usize,
    told: usize,
    unknown: usize,
    /// Error over estimate or floor.
    ratios: Vec<f64>,
    /// Estimate over error, where there are both.
    slack: Vec<f64>,
}

impl Tally {
    fn add(&mut self, error: f64, estimate: f64, size: f64) {
        self.ratios.push(if error == 0.0 { 0.0 } else { error / estimate.max(FLOOR * size) });
        if error > 0.0 && estimate > 0.0 {
            self.slack.push(estimate / error);
        }
    }

    fn over(&self, limit: f64) -> usize {
        self.ratios.iter().filter(|ratio| ratio.is_nan() || **ratio > limit).count()
    }

    fn worst(&self) -> f64 {
        self.ratios.iter().copied().fold(0.0, |a, b| if b > a || b.is_nan() { b } else { a })
    }

    fn print(&self, name: &str) {
        let mut slack = self.slack.clone();
        slack.sort_by(f64::total_cmp);
        let median = slack.get(slack.len() / 2).copied().unwrap_or(f64::NAN);
        println!(
            "{name}: {} systems, {} told, {} without a judge; of {} errors {} over the estimate, {} over 10 times, \
             worst {:.2}; median of estimate over error {median:.1}",
            self.systems,
            self.told,
            self.unknown,
            self.ratios.len(),
            self.over(1.0),
            self.over(LARGEST),
            self.worst()
        );
    }

    fn join(&mut self, other: &Tally) {
        self.systems += other.systems;
        self.told += other.told;
        self.unknown += other.unknown;
        self.ratios.extend(&other.ratios);
        self.slack.extend(&other.slack);
    }
}

/// The motion in double-double arithmetic.
fn judge(scene: &Scene, motion: &mut Motion, times: &[f64]) -> Result<Reference, ReferenceError> {
    let choice = chetaev(scene);
    let equations = derive(&scene.system, &choice).expect("derived before");
    let mut metric = Metric::new(&scene.system).expect("compiles");
    let start = motion.at(motion.start()).expect("readable");
    let size = times.iter().fold(0.0_f64, |size, &t| {
        let now = motion.at(t).expect("readable");
        size.max(metric.distance(t, &now.coordinates, &now.velocities, &start.coordinates))
    });
    let question = Question { system: &scene.system, start: &scene.start, equations: &equations, constants: &[] };
    reference(&question, times, ACCURACY * size)
}

fn chetaev(scene: &Scene) -> motion::Choice {
    choices(scene).into_iter().find(|c| c.formulation == CHETAEV).expect("it is there")
}

fn size(values: &[DoubleDouble]) -> Vec<f64> {
    values.iter().map(|x| x.size()).collect()
}

/// `|found − truth|`
fn errors(found: &[f64], truth: &[DoubleDouble]) -> Vec<f64> {
    found.iter().zip(truth).map(|(&x, &truth)| (DoubleDouble::from_f64(x) - truth).size()).collect()
}

fn differences(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect()
}

fn raise(largest: &mut [f64], now: &[f64]) {
    largest.iter_mut().zip(now).for_each(|(a, b)| *a = a.max(*b));
}

/// The motion of a scene, its errors, and those of a member of an ensemble.
fn measure(scene: &Scene, for_judge: &Scene, alone: &mut Tally, member: &mut Tally) {
    let choice = chetaev(scene);
    let settings = Settings::default();
    let of_scene = setting(scene);
    let times: Vec<f64> = (1..=TIMES).map(|k| scene.start.t + scene.duration * k as f64 / TIMES as f64).collect();
    alone.systems += 1;
    member.systems += 1;
    let told = |tally: &mut Tally, text: String| {
        tally.told += 1;
        println!("  told: {text}");
    };
    let mut motion = match motion::solve_choice(scene, &choice, &settings) {
        Ok(motion) => motion,
        Err(error) => {
            member.told += 1;
            return told(alone, error.to_string());
        }
    };
    let (so_far, whole) = error_estimates(&mut motion, of_scene, &times).expect("readable");
    if !motion.is_complete() {
        member.told += 1;
        return told(alone, format!("{:?}", motion.ending));
    }
    let truth = match judge(for_judge, &mut motion, &times) {
        Ok(truth) => truth,
        Err(error) => {
            println!("  without a judge: {error}");
            alone.unknown += 1;
            member.unknown += 1;
            return;
        }
    };
    let mut length = [0.0_f64; 2];
    if let ("completed", None) = whole.status(&motion) {
        let (mut sizes, mut runs) = (Sizes::default(), Vec::new());
        for ((&t, truth), estimate) in times.iter().zip(&truth.points).zip(&so_far) {
            let (kept, looser) = motion.at_in_both_runs(t).expect("readable");
            let apart = differences(&kept.velocities, &looser.velocities);
            runs.resize(apart.len(), 0.0);
            raise(&mut runs, &apart);
            let estimates = [&estimate.coordinates[..], &runs, &estimate.multipliers];
            length[0] = t - motion.start();
            compare(alone, &kept, truth, estimates, &mut sizes, length[0]);
        }
    } else {
        told(alone, whole.status(&motion).1.unwrap_or_default());
    }
    let mut ensemble = Ensemble::new(scene, &choice, &[], &settings).unwrap_or_else(|e| panic!("{e}"));
    let one = ensemble.member(&[]).unwrap_or_else(|e| panic!("{e}"));
    let motions = ensemble.motions(&[one], &times, &EnsembleOptions::default());
    for found in motions {
        let Ok(found) = found else {
            member.told += 1;
            continue;
        };
        let (("completed", None), Some(estimate)) = (found.status(), &found.estimate) else {
            told(member, found.status().1.unwrap_or_default());
            continue;
        };
        let mut sizes = Sizes::default();
        for ((&t, truth), outputs) in times.iter().zip(&truth.points).zip(&found.outputs) {
            length[1] = t - scene.start.t;
            let none = vec![f64::INFINITY; outputs.velocities.len()];
            compare(
                member,
                outputs,
                truth,
                [&estimate.coordinates, &none, &estimate.multipliers],
                &mut sizes,
                length[1],
            );
        }
    }
}

/// Largest values of coordinates, velocities and multipliers so far.
#[derive(Default)]
struct Sizes([Vec<f64>; 3]);

fn compare(
    tally: &mut Tally,
    found: &Outputs,
    truth: &reference::Point<DoubleDouble>,
    estimates: [&[f64]; 3],
    sizes: &mut Sizes,
    length: f64,
) {
    let values = [
        (&found.coordinates, &truth.coordinates),
        (&found.velocities, &truth.velocities),
        (&found.multipliers, &truth.multipliers),
    ];
    for (i, ((found, truth), estimates)) in values.into_iter().zip(estimates).enumerate() {
        let mut now = size(truth);
        if i == 0 {
            // how far its velocity may have brought it, too
            let ways = size(values[1].1);
            now.iter_mut().zip(ways).for_each(|(now, v)| *now = now.max(v * length));
        }
        sizes.0[i].resize(now.len(), 0.0);
        raise(&mut sizes.0[i], &now);
        for ((error, estimate), size) in errors(found, truth).into_iter().zip(estimates).zip(&sizes.0[i]) {
            if estimate.is_finite() {
                tally.add(error, *estimate, *size);
            }
        }
    }
}

#[test]
fn errors_are_within_ten_times_their_estimates() {
    let count = std::env::var("SYSTEMS").ok().and_then(|n| n.parse().ok()).unwrap_or(COUNT);
    let mut draw = Draw::new(3636);
    let mut tallies: Vec<[Tally; 2]> = FAMILIES.iter().map(|_| Default::default()).collect();
    for index in 0..count {
        let family = index % FAMILIES.len();
        let [text, for_judge] = draw.system(&FAMILIES[family]);
        let parse = |text: &str| Scene::parse("drawn", text).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let [alone, member] = &mut tallies[family];
        let before = [alone.over(LARGEST), member.over(LARGEST)];
        measure(&parse(&text), &parse(&for_judge), alone, member);
        if [alone.over(LARGEST), member.over(LARGEST)] != before {
            println!(
                "  {}, no. {index}: up to {:.1}, {:.1} so far\n{text}",
                FAMILIES[family].name,
                alone.worst(),
                member.worst()
            );
        }
    }
    let mut faults = Vec::new();
    for (which, name) in ["alone", "as members"].into_iter().enumerate() {
        let mut all = Tally::default();
        for (Family { name: family, .. }, tally) in FAMILIES.iter().zip(&tallies) {
            tally[which].print(&format!("{name}, {family}"));
            all.join(&tally[which]);
        }
        all.print(name);
        let well = FAMILIES.iter().zip(&tallies).filter(|(family, _)| family.is_well_conditioned);
        let (told, systems) = well.fold((0, 0), |(a, b), (_, tally)| (a + tally[which].told, b + tally[which].systems));
        let errors = all.ratios.len() as f64;
        for (is_right, fault) in [
            (all.over(LARGEST) == 0, "errors over ten times their estimates"),
            (all.over(1.0) as f64 <= OVER * errors, "too many errors over their estimates"),
            (told as f64 <= TOLD * systems as f64 + 1.0, "too many well-conditioned systems are told"),
            (all.unknown as f64 <= UNKNOWN * all.systems as f64 + 1.0, "too many systems without a judge"),
        ] {
            if !is_right {
                faults.push(format!("{name}: {fault}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("; "));
}
