//! One formulation's motions for all free constants, as a condition on these constants along a curve.

use std::collections::HashMap;
use std::sync::Arc;

use equations::{Equations, Role};
use mechanics::System;
use symbolic::{Evaluator, Expr, Graph, Scalar, Symbol, Tape};

use crate::DecisionError;
use crate::flow::{flow, inputs, timeless};
use crate::lift::Lift;

/// A formulation's equations as conditions affine in its costates `η` (multipliers `μ`, memory costates `P`).
///
/// Along a curve all but `η` is known. With the unknowns `z` of one instant (accelerations, and `μ̇` if any)
/// they are `J Δz + R_η η + R₀ = 0`, `Δz` being what the curve's own accelerations lack.
#[derive(Clone)]
pub struct Family {
    pub(crate) formulation: &'static str,
    pub(crate) shape: Shape,
    /// Whether costates stand in the matrix of the equations of an instant.
    by_costates: bool,
    /// Whether time stands in no equation.
    pub(crate) timeless: bool,
    names: Vec<String>,
    parameters: Vec<f64>,
    pub(crate) equations: Equations,
    pub(crate) program: Arc<Tape>,
    start: Arc<Tape>,
    pub(crate) lift: Option<Lift>,
}

/// Sizes, and what is where.
#[derive(Clone)]
pub(crate) struct Shape {
    /// n and h.
    pub(crate) coordinates: usize,
    pub(crate) constraints: usize,
    /// Number of `z`, of `η`, of free constants.
    pub(crate) unknowns: usize,
    pub(crate) costates: usize,
    pub(crate) constants: usize,
    /// Places of the accelerations among the `z`.
    pub(crate) accelerations: Vec<usize>,
    pub(crate) rates: Vec<CostateRate>,
    explicit: usize,
}

/// Where `η̇` comes from.
#[derive(Clone, Copy)]
pub(crate) enum CostateRate {
    /// It is the unknown with this place.
    Unknown(usize),
    /// It is the explicit rate with this place.
    Explicit(usize),
}

/// One instant of a family along a curve; matrices row by row.
pub(crate) struct Instant<'a, T> {
    /// `J = ∂R/∂z`, N×N.
    pub(crate) matrix: &'a [T],
    /// `R_η`, N×k.
    pub(crate) by_costate: &'a [T],
    /// `R₀`, N.
    pub(crate) rest: &'a [T],
    /// Explicit rates, each as k coefficients of `η` and the rest.
    pub(crate) explicit: &'a [T],
    /// `∂q̈/∂z` for the accelerations among `z`, n×(number of these).
    pub(crate) to_acceleration: &'a [T],
    /// `M`, n×n, and `A`, h×n.
    pub(crate) mass: &'a [T],
    pub(crate) jacobian: &'a [T],
}

impl Family {
    /// Reads `equations` of `system`, as derived: nothing left out, nothing substituted.
    ///
    /// # Errors
    /// [`DecisionError::Unsuited`] for equations not affine in costates, or that ask more than a curve tells.
    pub fn new(system: &System, equations: &Equations) -> Result<Self, DecisionError> {
        let unsuited = |reason: String| DecisionError::Unsuited { formulation: equations.formulation, reason };
        let system = &System { graph: equations.graph.clone(), ..system.clone() };
        let g = &system.graph;
        if !equations.definitions.is_empty() {
            return Err(unsuited("intermediate quantities stand in its equations; take the form as derived".into()));
        }
        let lift = match &equations.removal {
            Some(removal) => Lift::new(system, removal, equations)?,
            None => None,
        };
        let costates: Vec<Symbol> = equations.states.iter().filter(|y| costate(y.role)).map(|y| y.symbol).collect();
        if equations.states.iter().any(|y| y.role == Role::Costate) {
            return Err(unsuited("costates p stand in the place of velocities; take the form with multipliers".into()));
        }
        let unknowns = equations.unknowns();
        let residuals: Vec<Expr> = equations.blocks.iter().flat_map(|b| b.residuals.clone()).collect();
        let rates: Vec<Expr> = equations.states.iter().filter(|y| costate(y.role)).map(|y| y.rate).collect();

        let mut kinds = Vec::new();
        let mut explicit = Vec::new();
        for &rate in &rates {
            kinds.push(match g.as_symbol(rate).and_then(|s| unknowns.iter().position(|&z| z == s)) {
                Some(place) => CostateRate::Unknown(place),
                None => {
                    explicit.push(rate);
                    CostateRate::Explicit(explicit.len() - 1)
                }
            });
        }
        let is_rate = |z: usize| kinds.iter().any(|k| matches!(k, CostateRate::Unknown(place) if *place == z));
        let accelerations: Vec<usize> = (0..unknowns.len()).filter(|&z| !is_rate(z)).collect();
        let moving = equations.removal.as_ref().map_or(system.dimension(), |removal| removal.parameters.len());
        if accelerations.len() != moving {
            return Err(unsuited("accelerations were solved for on the spot; take the form as derived".into()));
        }
        let mut zeros: HashMap<Symbol, Expr> = costates.iter().map(|&s| (s, g.zero())).collect();
        zeros.extend((0..unknowns.len()).filter(|&z| is_rate(z)).map(|z| (unknowns[z], g.zero())));
        let slopes = g.jacobian(&[&residuals[..], &explicit].concat(), &costates);
        let by_rate: Vec<Symbol> = (0..unknowns.len()).filter(|&z| is_rate(z)).map(|z| unknowns[z]).collect();
        let by_rate = g.jacobian(&residuals, &by_rate);
        let bent = slopes
            .entries()
            .iter()
            .chain(by_rate.entries())
            .any(|&e| g.symbols_of(e).iter().any(|s| zeros.contains_key(s)));
        if bent {
            return Err(unsuited("its equations are not affine in the costates".into()));
        }

        let flow = flow(system, equations);
        let accelerated: Vec<Symbol> = accelerations.iter().map(|&z| unknowns[z]).collect();
        let second: Vec<Expr> = equations.velocities.iter().map(|&v| g.total_derivative(v, &flow)).collect();
        let mut outputs = g.jacobian(&residuals, &unknowns).entries().to_vec();
        let by_costates = outputs.iter().any(|&e| costates.iter().any(|&s| g.depends_on(e, s)));
        let (k, rows) = (costates.len(), residuals.len());
        outputs.extend(&slopes.entries()[..rows * k]);
        outputs.extend(&residuals);
        for (i, &rate) in explicit.iter().enumerate() {
            outputs.extend(slopes.row(rows + i));
            outputs.push(rate);
        }
        outputs.extend(g.jacobian(&second, &accelerated).entries());
        outputs.extend(system_matrices(g, system));
        let outputs = g.substitute_all(&outputs, &zeros);

        let inputs = inputs(system, lift.as_ref().map_or(&[], |lift| &lift.symbols));
        if let Some(s) = outputs.iter().flat_map(|&e| g.symbols_of(e)).find(|s| !inputs.contains(s)) {
            return Err(unsuited(format!("a curve does not tell `{}`, which stands in its equations", g.name(s))));
        }
        let constants = equations.constant_symbols();
        let starts: Vec<Expr> = equations.states.iter().filter(|y| costate(y.role)).map(|y| y.start).collect();
        let start = start_program(g, &starts, &constants, &inputs).map_err(unsuited)??;
        Ok(Family {
            formulation: equations.formulation,
            by_costates,
            shape: Shape {
                coordinates: system.dimension(),
                constraints: system.constraints.len(),
                unknowns: unknowns.len(),
                costates: k,
                constants: constants.len(),
                accelerations,
                rates: kinds,
                explicit: explicit.len(),
            },
            timeless: timeless(system.time, equations),
            names: constants.iter().map(|&s| g.name(s)).collect(),
            parameters: system.parameters.iter().map(|p| p.value).collect(),
            equations: equations.clone(),
            program: g.tape(&inputs, &outputs)?,
            start,
            lift,
        })
    }

