//! Plain explanations: what a scene may not model, and what it would have to be for a formulation to fit.
//!
//! Parameters e are added to the scene that are zero in it: constant forces along lengths (a tilt of
//! gravity), a drag `−e ∂L/∂v`, the rate of the clock, the scale of each column, an offset of the point that
//! is filmed along a heading, and changes of parameters that are not free, inertia among them. With the
//! Jacobian `J` of a fit and `G = ∂r/∂e`, both at its minimum, one of these takes away from χ², to first
//! order,
//!
//! ```text
//! |P G⁺ r|² ,     P the part of G that J does not reach            (Rao's score test) ;
//! ```
//!
//! where that may be enough, it is fitted. One that moves the film by more than a tenth of its extent is not
//! plain.

use mechanics::Parameter;
use motion::{Choice, choices_among};
use nalgebra::{DMatrix, DVector};
use scene::{Filmed, Scene};
use symbolic::limits::NOTHING;
use symbolic::{Expr, Function};

use crate::distribution::threshold;
use crate::film::expression;
use crate::least::{Stage, least, scaled};
use crate::question::{is_constant, is_law, problem_of};
use crate::unknown::CLOCK;
use crate::{Film, Fit, Problem, Question, Unknown};

/// The part of the extent of the films by which something plain moves them.
const PLAIN: f64 = 0.1;
/// The part of what is needed that the score has to promise before it is fitted.
const PROMISE: f64 = 0.5;

/// What would do.
pub(crate) struct Explanation {
    pub(crate) name: String,
    values: Vec<(String, f64)>,
    chi_squared: f64,
    part: f64,
}

impl Explanation {
    pub(crate) fn words(&self) -> String {
        let values: Vec<String> = self.values.iter().map(|(name, value)| format!("{name} {value:.2e}")).collect();
        format!(
            "with {} ({}; it moves the films by {:.1e} of their extent) χ² is {:.2}",
            self.name,
            values.join(", "),
            self.part,
            self.chi_squared
        )
    }
}

/// Numbers of one explanation, as unknowns of the scene that has them.
struct Candidate {
    name: String,
    numbers: Vec<String>,
}

