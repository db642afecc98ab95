//! Arrows: the velocity of a body, its virtual displacements, the reaction at its contacts, and which way is
//! down.
//!
//! The reaction is what has to act besides the given forces, in any formulation: `R = d/dt L_v − L_q − Q`.
//! Forces `w` at the contacts, on a body there and back on the one that it touches, do the same virtual work
//! where `Jᵀ w = R`, with the displacements `J δq` of their matter from each other. Of several such forces
//! the smallest are taken; where there are none, those whose rest is least in the metric of `M⁻¹`, `M =
//! L_vv`, and the rest is given as a part of `R`.
//!
//! Everything is for drawing: `J` and `d/dt` are differences, good to about 1e-5 of the largest value.

use mechanics::{Pose, Poses, System};
use motion::SolveError;
use nalgebra::{DMatrix, DVector, SymmetricEigen, Vector3};
use scene::Scene;
use symbolic::limits::HALF_THE_DIGITS;
use symbolic::{Evaluator, Expr};

use crate::run::Run;

/// Step of differences by a number, relative to its size or one.
const BY_NUMBER: f64 = 1e-5;

/// The step by this number.
pub(crate) fn step_by(x: f64) -> f64 {
    BY_NUMBER * x.abs().max(1.0)
}

/// Step of differences by time, as a part of the motion.
const BY_TIME: f64 = 1e-4;

/// What is needed of a scene, compiled.
pub(crate) struct Arrows {
    poses: Poses,
    /// The first body that moves, and every contact of those that move.
    first: usize,
    contacts: Vec<Contact>,
    /// `L_v`, `L_q + Q`, `M`, `A` of `(t, q, v)`; `A δq = 0` for virtual displacements.
    program: Evaluator<f64>,
    coordinates: usize,
}

impl Arrows {
    /// Those of a scene with a body that moves with the coordinates, `None` without one.
    pub(crate) fn of(scene: &Scene) -> Result<Option<Arrows>, SolveError> {
        let (system, view) = (&scene.system, &scene.view);
        let moved: Vec<usize> = (0..view.bodies.len()).filter(|&i| view.is_moved(system, &view.bodies[i])).collect();
        let Some(&first) = moved.first() else { return Ok(None) };
        let touches = moved.iter().flat_map(|&body| {
            let others = view.bodies[body].touches.iter().map(|touch| touch.body).enumerate();
            others.map(move |(k, other)| Contact { body, touch: Some((k, other)) })
        });
        let mut contacts: Vec<Contact> = touches.collect();
        if contacts.is_empty() {
            contacts.push(Contact { body: first, touch: None });
        }
        let inputs = [&[system.time], &system.positions()[..], &system.velocities()].concat();
        let program = system.evaluator(&inputs, &expressions(system))?;
        let poses = view.poses(system)?;
        Ok(Some(Arrows { poses, first, contacts, program, coordinates: system.dimension() }))
    }

    /// How many contacts there are.
    pub(crate) fn contacts(&self) -> usize {
        self.contacts.len()
    }

    /// Appends, at `t` of a motion from `start`: velocity of the place whose path is drawn (3), the rest of
    /// the reaction that is no force at the contacts (1, a part of it), two orthonormal directions of virtual
    /// displacements of that place (6, zeros where there are fewer), and place and force of each contact (6
    /// each).
    pub(crate) fn put(&mut self, run: &mut Run, start: f64, t: f64, numbers: &mut Vec<f64>) -> Result<(), SolveError> {
        let n = self.coordinates;
        let now = run.at(t)?;
        let (q, v) = (&now.coordinates, &now.velocities);
        let rates = self.momentum_rates(run, start, t)?;
        let values = self.program.evaluate(&[&[t], &q[..], v].concat()).to_vec();
        let (given, mass) = (&values[n..2 * n], DMatrix::from_row_slice(n, n, &values[2 * n..2 * n + n * n]));
        let rows = &values[2 * n + n * n..];
        let conditions = DMatrix::from_row_slice(rows.len() / n, n, rows);
        let reaction = DVector::from_iterator(n, rates.iter().zip(given).map(|(rate, given)| rate - given));
        let size = rates.iter().chain(given).fold(0.0_f64, |a, x| a.max(x.abs()));

        let (mark, matter) = self.displacements(t, q);
        let velocity = &mark * DVector::from_column_slice(v) + self.drift(t, q);
        let (forces, rest) = forces(&matter, &mass, &reaction, size);
        numbers.extend(velocity.iter());
        numbers.push(rest);
        numbers.extend(directions(&mark, &conditions));
        let poses = self.poses.at(t, q);
        for (contact, force) in self.contacts.iter().zip(forces.as_slice().chunks_exact(3)) {
            numbers.extend(contact.place(&poses));
            numbers.extend(force);
        }
        Ok(())
    }

