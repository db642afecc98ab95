//! Do judges that share nothing with the derivations notice when a sign, a term or a factor of one is wrong?
//!
//! [`symbolic::faults`] counts what can go wrong with the operations of a piece of work, and lets one of them
//! go wrong. For every formulation, form and automatic removal of every system here, and for what is done to
//! their equations afterwards, such faults are tried one by one. The judges see the numbers of the equations
//! at random states, and differences of the values of `L`, `f` and `Q`. A fault with which the equations are
//! of the same motion is none; every other one has to be noticed, or explained in `explained.toml`.

mod explained;
mod judge;
mod reading;
mod removal;
mod removed;
mod road;
mod truth;

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use deltaq::{FORMS, FORMULATIONS};
use equations::Formulation;
use explained::{Place, explain};
use mechanics::Removal;
use scene::Scene;

use road::{Outcome, Stage, Trial};

/// A scene by its name, numbers in the place of its own, and what is known of its guards.
type BuiltIn = (&'static str, &'static [(&'static str, f64)], Guards);

/// Built-in scenes, with numbers of one size where the built-in ones are not.
const SCENES: [BuiltIn; 10] = [
    ("sledge", &[], Guards::None),
    ("ball-in-cone", &[("a", 0.6)], Guards::Some),
    ("heisenberg", &[], Guards::None),
    ("sleigh", &[], Guards::None),
    ("disc", &[], Guards::None),
    ("turntable", &[("a", 0.5)], Guards::Some),
    ("appell-hamel", &[], Guards::Some),
    ("velocity-pendulum", &[], Guards::Some),
    ("bowl", &[], Guards::None),
    ("planar-body", &[], Guards::None),
];

/// Systems of this test: time, forces, second rates, memory.
const OWN: [(&str, &str); 5] = [
    ("charged", include_str!("charged.toml")),
    ("driven", include_str!("driven.toml")),
    ("pushed", include_str!("pushed.toml")),
    ("second-order", include_str!("second-order.toml")),
    ("memory", include_str!("memory.toml")),
];

/// Whether there is a choice of variables that never breaks down.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Guards {
    None,
    Some,
}

/// Faults that are tried on one road of those that one place has there.
const A_PLACE: usize = 6;

/// A road that is yet to be taken.
pub struct Way<'a> {
    pub scene: &'a Scene,
    pub guards: Guards,
    pub formulation: &'static Formulation,
    pub removal: Option<Removal>,
    pub stage: Stage,
}

fn ways(scene: &Scene, guards: Guards) -> Vec<Way<'_>> {
    let mut removals = scene.removals.clone();
    removals.extend(Removal::by_coordinates(&scene.system, &scene.start));
    removals.extend(Removal::by_quasi_velocities(&scene.system, &scene.start));
    // L does not contain a rate of its parameters: there are no equations to be read off
    removals.retain(|removal| removal.name != "by-heading");
    let mut ways = Vec::new();
    for formulation in FORMULATIONS.iter().chain(FORMS) {
        let with = if formulation.needs_removal { removals.iter().map(Some).collect() } else { vec![None] };
        if formulation.needs_removal {
            let found = removals.iter().map(|r| Way {
                scene,
                guards,
                formulation,
                removal: Some(r.clone()),
                stage: Stage::Remove,
            });
            ways.extend(found);
        }
        for (removal, stage) in with.into_iter().flat_map(|r| Stage::ALL.map(|stage| (r.cloned(), stage))) {
            ways.push(Way { scene, guards, formulation, removal, stage });
        }
    }
    ways
}

/// How many faults ended how.
#[derive(Default)]
struct Tally {
    roads: usize,
    noticed: usize,
    unchanged: usize,
    survived: usize,
}

#[derive(Default)]
struct Results {
    stages: BTreeMap<Stage, Tally>,
    /// How often faults of a place were noticed.
    places: BTreeMap<Place, usize>,
    survivors: BTreeMap<Place, Vec<String>>,
}

