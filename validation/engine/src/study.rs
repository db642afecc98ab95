//! The limit of the engine's motion as its time step shrinks.

use bench::exponent;
use motion::{CHETAEV, Ending, Settings, VAKONOMIC_COSTATE, choices, solve_choice};
use scene::Scene;

use crate::{Ball, Contacts, EngineError, Mapping, Pose, Run, Setup, Trajectory};

/// Times at which motions are compared, besides the start.
pub const SAMPLES: usize = 100;
/// The order that is expected of the engine, and how far the measured one may be from it.
pub const ORDER: (f64, f64) = (1.0, 0.15);
/// How near to Chetaev's motion the extrapolated one has to come, relative.
pub const NEAR: f64 = 1e-4;
/// How many times further than Chetaev's the motions of the other formulations have to be.
pub const FAR: f64 = 100.0;

/// The motion of one formulation, as poses of the ball.
#[derive(Clone, Debug)]
pub struct Target {
    /// What the reader sees.
    pub label: String,
    /// Name of the formulation.
    pub formulation: String,
    /// Poses at the sampling times that the motion reaches.
    pub poses: Vec<Pose>,
    /// Why it reaches none, or not all.
    pub remark: Option<String>,
}

/// The engine at one time step.
#[derive(Clone, Debug)]
pub struct Level {
    /// Time step, s.
    pub dt: f64,
    /// Largest distance to each target, relative to [`Study::scale`]; NaN where the target has no motion.
    pub distances: Vec<f64>,
    /// The same after Richardson's extrapolation with the level before, which has twice the time step.
    pub extrapolated: Option<Vec<f64>>,
    /// Largest distance of the ball from the surface, m.
    pub off_surface: f64,
}

/// Time steps, as powers of two.
#[derive(Clone, Copy, Debug)]
pub struct Ladder {
    /// Steps of the coarsest run, a multiple of [`SAMPLES`].
    pub coarsest: usize,
    /// Runs, each with twice the steps of the one before.
    pub runs: u32,
}

/// One scene in the engine, beside its formulations.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name: that of the scene.
    pub name: String,
    /// One line.
    pub title: String,
    /// What the engine got.
    pub setup: Setup,
    /// Velocity of the contact point at the start, m/s.
    pub residual: f64,
    /// Length of the motions, s.
    pub duration: f64,
    /// Largest distance of the first target from its start, m ([`Pose::distance`]).
    pub scale: f64,
    /// Chetaev's motion first.
    pub targets: Vec<Target>,
    /// Relative distance of each target from the first.
    pub apart: Vec<f64>,
    /// Runs with [`Contacts::HARD`], coarsest first.
    pub hard: Vec<Level>,
    /// Runs with [`Contacts::YIELDING`].
    pub yielding: Vec<Level>,
    /// Runs with [`Contacts::AsShipped`].
    pub shipped: Vec<Level>,
}

impl Study {
    /// A scene with all formulations (without the vakonomic costate form: it is the same motion).
    ///
    /// # Errors
    /// [`EngineError`] if the scene is not mapped or the ball is lost. A refusing formulation is a remark.
    pub fn of_scene(scene: &Scene, ladder: Ladder) -> Result<Study, EngineError> {
        let mapping = Mapping::new(scene)?;
        let mut targets = Vec::new();
        for choice in choices(scene).into_iter().filter(|c| c.formulation != VAKONOMIC_COSTATE) {
            let mut target = Target {
                label: choice.label.clone(),
                formulation: choice.formulation.name.into(),
                poses: vec![],
                remark: None,
            };
            match solve_choice(scene, &choice, &Settings::default()) {
                Ok(mut motion) => {
                    for time in (0..=SAMPLES).map(|k| scene.start.t + scene.duration * k as f64 / SAMPLES as f64) {
                        if time <= motion.end() {
                            target.poses.push(mapping.pose(&motion.at(time)?.coordinates));
                        }
                    }
                    if let Ending::Stopped { t, cause } = &motion.ending {
                        target.remark = Some(format!("stops at {t:.3} s: {cause}"));
                    }
                }
                Err(error) => target.remark = Some(format!("refuses: {error}")),
            }
            targets.push(target);
        }
        Study::measured([&scene.name, &scene.title], mapping.setup, scene.duration, targets, ladder)
    }

    /// A homogeneous ball (1 kg, 0.1 m) from rest on a plane of slope 0.3 rad, 1 s, against its closed
    /// solution: `s = ½ · 5/7 g sin α t²` downhill, turned by `s/a`. Integrable, so all formulations agree.
    ///
    /// # Errors
    /// As [`Study::of_scene`].
    pub fn of_incline(ladder: Ladder) -> Result<Study, EngineError> {
        let (slope, duration, radius) = (0.3_f64, 1.0, 0.1);
        let ball = Ball { mass: 1.0, radius, gyration: (0.4_f64).sqrt() * radius };
        let setup = Setup::incline(slope, ball, 9.81);
        let downhill = rapier3d_f64::math::Vector::new(slope.cos(), 0.0, -slope.sin());
        let poses = (0..=SAMPLES).map(|k| {
            let time = duration * k as f64 / SAMPLES as f64;
            let way = 0.5 * 5.0 / 7.0 * setup.gravity * slope.sin() * time * time;
            let attitude = rapier3d_f64::math::Rotation::from_rotation_y(way / radius);
            Pose { centre: setup.pose.centre + way * downhill, attitude }
        });
        let closed = Target {
            label: "5/7 g sin α".into(),
            formulation: CHETAEV.name.into(),
            poses: poses.collect(),
            remark: Some("all formulations agree: the constraint is integrable".into()),
        };
        Study::measured(["incline", "Homogeneous ball on an incline"], setup, duration, vec![closed], ladder)
    }

