//! Profiles of χ²: one unknown is fixed near the minimum, and the others are fitted.
//!
//! The others follow by chords: with the Jacobian `J` that they have at the minimum,
//!
//! ```text
//! δ = −J⁺ r ,     |r|² − |J δ|²  for their least χ² ,
//! ```
//!
//! until `|J δ|²` is small; where that does not happen, by Levenberg and Marquardt's method.

use motion::shooting::{CHORDS, Minimum};
use nalgebra::{DMatrix, DVector, Dyn, SVD};

use crate::Problem;
use crate::distribution::RISE;
use crate::least::{Stage, least, scaled};

/// Smallest singular value over the largest, of a Jacobian with columns of length one, below which unknowns
/// are not shown: what is left of derivatives that carry errors of 1e-9.
pub(crate) const SHOWN: f64 = 1e-7;
/// Steps outwards and steps in all to the end of a profile, and the part of the rise that they come to.
const OUTWARDS: usize = 5;
const STEPS: usize = 15;
/// `|J δ|²` of the last chord.
pub(crate) const LAST: f64 = 0.02;
/// Distances are halved up to this many times.
const HALVINGS: usize = 2;

/// How χ² rises where unknown `i` is held and the others are fitted.
pub(crate) struct Profile<'a> {
    problem: Problem,
    best: &'a Minimum,
    errors: &'a [f64],
    i: usize,
    others: Option<Others>,
    /// The point at which their Jacobian was taken.
    derived: usize,
    /// Points that were looked at: all unknowns there, the rise.
    known: Vec<(Vec<f64>, f64)>,
}

/// The others as they move near the minimum.
struct Others {
    /// None where there are no others.
    svd: Option<SVD<f64, Dyn, Dyn>>,
    lengths: Vec<f64>,
    /// With the unknown that is held.
    slopes: Vec<f64>,
}

impl Others {
    fn new(jacobian: &DMatrix<f64>, i: usize) -> Option<Self> {
        let (matrix, lengths) = scaled(&jacobian.clone().remove_column(i));
        let svd = match matrix.ncols() {
            0 => None,
            _ => Some(matrix.try_svd(true, true, f64::EPSILON, 1000)?),
        };
        let others = Others { svd, lengths, slopes: Vec::new() };
        let (slopes, _) = others.chord(&jacobian.column(i).into_owned())?;
        Some(Others { slopes, ..others })
    }

    /// `δ` and `|J δ|²`.
    fn chord(&self, r: &DVector<f64>) -> Option<(Vec<f64>, f64)> {
        let Some(svd) = &self.svd else { return Some((Vec::new(), 0.0)) };
        let limit = SHOWN * svd.singular_values.max();
        let along = svd.solve(r, limit).ok()?;
        let parts = svd.u.as_ref()?.tr_mul(r);
        let seen = parts.iter().zip(svd.singular_values.iter()).filter(|(_, s)| **s > limit);
        let gain = seen.map(|(x, _)| x * x).sum();
        let step = |(x, l): (&f64, &f64)| if *l > 0.0 { -x / l } else { 0.0 };
        Some((along.iter().zip(&self.lengths).map(step).collect(), gain))
    }
}

impl<'a> Profile<'a> {
    /// Beside the minimum `best`, where residuals have this Jacobian.
    pub(crate) fn new(
        problem: &Problem,
        jacobian: &DMatrix<f64>,
        best: &'a Minimum,
        errors: &'a [f64],
        i: usize,
    ) -> Self {
        let others = Others::new(jacobian, i);
        Profile {
            problem: problem.clone(),
            best,
            errors,
            i,
            others,
            derived: 0,
            known: vec![(best.unknowns.clone(), 0.0)],
        }
    }

    /// The rise at `x`; infinite where there is no motion.
    pub(crate) fn rise(&mut self, x: f64) -> f64 {
        if let Some((_, rise)) = self.known.iter().find(|(known, _)| known[self.i] == x) {
            return *rise;
        }
        if self.followed(x, HALVINGS).is_none() {
            let Some((theta, chi_squared)) = self.searched(x) else { return f64::INFINITY };
            self.known.push((theta, chi_squared - self.best.value));
        }
        self.known[self.known.len() - 1].1
    }

