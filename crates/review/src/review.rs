//! The verdict on somebody's equations, and what is wrong with them.

use std::collections::{BTreeMap, BTreeSet};

use decision::exact::{FIELDS, Modular, in_field};
use equations::Formulation;
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;
use symbolic::{Bounded, Scalar, Symbol};

use crate::ReviewError;
use crate::atoms::{Atom, Called, atoms, pieces, wrong_constraints};
use crate::base::{Base, formulated, substituted, with_constraints};
use crate::case::Case;
use crate::frame::{Frame, Point, Trouble};
use crate::monomials::{Coefficient, differing};
use crate::number::{Number, constants};
use crate::reading::{Line, Reading, read};
use crate::theirs::in_theirs;

/// Whether equations are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The same accelerations from every start.
    Right,
    /// Other accelerations.
    Wrong,
    /// Nothing can be told.
    Undecided,
}

/// By which numbers it was decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Numbers {
    /// Residues: a difference is proved; equality at all points would else be an accident.
    Field,
    /// Floats with bands of round-off.
    Floats,
}

/// One acceleration of both sides.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Difference {
    /// Its name, `x''`.
    pub name: String,
    /// By their equations.
    #[schemars(with = "Option<f64>")]
    pub theirs: f64,
    /// By the right ones.
    #[schemars(with = "Option<f64>")]
    pub right: f64,
}

/// A review.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Review {
    /// Whether they are right.
    pub verdict: Verdict,
    /// Of which formulation they were to be.
    #[serde(rename = "formulation")]
    pub asked: &'static str,
    /// How it was decided; none where nothing was.
    pub numbers: Option<Numbers>,
    /// Whose equations they are exactly: what was done, one of several readings each; none where none of the
    /// mistakes that are known explains them.
    pub explanations: Vec<Vec<String>>,
    /// Their constraints that do not hold where those of the scene do.
    pub broken: Vec<String>,
    /// A state, in their variables, at which accelerations differ; the start of the scene, if they do there.
    #[serde(serialize_with = "crate::value::named")]
    #[schemars(with = "BTreeMap<String, f64>")]
    pub state: Vec<(String, f64)>,
    /// Whether it is the start.
    pub at_start: bool,
    /// Accelerations there that differ.
    pub differences: Vec<Difference>,
    /// Where nothing explains them: coefficients that differ there.
    pub coefficients: Vec<Coefficient>,
    /// Names that were taken for multipliers and other unknowns.
    pub unknowns: Vec<String>,
    /// Remarks: what was taken from the scene, on which leaf it holds, why nothing can be told.
    pub notes: Vec<String>,
}

/// What they are held against, and how they are to be read.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The formulation whose equations they are to be.
    pub formulation: &'static Formulation,
    /// Formulas `NAME = …` for coordinates and parameters of the scene, in names of theirs.
    pub wheres: Vec<String>,
    /// Relative errors of the numbers of a table.
    pub tolerance: f64,
}

impl Default for Asked {
    fn default() -> Self {
        Asked { formulation: motion::CHETAEV, wheres: Vec::new(), tolerance: 1e-8 }
    }
}

