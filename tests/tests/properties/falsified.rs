//! Every claim is seen to fail once: on a system where it is false, or on motions of wrong equations.
//!
//! `cargo test --release --workspace --exclude engine --test tests falsified:: -- --nocapture` prints what is
//! said.

use std::collections::BTreeSet;
use std::mem::swap;

use comparison::{Finding as Ranks, Membership, Pairing};
use motion::{CHETAEV, SolveError, choices};
use program::parallel::map;
use proptest::strategy::ValueTree;
use random::writings::Writing;
use random::{Batch, CHECKS, Case, Fault, Finding, Findings, Kind, Word, draw_recipe, equations, make, null_test};
use random::{NullTest, Summary};
use scene::Scene;

mod forces;

/// The seed of the systems.
const SEED: u64 = 38;

/// Systems of a kind that are tried for a fault that a claim notices.
const TRIES: u64 = 24;

/// Steps of shrinking.
const STEPS: usize = 30;

/// A claim, a kind of system, and what is made wrong there so that the claim is false.
struct False {
    theorem: u8,
    claim: &'static str,
    kind: Kind,
    wrong: &'static str,
    fault: Fault,
}

type Spoils = fn(&mut Case) -> Result<(), SolveError>;

const fn in_case(theorem: u8, claim: &'static str, kind: Kind, wrong: &'static str, case: Spoils) -> False {
    False { theorem, claim, kind, wrong, fault: Fault { case, ..Fault::NONE } }
}

const fn in_null(claim: &'static str, wrong: &'static str, null: fn(&mut Scene)) -> False {
    False { theorem: 13, claim, kind: Kind::Free, wrong, fault: Fault { null, ..Fault::NONE } }
}

const EXCHANGED: &str = "Chetaev's motion and the vakonomic one exchanged";

fn exchanged(case: &mut Case) -> Result<(), SolveError> {
    swap(&mut case.chetaev, &mut case.vakonomic);
    Ok(())
}

const FORGOTTEN: &str = "the constraints forgotten in Chetaev's motion";

fn forgotten(case: &mut Case) -> Result<(), SolveError> {
    let mut system = case.scene.system.clone();
    system.constraints.clear();
    let equations = equations(&system, CHETAEV, None)?;
    case.chetaev = case.solve(&system, &case.scene.start, case.end(), equations, &[])?;
    Ok(())
}

const RUBBED: &str = "friction in Chetaev's motion";

fn rubbed(case: &mut Case) -> Result<(), SolveError> {
    let mut system = case.scene.system.clone();
    let (g, v) = (&system.graph, system.velocities());
    system.forces = v.iter().map(|&v| g.mul(g.ratio(-1, 10), g.variable(v))).collect();
    let equations = equations(&system, CHETAEV, None)?;
    case.chetaev = case.solve(&system, &case.scene.start, case.end(), equations, &[])?;
    Ok(())
}

const WITHOUT_COSTATES: &str = "the motion by removal without costates";

fn without_costates(case: &mut Case) -> Result<(), SolveError> {
    if let Some((removal, motion)) = &case.control {
        let same = case.removed.iter_mut().filter(|removed| removed.removal.name == removal.name);
        same.for_each(|removed| removed.motion = motion.clone());
    }
    Ok(())
}

const OTHER_MULTIPLIERS: &str = "multipliers that are not those of the motion";

fn other_multipliers(case: &mut Case) -> Result<(), SolveError> {
    case.scene.multipliers.iter_mut().for_each(|mu| *mu *= 2.0);
    Ok(())
}

fn no_multipliers(case: &mut Case) -> Result<(), SolveError> {
    case.scene.multipliers.iter_mut().for_each(|mu| *mu = 0.0);
    Ok(())
}

/// It is said of the system that it is of another kind.
fn called(case: &mut Case, kind: Kind) -> Result<(), SolveError> {
    case.recipe.kind = kind;
    Ok(())
}

fn called_integrable(case: &mut Case) -> Result<(), SolveError> {
    called(case, Kind::HiddenIntegrable)
}

