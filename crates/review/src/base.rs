//! Equations that theirs may be: a formulation of the scene, or of the scene with a mistake in it.

use std::collections::HashMap;

use decision::exact::Exact;
use equations::{Derivation, Equations, Formulation, Role};
use mechanics::{DisplacementParameter, System};
use scene::Scene;
use symbolic::{CompileError, Evaluator, Expr, Graph, Symbol};

use crate::frame::{Frame, Linear, Point, Trouble};
use crate::number::{At, Number, constants, eliminate, values};
use crate::reading::Reading;
use crate::{Law, substitution};

/// Rows `R(q̈, others; q, v, t) = 0`, linear in the others, which are multipliers and their rates.
pub(crate) struct Base {
    /// What was done, as one says of somebody's equations; nothing for what was asked for.
    pub(crate) words: Vec<String>,
    /// The rows where the others are zero, and their slopes by them.
    rows: Linear,
    /// Unknowns that the state does not give.
    states: Vec<Symbol>,
    /// Whether the rows are the balances of the scene's coordinates and the rates of its constraints.
    pub(crate) plain: bool,
}

/// Their residuals and those of single terms, without the others.
pub(crate) struct Residuals<C> {
    pub(crate) residual: Vec<C>,
    /// One list as long for each column that was given.
    pub(crate) columns: Vec<Vec<C>>,
}

impl Base {
    /// Of `equations` as derived from the scene that `reading` has; nothing where their unknowns are others.
    pub(crate) fn new(words: Vec<String>, reading: &Reading, equations: &Equations) -> Option<Base> {
        let (g, system) = (&equations.graph, &reading.system);
        if !equations.definitions.is_empty() {
            return None;
        }
        let accelerations = system.accelerations();
        let unknowns = equations.unknowns();
        let others: Vec<Symbol> = unknowns.iter().copied().filter(|z| !accelerations.contains(z)).collect();
        let known = [system.positions(), system.velocities()].concat();
        let start = equations.removal.as_ref().map(|removal| &removal.start);
        let (mut states, mut follow) = (Vec::new(), HashMap::new());
        for state in equations.states.iter().filter(|state| !known.contains(&state.symbol)) {
            match (state.role, start.and_then(|start| start.get(&state.symbol))) {
                (Role::Multiplier | Role::MemoryCostate, _) => states.push(state.symbol),
                (Role::DisplacementParameter | Role::ParameterRate, Some(&e)) => _ = follow.insert(state.symbol, e),
                _ => return None,
            }
        }
        let mut rows: Vec<Expr> = equations.blocks.iter().flat_map(|b| b.residuals.clone()).collect();
        let plain = rows.len() == system.dimension() + system.constraints.len();
        if let Some(removal) = &equations.removal {
            // q̈ by the parametrization
            let mut flow: Vec<(Symbol, Expr)> = vec![(system.time, g.one())];
            let pairs =
                |u: &DisplacementParameter| [(u.symbol, g.variable(u.rate)), (u.rate, g.variable(u.second_rate))];
            flow.extend(removal.parameters.iter().flat_map(pairs));
            flow.extend(removal.memory.iter().map(|w| (w.symbol, w.rate)));
            let rates = g.total_derivatives(&removal.coordinates, &flow);
            let second = |e: &Expr| removal.parameters.iter().any(|u| g.depends_on(*e, u.second_rate));
            if rates.iter().any(second) {
                return None;
            }
            let moved = g.total_derivatives(&rates, &flow);
            rows.extend(moved.iter().zip(&accelerations).map(|(&e, &a)| g.sub(e, g.variable(a))));
            rows.retain(|&e| !g.is_zero(e));
        }
        rows = g.substitute_all(&rows, &follow);
        Base::of(words, reading, g, &rows, (&others, &states), plain)
    }

    /// `rows`, expressions of `g`, in these `others` and unknown states.
    fn of(
        words: Vec<String>,
        reading: &Reading,
        g: &Graph,
        rows: &[Expr],
        (others, states): (&[Symbol], &[Symbol]),
        plain: bool,
    ) -> Option<Base> {
        let mut rows = Linear::new(g, rows, others, false);
        if rows.bends(g, others) {
            return None;
        }
        let own = &reading.system.graph;
        let states = states.iter().map(|&s| own.symbol(&g.name(s))).collect();
        if !std::ptr::eq(own, g) {
            rows.outputs = own.adopt(g, &rows.outputs);
        }
        rows.outputs = reading.of_scene(own, &rows.outputs);
        Some(Base { words, rows, states, plain })
    }

