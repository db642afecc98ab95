//! Constants as functions of the start: `c = φ(q, v, t)`, an identity on all of `f = 0`.

use std::sync::Arc;

use mechanics::{State, System};
use symbolic::limits::IN_FIELD;
use symbolic::{Evaluator, Expr, Tape};

use crate::DecisionError;
use crate::exact::{Echelon, Exact, FIELDS, Jet, Modular, in_field};
use crate::family::{CostateRate, Family};
use crate::flow::inputs;
use crate::identity::is_identity;
use crate::proof::Question;
use crate::random_start::at_random;
use crate::start::ExactStart;

/// Constants as functions of the start, for which the motion belongs to the family at every start on the
/// constraint.
///
/// `c_j = Σ a_{jb} B_b(q, v)` with fractions `a_{jb}` and as `B_b` the momenta `∂L/∂v`, 1 and the velocities.
/// Solved for `a` at random points of one finite field, they hold at four of another. That is not a proof.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Names of the constants.
    pub constants: Vec<String>,
    /// `φ_j`, as printed expressions.
    pub expressions: Vec<String>,
    /// Their values at the start in question.
    pub values: Vec<f64>,
    /// Whether the equations with `φ` put in are zero symbolically, on all of `f = 0`: a proof.
    pub proved: bool,
    /// Whether they are so with every `η`: all constants are proved to do.
    pub every: bool,
}

/// The system with the functions that constants are sought among.
struct Ansatz<'a> {
    question: &'a Question<'a>,
    family: &'a Family,
    program: Arc<Tape>,
    functions: Vec<Expr>,
}

/// Rows `r · a = s` at one point, for the coefficients `a` of all constants.
type Rows = Vec<Vec<Modular>>;

impl Question<'_> {
    /// Looks for a section of the set of constants over all starts.
    ///
    /// # Errors
    /// [`DecisionError::Compile`] for expressions with symbols that the system does not have.
    pub fn section(
        &self,
        system: &System,
        start: &ExactStart,
        state: &State,
    ) -> Result<Option<Section>, DecisionError> {
        let family = self.family();
        if family.shape.constants != family.shape.costates || family.lift.is_some() {
            return Ok(None);
        }
        let g = &system.graph;
        let mut functions = g.gradient(system.lagrangian, &system.velocities());
        functions.push(g.one());
        functions.extend(g.variables(&system.velocities()));
        let program = g.tape(&inputs(system, &[]), &functions)?;
        let ansatz = Ansatz { question: self, family, program, functions };
        let Some(coefficients) = ansatz.solve(start) else { return Ok(None) };
        let (k, count) = (family.shape.constants, ansatz.functions.len());
        let values = system.values_at(state);
        let constants = family.constants().to_vec();
        let mut section =
            Section { constants, expressions: Vec::new(), values: Vec::new(), proved: false, every: false };
        let mut formulas = Vec::new();
        for j in 0..k {
            let terms = ansatz
                .functions
                .iter()
                .zip(&coefficients[j * count..(j + 1) * count])
                .map(|(&b, a)| g.mul(g.fraction(a.fraction), b));
            let expression = g.sum(&terms.collect::<Vec<_>>());
            section.values.push(g.evaluate(expression, &values)?);
            section.expressions.push(g.plain(expression));
            formulas.push(expression);
        }
        section.every = is_identity(system, &self.curve, family, None);
        section.proved = section.every || is_identity(system, &self.curve, family, Some(&formulas));
        Ok(Some(section))
    }

    /// The section `c = 0`, where every other constant does as well, which is proved; for scenes whose random
    /// starts have no image, as with roots.
    pub fn every_constant(&self, system: &System) -> Option<Section> {
        let (family, k) = (self.family(), self.family().shape.constants);
        let suits = k == family.shape.costates && family.lift.is_none();
        (suits && is_identity(system, &self.curve, family, None)).then(|| Section {
            constants: family.constants().to_vec(),
            expressions: vec!["0".into(); k],
            values: vec![0.0; k],
            proved: true,
            every: true,
        })
    }
}