    /// The known point that is nearest to `x`.
    fn nearest(&self, x: f64) -> usize {
        let away = |k: &usize| (self.known[*k].0[self.i] - x).abs();
        (0..self.known.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
    }

    /// Adds the point at `x` by chords from the nearest that is known, with the Jacobian there if that of
    /// another does not do, and by way of points halfway; none where these do not come to it.
    fn followed(&mut self, x: f64, halvings: usize) -> Option<()> {
        let near = self.nearest(x);
        let found = self.chords(x, near).or_else(|| self.renewed(x, near));
        if let Some((theta, chi_squared)) = found {
            self.known.push((theta, chi_squared - self.best.value));
            return Some(());
        }
        let halfway = 0.5 * (self.known[near].0[self.i] + x);
        self.followed(halfway, halvings.checked_sub(1)?)?;
        self.followed(x, halvings - 1)
    }

    /// Chords with the Jacobian of the point from which they begin, if they had that of another.
    fn renewed(&mut self, x: f64, from: usize) -> Option<(Vec<f64>, f64)> {
        if self.derived == from {
            return None;
        }
        let (_, jacobian) = self.problem.weighed(&self.known[from].0, true).ok()?;
        self.others = Others::new(&jacobian, self.i);
        self.derived = from;
        self.chords(x, from)
    }

    /// All unknowns and the least χ² at `x`, by chords from this point.
    fn chords(&mut self, x: f64, from: usize) -> Option<(Vec<f64>, f64)> {
        let (others, i) = (self.others.as_ref()?, self.i);
        let moved = |theta: &mut Vec<f64>, steps: &[f64], part: f64| {
            let places = (0..theta.len()).filter(|j| *j != i);
            places.zip(steps).for_each(|(j, step)| theta[j] += part * step);
        };
        let mut theta = self.known[from].0.clone();
        let step = x - theta[i];
        moved(&mut theta, &others.slopes, step);
        theta[i] = x;
        let mut before = f64::INFINITY;
        for _ in 0..CHORDS {
            let bounds = self.problem.unknowns().iter().map(|unknown| unknown.bound);
            if bounds.zip(&theta).any(|(bound, x)| bound.is_some_and(|bound| *x < bound)) {
                return None;
            }
            let (values, _) = self.problem.weighed(&theta, false).ok()?;
            let (step, gain) = others.chord(&values)?;
            // what goes down slowly is no place for chords
            if gain.is_nan() || gain > 0.25 * before {
                return None;
            }
            if gain <= LAST {
                return Some((theta, values.norm_squared() - gain));
            }
            before = gain;
            moved(&mut theta, &step, 1.0);
        }
        None
    }

    /// All unknowns and the least χ² at `x`, by a search from the nearest known point.
    fn searched(&self, x: f64) -> Option<(Vec<f64>, f64)> {
        let mut start = self.known[self.nearest(x)].0.clone();
        let mut scale = self.errors.to_vec();
        start.remove(self.i);
        scale.remove(self.i);
        scale.iter_mut().filter(|x| x.is_infinite()).for_each(|x| *x = 1.0);
        let found = least(&self.problem.without(self.i, x), &start, &scale, Stage::Profile).ok()?;
        let mut theta = found.unknowns;
        theta.insert(self.i, x);
        Some((theta, found.value))
    }

    /// Where χ² has risen by `rise` on this side, not beyond `bound`; open where that cannot be found: by
    /// secants of the root of the rise, which is a straight line where χ² is quadratic.
    pub(crate) fn end(&mut self, side: f64, rise: f64, bound: f64) -> f64 {
        let value = self.best.unknowns[self.i];
        let (mut inside, mut outside) = ((value, 0.0), None);
        let mut x = value + side * RISE.sqrt() * self.errors[self.i];
        for step in 0..STEPS {
            x = x.max(bound);
            let found = self.rise(x).max(0.0);
            // beyond where motions can be followed it is open
            if found.is_infinite() {
                return if side < 0.0 { bound } else { f64::INFINITY };
            }
            if (found - rise).abs() <= LAST * rise {
                return x;
            }
            if found < rise {
                if x <= bound {
                    return bound;
                }
                if outside.is_none() && step >= OUTWARDS {
                    return if side < 0.0 { bound } else { f64::INFINITY };
                }
                inside = (x, found.sqrt());
            } else {
                outside = Some((x, found.sqrt()));
            }
            let goal = rise.sqrt();
            x = match outside {
                None => value + (inside.0 - value) * (goal / inside.1).clamp(1.2, 3.0),
                Some((x, root)) => {
                    let part = (goal - inside.1) / (root - inside.1);
                    inside.0 + (x - inside.0) * part.clamp(0.1, 0.9)
                }
            };
        }
        x
    }
}