    fn measured(
        [name, title]: [&str; 2],
        setup: Setup,
        duration: f64,
        targets: Vec<Target>,
        ladder: Ladder,
    ) -> Result<Study, EngineError> {
        let residual = setup.slip(setup.pose.centre, setup.velocity, setup.spin).length();
        let (name, title) = (name.into(), title.into());
        let gyration = setup.ball.gyration;
        let first = &targets[0].poses;
        let scale = distance(first, &vec![setup.pose; first.len()], gyration);
        let apart = targets.iter().map(|t| distance(first, &t.poses, gyration) / scale).collect();
        let [hard, yielding, shipped] = Default::default();
        let study = Study { name, title, setup, residual, duration, scale, targets, apart, hard, yielding, shipped };
        let levels = |contacts| study.levels(ladder, contacts);
        let [hard, yielding, shipped] = std::thread::scope(|scope| {
            let kinds = [Contacts::HARD, Contacts::YIELDING, Contacts::AsShipped];
            let threads = kinds.map(|contacts| scope.spawn(move || levels(contacts)));
            threads.map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        Ok(Study { hard: hard?, yielding: yielding?, shipped: shipped?, ..study })
    }

    fn levels(&self, ladder: Ladder, contacts: Contacts) -> Result<Vec<Level>, EngineError> {
        let mut levels = Vec::new();
        let mut coarser: Option<Trajectory> = None;
        for run in 0..ladder.runs {
            let steps = ladder.coarsest << run;
            let trajectory = Run { contacts, duration: self.duration, steps, samples: SAMPLES }.of(&self.setup)?;
            let extrapolated = coarser.map(|coarser| {
                let pairs = trajectory.poses.iter().zip(&coarser.poses);
                self.to_targets(&pairs.map(|(fine, coarse)| fine.extrapolated(coarse)).collect::<Vec<Pose>>())
            });
            levels.push(Level {
                dt: self.duration / steps as f64,
                distances: self.to_targets(&trajectory.poses),
                extrapolated,
                off_surface: trajectory.off_surface,
            });
            coarser = Some(trajectory);
        }
        Ok(levels)
    }

    fn to_targets(&self, poses: &[Pose]) -> Vec<f64> {
        let gyration = self.setup.ball.gyration;
        self.targets.iter().map(|target| distance(poses, &target.poses, gyration) / self.scale).collect()
    }

    /// The result of the runs.
    pub fn finding(&self) -> Finding {
        let distances = |levels: &[Level]| levels.iter().map(|level| level.distances[0]).collect::<Vec<f64>>();
        let extrapolated = |levels: &[Level]| {
            let extrapolated = levels.iter().filter_map(|level| level.extrapolated.as_ref());
            extrapolated.map(|distances| distances[0]).collect::<Vec<f64>>()
        };
        let smallest = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
        let hard = extrapolated(&self.hard);
        let finest = self.hard.last().map_or(&[][..], |level| &level.distances);
        let others: Vec<f64> = finest.iter().skip(1).copied().filter(|distance| distance.is_finite()).collect();
        let nearest = smallest(&distances(&self.hard));
        Finding {
            order: order(&self.hard),
            nearest,
            extrapolated: smallest(&hard),
            falling: hard.windows(2).last().is_some_and(|pair| pair[1] < 0.5 * pair[0]),
            others: smallest(&others) / nearest,
            yielding: smallest(&extrapolated(&self.yielding)),
            shipped: smallest(&distances(&self.shipped)),
        }
    }
}

/// Largest distance over the times that both reach, m; NaN where there is none but the start.
fn distance(one: &[Pose], two: &[Pose], gyration: f64) -> f64 {
    if one.len().min(two.len()) < 2 {
        return f64::NAN;
    }
    one.iter().zip(two).map(|(a, b)| a.distance(b, gyration)).fold(0.0, f64::max)
}

/// The end of a [`Study`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Exponent of `dt` in the distance to Chetaev's motion, by least squares over all runs.
    pub order: f64,
    /// Smallest relative distance to Chetaev's motion.
    pub nearest: f64,
    /// The same after Richardson's extrapolation.
    pub extrapolated: f64,
    /// Whether the last halving of the step still at least halved the extrapolated distance: no floor yet.
    pub falling: bool,
    /// How many times as far the nearest motion of another formulation is; infinite where there is no other.
    pub others: f64,
    /// [`Finding::extrapolated`] with contacts that yield.
    pub yielding: f64,
    /// Smallest relative distance to Chetaev's motion with contacts as shipped.
    pub shipped: f64,
}

impl Finding {
    /// Whether the motion tends to Chetaev's at first order, comes near it, and stays far from the others.
    pub fn holds(&self) -> bool {
        (self.order - ORDER.0).abs() <= ORDER.1 && self.extrapolated <= NEAR && self.others >= FAR
    }
}

/// Slope of `ln distance` over `ln dt`, first target; NaN for fewer than three levels.
pub fn order(levels: &[Level]) -> f64 {
    let points: Vec<(f64, f64)> = levels.iter().map(|level| (level.dt, level.distances[0])).collect();
    exponent(&points).map_or(f64::NAN, |fit| fit.value)
}
