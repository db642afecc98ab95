//! The verdict on somebody's equations, and what is wrong with them.

use decision::exact::{FIELDS, Modular, in_field};
use equations::Formulation;
use scene::Scene;
use symbolic::{Bounded, Symbol};

use crate::atoms::{Atom, atoms, pieces, wrong_constraints};
use crate::base::{Base, formulated, substituted, with_constraint};
use crate::case::{Case, split};
use crate::frame::{Frame, Trouble};
use crate::number::Number;
use crate::reading::{Line, Reading, read};
use crate::ReviewError;

/// Whether equations are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The same accelerations from every start.
    Right,
    /// Other accelerations.
    Wrong,
    /// Nothing can be told.
    Undecided,
}

/// By which numbers it was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// Residues: a difference is proved; what is equal is so but for a chance of less than 1e-15.
    Field,
    /// Floats with bands of round-off.
    Floats,
}

/// One acceleration of both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Its name, `x''`.
    pub name: String,
    /// By their equations.
    pub theirs: f64,
    /// By the right ones.
    pub right: f64,
}

/// A review.
#[derive(Clone, Debug, PartialEq)]
pub struct Review {
    /// Whether they are right.
    pub verdict: Verdict,
    /// Of which formulation they were to be.
    pub asked: &'static str,
    /// How it was decided; none where nothing was.
    pub numbers: Option<Numbers>,
    /// Whose equations they are exactly: what was done, one of several readings each; none where none of the
    /// mistakes that are known explains them.
    pub explanations: Vec<Vec<String>>,
    /// Their constraints that do not hold where those of the scene do.
    pub broken: Vec<String>,
    /// A state, in their variables, at which accelerations differ; the start of the scene, if they do there.
    pub state: Vec<(String, f64)>,
    /// Whether it is the start.
    pub at_start: bool,
    /// Accelerations there that differ.
    pub differences: Vec<Difference>,
    /// Names that were taken for multipliers and other unknowns.
    pub unknowns: Vec<String>,
    /// Remarks: what was taken from the scene, on which leaf it holds, why nothing can be told.
    pub notes: Vec<String>,
}

/// Whether the equations of `lines` are those of `formulation` of the scene; `wheres` are formulas `NAME = …`
/// for its coordinates and parameters in their names.
///
/// # Errors
/// [`ReviewError`], for what cannot be read.
pub(crate) fn review(
    scene: &Scene,
    lines: &[Line],
    wheres: &[String],
    formulation: &'static Formulation,
) -> Result<Review, ReviewError> {
    let reading = read(scene, lines, wheres)?;
    let name = |s: &Symbol| reading.system.graph.name(*s);
    let mut review = Review {
        verdict: Verdict::Undecided,
        asked: formulation.name,
        numbers: None,
        explanations: Vec::new(),
        broken: Vec::new(),
        state: Vec::new(),
        at_start: false,
        differences: Vec::new(),
        unknowns: reading.multipliers.iter().chain(reading.states.iter().map(|s| &s[0])).map(name).collect(),
        notes: Vec::new(),
    };
    let start = |s: Symbol| start_of(scene, s);
    let frame = match Frame::new(&reading, &start) {
        Ok(frame) => frame,
        Err(text) => {
            review.notes.push(format!("`{text}` is not linear in accelerations and multipliers"));
            return Ok(review);
        }
    };
    if !frame.on_leaf.is_empty() {
        review.notes.push(format!("what is said holds where {}", frame.on_leaf.join(", ")));
    }
    let asked: Vec<Base> = formulated(scene, &reading, formulation);
    if asked.is_empty() {
        review.notes.push(format!("the scene has no {} equations that these can be compared with", formulation.title));
        return Ok(review);
    }
    let mut trouble = in_field(&FIELDS[0], || decide::<Modular>(scene, &frame, &asked, formulation, &mut review)).err();
    if let Some(Trouble::NoPoint(_)) = trouble {
        trouble = decide::<Bounded>(scene, &frame, &asked, formulation, &mut review).err();
    }
    match trouble {
        None => {}
        Some(Trouble::Contradiction) => {
            review.verdict = Verdict::Wrong;
            review.notes.push("no accelerations fulfil all of these equations where the constraints hold".into());
        }
        Some(Trouble::Undetermined(names)) => {
            review.notes.push(format!("these equations do not determine {}", names.join(", ")));
        }
        Some(Trouble::NoPoint(why)) => review.notes.push(why),
    }
    if review.verdict == Verdict::Wrong {
        differences(&mut review, &frame, &asked);
    }
    Ok(review)
}

/// The number of the scene's start that a symbol has, or one in its place.
fn start_of(scene: &Scene, s: Symbol) -> f64 {
    let (system, start) = (&scene.system, &scene.start);
    let of = |symbols: Vec<Symbol>, values: &[f64]| symbols.iter().position(|&own| own == s).map(|i| values[i]);
    let time = (s == system.time).then_some(start.t);
    of(system.positions(), &start.q).or_else(|| of(system.velocities(), &start.v)).or(time).unwrap_or(0.7)
}