    /// `d/dt L_v` at `t`, by a parabola through three times within the motion.
    fn momentum_rates(&mut self, run: &mut Run, start: f64, t: f64) -> Result<Vec<f64>, SolveError> {
        let (end, n) = (run.end(), self.coordinates);
        let h = BY_TIME * (end - start);
        let (times, weights) = match (t - h < start, t + h > end) {
            (true, _) => ([t, t + h, t + 2.0 * h], [-1.5, 2.0, -0.5]),
            (_, true) => ([t - 2.0 * h, t - h, t], [0.5, -2.0, 1.5]),
            _ => ([t - h, t, t + h], [-0.5, 0.0, 0.5]),
        };
        let mut rates = vec![0.0; n];
        for (t, weight) in times.into_iter().zip(weights) {
            let now = run.at(t.clamp(start, end))?;
            let values = self.program.evaluate(&[&[t], &now.coordinates[..], &now.velocities].concat());
            rates.iter_mut().zip(values).for_each(|(rate, momentum)| *rate += weight * momentum / h);
        }
        Ok(rates)
    }

    /// `∂/∂q` of the place whose path is drawn (3×n), and of the matter at each contact (3k×n).
    fn displacements(&mut self, t: f64, q: &[f64]) -> (DMatrix<f64>, DMatrix<f64>) {
        let here = self.poses.at(t, q);
        let mut mark = DMatrix::zeros(3, q.len());
        let mut matter = DMatrix::zeros(3 * self.contacts.len(), q.len());
        for i in 0..q.len() {
            let ([before, after], step) = self.around(t, q, i);
            let by = |a: [f64; 3], b: [f64; 3]| (Vector3::from(b) - Vector3::from(a)) / step;
            let marked = |poses: &[Pose]| poses[self.first].marked();
            mark.fixed_view_mut::<3, 1>(0, i).copy_from(&by(marked(&before), marked(&after)));
            for (k, contact) in self.contacts.iter().enumerate() {
                let moved = contact.carried(&here, &after) - contact.carried(&here, &before);
                matter.fixed_view_mut::<3, 1>(3 * k, i).copy_from(&(moved / step));
            }
        }
        (mark, matter)
    }

    /// Poses with coordinate `i` a little less and a little more, and by how much these are apart.
    fn around(&mut self, t: f64, q: &[f64], i: usize) -> ([Vec<Pose>; 2], f64) {
        let h = step_by(q[i]);
        let at = |step: f64| {
            let mut q = q.to_vec();
            q[i] += step;
            self.poses.at(t, &q)
        };
        ([-h, h].map(at), 2.0 * h)
    }

    /// `∂/∂t` of the place whose path is drawn.
    fn drift(&mut self, t: f64, q: &[f64]) -> DVector<f64> {
        let h = step_by(t);
        let mut at = |t: f64| Vector3::from(self.poses.at(t, q)[self.first].marked());
        let drift = (at(t + h) - at(t - h)) / (2.0 * h);
        DVector::from_column_slice(drift.as_slice())
    }

    /// The axis of space that is down: `L_q` at rest is `Σ Jᵀ w_b`, with displacements `J δq` of the places
    /// of the bodies, and for each body one and the same `w_b` along that axis at all `states`, none against
    /// it. `None` where there is no such axis.
    pub(crate) fn down(&mut self, states: &[(f64, Vec<f64>)]) -> Option<[f64; 3]> {
        let (n, bodies) = (self.coordinates, self.poses.at(states.first()?.0, &states.first()?.1).len());
        let mut forces = DVector::zeros(n * states.len());
        let mut places = [(); 3].map(|()| DMatrix::zeros(n * states.len(), bodies));
        for (s, (t, q)) in states.iter().enumerate() {
            let rest = vec![0.0; n];
            let values = self.program.evaluate(&[&[*t], &q[..], &rest].concat());
            forces.rows_mut(s * n, n).copy_from_slice(&values[n..2 * n]);
            for i in 0..n {
                let ([before, after], step) = self.around(*t, q, i);
                for (axis, places) in places.iter_mut().enumerate() {
                    for body in 0..bodies {
                        places[(s * n + i, body)] = (after[body].at[axis] - before[body].at[axis]) / step;
                    }
                }
            }
        }
        let size = forces.norm();
        let found = |axis: usize| {
            let weights = places[axis].clone().svd(true, true).solve(&forces, HALF_THE_DIGITS).ok()?;
            let off = (&places[axis] * &weights - &forces).norm();
            let is_one = weights.iter().all(|w| *w >= -HALF_THE_DIGITS * size)
                || weights.iter().all(|w| *w <= HALF_THE_DIGITS * size);
            (size > 0.0 && off < 1e-6 * size && is_one).then(|| weights.sum())
        };
        let (axis, sign) = [2, 1, 0].into_iter().find_map(|axis| found(axis).map(|weight| (axis, weight.signum())))?;
        let mut down = [0.0; 3];
        down[axis] = sign;
        Some(down)
    }
}