const CALLED_INTEGRABLE: &str = "called integrable";

/// What is found of Chetaev's motion, after a change.
fn found(case: &mut Case, change: fn(&mut Membership)) -> Result<(), SolveError> {
    let mut found = case.membership()?;
    found.iter_mut().for_each(change);
    case.membership = found;
    Ok(())
}

/// The proof of another question: that the vakonomic motion is vakonomic.
fn proved_elsewhere(case: &mut Case) -> Result<(), SolveError> {
    let choices = choices(&case.scene);
    let vakonomic = &choices[1];
    let proof = Pairing::new(&case.scene, vakonomic, vakonomic)?.decide(case.end())?.proof;
    case.membership = case.membership()?.map(|found| Membership { proof, ..found });
    Ok(())
}

fn planted(case: &mut Case) -> Result<(), SolveError> {
    case.planted = CHETAEV;
    Ok(())
}

const PLANTED: &str = "Chetaev's motion is planted, not a vakonomic one";

fn blind(case: &mut Case) -> Result<(), SolveError> {
    if let Some((_, motion)) = &case.control {
        case.chetaev = motion.clone();
    }
    Ok(())
}

fn control_forgotten(case: &mut Case) -> Result<(), SolveError> {
    forgotten(case)?;
    if let Some((_, motion)) = &mut case.control {
        swap(motion, &mut case.chetaev);
    }
    Ok(())
}

const VAKONOMIC_BETWEEN: &str = "the vakonomic motion in place of that of the family";

fn vakonomic_between(case: &mut Case) -> Result<(), SolveError> {
    case.between = Some(case.vakonomic.clone());
    Ok(())
}

/// A force that L does not have.
fn pulled(scene: &mut Scene) {
    let system = &mut scene.system;
    let (g, q) = (&system.graph, system.positions());
    let pull: Vec<_> = q.iter().map(|&q| g.mul(g.ratio(3, 10), g.variable(q))).collect();
    system.lagrangian = g.add(system.lagrangian, g.sum(&pull));
}

const PULLED: &str = "a term too many in L";

/// Of the disc, only turning and rolling has inertia.
fn massless(scene: &mut Scene) {
    let system = &mut scene.system;
    if let [x, y, _, _] = &system.velocities()[..] {
        let g = &system.graph;
        system.lagrangian = g.substitute(system.lagrangian, &[(*x, g.zero()), (*y, g.zero())].into());
    }
}

/// One constraint, and an integrable one.
static OTHER_SYSTEM: Writing = Writing {
    name: "another system",
    adds: 0,
    keeps_gaps: true,
    of: |scene| {
        let mut scene = scene.clone();
        let constraints = scene.get_mut("system")?.get_mut("constraints")?.as_array_mut()?;
        *constraints = vec!["q1' - q2'".into()];
        Some(scene)
    },
};