fn decide<C: Number>(
    scene: &Scene,
    frame: &Frame,
    asked: &[Base],
    formulation: &'static Formulation,
    review: &mut Review,
) -> Result<(), Trouble> {
    let case = Case::<C>::new(frame, false)?;
    let is_right = |case: &Case<C>| case.broken().is_empty() && asked.iter().any(|base| case.is(base));
    review.numbers = Some(if C::PROVES { Numbers::Field } else { Numbers::Floats });
    review.broken = case.broken();
    if is_right(&case) {
        review.verdict = Verdict::Right;
        return Ok(());
    }
    if Case::new(frame, true).is_ok_and(|case| is_right(&case)) {
        let absent = frame.absent();
        if !absent.is_empty() {
            review.verdict = Verdict::Right;
            review.notes.push(format!("for the numbers of the scene: {} stand in none of these", absent.join(", ")));
            return Ok(());
        }
        review.notes.push("for the numbers of the scene, and not for others, they agree".into());
    }
    review.verdict = Verdict::Wrong;
    review.explanations = explanations(scene, frame.reading, &case, asked, formulation);
    Ok(())
}

/// Whose equations they are, by the fewest mistakes.
fn explanations<C: Number>(
    scene: &Scene,
    reading: &Reading,
    case: &Case<C>,
    asked: &[Base],
    formulation: &'static Formulation,
) -> Vec<Vec<String>> {
    let others = deltaq::FORMULATIONS.iter().copied().filter(|f| *f != formulation);
    let others: Vec<Base> = others.flat_map(|f| formulated(scene, reading, f)).collect();
    let pieces = pieces(&reading.system);
    let terms: Vec<symbolic::Expr> = pieces.iter().map(|(_, l)| *l).collect();
    let substituted = substituted(scene, reading, &terms);
    let exact = |bases: &mut dyn Iterator<Item = &Base>| -> Vec<Vec<String>> {
        bases.filter(|base| case.is(base)).map(|base| base.words.clone()).collect()
    };
    let found = exact(&mut others.iter().chain(substituted.iter().map(|(base, _)| base)));
    if !found.is_empty() {
        return found;
    }
    let atoms: Vec<Atom> = atoms(reading);
    let (called, columns) = split(&atoms);
    let columns = case.columns(&columns);
    let with = |bases: &mut dyn Iterator<Item = &Base>, pairs: bool, named: bool| -> Vec<Vec<String>> {
        let Some(columns) = &columns else { return Vec::new() };
        let explained = |base: &Base| {
            let skip = if named { 0 } else { base.words.len() };
            let found = case.explain(base, &called, columns, pairs);
            found.into_iter().map(move |words| words[skip..].to_vec()).collect::<Vec<_>>()
        };
        bases.filter(|base| base.plain).flat_map(explained).collect()
    };
    let mut found = with(&mut asked.iter(), false, false);
    if found.is_empty() {
        let names: Vec<_> = pieces.iter().map(|(called, _)| called).collect();
        for (base, columns) in &substituted {
            if let Some(columns) = case.columns(columns) {
                found.extend(case.explain(base, &names, &columns, false));
            }
        }
    }
    if found.is_empty() {
        found = with(&mut others.iter(), false, true);
    }
    let mut wrong: Vec<Base> = Vec::new();
    if found.is_empty() && formulation == deltaq::CHETAEV {
        let bases = wrong_constraints(&reading.system).into_iter();
        wrong = bases.flat_map(|(i, f, what)| with_constraint(reading, i, f, &what)).collect();
        found = exact(&mut wrong.iter());
    }
    if found.is_empty() {
        found = with(&mut asked.iter(), true, false);
    }
    if found.is_empty() {
        found = with(&mut wrong.iter(), false, true);
    }
    found
}

/// Accelerations of both sides at the start, or at another state where they differ there.
fn differences(review: &mut Review, frame: &Frame, asked: &[Base]) {
    for seed in 0..10 {
        let drawn = frame.draw::<Bounded>(seed, u32::from(seed > 0), true).and_then(|inputs| frame.at(inputs));
        let Ok(point) = drawn else { continue };
        let right = |base: &Base| {
            let signs = base.signs(frame).into_iter().next()?;
            base.accelerations(&mut base.program(frame).ok()?, &point, &signs)
        };
        let Some(right) = asked.iter().find_map(right) else { continue };
        let g = &frame.reading.system.graph;
        let pairs = frame.reading.coordinates.iter().zip(point.accelerations.iter().zip(&right));
        let differs = pairs.filter(|(_, (a, b))| !(**a - **b).vanishes());
        review.differences = differs
            .map(|(c, (a, b))| Difference { name: g.name(c[2]), theirs: a.value, right: b.value })
            .collect();
        if !review.differences.is_empty() {
            let moving = frame.reading.parameters.len()..;
            let values = frame.inputs.iter().zip(&point.inputs).collect::<Vec<_>>();
            let state = values[moving].iter().map(|(s, x)| (g.name(**s), x.coefficient(0).value));
            review.state = state.collect();
            review.at_start = seed == 0 && frame.reading.map.is_empty() && frame.on_leaf.is_empty();
            return;
        }
    }
}