    /// Whether the equations may be singular for some constants, which give no motion then: where `f` is not
    /// linear in the velocities, `∂²(L + μ·f)/∂v²` depends on them.
    pub fn may_be_singular(&self) -> bool {
        self.by_costates
    }

    /// Names of the free constants.
    pub fn constants(&self) -> &[String] {
        &self.names
    }

    /// Name of the formulation.
    pub fn formulation(&self) -> &'static str {
        self.formulation
    }

    /// Values of the parameters, in the order of the inputs.
    pub(crate) fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    pub(crate) fn evaluator<T: Scalar>(&self) -> Evaluator<T> {
        Evaluator::new(self.program.clone())
    }

    /// `η(t₀)` as k rows of one coefficient for each constant and the rest.
    pub(crate) fn start<T: Scalar>(&self, inputs: &[T]) -> Vec<T> {
        Evaluator::new(self.start.clone()).evaluate(inputs).to_vec()
    }
}

impl Shape {
    /// The outputs of the program, by name.
    pub(crate) fn instant<'a, T>(&self, values: &'a [T]) -> Instant<'a, T> {
        let (n, z, k) = (self.coordinates, self.unknowns, self.costates);
        let (matrix, values) = values.split_at(z * z);
        let (by_costate, values) = values.split_at(z * k);
        let (rest, values) = values.split_at(z);
        let (explicit, values) = values.split_at(self.explicit * (k + 1));
        let (to_acceleration, values) = values.split_at(n * self.accelerations.len());
        let (mass, jacobian) = values.split_at(n * n);
        Instant { matrix, by_costate, rest, explicit, to_acceleration, mass, jacobian }
    }
}

/// Whether a state is one of the `η`.
pub(crate) fn costate(role: Role) -> bool {
    matches!(role, Role::Multiplier | Role::MemoryCostate | Role::ParameterMomentum)
}

/// `M` and `A`.
fn system_matrices(g: &Graph, system: &System) -> Vec<Expr> {
    let v = system.velocities();
    let mut entries = g.jacobian(&g.gradient(system.lagrangian, &v), &v).entries().to_vec();
    entries.extend(g.jacobian(&system.constraints, &v).entries());
    entries
}

type Started = Result<Arc<Tape>, symbolic::CompileError>;

/// `∂η(t₀)/∂c` and `η(t₀)` at `c = 0`, row by row.
fn start_program(g: &Graph, starts: &[Expr], constants: &[Symbol], inputs: &[Symbol]) -> Result<Started, String> {
    let slopes = g.jacobian(starts, constants);
    if slopes.entries().iter().any(|&e| constants.iter().any(|&c| g.depends_on(e, c))) {
        return Err("its costates do not start at affine functions of the constants".into());
    }
    let zeros: HashMap<Symbol, Expr> = constants.iter().map(|&c| (c, g.zero())).collect();
    let mut outputs = Vec::new();
    for (i, &start) in starts.iter().enumerate() {
        outputs.extend(slopes.row(i));
        outputs.push(g.substitute(start, &zeros));
    }
    Ok(g.tape(inputs, &outputs))
}