impl Results {
    fn take(&mut self, way: &Way, a_place: usize) {
        let Some(road) = Trial::new(way) else { return };
        road.sound.verdict().unwrap_or_else(|words| panic!("{}, {:?}, sound: {words}", road.name, road.stage));
        let tally = self.stages.entry(road.stage).or_default();
        tally.roads += 1;
        for (which, place) in thinned(&road, a_place) {
            let noticed = self.places.entry(place.clone()).or_default();
            match road.spoiled(which) {
                Outcome::Noticed => {
                    tally.noticed += 1;
                    *noticed += 1;
                }
                Outcome::Unchanged => tally.unchanged += 1,
                Outcome::Survived { change, found } => {
                    tally.survived += 1;
                    let words =
                        format!("{}, {:?}, {which}: change {change:.1e}, found {found:.1e}", road.name, road.stage);
                    self.survivors.entry(place).or_default().push(words);
                }
            }
        }
    }

    fn add(&mut self, other: Results) {
        for (stage, tally) in other.stages {
            let sum = self.stages.entry(stage).or_default();
            sum.roads += tally.roads;
            sum.noticed += tally.noticed;
            sum.unchanged += tally.unchanged;
            sum.survived += tally.survived;
        }
        other.places.into_iter().for_each(|(place, noticed)| *self.places.entry(place).or_default() += noticed);
        other.survivors.into_iter().for_each(|(place, words)| self.survivors.entry(place).or_default().extend(words));
    }
}

/// The chances of a road, of each place as many as said, evenly spread.
fn thinned(road: &Trial, a_place: usize) -> Vec<(usize, Place)> {
    let mut of: BTreeMap<Place, Vec<usize>> = BTreeMap::new();
    for (which, chance) in road.chances.iter().enumerate() {
        of.entry(Place::new(chance)).or_default().push(which);
    }
    let spread = |(place, all): (Place, Vec<usize>)| {
        let count = all.len().min(a_place);
        (0..count).map(move |i| (all[i * all.len() / count], place.clone())).collect::<Vec<_>>()
    };
    of.into_iter().flat_map(spread).collect()
}

fn scenes() -> Vec<(Scene, Guards)> {
    let built_in = SCENES.iter().map(|(name, numbers, guards)| {
        let numbers: Vec<(String, f64)> = numbers.iter().map(|&(name, x)| (name.into(), x)).collect();
        (validation::catalogue::find(name, &numbers).unwrap_or_else(|e| panic!("{e}")), *guards)
    });
    let own = OWN.iter().map(|(name, text)| (Scene::parse(name, text).unwrap_or_else(|e| panic!("{e}")), Guards::Some));
    built_in.chain(own).collect()
}

/// Tries so many faults of each place on each road.
fn try_faults(a_place: usize) {
    let begun = Instant::now();
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !road::SPOILED.get() {
            told(info)
        }
    }));
    let (all, next) = (Mutex::new(Results::default()), AtomicUsize::new(0));
    let work = || {
        // a graph is not shared between threads
        let (scenes, mut own) = (scenes(), Results::default());
        let ways: Vec<Way> = scenes.iter().flat_map(|(scene, guards)| ways(scene, *guards)).collect();
        while let Some(way) = ways.get(next.fetch_add(1, Ordering::Relaxed)) {
            own.take(way, a_place);
        }
        all.lock().expect("no thread has panicked").add(own);
    };
    let threads = std::thread::available_parallelism().map_or(2, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| _ = scope.spawn(work)));
    let all = all.into_inner().expect("no thread has panicked");

    println!("{:<10} {:>6} {:>8} {:>8} {:>12} {:>9}", "stage", "roads", "faults", "noticed", "same motion", "survived");
    for (stage, Tally { roads, noticed, unchanged, survived }) in &all.stages {
        let faults = noticed + unchanged + survived;
        println!("{:<10} {roads:>6} {faults:>8} {noticed:>8} {unchanged:>12} {survived:>9}", format!("{stage:?}"));
    }
    let never: Vec<&Place> = all.places.iter().filter(|(_, noticed)| **noticed == 0).map(|(place, _)| place).collect();
    println!("\n{} places, {} of them without a fault that is noticed:", all.places.len(), never.len());
    never.iter().for_each(|place| println!("   {place}"));
    let unexplained = explain(&all.survivors);
    println!("\n{:.1} s on {threads} threads", begun.elapsed().as_secs_f64());
    assert!(unexplained.is_empty(), "{}", unexplained.join("\n"));
}

#[test]
fn faults_are_noticed() {
    try_faults(A_PLACE);
}

#[test]
#[ignore = "takes minutes: every fault of every place"]
fn every_fault_is_noticed() {
    try_faults(usize::MAX);
}
