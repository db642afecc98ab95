//! A start completed: its velocities found, checked, projected.

use std::collections::HashMap;

use symbolic::{Expr, Symbol};

use super::data::{Completion, StartData, StartNumbers, StartShape};
use super::error::StartError;
use super::numeric::{Residual, Residuals};
use super::project::Projection;
use super::regularity::Regularity;
use super::velocities::{Attempt, VelocityProgram};
use crate::newton::NewtonOptions;
use crate::{Removal, State, System};

/// Finds the velocities that were not given from `f(q₀, v, t₀) = 0` and the start equations, checks the start
/// ([`check_regularity`]).
///
/// With rates of removal parameters given, the unknowns are `(ü, u̇, u, w)` with `q(u̇, u, w) = q₀`, the
/// given velocities and the removal's start expressions; then `v = q̇(ü, u̇, u, w)`.
///
/// # Errors
/// [`StartError`].
///
/// [`check_regularity`]: super::check_regularity
pub fn complete_start(system: &System, data: &StartData) -> Result<(State, Completion), StartError> {
    let sorted = |map: &HashMap<Symbol, f64>| {
        let mut pairs: Vec<(Symbol, f64)> = map.iter().map(|(&s, &x)| (s, x)).collect();
        pairs.sort_by_key(|(s, _)| *s);
        pairs.into_iter().unzip::<Symbol, f64, Vec<_>, Vec<_>>()
    };
    let ((given, rates), (guessed, guess)) = (sorted(&data.given), sorted(&data.guess));
    let removal = data.removal;
    let (equations, project) = (&data.equations, data.project);
    let shape = StartShape { given: &given, guessed: &guessed, equations, project, removal, varied: &[] };
    let positions = data.positions.clone();
    let numbers = StartNumbers { time: data.time, positions, given: rates, guess, varied: Vec::new() };
    StartProgram::new(system, &shape).complete(&numbers)
}

/// [`complete_start`], compiled for starts that differ by numbers only.
#[derive(Clone)]
pub struct StartProgram {
    velocities: VelocityProgram,
    /// With the first 0, 1, … start equations only, up to all but one.
    without: Vec<VelocityProgram>,
    regularity: Regularity,
    projection: Option<Projection>,
    /// Of constraints and start equations.
    residuals: Residuals,
    constraints: usize,
    /// Without figures.
    completion: Completion,
}

impl StartProgram {
    /// For starts of this shape.
    pub fn new(system: &System, shape: &StartShape) -> Self {
        let (g, velocities) = (&system.graph, system.velocities());
        let by_rates = shape.removal.filter(|_| shape.given.iter().any(|s| !velocities.contains(s)));
        let (mut equations, outputs) = match by_rates {
            Some(removal) => parametrized(system, removal, shape),
            None => (system.constraints.clone(), g.variables(&velocities)),
        };
        let first = equations.len();
        let in_unknowns: HashMap<Symbol, Expr> = velocities.iter().copied().zip(outputs.iter().copied()).collect();
        let own = shape.equations.iter();
        equations.extend(own.map(|&e| if by_rates.is_some() { g.substitute(e, &in_unknowns) } else { e }));
        let with = |end: usize| VelocityProgram::new(system, shape, &equations[..end], first, &outputs);
        let mut completion = Completion {
            given: names(system, |s| shape.given.contains(&s)),
            supplied: names(system, |s| !shape.given.contains(&s)),
            equations: shape.equations.to_vec(),
            ..Completion::default()
        };
        if let Some(removal) = by_rates {
            let own = removal.parameters.iter().filter(|u| u.coordinate.is_none() && shape.given.contains(&u.rate));
            completion.given.extend(own.map(|u| g.name(u.rate)));
        }
        StartProgram {
            velocities: with(equations.len()),
            without: (first..equations.len()).map(with).collect(),
            regularity: Regularity::new(system, shape.varied),
            projection: shape.project.then(|| Projection::new(system, shape.varied)),
            residuals: Residuals::new(system, shape.equations, shape.varied),
            constraints: system.constraints.len(),
            completion,
        }
    }