/// Whether the equations of `lines` are those that are asked for; with `rows`, states `(t, q, v)` and
/// accelerations by them, whether these are.
///
/// # Errors
/// [`ReviewError`], for what cannot be read.
pub(crate) fn review(
    scene: &Scene,
    lines: &[Line],
    rows: Option<&[Row]>,
    to_be: &Asked,
    explains: bool,
) -> Result<Review, ReviewError> {
    let reading = read(scene, lines, &to_be.wheres)?;
    let formulation = to_be.formulation;
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
        coefficients: Vec::new(),
        unknowns: reading.multipliers.iter().chain(reading.states.iter().map(|s| &s[0])).map(name).collect(),
        notes: Vec::new(),
    };
    let frame = match Frame::new(&reading, &scene.start) {
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
    let held = Held { scene, frame: &frame, asked: &asked, formulation, explains };
    if let Some(rows) = rows {
        let points = held.points(rows, to_be.tolerance);
        review.differences = held.differences(&points, &mut review.state);
        if let Err(trouble) = held.decide(&Case::at(&frame, points), None, &mut review) {
            review.notes.push(trouble.words());
        }
        if review.verdict == Verdict::Right {
            (review.differences, review.state) = Default::default();
        }
        return Ok(review);
    }
    // a root has two signs in a field, and that of a square need not be the base
    let mut trouble = if frame.has_roots() {
        Some(Trouble::NoPoint(String::new()))
    } else {
        in_field(&FIELDS[0], || held.decide_at_random::<Modular>(&mut review)).err()
    };
    if let Some(Trouble::NoPoint(_)) = trouble {
        trouble = held.decide_at_random::<Bounded>(&mut review).err();
    }
    if trouble == Some(Trouble::Contradiction) {
        review.verdict = Verdict::Wrong;
    }
    review.notes.extend(trouble.map(|trouble| trouble.words()));
    let wrong = review.verdict == Verdict::Wrong && explains;
    if let Some(other) = in_theirs(scene, &reading).filter(|_| wrong && review.explanations.is_empty()) {
        let to_be = Asked { wheres: Vec::new(), ..to_be.clone() };
        review.explanations = self::review(&other, lines, None, &to_be, true)?.explanations;
    }
    for seed in 0..if wrong { 10 } else { 0 } {
        let drawn = frame.draw::<Bounded>(seed, u32::from(seed > 0), true).and_then(|inputs| frame.at(inputs));
        let points: Vec<Point<Bounded>> = drawn.into_iter().collect();
        review.differences = held.differences(&points, &mut review.state);
        if !review.differences.is_empty() {
            if review.explanations.is_empty() {
                let found = asked.iter().zip(&points).map(|(base, point)| differing(&frame, base, &point.inputs));
                review.coefficients = found.flatten().flatten().collect();
            }
            review.at_start = seed == 0 && frame.reading.map.is_empty() && frame.on_leaf.is_empty();
            break;
        }
    }
    Ok(review)
}

/// A state and the accelerations that their program has there.
pub(crate) struct Row {
    pub(crate) t: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
}

/// States `(t, q, v)` of the scene on its constraints, drawn at random, at which a program can be asked for
/// its accelerations.
pub fn states(scene: &Scene) -> Vec<mechanics::State> {
    let Ok(reading) = read(scene, &[], &[]) else { return Vec::new() };
    let Ok(frame) = Frame::new(&reading, &scene.start) else { return Vec::new() };
    let (first, n) = (reading.parameters.len(), scene.system.dimension());
    let numbers = |seed: u64| {
        let drawn = frame.draw::<Bounded>(seed, u32::from(seed > 0), true).ok()?;
        let x: Vec<f64> = drawn[first..].iter().map(|x| x.coefficient(0).value).collect();
        Some(mechanics::State { t: x[0], q: x[1..=n].to_vec(), v: x[n + 1..].to_vec() })
    };
    (0..40).filter_map(numbers).take(8).collect()
}

/// What they are held against.
struct Held<'a> {
    scene: &'a Scene,
    frame: &'a Frame<'a>,
    asked: &'a [Base],
    formulation: &'static Formulation,
    explains: bool,
}

