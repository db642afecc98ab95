//! Do judges that share nothing with the derivations notice when a sign, a term or a factor of one is wrong?
//!
//! [`symbolic::faults`] counts what can go wrong with the operations of a piece of work, and lets one of them
//! go wrong. For every formulation, form and automatic removal of every system here, and for what is done to
//! their equations afterwards, such faults are tried one by one. The judges see the numbers of the equations
//! at random states, and differences of the values of `L`, `f` and `Q`. A fault with which the equations are
//! of the same motion is none; every other one has to be noticed, or explained in [`EXPLAINED`].

mod judge;
mod reading;
mod removal;
mod removed;
mod road;
mod truth;

use std::collections::{BTreeMap, BTreeSet};
use std::panic::Location;
use std::path::Path;
use std::time::Instant;

use equations::Formulation;
use mechanics::{Parameter, Removal};
use motion::{FORMS, FORMULATIONS, over_threads};
use scene::Scene;

use road::{Outcome, Stage, Trial};

/// Whether there is a choice of variables that never breaks down.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Guards {
    None,
    Some,
}

/// Name, numbers in the place of the scene's, and guards.
type Asked = (&'static str, &'static [(&'static str, f64)], Guards);

/// Built-in scenes with what is known of their guards, and with numbers of one size where their own are not.
const SCENES: [Asked; 10] = [
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

/// Faults that no judge can notice: the end of the path, the line, what goes wrong there, the reason.
const EXPLAINED: [[&str; 4]; 2] = [
    [
        "mechanics/src/automatic_removal.rs",
        "let denominator = g.product(&g.denominators(&entries));",
        "factor dropped",
        "u' times a function of q is the rate of another parameter of the same directions; that this one needs no \
         chart is shown by the example of the function",
    ],
    [
        "mechanics/src/speeds.rs",
        "let mass = number(g.derivative(g.derivative(system.lagrangian, v), v)).abs();",
        "derivative left out",
        "which velocities are solved for is a choice, and every regular one gives a removal; that it does not \
         depend on units is shown by `units_change_no_word`",
    ],
];

/// Number of faults per place that are tried on one derivation path; `FAULTS_A_PLACE=N` tries more, or all.
/// Each path begins with another one, so that the paths of fifteen systems together try most of them.
const A_PLACE: usize = 1;

/// A derivation path that is still to be tried.
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
    let of = |formulation: &'static Formulation| {
        let needed = formulation.needs_removal();
        let removals = if needed { removals.iter().cloned().map(Some).collect() } else { vec![None] };
        let stages = move |removal: Option<Removal>| {
            let stages = Stage::ALL.into_iter().skip(usize::from(!needed));
            stages.map(move |stage| Way { scene, guards, formulation, removal: removal.clone(), stage })
        };
        removals.into_iter().flat_map(stages)
    };
    FORMULATIONS.iter().chain(FORMS).copied().flat_map(of).collect()
}

/// Where an operation is asked for, and what goes wrong with it.
type Place = (&'static Location<'static>, &'static str);

/// The text of the line.
fn line(at: &Location) -> String {
    let source = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(at.file()));
    source.unwrap_or_default().lines().nth(at.line() as usize - 1).unwrap_or_default().trim().to_owned()
}

fn words((at, what): &Place) -> String {
    format!("{at} {what}: {}", line(at))
}

/// A fault, its derivation path, and the outcome.
struct Fault {
    road: String,
    formulation: &'static Formulation,
    stage: Stage,
    place: Place,
    outcome: Outcome,
}

/// The scene with all that formulations need besides its own: parameters, and conditions on virtual
/// displacements that are not the constraints.
fn with_needs(scene: Scene) -> Scene {
    let mut system = scene.system.clone();
    let g = &system.graph;
    // λ of slip would be zero in all states on the constraint: see the tests of its crate
    let names = FORMULATIONS.iter().flat_map(|formulation| formulation.needs.parameters()).filter(|n| **n != "slip");
    let parameters = names.map(|name| Parameter { symbol: g.symbol(name), value: judge::KAPPA, formula: None });
    system.parameters.extend(parameters.collect::<Vec<_>>());
    let condition = |(i, &f): (usize, &symbolic::Expr)| {
        let c = &system.coordinates[i];
        let [q, v] = [c.position, c.velocity].map(|symbol| g.variable(symbol));
        g.add(f, g.mul(g.mul(g.number(0.3), g.call(symbolic::Function::Cos, q)), v))
    };
    system.virtual_conditions = system.constraints.iter().enumerate().map(condition).collect();
    Scene { system, ..scene }
}

/// Tries a number of faults of each place on every derivation path of a scene, evenly spread.
fn faults(scene: &Scene, guards: Guards, a_place: usize) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (path, trial) in ways(scene, guards).iter().filter_map(Trial::new).enumerate() {
        let Trial { name, formulation, stage, chances, .. } = &trial;
        trial.sound.verdict().unwrap_or_else(|words| panic!("{name}, {stage:?}, sound: {words}"));
        let mut of: BTreeMap<Place, Vec<usize>> = BTreeMap::new();
        for (which, chance) in chances.iter().enumerate() {
            of.entry((chance.at, chance.what)).or_default().push(which);
        }
        for (place, all) in of {
            let count = all.len().min(a_place);
            let outcomes = (0..count).map(|i| trial.spoiled(all[(path + i * all.len() / count) % all.len()]));
            let road = |outcome| Fault { road: name.clone(), formulation, stage: *stage, place, outcome };
            faults.extend(outcomes.map(road));
        }
    }
    faults
}

#[test]
fn faults_are_noticed() {
    let begun = Instant::now();
    let a_place = std::env::var("FAULTS_A_PLACE").map_or(A_PLACE, |count| count.parse().expect("a number"));
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !road::SPOILED.get() {
            told(info)
        }
    }));
    // a graph is not shared between threads
    let of_scene = |i: usize| match SCENES.get(i) {
        Some((name, numbers, guards)) => {
            let numbers: Vec<_> = numbers.iter().map(|&(name, x)| (name.into(), x.into())).collect();
            faults(&with_needs(scene::catalogue::find(name, &numbers).expect("a scene")), *guards, a_place)
        }
        None => {
            let (name, text) = OWN[i - SCENES.len()];
            faults(&with_needs(Scene::parse(name, text).expect("a scene")), Guards::Some, a_place)
        }
    };
    let faults: Vec<Fault> = over_threads(0, SCENES.len() + OWN.len(), of_scene).into_iter().flatten().collect();

    println!("{:<28} {:>6} {:>8} {:>8} {:>12} {:>9}", "", "roads", "faults", "noticed", "same motion", "survived");
    let counted = |name: String, of: &dyn Fn(&&Fault) -> bool| {
        let here: Vec<&Fault> = faults.iter().filter(of).collect();
        let count = |wanted: fn(&Outcome) -> bool| here.iter().filter(|fault| wanted(&fault.outcome)).count();
        let roads: BTreeSet<&str> = here.iter().map(|fault| &fault.road[..]).collect();
        let noticed = count(|outcome| matches!(outcome, Outcome::Noticed));
        let unchanged = count(|outcome| matches!(outcome, Outcome::Unchanged));
        let survived = here.len() - noticed - unchanged;
        println!("{name:<28} {:>6} {:>8} {noticed:>8} {unchanged:>12} {survived:>9}", roads.len(), here.len());
        noticed
    };
    for stage in Stage::ALL {
        counted(format!("{stage:?}"), &|fault| fault.stage == stage);
    }
    let mut untried = Vec::new();
    for own in FORMULATIONS.iter().chain(FORMS) {
        for stage in &Stage::ALL[1..] {
            let noticed = counted(format!("{own:?}, {stage:?}"), &|f| (f.formulation, f.stage) == (*own, *stage));
            untried.extend((noticed == 0).then_some((own, stage)));
        }
    }
    let places: BTreeSet<Place> = faults.iter().map(|fault| fault.place).collect();
    let noticed = faults.iter().filter(|fault| matches!(fault.outcome, Outcome::Noticed)).map(|fault| fault.place);
    let noticed: BTreeSet<Place> = noticed.collect();
    println!("\n{} places, {} of them without a fault that is noticed:", places.len(), places.len() - noticed.len());
    places.difference(&noticed).for_each(|place| println!("   {}", words(place)));
    let (mut used, mut wrong) = ([false; EXPLAINED.len()], String::new());
    for Fault { road, stage, place: place @ (at, what), outcome, .. } in &faults {
        let Outcome::Survived { change, found } = outcome else { continue };
        let explains = |[file, text, of, _]: &[&str; 4]| at.file().ends_with(file) && line(at) == *text && what == of;
        match EXPLAINED.iter().position(explains) {
            Some(i) => used[i] = true,
            None => {
                wrong += &format!(
                    "not noticed: {}\n   {road}, {stage:?}: change {change:.1e}, found {found:.1e}\n",
                    words(place)
                );
            }
        }
    }
    let stale = EXPLAINED.iter().zip(used).filter(|(_, used)| !used);
    wrong.extend(stale.map(|(reason, _)| format!("stale: {reason:?}\n")));
    println!("\n{:.1} s", begun.elapsed().as_secs_f64());
    assert!(untried.is_empty(), "no fault was noticed: {untried:?}");
    assert!(wrong.is_empty(), "{wrong}");
}
