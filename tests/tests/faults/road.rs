//! Derivation paths from a system to its equations, and their judges.

use equations::{Derivation, Formulation, Plan};
use motion::FORMS;
use symbolic::faults::{self, Chance};

use super::judge::{self, Findings, Principle};
use super::reading::{Reading, read, samples, worst_for};
use super::removed::{self, Parametrized};
use super::truth::Truth;
use super::{Guards, Way, removal};

thread_local! {
    /// Whether panics of this thread are expected.
    pub static SPOILED: std::cell::Cell<bool> = const { std::cell::Cell::new(false) };
}

/// States in which equations are read.
pub const STATES: usize = 2;

/// Motions nearer to each other than this are the same.
const SAME: f64 = 1e-7;

/// What is done with a fault in it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stage {
    /// A removal is found.
    Remove,
    Derive,
    LeaveOut,
    Plan,
}

impl Stage {
    pub const ALL: [Stage; 4] = [Stage::Remove, Stage::Derive, Stage::LeaveOut, Stage::Plan];
}

/// What judges find with the k-th fault, and how far it leads from what is handed over without.
type WithFault<'a> = Box<dyn Fn(usize) -> Result<(Findings, f64), String> + 'a>;

/// Work into which faults are put: one formulation of one scene, at one stage.
pub struct Trial<'a> {
    pub name: String,
    pub formulation: &'static Formulation,
    pub stage: Stage,
    pub chances: Vec<Chance>,
    /// What judges find without a fault.
    pub sound: Findings,
    pub with_fault: WithFault<'a>,
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

impl<'a> Trial<'a> {
    /// Nothing where the formulation refuses the scene.
    pub fn new(way: &Way<'a>) -> Option<Trial<'a>> {
        let Way { scene, guards, formulation, ref removal, stage } = *way;
        let removal = removal.clone();
        if stage == Stage::Remove {
            return removal::trial(scene, &removal?, formulation);
        }
        let truth = Truth::new(&scene.system);
        let title = removal.as_ref().map_or(String::new(), |r| format!(", {}", r.name));
        let name = format!("{}, {}{title}", scene.name, formulation.name);
        let samples = samples(scene, &truth, removal.as_ref(), STATES);
        let parametrized = removal.as_ref().map(|r| Parametrized::new(&scene.system, r).expect("compiles"));
        let derived = move || {
            let derivation = Derivation { removal: removal.as_ref(), start: Some(&scene.start), ..Default::default() };
            (formulation.derive)(&scene.system, &derivation).map_err(|e| e.to_string())
        };
        // what the stage begins with, after that of derivation
        let before = match (derived().ok()?, stage) {
            (_, Stage::Remove | Stage::Derive) => None,
            (derived, Stage::LeaveOut) => Some(derived),
            (derived, Stage::Plan) => Some(derived.leave_out_unneeded()),
        };
        assert_eq!(samples.len(), STATES, "{name}: too few states");
        let begun = before.clone();
        let work = move || match begun.clone() {
            None => Ok((derived()?, None)),
            Some(before) if stage == Stage::LeaveOut => Ok((before.leave_out_unneeded(), None)),
            Some(before) => {
                let plan = Plan::choose(&before, None).map_err(|e| e.to_string())?;
                Ok::<_, String>((before, Some(plan)))
            }
        };
        let (sound, chances) = faults::chances(&work);
        let (equations, plan) = sound.ok()?;
        let refused = |e: String| -> Reading { panic!("{name}: {e}") };
        let mut sound = read(&equations, plan.as_ref(), &samples, None).unwrap_or_else(refused);
        let near = plan.as_ref().and_then(|plan| worst_for(&equations, plan, &samples[0], &sound.instants[0].y));
        if near.is_some() {
            sound = read(&equations, plan.as_ref(), &samples, near.as_deref()).unwrap_or_else(refused);
        }
        let earlier = before.map(|before| read(&before, None, &samples, near.as_deref()).unwrap_or_else(refused));
        let guardless = guards == Guards::None && FORMS.contains(&formulation);
        let principle = Principle::of(formulation);
        let states = samples.clone();
        let judged = move |reading: &Reading| match (&earlier, &parametrized) {
            (Some(earlier), _) => judge::same_motion(earlier, reading),
            (None, Some(removed)) => removed::judge(&truth, removed, &states, reading),
            (None, None) => {
                let mut findings = judge::judge(&truth, principle, &states, reading);
                let none = reading.instants.iter().all(|instant| instant.guards.is_empty());
                findings.must("variables that never break down", none || !guardless);
                findings
            }
        };
        let (findings, count) = (judged(&sound), chances.len());
        let with_fault = move |which: usize| {
            let (equations, plan) = faults::spoiled(which, count, &work)?;
            let reading = read(&equations, plan.as_ref(), &samples, near.as_deref())?;
            Ok((judged(&reading), reading.change(&sound)))
        };
        Some(Trial { name, formulation, stage, chances, sound: findings, with_fault: Box::new(with_fault) })
    }

    /// What becomes of a fault.
    pub fn spoiled(&self, which: usize) -> Outcome {
        SPOILED.set(true);
        let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| (self.with_fault)(which)));
        SPOILED.set(false);
        match found.map(|found| found.map(|(findings, change)| (findings.verdict(), change))) {
            Ok(Ok((Ok(_), change))) if change < SAME => Outcome::Unchanged,
            Ok(Ok((Ok(found), change))) => Outcome::Survived { change, found },
            // or an error of the derivation, or of whoever evaluates what it handed over
            _ => Outcome::Noticed,
        }
    }
}