/// `L_v`, `L_q + Q`, `M`, and `A`, row by row.
fn expressions(system: &System) -> Vec<Expr> {
    let g = &system.graph;
    let (q, v) = (system.positions(), system.velocities());
    let gradient = g.gradient(system.lagrangian, &q);
    let given = gradient.iter().zip(&system.forces).map(|(&l, &force)| g.add(l, force));
    let conditions = match &system.virtual_conditions[..] {
        [] => system.constraint_jacobian(),
        conditions => g.jacobian(conditions, &v),
    };
    let momenta = g.gradient(system.lagrangian, &v).into_iter().chain(given);
    let hessian = system.velocity_hessian();
    momenta.chain(hessian.entries().iter().copied()).chain(conditions.entries().iter().copied()).collect()
}

/// Where a body touches another one, its touch and the other body; or the place of a body alone.
struct Contact {
    body: usize,
    touch: Option<(usize, usize)>,
}

impl Contact {
    fn place(&self, poses: &[Pose]) -> [f64; 3] {
        let pose = &poses[self.body];
        self.touch.map_or(pose.at, |(k, _)| pose.touches[k])
    }

    /// Where matter of the body that is at the contact `here` is in `poses`, from that of the other body.
    fn carried(&self, here: &[Pose], poses: &[Pose]) -> Vector3<f64> {
        let place = self.place(here);
        let of = |body: usize| carried(&poses[body], own_place(&here[body], place));
        self.touch.map_or(of(self.body), |(_, other)| of(self.body) - of(other))
    }
}

/// A place of space in the axes of a body.
fn own_place(pose: &Pose, at: [f64; 3]) -> [f64; 3] {
    let from = [0, 1, 2].map(|i| at[i] - pose.at[i]);
    [0, 1, 2].map(|j| (0..3).map(|i| pose.rotation[i][j] * from[i]).sum())
}

/// Where a body has taken a place in its own axes.
fn carried(pose: &Pose, own: [f64; 3]) -> Vector3<f64> {
    Vector3::from([0, 1, 2].map(|i| pose.at[i] + (0..3).map(|j| pose.rotation[i][j] * own[j]).sum::<f64>()))
}

/// The forces at the contacts, and which part of the reaction they are not; NaN, which is not drawn, where
/// the equations have no finite value.
fn forces(matter: &DMatrix<f64>, mass: &DMatrix<f64>, reaction: &DVector<f64>, size: f64) -> (DVector<f64>, f64) {
    let all = matter.iter().chain(mass.iter()).chain(reaction.iter());
    if !{ all }.all(|x| x.is_finite()) {
        return (DVector::from_element(matter.nrows(), f64::NAN), f64::NAN);
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(mass.clone());
    let least = HALF_THE_DIGITS * eigenvalues.amax();
    let roots = eigenvalues.map(|x| 1.0 / x.abs().max(least).max(f64::MIN_POSITIVE).sqrt());
    let weight = &eigenvectors * DMatrix::from_diagonal(&roots) * eigenvectors.transpose();
    let (left, right) = (&weight * matter.transpose(), &weight * reaction);
    if reaction.amax() <= 1e-6 * size {
        return (DVector::zeros(matter.nrows()), 0.0);
    }
    let largest = left.amax();
    match left.clone().svd(true, true).solve(&right, HALF_THE_DIGITS * largest) {
        Ok(forces) => {
            let rest = (&left * &forces - &right).norm() / right.norm();
            (forces, rest)
        }
        Err(_) => (DVector::zeros(matter.nrows()), 1.0),
    }
}

/// Two orthonormal directions in which the place goes with virtual displacements, zeros where there are
/// fewer.
fn directions(mark: &DMatrix<f64>, conditions: &DMatrix<f64>) -> [f64; 6] {
    if !mark.iter().chain(conditions.iter()).all(|x| x.is_finite()) {
        return [0.0; 6];
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(conditions.transpose() * conditions);
    let largest = eigenvalues.amax();
    let allowed: Vec<_> = (0..eigenvalues.len())
        .filter(|&i| eigenvalues[i] <= HALF_THE_DIGITS * largest)
        .map(|i| eigenvectors.column(i))
        .collect();
    let mut found = [0.0; 6];
    if allowed.is_empty() {
        return found;
    }
    let places = mark * DMatrix::from_columns(&allowed);
    let covariance = SymmetricEigen::new(&places * places.transpose());
    let mut order: Vec<usize> = (0..3).collect();
    order.sort_by(|a, b| covariance.eigenvalues[*b].total_cmp(&covariance.eigenvalues[*a]));
    let largest = covariance.eigenvalues.amax();
    // what is left of differences is no direction
    let least = (HALF_THE_DIGITS * largest).max(HALF_THE_DIGITS * HALF_THE_DIGITS);
    for (k, &i) in order.iter().take(2).enumerate().filter(|(_, i)| covariance.eigenvalues[**i] > least) {
        found[3 * k..3 * k + 3].iter_mut().zip(covariance.eigenvectors.column(i).iter()).for_each(|(to, x)| *to = *x);
    }
    found
}