const FALSE: &[False] = &[
    in_case(0, "Chetaev: multipliers and Maggi's equations", Kind::Linear, EXCHANGED, exchanged),
    in_case(0, "vakonomic: multiplier form and costate form", Kind::Linear, EXCHANGED, exchanged),
    in_case(0, "the constraint is kept", Kind::Linear, FORGOTTEN, forgotten),
    in_case(0, "natural costates vanish at the horizon", Kind::Linear, "constants of another motion", |case| {
        case.natural = case.removed.first().map(|removed| removed.motion.clone());
        Ok(())
    }),
    in_case(1, "vakonomic agrees with Chetaev", Kind::Linear, CALLED_INTEGRABLE, called_integrable),
    in_case(1, "coordinate removal agrees with Chetaev", Kind::Affine, CALLED_INTEGRABLE, called_integrable),
    in_case(
        2,
        "removed constraint is vakonomic motion of the augmented system",
        Kind::Linear,
        WITHOUT_COSTATES,
        without_costates,
    ),
    in_case(
        3,
        "coordinate removal is the vakonomic motion with mu = -P - L_w'",
        Kind::Affine,
        WITHOUT_COSTATES,
        without_costates,
    ),
    in_case(3, "vakonomic is the coordinate removal with P = -mu - L_w'", Kind::Affine, EXCHANGED, exchanged),
    in_case(4, "Chetaev: constraints recombined", Kind::Linear, EXCHANGED, exchanged),
    in_case(4, "vakonomic: constraints recombined", Kind::Linear, OTHER_MULTIPLIERS, other_multipliers),
    in_case(4, "Chetaev: other coordinates", Kind::Nonlinear, RUBBED, rubbed),
    in_case(4, "vakonomic: other coordinates", Kind::TimeDependent, EXCHANGED, exchanged),
    in_case(4, "other writings have the same sentences", Kind::Linear, "a writing of another system", |case| {
        case.writing = Some(&OTHER_SYSTEM);
        Ok(())
    }),
    in_case(5, "exponent of the leading divergence", Kind::Linear, OTHER_MULTIPLIERS, no_multipliers),
    in_case(5, "coefficient of the leading divergence", Kind::Affine, OTHER_MULTIPLIERS, other_multipliers),
    in_case(6, "Chetaev: energy", Kind::Affine, "called homogeneous", |case| called(case, Kind::Linear)),
    in_case(6, "vakonomic: energy", Kind::Affine, EXCHANGED, exchanged),
    in_case(6, "removed constraint: energy", Kind::Linear, WITHOUT_COSTATES, without_costates),
    in_case(7, "vakonomic: momentum of a cyclic coordinate", Kind::ChaplyginIntegrable, EXCHANGED, exchanged),
    in_case(8, "friction tends to Chetaev at rate 1/N", Kind::Linear, EXCHANGED, exchanged),
    in_case(8, "added mass tends to vakonomic at rate 1/N", Kind::Linear, EXCHANGED, exchanged),
    in_case(8, "the family between begins at vakonomic", Kind::Linear, EXCHANGED, exchanged),
    in_case(8, "the family between tends to Chetaev at rate 1/kappa", Kind::Linear, EXCHANGED, exchanged),
    in_case(9, "decision and proof agree", Kind::Linear, "the proof of another motion", proved_elsewhere),
    in_case(9, "almost every start: ranks are final at order h", Kind::Linear, "ranks that go on growing", |case| {
        found(case, |found| match &mut found.proof.almost_every_start {
            Ranks::None(none) => none.order += 9,
            Ranks::Contained { order, .. } => *order += 9,
            _ => {}
        })
    }),
    in_case(9, "the set has the dimension that ranks ask for", Kind::Integrable, "a direction lost", |case| {
        found(case, |found| drop(found.decision.set.directions.pop()))
    }),
    in_case(9, "integrable constraints leave every mu0", Kind::Linear, CALLED_INTEGRABLE, called_integrable),
    in_case(9, "and ranks say so", Kind::Linear, CALLED_INTEGRABLE, called_integrable),
    in_case(9, "integrals leave a mu0 each", Kind::Linear, "called partly integrable", |case| {
        called(case, Kind::PartlyIntegrable)
    }),
    in_case(9, "the multipliers found give Chetaev's motion", Kind::Integrable, FORGOTTEN, forgotten),
    in_case(9, "a planted vakonomic motion is found", Kind::Linear, PLANTED, planted),
    in_case(9, "nor is it refuted", Kind::Linear, PLANTED, planted),
    in_case(9, "a fit does not find what the decision denies", Kind::Linear, EXCHANGED, exchanged),
    in_case(10, "Chetaev runs back the way it came", Kind::Linear, EXCHANGED, exchanged),
    in_case(10, "vakonomic runs back the way it came", Kind::Linear, EXCHANGED, exchanged),
    in_case(10, "removed constraint runs back the way it came", Kind::Affine, WITHOUT_COSTATES, without_costates),
    in_case(10, "Chetaev in other units", Kind::Nonlinear, RUBBED, rubbed),
    in_case(10, "vakonomic in other units", Kind::Linear, OTHER_MULTIPLIERS, other_multipliers),
    in_case(10, "removed constraint in other units", Kind::Affine, WITHOUT_COSTATES, without_costates),
    in_case(
        11,
        "Frobenius' test finds what the construction put in",
        Kind::Linear,
        CALLED_INTEGRABLE,
        called_integrable,
    ),
    in_case(11, "ranks over a finite field count the integrals", Kind::Linear, CALLED_INTEGRABLE, called_integrable),
    in_case(12, "right in Chaplygin's integrable form", Kind::Linear, "called Chaplygin's form", |case| {
        called(case, Kind::ChaplyginIntegrable)
    }),
    in_case(12, "flagged where it is wrong, and only there", Kind::Linear, "the control compared with itself", blind),
    in_case(12, "not flagged where it is right", Kind::ChaplyginIntegrable, FORGOTTEN, |case| {
        called(case, Kind::Integrable)?;
        forgotten(case)
    }),
    in_case(
        12,
        "substitution is the vakonomic motion with c = 0",
        Kind::ChaplyginIntegrable,
        "the constraints forgotten in the control",
        control_forgotten,
    ),
    in_case(12, "right exactly where c = 0 gives Chetaev's motion", Kind::ChaplyginIntegrable, FORGOTTEN, forgotten),
    in_null("Appell–Hamel: Chetaev runs straight", PULLED, pulled),
    in_null("Appell–Hamel: vakonomic runs the same line", PULLED, pulled),
    in_null("Heisenberg: Chetaev runs straight", PULLED, pulled),
    in_null("Heisenberg: vakonomic runs in a circle of rate mu", PULLED, pulled),
    in_null("disc: Chetaev rolls uniformly", PULLED, pulled),
    in_null("disc: the special multipliers give the Chetaev motion", PULLED, pulled),
    in_null("disc: zero multipliers do not", "a disc that has only moments of inertia", massless),
    in_case(14, "removal with p_u = 0 is Newton's motion", Kind::Linear, CALLED_INTEGRABLE, called_integrable),
    in_case(15, "vakonomic: L + phi f with mu0 - phi", Kind::Linear, OTHER_MULTIPLIERS, other_multipliers),
    in_case(15, "removed constraint: L + phi f with the same P0", Kind::Linear, WITHOUT_COSTATES, without_costates),
    in_case(16, "Chetaev: L + dF/dt", Kind::Nonlinear, RUBBED, rubbed),
    in_case(16, "vakonomic: L + dF/dt with the same mu0", Kind::Linear, OTHER_MULTIPLIERS, other_multipliers),
    in_case(16, "removed constraint: L + dF/dt with P0 - F_w", Kind::Affine, WITHOUT_COSTATES, without_costates),
    in_case(17, "kappa: constraints recombined, mu0 transformed", Kind::Linear, VAKONOMIC_BETWEEN, vakonomic_between),
    in_case(
        18,
        "the law of first order from v0 + Pi C mu0/kappa is O(1/kappa^2) off the family",
        Kind::Linear,
        VAKONOMIC_BETWEEN,
        vakonomic_between,
    ),
];