/// Those with which `fit` of `choice` is not excluded beside `best`; none for removals and laws with numbers.
pub(crate) fn explanations(
    scene: &Scene,
    choice: &Choice,
    films: &[Film],
    question: &Question,
    (problem, fit): (&Problem, &Fit),
    best: &Fit,
) -> Option<Vec<Explanation>> {
    if choice.removal.is_some() || is_law(choice.formulation) {
        return None;
    }
    let (scene, candidates) = &widened(scene, films, problem);
    let choice = choices_among(scene, |f| *f == *choice.formulation).into_iter().find(|c| c.removal.is_none())?;
    let with = |numbers: &[String]| -> Option<(Problem, Vec<f64>)> {
        let added = numbers.iter().map(|name| Unknown::named(name));
        let unknowns: Vec<Unknown> = question.unknowns.iter().cloned().chain(added).collect();
        let question = Question { unknowns: &unknowns, ..question.clone() };
        let mut wider = problem_of(scene, &choice, films, &question).ok()?;
        let known = |label: &str| fit.estimates.iter().find(|e| e.name == *label).map(|e| e.value);
        let each = wider.unknowns().iter().zip(wider.start());
        let start: Vec<f64> = each.map(|(unknown, own)| known(&unknown.label()).unwrap_or(*own)).collect();
        wider.begin_at(&start);
        Some((wider, start))
    };
    let all: Vec<String> = candidates.iter().flat_map(|c| c.numbers.iter().cloned()).collect();
    let (mut wider, start) = with(&all)?;
    let (r, jacobian) = wider.weighed(&start, true).ok()?;
    let place = |name: &String| wider.unknowns().iter().position(|u| u.name == *name);
    let places = |of: &Candidate| of.numbers.iter().map(place).collect::<Option<Vec<usize>>>();
    let added: Vec<usize> = all.iter().filter_map(place).collect();
    let own: Vec<usize> = (0..start.len()).filter(|i| !added.contains(i)).collect();
    let reached = Reached::new(&jacobian.select_columns(&own))?;
    let rest = reached.left(&DMatrix::from_column_slice(r.len(), 1, r.as_slice()));
    let extent = problem.extent();
    let mut found = Vec::new();
    for candidate in candidates {
        let Some(columns) = places(candidate) else { continue };
        let moved = jacobian.select_columns(&columns);
        let Some((gain, by)) = score(&reached.left(&moved), &rest.column(0).into_owned()) else { continue };
        let free = fit.freedom.saturating_sub(columns.len());
        let needed = fit.chi_squared - best.chi_squared - threshold(free.saturating_sub(best.freedom).max(1));
        if gain < PROMISE * needed || (&moved * &by).norm() > 2.0 * PLAIN * extent {
            continue;
        }
        let Some((problem, mut start)) = with(&candidate.numbers) else { continue };
        let place = |name: &String| problem.unknowns().iter().position(|u| u.name == *name);
        let at: Vec<usize> = candidate.numbers.iter().filter_map(place).collect();
        let error =
            |label: String| fit.estimates.iter().find(|e| e.name == label && e.error.is_finite()).map(|e| e.error);
        let mut scale: Vec<f64> = problem.unknowns().iter().map(|u| error(u.label()).unwrap_or(1.0)).collect();
        for (&i, by) in at.iter().zip(by.iter()) {
            scale[i] = by.abs().max(f64::MIN_POSITIVE);
            start[i] += by;
        }
        let Ok(minimum) = least(&problem, &start, &scale, Stage::Profile) else { continue };
        let changes: Vec<f64> = at.iter().map(|&i| minimum.unknowns[i] - problem.start()[i]).collect();
        let part = (&moved * DVector::from_column_slice(&changes)).norm() / extent;
        if fit.chi_squared - minimum.value >= needed && part <= PLAIN {
            let label = |&i: &usize| problem.unknowns()[i].name.trim_start_matches(ADDED).to_owned();
            let values = at.iter().map(label).zip(changes).collect();
            let (name, chi_squared) = (candidate.name.clone(), minimum.value);
            found.push(Explanation { name, values, chi_squared, part });
        }
    }
    Some(found)
}

/// What columns reach.
struct Reached(Option<DMatrix<f64>>);

impl Reached {
    fn new(jacobian: &DMatrix<f64>) -> Option<Reached> {
        let (matrix, _) = scaled(jacobian);
        if matrix.ncols() == 0 {
            return Some(Reached(None));
        }
        let svd = matrix.try_svd(true, false, f64::EPSILON, 1000)?;
        let (limit, basis) = (NOTHING * svd.singular_values.max(), svd.u?);
        let kept: Vec<usize> = (0..svd.singular_values.len()).filter(|&i| svd.singular_values[i] > limit).collect();
        Some(Reached(Some(basis.select_columns(&kept))))
    }

    /// What they do not.
    fn left(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        match &self.0 {
            None => columns.clone(),
            Some(basis) => columns - basis * (basis.transpose() * columns),
        }
    }
}

/// By how much `columns` lower the squares of `rest`, and with which factors.
fn score(columns: &DMatrix<f64>, rest: &DVector<f64>) -> Option<(f64, DVector<f64>)> {
    let (matrix, lengths) = scaled(columns);
    if lengths.iter().any(|length| !(length.is_finite() && *length > 0.0)) {
        return None;
    }
    let svd = matrix.clone().try_svd(true, true, f64::EPSILON, 1000)?;
    let by = svd.solve(&-rest, 1e-6 * svd.singular_values.max()).ok()?;
    let left = rest + matrix * &by;
    let by = DVector::from_fn(lengths.len(), |i, _| by[i] / lengths[i]);
    Some((rest.norm_squared() - left.norm_squared(), by))
}

/// Names of numbers that are added begin so: no scene has such a name.
const ADDED: &str = "explained by ";