    /// The program for numbers of one kind, from the inputs of a frame, accelerations and states.
    pub(crate) fn program<C: Number>(&self, frame: &Frame) -> Result<Evaluator<At<C>>, CompileError> {
        let accelerations = frame.reading.coordinates.iter().map(|c| c[2]);
        let inputs: Vec<Symbol> =
            frame.inputs.iter().copied().chain(accelerations).chain(self.states.clone()).collect();
        Ok(Evaluator::new(frame.reading.system.graph.compile(&inputs, &self.rows.outputs, &<_>::default())?))
    }

    /// Signs with which their unknowns with a rate may be those of these equations.
    pub(crate) fn signs(&self, frame: &Frame) -> Vec<Vec<bool>> {
        let count = self.states.len();
        if count == 0 {
            return vec![Vec::new()];
        }
        if frame.reading.states.len() != count || count > 4 {
            return Vec::new();
        }
        (0..1_usize << count).map(|bits| (0..count).map(|i| bits >> i & 1 == 1).collect()).collect()
    }

    /// Residuals of their accelerations, `columns` of as many rows beside them.
    pub(crate) fn residuals<C: Number>(
        &self,
        program: &mut Evaluator<At<C>>,
        point: &Point<C>,
        accelerations: &[C],
        signs: &[bool],
        columns: &[Vec<C>],
    ) -> Result<Residuals<C>, Trouble> {
        let mut inputs = [&point.inputs[..], &constants(accelerations)].concat();
        let first = point.inputs.len() - signs.len();
        let own = point.inputs[first..].iter().zip(signs).map(|(&x, &turned)| if turned { -x } else { x });
        inputs.extend(own);
        let outputs = values(program, &inputs)?;
        // the combinations of rows in which the others cancel
        let mut rows = self.rows.rows(&outputs);
        rows.iter_mut().enumerate().for_each(|(i, row)| row.extend(columns.iter().map(|column| column[i])));
        let others = self.rows.unknowns;
        let done = eliminate(&mut rows, others).len();
        let of = |k: usize| rows[done..].iter().map(|row| row[others + k]).collect();
        Ok(Residuals { residual: of(0), columns: (1..=columns.len()).map(of).collect() })
    }
}

impl Base {
    /// `q̈` by these equations, which are affine in them; nothing where they are not determined.
    pub(crate) fn accelerations<C: Number>(
        &self,
        program: &mut Evaluator<At<C>>,
        point: &Point<C>,
        signs: &[bool],
    ) -> Option<Vec<C>> {
        let n = point.accelerations.len();
        let mut at = |k: Option<usize>| {
            let mut a = vec![C::ZERO; n];
            k.into_iter().for_each(|k| a[k] = C::of(Exact::ONE).unwrap_or(C::ZERO));
            self.residuals(program, point, &a, signs, &[]).ok().map(|found| found.residual)
        };
        let rest = at(None)?;
        let columns: Vec<Vec<C>> = (0..n).map(|k| at(Some(k))).collect::<Option<_>>()?;
        let row = |i: usize| columns.iter().map(|c| c[i] - rest[i]).chain([rest[i]]).collect::<Vec<C>>();
        let mut rows: Vec<Vec<C>> = (0..rest.len()).map(row).collect();
        let pivots = eliminate(&mut rows, n);
        if pivots.len() < n || rows[n..].iter().any(|row| !row[n].vanishes()) {
            return None;
        }
        let mut right = vec![C::ZERO; n];
        pivots.iter().zip(&rows).for_each(|(&j, row)| right[j] = -row[n]);
        Some(right)
    }
}