impl Ansatz<'_> {
    /// Coefficients that solve the equations at random points, as fractions, and hold at further ones.
    fn solve(&self, start: &ExactStart) -> Option<Vec<Exact>> {
        let unknowns = self.family.shape.constants * self.functions.len();
        let points = (unknowns / self.family.shape.coordinates + 4) as u64;
        let [first, second, ..] = &FIELDS;
        let fractions = in_field(first, || self.fractions(start, points, unknowns))?;
        in_field(second, || {
            let solution: Vec<Modular> = fractions.iter().map(|&x| Modular::fraction(x)).collect::<Option<_>>()?;
            for seed in points..points + IN_FIELD {
                for row in self.rows(start, seed)? {
                    let sum = row.iter().zip(&solution).fold(Modular::ZERO, |sum, (&r, &a)| sum + r * a);
                    if sum != row[unknowns] {
                        return None;
                    }
                }
            }
            Some(fractions)
        })
    }

    fn fractions(&self, start: &ExactStart, points: u64, unknowns: usize) -> Option<Vec<Exact>> {
        let mut echelon = Echelon::default();
        for seed in 0..points {
            for row in self.rows(start, seed)? {
                // a pivot in the last column: 0 = 1
                if echelon.add(row) && echelon.0.last().is_some_and(|(pivot, _)| *pivot == unknowns) {
                    return None;
                }
            }
        }
        // r · a − s · 1 = 0
        let solution = echelon.kernel(unknowns + 1).1.pop()?;
        solution[..unknowns].iter().map(|&x| (-x).small_fraction()).collect()
    }

    /// What the equations of the family say about the coefficients at a random point.
    fn rows(&self, start: &ExactStart, seed: u64) -> Option<Rows> {
        let (curve, _) = at_random(start, seed.wrapping_mul(0x51ed) ^ 0xa11, |point| {
            self.question.series(&point, 2).map_err(|fault| fault.to_string())
        })
        .ok()?;
        let functions = Evaluator::<Jet<Modular>>::new(self.program.clone()).evaluate(&curve.inputs).to_vec();
        let values = self.family.evaluator::<Jet<Modular>>().evaluate(&curve.inputs).to_vec();
        if functions.iter().chain(&values).any(|x| x.flaw().is_some()) {
            return None;
        }
        let shape = &self.family.shape;
        let instant = shape.instant(&values);
        let (k, size, count) = (shape.costates, shape.unknowns, functions.len());
        let mut rows = Vec::new();
        let mut row = |slope: &dyn Fn(usize) -> Modular, rate: &dyn Fn(usize) -> Modular, rest: Modular| {
            let entries = (0..k).flat_map(|j| functions.iter().map(move |b| (j, b)));
            let entries = entries.map(|(j, b)| slope(j) * b.coefficient(0) + rate(j) * b.coefficient(1));
            rows.push(entries.chain([-rest]).collect::<Vec<_>>());
        };
        for i in 0..size {
            // R_η η + J_η̇ η̇ + R₀ = 0, the accelerations being the curve's own
            let rate = |j: usize| match shape.rates[j] {
                CostateRate::Unknown(place) => instant.matrix[i * size + place].coefficient(0),
                CostateRate::Explicit(_) => Modular::ZERO,
            };
            row(&|j| instant.by_costate[i * k + j].coefficient(0), &rate, instant.rest[i].coefficient(0));
        }
        for (own, kind) in shape.rates.iter().enumerate() {
            let CostateRate::Explicit(place) = *kind else { continue };
            let explicit = &instant.explicit[place * (k + 1)..(place + 1) * (k + 1)];
            let minus = |j: usize| if j == own { -Modular::one() } else { Modular::ZERO };
            row(&|j| explicit[j].coefficient(0), &minus, explicit[k].coefficient(0));
        }
        debug_assert!(rows.iter().all(|row| row.len() == k * count + 1));
        Some(rows)
    }
}