    /// The start with these numbers.
    ///
    /// # Errors
    /// As [`complete_start`].
    pub fn complete(&mut self, numbers: &StartNumbers) -> Result<(State, Completion), StartError> {
        let varied = &numbers.varied;
        if self.projection.is_some() && !self.completion.equations.is_empty() {
            return Err(StartError::ProjectedEquations);
        }
        let (mut state, looked_for) = self.velocities.solve(numbers, &mut self.regularity)?;
        if let Some(velocities) = looked_for {
            return Err(self.contradiction(numbers, state, Some(velocities))?);
        }
        let mut completion = self.completion.clone();
        self.regularity.check(&state, varied)?;
        let limit = NewtonOptions::default().limit;
        let (mut residual, _) = largest(&self.residuals.at(&state, varied)?);
        completion.projected = self.projection.is_some().then_some(0.0);
        if let Some(projection) = self.projection.as_mut().filter(|_| residual > limit) {
            let (projected, length) = projection.project(&mut self.regularity, &state, varied)?;
            (state, completion.projected) = (projected, Some(length));
            self.regularity.check(&state, varied)?;
            (residual, _) = largest(&self.residuals.at(&state, varied)?);
        }
        if residual > limit {
            return Err(self.contradiction(numbers, state, None)?);
        }
        completion.residual = residual;
        Ok((state, completion))
    }

    /// The constraint that is missed most, where they cannot be fulfilled by themselves; else the first start
    /// equation that does not go with what is before it. At `state` conditions are missed that are not linear
    /// in the velocities `looked_for`, or are together.
    fn contradiction(
        &mut self,
        numbers: &StartNumbers,
        mut state: State,
        looked_for: Option<Vec<String>>,
    ) -> Result<StartError, StartError> {
        let limit = NewtonOptions::default().limit;
        let mut equation = self.without.len();
        for (fewer, program) in self.without.iter_mut().enumerate() {
            let Attempt { state: found, unsolved, .. } = program.attempt(numbers)?;
            let wanted = if self.velocities.is_linear() { !unsolved || fewer == 0 } else { unsolved };
            state = if wanted { found } else { state };
            if unsolved {
                equation = fewer;
                break;
            }
        }
        let residuals = self.residuals.at(&state, &numbers.varied)?;
        if let Some(place) = equation.checked_sub(1) {
            let Residual { value, relative } = residuals[self.constraints + place];
            return Ok(StartError::ContradictoryEquation { equation, value, residual: relative, limit });
        }
        let (residual, constraint) = largest(&residuals[..self.constraints]);
        Ok(match looked_for {
            Some(velocities) => StartError::NoRealSolution { velocities, constraint, residual, limit },
            None => StartError::Contradictory { constraint, residual, limit },
        })
    }
}

/// The largest relative residual, and its number from 1.
fn largest(residuals: &[Residual]) -> (f64, usize) {
    let residuals = residuals.iter().map(|r| r.relative).zip(1..);
    residuals.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0))
}

fn names(system: &System, select: impl Fn(Symbol) -> bool) -> Vec<String> {
    system.velocities().into_iter().filter(|&s| select(s)).map(|s| system.graph.name(s)).collect()
}

/// Equations for the variables of a removal, and the velocities as expressions in them.
fn parametrized(system: &System, removal: &Removal, shape: &StartShape) -> (Vec<Expr>, Vec<Expr>) {
    let g = &system.graph;
    let rates = removal.velocities(system);
    let as_rates: HashMap<Symbol, Expr> = system.velocities().into_iter().zip(rates.iter().copied()).collect();
    let start = removal.start.iter().filter(|(s, _)| !shape.given.contains(s));
    let mut equations: Vec<Expr> = start.map(|(&s, &e)| g.sub(g.variable(s), g.substitute(e, &as_rates))).collect();
    equations.sort();
    for (i, c) in system.coordinates.iter().enumerate() {
        equations.push(g.sub(removal.coordinates[i], g.variable(c.position)));
        if shape.given.contains(&c.velocity) {
            equations.push(g.sub(rates[i], g.variable(c.velocity)));
        }
    }
    equations.retain(|&e| !g.is_zero(e));
    (equations, rates)
}