/// The scene with numbers of all explanations, zero.
fn widened(scene: &Scene, films: &[Film], problem: &Problem) -> (Scene, Vec<Candidate>) {
    let mut wider = scene.clone();
    let (system, g) = (&scene.system, &wider.system.graph);
    let mut added: Vec<Parameter> = Vec::new();
    let mut new = |name: String| -> (String, Expr) {
        let name = format!("{ADDED}{name}");
        let symbol = g.symbol(&name);
        added.push(Parameter { symbol, value: 0.0, formula: None });
        (name, g.variable(symbol))
    };
    let is_angle = |unit: &str| ["rad", "mrad", "deg", "°"].contains(&unit);
    let lengths: Vec<usize> = (0..system.dimension()).filter(|&i| !is_angle(&system.coordinates[i].unit)).collect();
    let (mut candidates, mut pushes, mut lagrangian) = (Vec::new(), Vec::new(), vec![system.lagrangian]);
    for &i in &lengths {
        let (name, push) = new(format!("force along {}", system.coordinates[i].name));
        lagrangian.push(g.mul(push, g.variable(system.coordinates[i].position)));
        pushes.push(name);
    }
    if !pushes.is_empty() {
        candidates.push(Candidate { name: "constant forces, as of a tilt".into(), numbers: pushes });
    }
    let (name, drag) = new("drag".into());
    candidates.push(Candidate { name: "a drag".into(), numbers: vec![name] });
    let momenta = g.gradient(system.lagrangian, &system.velocities());
    let forces = system.forces.iter().zip(momenta).map(|(&f, p)| g.sub(f, g.mul(drag, p))).collect();
    // columns, each with a scale and the point that it shows
    let mut columns: Vec<String> = films.iter().flat_map(|film| film.columns.iter().map(|c| c.name.clone())).collect();
    columns.sort_unstable();
    columns.dedup();
    let place = |name: &String| system.coordinates.iter().position(|c| c.name == *name);
    let plane: Vec<usize> = columns.iter().filter_map(place).filter(|i| lengths.contains(i)).collect();
    let mut moved: Vec<(usize, Expr)> = Vec::new();
    if let [x, y] = plane[..] {
        for heading in system.coordinates.iter().filter(|c| is_angle(&c.unit)) {
            let (along, e) = new(format!("offset along {}", heading.name));
            let (across, s) = new(format!("offset across {}", heading.name));
            let angle = g.variable(heading.position);
            let (cos, sin) = (g.call(Function::Cos, angle), g.call(Function::Sin, angle));
            moved.push((x, g.sub(g.mul(e, cos), g.mul(s, sin))));
            moved.push((y, g.add(g.mul(e, sin), g.mul(s, cos))));
            let name = format!("an offset of the filmed point along {}", heading.name);
            candidates.push(Candidate { name, numbers: vec![along, across] });
        }
    }
    let mut filmed = scene.film.clone();
    for column in &columns {
        let Ok(own) = expression(scene, column) else { continue };
        let (name, scale) = new(format!("scale of {column}"));
        let offsets = moved.iter().filter(|(i, _)| system.coordinates[*i].name == *column).map(|(_, e)| *e);
        let terms: Vec<Expr> = [own, g.mul(scale, own)].into_iter().chain(offsets).collect();
        filmed.retain(|filmed| filmed.name != *column);
        filmed.push(Filmed { name: column.clone(), expression: g.sum(&terms), sigma: None });
        candidates.push(Candidate { name: format!("another scale of {column}"), numbers: vec![name] });
    }
    let is_free = |name: &str| problem.unknowns().iter().any(|u| u.name == name);
    if !is_free(CLOCK) && g.find_symbol(CLOCK).is_none() {
        candidates.push(Candidate { name: "a clock of another rate".into(), numbers: vec![CLOCK.into()] });
    }
    for parameter in &system.parameters {
        let name = g.name(parameter.symbol);
        let is_known = films.iter().any(|film| film.known.iter().any(|(known, _)| *known == name));
        if parameter.value != 0.0 && !is_free(&name) && !is_known && !is_constant(&name) {
            candidates.push(Candidate { name: format!("another {name}"), numbers: vec![name] });
        }
    }
    (wider.system.lagrangian, wider.system.forces, wider.film) = (g.sum(&lagrangian), forces, filmed);
    wider.system.parameters.extend(added);
    (wider, candidates)
}