/// What is found on system `index` of a kind; no system where there is no motion.
fn found_on(claimed: &False, index: u64, fault: &Fault) -> Option<Findings> {
    if claimed.theorem == 13 {
        let numbers = NullTest::draw(SEED, index).current();
        return null_test(&numbers, fault).ok();
    }
    let mut case = Case::new(draw_recipe(SEED, index, &[claimed.kind]), "falsified").ok()?;
    (fault.case)(&mut case).ok()?;
    for check in CHECKS.iter().filter(|check| check.theorem == claimed.theorem) {
        make(check, &mut case);
    }
    Some(case.found)
}

/// The first system on which the claim fails for what is wrong, and does not fail without it.
fn noticed(claimed: &False) -> Option<(u64, Finding)> {
    (0..TRIES).find_map(|index| {
        let fails = |fault: &Fault| -> Option<Finding> {
            found_on(claimed, index, fault)?.failures().find(|f| f.claim == claimed.claim).cloned()
        };
        let failure = fails(&claimed.fault)?;
        let sound = fails(&Fault::NONE);
        assert!(sound.is_none(), "{} {index} fails without a fault: {sound:?}", claimed.kind);
        Some((index, failure))
    })
}

#[test]
fn every_claim_fails_where_it_is_false() {
    let all: Vec<&False> = FALSE.iter().chain(forces::FALSE).collect();
    let found = map(&all, |claimed| noticed(claimed));
    let mut survived = Vec::new();
    for (claimed, found) in all.into_iter().zip(found) {
        let False { theorem, claim, kind, wrong, .. } = claimed;
        let Some((index, Finding { figure, limit, note, .. })) = found else {
            survived.push((theorem, claim, wrong));
            continue;
        };
        println!("T{theorem} | {claim} | {kind} {index}: {wrong} | fails: {figure:.1e}, limit {limit:.1e}; {note}");
    }
    assert!(survived.is_empty(), "not noticed: {survived:#?}");
}

