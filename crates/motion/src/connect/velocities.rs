//! The start velocities that the constraints leave free, and the others by them.

use mechanics::{StartNumbers, StartProgram, StartShape, State};
use nalgebra::DMatrix;
use scene::Scene;

use crate::{Metric, SolveError};

/// `v = v(v_free)` with `f(q₀, v, t₀) = 0`; of several roots the one near the scene's own.
#[derive(Clone)]
pub(super) struct Velocities {
    program: StartProgram,
    numbers: StartNumbers,
    /// Places of the free ones among the coordinates, rising.
    pub(super) free: Vec<usize>,
}

impl Velocities {
    /// Free are those whose complement the constraints determine best, in lengths of the kinetic metric.
    pub(super) fn new(scene: &Scene, metric: &mut Metric) -> Result<Self, SolveError> {
        let (system, State { t, q, v }) = (&scene.system, &scene.start);
        let (n, h) = (system.dimension(), system.constraints.len());
        let inputs = [system.positions(), system.velocities(), vec![system.time]].concat();
        let mut program = system.evaluator::<f64>(&inputs, system.constraint_jacobian().entries())?;
        let jacobian = program.evaluate(&[&q[..], v, &[*t]].concat()).to_vec();
        let mut units = metric.inertia(*t, q, v).0;
        let largest = units.iter().fold(0.0, |a: f64, &x| a.max(x));
        // coordinates without inertia are determined by the others where possible
        units.iter_mut().for_each(|unit| *unit = unit.max(1e-6 * if largest > 0.0 { largest } else { 1.0 }));
        let scaled = DMatrix::from_fn(h, n, |i, j| jacobian[i * n + j] / units[j]);
        let mut order = DMatrix::from_fn(1, n, |_, j| j);
        if h > 0 {
            scaled.col_piv_qr().p().permute_columns(&mut order);
        }
        let mut free: Vec<usize> = order.iter().skip(h).copied().collect();
        free.sort_unstable();
        let symbols = system.velocities();
        let given: Vec<_> = free.iter().map(|&i| symbols[i]).collect();
        let others: Vec<usize> = (0..n).filter(|i| !free.contains(i)).collect();
        let guessed: Vec<_> = others.iter().map(|&i| symbols[i]).collect();
        let shape = StartShape { given: &given, guessed: &guessed, ..StartShape::default() };
        let guess = others.iter().map(|&i| v[i]).collect();
        let numbers = StartNumbers { time: *t, positions: q.clone(), guess, ..StartNumbers::default() };
        Ok(Velocities { program: StartProgram::new(system, &shape), numbers, free })
    }

    /// The start with these free velocities.
    pub(super) fn start(&mut self, free: &[f64]) -> Result<State, SolveError> {
        self.numbers.given = free.to_vec();
        Ok(self.program.complete(&self.numbers)?.0)
    }
}