impl Held<'_> {
    fn decide_at_random<C: Number>(&self, review: &mut Review) -> Result<(), Trouble> {
        let case = Case::<C>::new(self.frame, false)?;
        let own = Case::new(self.frame, true).ok();
        self.decide(&case, own.as_ref(), review)
    }

    /// Decides by `case`; `own` has the scene's numbers for its parameters.
    fn decide<C: Number>(&self, case: &Case<C>, own: Option<&Case<C>>, review: &mut Review) -> Result<(), Trouble> {
        let is_right = |case: &Case<C>| -> Result<bool, Trouble> {
            let found: Vec<_> = self.asked.iter().map(|base| case.is(base)).collect();
            // what has no value here is not wrong
            let open = found.iter().find(|found| found.is_err()).filter(|_| !found.contains(&Ok(true)));
            open.cloned().unwrap_or(Ok(found.contains(&Ok(true))))
        };
        review.broken = case.broken();
        let right = review.broken.is_empty() && is_right(case)?;
        review.verdict = if right { Verdict::Right } else { Verdict::Wrong };
        review.numbers = Some(if C::PROVES { Numbers::Field } else { Numbers::Floats });
        let at_own = |own: &Case<C>| own.broken().is_empty() && is_right(own) == Ok(true);
        if review.verdict == Verdict::Wrong && own.is_some_and(at_own) {
            let absent = self.frame.absent();
            if absent.is_empty() {
                review.notes.push("for the numbers of the scene, and not for others, they agree".into());
            } else {
                review.verdict = Verdict::Right;
                review
                    .notes
                    .push(format!("for the numbers of the scene: {} stand in none of these", absent.join(", ")));
            }
        }
        if review.verdict == Verdict::Wrong && self.explains {
            review.explanations = explanations(self.scene, self.frame.reading, case, self.asked, self.formulation);
        }
        Ok(())
    }

    fn points(&self, rows: &[Row], tolerance: f64) -> Vec<Point<Bounded>> {
        let largest = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).fold(0.0, |most: f64, x| most.max(x.abs()));
        let number = |value: f64, size: f64| Bounded {
            value,
            magnitude: size.max(value.abs()) * tolerance / Bounded::ROUND_OFF,
        };
        let of = |row: &Row| {
            let inputs = self.frame.reading.parameters.iter().map(|p| Bounded::from_f64(p.1));
            let q = (0..row.q.len()).map(|i| number(row.q[i], largest(&|row| row.q[i])));
            let v = (0..row.q.len()).map(|i| number(row.v[i], largest(&|row| row.v[i])));
            let all: Vec<Bounded> = inputs.chain([Bounded::from_f64(row.t)]).chain(q).chain(v).collect();
            let a = (0..row.q.len()).map(|i| number(row.a[i], largest(&|row| row.a[i])));
            Point { inputs: constants(&all), accelerations: a.collect(), broken: Vec::new() }
        };
        rows.iter().map(of).collect()
    }

    /// Accelerations of both sides at the first point where they differ, and its state.
    fn differences(&self, points: &[Point<Bounded>], state: &mut Vec<(String, f64)>) -> Vec<Difference> {
        let (frame, g) = (self.frame, &self.frame.reading.system.graph);
        for point in points {
            let right = |base: &Base| {
                let signs = base.signs(frame).into_iter().next()?;
                base.accelerations(&mut base.program(frame).ok()?, point, &signs)
            };
            let Some(right) = self.asked.iter().find_map(right) else { continue };
            let pairs = frame.reading.coordinates.iter().zip(point.accelerations.iter().zip(&right));
            let differs: Vec<Difference> = pairs
                .filter(|(_, (a, b))| !(**a - **b).vanishes())
                .map(|(c, (a, b))| Difference { name: g.name(c[2]), theirs: a.value, right: b.value })
                .collect();
            if !differs.is_empty() {
                let moving = frame.inputs.iter().zip(&point.inputs).skip(frame.reading.parameters.len());
                *state = moving.map(|(&s, x)| (g.name(s), x.coefficient(0).value)).collect();
                return differs;
            }
        }
        Vec::new()
    }
}

/// Pairs of a constraint written wrong and another mistake beyond which they are not tried.
const MOST: usize = 4_000_000;

/// Whose equations they are, by the fewest mistakes.
fn explanations<C: Number>(
    scene: &Scene,
    reading: &Reading,
    case: &Case<C>,
    asked: &[Base],
    formulation: &'static Formulation,
) -> Vec<Vec<String>> {
    let others = motion::FORMULATIONS.iter().copied().filter(|f| *f != formulation);
    let others: Vec<Base> = others.flat_map(|f| formulated(scene, reading, f)).collect();
    let pieces = pieces(&reading.system);
    let terms: Vec<symbolic::Expr> = pieces.iter().map(|(_, l)| *l).collect();
    let substituted = substituted(scene, reading, &terms);
    let exact = |bases: &mut dyn Iterator<Item = &Base>| -> Vec<Vec<String>> {
        bases.filter(|base| case.is(base) == Ok(true)).map(|base| base.words.clone()).collect()
    };
    let mut found = exact(&mut substituted.iter().map(|(base, _)| base).chain(&others));
    let atoms: Vec<Atom> = atoms(reading);
    let (called, columns): (Vec<&Called>, Vec<_>) =
        atoms.iter().map(|atom| (&atom.called, atom.column.clone())).unzip();
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
    found.extend(with(&mut asked.iter(), false, false));
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
    if found.is_empty() && formulation == motion::CHETAEV {
        wrong = with_constraints(reading, wrong_constraints(&reading.system));
        found = exact(&mut wrong.iter());
    }
    if found.is_empty() {
        found = with(&mut asked.iter(), true, false);
    }
    if found.is_empty() && wrong.len() * atoms.len() <= MOST {
        found = with(&mut wrong.iter(), false, true);
    }
    // other removals may give the same
    let mut told = BTreeSet::new();
    found.retain(|words| told.insert(words.clone()));
    found
}