#[test]
fn no_claim_is_made_that_was_never_seen_to_fail() {
    let batch = Batch { seed: SEED, kinds: Kind::ALL.to_vec() };
    let records = map(&(0..20).collect::<Vec<u64>>(), |&index| batch.record(index));
    let made = records.iter().flat_map(|r| r.held.iter().map(|(theorem, claim, _)| (*theorem, claim.as_str())));
    let made: BTreeSet<(u8, &str)> = made.collect();
    let falsified: BTreeSet<(u8, &str)> = FALSE.iter().map(|f| (f.theorem, f.claim)).collect();
    assert!(made.is_subset(&falsified), "{:?}", made.difference(&falsified).collect::<Vec<_>>());
    assert!(made.len() > 40, "only {} claims are made", made.len());
}

/// Of each theorem the first claim in [`FALSE`]. `SHRINKING=600` shrinks as far as the program does.
#[test]
fn what_fails_is_counted_shrunk_and_written() {
    let steps = std::env::var("SHRINKING").map_or(STEPS, |steps| steps.parse().expect("a number"));
    let theorems: Vec<u8> = (0..=17).collect();
    let shrunk = map(&theorems, |&theorem| {
        let False { kind, fault, .. } = FALSE.iter().find(|claimed| claimed.theorem == theorem).expect("a claim");
        let batch = Batch { seed: SEED, kinds: vec![*kind] };
        let record = (0..TRIES).map(|i| batch.faulty_record(batch.thorough(i), fault));
        let record = record.into_iter().find(|record| record.word(theorem) == Some(Word::Fails));
        let record = record.unwrap_or_else(|| panic!("T{theorem} fails nowhere"));
        let (whole, small) =
            (batch.scene(record.index), batch.faulty_counterexample(record.index, theorem, fault, steps));
        (record, whole, small.unwrap_or_else(|| panic!("T{theorem}: no counterexample")))
    });
    for (theorem, (record, whole, small)) in theorems.into_iter().zip(shrunk) {
        assert!(record.failures().contains(&theorem), "T{theorem}: {record:?}");
        assert_eq!(Summary::of(&[record]).theorems[&theorem].fails, 1);
        let size = |scene: &Scene| (scene.system.dimension(), scene.system.constraints.len());
        println!("T{theorem}: {:?} to {:?}, {}", size(&whole), size(&small), small.notes);
        assert!(small.notes.starts_with(&format!("T{theorem} fails: ")), "{}", small.notes);
        let text = small.to_toml();
        // a null test has a system of its own
        let shorter = text.len() - small.notes.len() < whole.to_toml().len();
        assert!(theorem == 13 || size(&small) <= size(&whole) && shorter, "T{theorem}\n{text}");
        let again = Scene::parse(&small.name, &text).expect("opens");
        assert_eq!((again.start, again.notes), (small.start, small.notes));
    }
}