/// A formulation of the scene, with a removal where it needs one.
pub(crate) fn formulated(scene: &Scene, reading: &Reading, formulation: &'static Formulation) -> Vec<Base> {
    if !formulation.needs_removal() {
        let words = vec![format!("{} equations", formulation.title)];
        let equations = (formulation.derive)(&reading.system, &Derivation::default());
        return equations.ok().and_then(|e| Base::new(words, reading, &e)).into_iter().collect();
    }
    let own = Scene { system: reading.system.clone(), ..scene.clone() };
    let base = |removal: &mechanics::Removal| {
        let words = vec![format!("{} equations ({})", formulation.title, removal.name)];
        let derivation = Derivation { removal: Some(removal), ..Derivation::default() };
        Base::new(words, reading, &(formulation.derive)(&own.system, &derivation).ok()?)
    };
    motion::removals(&own).unwrap_or_default().iter().filter_map(base).collect()
}

/// The constraint put into `L`, by every removal in coordinates; with terms of `L` as columns: the residuals
/// that each has.
pub(crate) fn substituted(scene: &Scene, reading: &Reading, terms: &[Expr]) -> Vec<(Base, Vec<Vec<Expr>>)> {
    let own = Scene { system: reading.system.clone(), ..scene.clone() };
    let mut bases = Vec::new();
    for removal in motion::removals(&own).unwrap_or_default() {
        let parameters = removal.parameters.iter().map(|u| u.coordinate);
        if parameters.chain(removal.memory.iter().map(|w| w.coordinate)).any(|i| i.is_none()) {
            continue;
        }
        let words = vec![Law::Substitution.words().to_owned()];
        let of = |l: Expr, rates: bool| {
            let system = System { lagrangian: l, ..own.system.clone() };
            let g = &system.graph;
            let kept = g.total_derivatives(&system.constraints, &system.flow());
            let kept = kept.into_iter().map(|e| if rates { e } else { g.zero() });
            let rows: Vec<Expr> = substitution::residuals(&system, &removal).into_iter().chain(kept).collect();
            (system, rows)
        };
        let (system, rows) = of(own.system.lagrangian, true);
        let Some(base) = Base::of(words, reading, &system.graph, &rows, (&[], &[]), false) else { continue };
        let g = &reading.system.graph;
        let of = |&term: &Expr| {
            let (system, rows) = of(term, false);
            reading.of_scene(g, &g.adopt(&system.graph, &rows))
        };
        let columns = terms.iter().map(of).collect();
        bases.push((base, columns));
    }
    bases
}

/// The scene with one constraint written wrong: in its rate and in the reaction, or in one of them, or with
/// the rate of its coefficients left out besides; and how often what was written wrong.
pub(crate) fn with_constraints(reading: &Reading, wrong: Vec<(Vec<Expr>, String)>) -> Vec<Base> {
    let system = &reading.system;
    let (g, v, flow) = (&system.graph, system.velocities(), system.flow());
    let (momenta, slopes) = (g.gradient(system.lagrangian, &v), g.gradient(system.lagrangian, &system.positions()));
    let balances = system.balances(&momenta, &[&slopes, &system.forces], &flow);
    let lambda = system.multipliers("lambda", "");
    let still: Vec<(Symbol, Expr)> = flow.iter().copied().filter(|(s, _)| !v.contains(s)).collect();
    let base = |reacts: &[Expr], kept: &[Expr], words: Vec<String>| {
        let reaction = g.transpose_vec(&g.jacobian(reacts, &v), &g.variables(&lambda));
        let balances = balances.iter().zip(&reaction).map(|(&row, &r)| g.sub(row, r));
        let rows: Vec<Expr> = balances.chain(kept.iter().copied()).collect();
        Base::of(words, reading, g, &rows, (&lambda, &[]), true)
    };
    let right = g.total_derivatives(&system.constraints, &flow);
    let mut bases = Vec::new();
    for (constraints, what) in wrong {
        let rates = g.total_derivatives(&constraints, &flow);
        let driven = g.total_derivatives(&constraints, &still);
        let frozen: Vec<Expr> = rates.iter().zip(driven).map(|(&rate, driven)| g.sub(rate, driven)).collect();
        let said = |more: &str| format!("{what}{more}");
        bases.extend(base(&constraints, &rates, vec![said("")]));
        bases.extend(base(&constraints, &right, vec![said(", in its reaction only")]));
        bases.extend(base(&system.constraints, &rates, vec![said(", in its rate only")]));
        bases.extend(base(&constraints, &frozen, vec![said(""), Law::MissingRate.words().to_owned()]));
    }
    bases
}
