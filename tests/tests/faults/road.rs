//! Roads from a system to what is handed over, and who judges them.

use equations::{Derivation, Equations, Formulation, Plan};
use mechanics::Removal;
use scene::Scene;
use symbolic::faults::{self, Chance};

use super::judge::{self, Findings, Principle};
use super::reading::{Reading, Sample, read, samples, worst_for};
use super::removal;
use super::removed::{self, Parametrized};
use super::truth::Truth;
use super::{Guards, Way};

thread_local! {
    /// Whether panics of this thread are expected.
    pub static SPOILED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// States in which equations are read.
pub const STATES: usize = 2;

/// Motions nearer to each other than this are the same.
const SAME: f64 = 1e-7;

/// What is done with a fault in it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Stage {
    /// A removal is found.
    Remove,
    Derive,
    LeaveOut,
    Plan,
}

impl Stage {
    /// Those of the equations of a formulation.
    pub const ALL: [Stage; 3] = [Stage::Derive, Stage::LeaveOut, Stage::Plan];
}

/// One formulation of one scene, up to one stage.
struct Road {
    name: String,
    stage: Stage,
    scene: Scene,
    guardless: bool,
    truth: Truth,
    removal: Option<Removal>,
    formulation: &'static Formulation,
    samples: Vec<Sample>,
    /// What the stage begins with, after that of derivation.
    before: Option<Equations>,
    parametrized: Option<Parametrized>,
    /// What is read off where nothing is spoiled, and off what the stage began with.
    sound: Option<Reading>,
    earlier: Option<Reading>,
    chances: Vec<Chance>,
    /// Where the chosen form is least accurate.
    near: Option<Vec<f64>>,
}

/// What judges find with the k-th fault, and how far it leads.
type WithFault = Box<dyn Fn(usize) -> Result<(Findings, f64), String>>;

/// Work into which faults are put.
pub struct Trial {
    pub name: String,
    pub stage: Stage,
    pub chances: Vec<Chance>,
    /// What judges find without a fault.
    pub sound: Findings,
    /// What they find with one, and how far it leads from what is handed over without.
    pub with_fault: WithFault,
}

impl Trial {
    /// Nothing where the formulation refuses the scene.
    pub fn new(way: &Way) -> Option<Trial> {
        if way.stage == Stage::Remove {
            return removal::trial(way);
        }
        let road = Road::new(way)?;
        let sound = road.judged(road.sound.as_ref()?);
        let (name, chances) = (road.name.clone(), road.chances.clone());
        Some(Trial { name, stage: way.stage, chances, sound, with_fault: Box::new(move |which| road.spoiled(which)) })
    }

    /// What becomes of a fault.
    pub fn spoiled(&self, which: usize) -> Outcome {
        SPOILED.set(true);
        let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| (self.with_fault)(which)));
        SPOILED.set(false);
        match found {
            Ok(Ok((findings, change))) => match findings.verdict() {
                Err(_) => Outcome::Noticed,
                Ok(_) if change < SAME => Outcome::Unchanged,
                Ok(found) => Outcome::Survived { change, found },
            },
            // an error of the derivation, or of whoever evaluates what it handed over
            Ok(Err(_)) | Err(_) => Outcome::Noticed,
        }
    }
}

/// What became of a fault.
pub enum Outcome {
    /// Somebody notices.
    Noticed,
    /// Nothing that is handed over changes.
    Unchanged,
    /// A change that is no round-off, and what judges found all the same.
    Survived { change: f64, found: f64 },
}

impl Road {
    fn new(way: &Way) -> Option<Road> {
        let Way { scene, guards, formulation, ref removal, stage } = *way;
        let truth = Truth::new(&scene.system);
        let removal = removal.clone();
        let samples = samples(scene, &truth, removal.as_ref(), STATES);
        let title = removal.as_ref().map_or(String::new(), |r| format!(", {}", r.name));
        let parametrized = removal.as_ref().map(|r| Parametrized::new(&scene.system, r).expect("compiles"));
        let mut road = Road {
            name: format!("{}, {}{title}", scene.name, formulation.name),
            stage,
            scene: scene.clone(),
            guardless: guards == Guards::None && formulation.name.ends_with("reduced"),
            truth,
            removal,
            formulation,
            samples,
            before: None,
            parametrized,
            sound: None,
            near: None,
            earlier: None,
            chances: Vec::new(),
        };
        let derived = road.derived().ok()?;
        assert_eq!(road.samples.len(), STATES, "{}: too few states", road.name);
        if stage != Stage::Derive {
            road.before = Some(if stage == Stage::Plan { derived.leave_out_unneeded() } else { derived });
        }
        let (work, chances) = faults::chances(|| road.work());
        let (equations, form) = work.ok()?;
        road.chances = chances;
        let refused = |e: String| -> Reading { panic!("{}: {e}", road.name) };
        let mut sound = read(&equations, form.as_ref(), &road.samples, None).unwrap_or_else(refused);
        if let Some(form) = &form {
            road.near = worst_for(&equations, form, &road.samples[0], &sound.instants[0].y);
            sound = read(&equations, Some(form), &road.samples, road.near.as_deref()).unwrap_or_else(refused);
        }
        if let Some(before) = &road.before {
            let earlier = read(before, None, &road.samples, road.near.as_deref()).unwrap_or_else(refused);
            road.earlier = Some(earlier);
        }
        road.sound = Some(sound);
        Some(road)
    }

    fn derived(&self) -> Result<Equations, String> {
        let derivation =
            Derivation { removal: self.removal.as_ref(), start: Some(&self.scene.start), ..Default::default() };
        (self.formulation.derive)(&self.scene.system, &derivation).map_err(|e| e.to_string())
    }

    /// What faults are put into.
    fn work(&self) -> Result<(Equations, Option<Plan>), String> {
        let before = || self.before.clone().expect("made at the beginning");
        match self.stage {
            Stage::Remove | Stage::Derive => Ok((self.derived()?, None)),
            Stage::LeaveOut => Ok((before().leave_out_unneeded(), None)),
            Stage::Plan => {
                let equations = before();
                let form = Plan::choose(&equations, None).map_err(|e| e.to_string())?;
                Ok((equations, Some(form)))
            }
        }
    }

    fn judged(&self, reading: &Reading) -> Findings {
        if let Some(earlier) = &self.earlier {
            return judge::same_motion(earlier, reading);
        }
        match &self.parametrized {
            Some(removed) => removed::judge(&self.truth, removed, &self.samples, reading),
            None => {
                let chetaev = self.formulation.name.starts_with("chetaev");
                let principle = if chetaev { Principle::Chetaev } else { Principle::Vakonomic };
                let mut findings = judge::judge(&self.truth, principle, &self.samples, reading);
                let none = reading.instants.iter().all(|instant| instant.guards.is_empty());
                findings.must("variables that never break down", none || !self.guardless);
                findings
            }
        }
    }

    /// What judges find with a fault, and how far it leads from the sound motion.
    fn spoiled(&self, which: usize) -> Result<(Findings, f64), String> {
        let (equations, form) = faults::spoiled(which, self.chances.len(), || self.work())?;
        let reading = read(&equations, form.as_ref(), &self.samples, self.near.as_deref())?;
        let change = self.sound.as_ref().map_or(f64::NAN, |sound| reading.change(sound));
        Ok((self.judged(&reading), change))
    }
}
