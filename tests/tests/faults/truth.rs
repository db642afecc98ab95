//! A system by the values of `L`, `f` and `Q` alone. Every derivative is a difference of sixth order: nothing
//! here is derived from an expression.

use std::cell::RefCell;

use mechanics::System;
use nalgebra::{DMatrix, DVector};
use symbolic::{Evaluator, Symbol};

/// An instant of a curve, with multipliers of `f`.
#[derive(Clone, Debug)]
pub struct Point {
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub mu: Vec<f64>,
}

impl Point {
    /// The curve through this point with acceleration `a`, and multipliers that move at `rate`.
    pub fn moved(&self, a: &[f64], rate: &[f64], s: f64) -> Point {
        Point {
            t: self.t + s,
            q: self.q.iter().zip(&self.v).zip(a).map(|((q, v), a)| q + s * v + 0.5 * s * s * a).collect(),
            v: self.v.iter().zip(a).map(|(v, a)| v + s * a).collect(),
            mu: self.mu.iter().zip(rate).map(|(mu, rate)| mu + s * rate).collect(),
        }
    }
}

const STEP: f64 = 4e-3;

/// The derivative at 0.
pub fn slope(mut of: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let mut slope = Vec::new();
    for (step, weight) in [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)] {
        let (after, before) = (of(step * STEP), of(-step * STEP));
        slope.resize(after.len(), 0.0);
        for (d, (after, before)) in slope.iter_mut().zip(after.iter().zip(before)) {
            *d += weight * (after - before) / STEP;
        }
    }
    slope
}

/// The derivatives by each entry of `at`: one row an entry.
pub fn slopes(at: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Vec<f64>> {
    let shifted = |i: usize, s: f64| {
        let mut x = at.to_vec();
        x[i] += s;
        x
    };
    (0..at.len()).map(|i| slope(|s| of(&shifted(i, s)))).collect()
}

pub struct Truth {
    pub n: usize,
    pub h: usize,
    pub positions: Vec<Symbol>,
    pub velocities: Vec<Symbol>,
    /// Whether the constraints are linear in the velocities.
    pub linear: bool,
    names: Vec<String>,
    /// `L, f, Q, w` from `t, q, v`
    function: RefCell<Evaluator<f64>>,
}

impl Truth {
    pub fn new(system: &System) -> Truth {
        let system = system.clone();
        let inputs = [&[system.time][..], &system.positions(), &system.velocities()].concat();
        let function = system.evaluator(&inputs, &system.written()).expect("compiles");
        Truth {
            n: system.dimension(),
            h: system.constraints.len(),
            positions: system.positions(),
            velocities: system.velocities(),
            linear: system.constraints_linear_in_velocity(),
            names: system.coordinates.iter().map(|c| c.name.clone()).collect(),
            function: RefCell::new(function),
        }
    }

    /// What may be constant: the momenta, then the energy.
    pub fn conserved(&self, place: usize) -> String {
        self.names.get(place).map_or("energy".into(), |name| format!("momentum {name}"))
    }

    fn values(&self, t: f64, q: &[f64], v: &[f64]) -> Vec<f64> {
        self.function.borrow_mut().evaluate(&[&[t][..], q, v].concat()).to_vec()
    }

    pub fn lagrangian(&self, t: f64, q: &[f64], v: &[f64]) -> f64 {
        self.values(t, q, v)[0]
    }

    pub fn constraints(&self, at: &Point) -> Vec<f64> {
        self.values(at.t, &at.q, &at.v)[1..=self.h].to_vec()
    }

    pub fn forces(&self, at: &Point) -> Vec<f64> {
        self.values(at.t, &at.q, &at.v)[1 + self.h..][..self.n].to_vec()
    }

    /// `𝓛 = L + μ·f`
    fn augmented(&self, at: &Point) -> Vec<f64> {
        let values = self.values(at.t, &at.q, &at.v);
        vec![values[0] + at.mu.iter().zip(&values[1..]).map(|(mu, f)| mu * f).sum::<f64>()]
    }

    /// `∂𝓛/∂v`
    pub fn momenta(&self, at: &Point) -> Vec<f64> {
        slopes(&at.v, |v| self.augmented(&Point { v: v.to_vec(), ..at.clone() })).concat()
    }

    /// `∂𝓛/∂q`
    pub fn gradient(&self, at: &Point) -> Vec<f64> {
        slopes(&at.q, |q| self.augmented(&Point { q: q.to_vec(), ..at.clone() })).concat()
    }

    /// `∂𝓛/∂t`
    pub fn by_time(&self, at: &Point) -> f64 {
        slope(|s| self.augmented(&Point { t: at.t + s, ..at.clone() }))[0]
    }

    /// `v·𝓛_v − 𝓛`
    pub fn energy(&self, at: &Point) -> f64 {
        at.v.iter().zip(self.momenta(at)).map(|(v, p)| v * p).sum::<f64>() - self.augmented(at)[0]
    }

    /// `Aᵀ = (∂f/∂v)ᵀ`, n×h
    pub fn reactions(&self, at: &Point) -> DMatrix<f64> {
        let rows = slopes(&at.v, |v| self.constraints(&Point { v: v.to_vec(), ..at.clone() }));
        DMatrix::from_fn(self.n, self.h, |i, j| rows[i][j])
    }

    /// `Wᵀ = (∂w/∂v)ᵀ`, n×h
    pub fn prescribed(&self, at: &Point) -> DMatrix<f64> {
        let rows = slopes(&at.v, |v| self.values(at.t, &at.q, v)[1 + self.h + self.n..].to_vec());
        DMatrix::from_fn(self.n, self.h, |i, j| rows[i][j])
    }

    /// `C = (∂f/∂q)ᵀ − Ȧᵀ` along the curve with acceleration `a`, n×h
    pub fn curvature(&self, at: &Point, a: &[f64]) -> DMatrix<f64> {
        let by_place = slopes(&at.q, |q| self.constraints(&Point { q: q.to_vec(), ..at.clone() }));
        let still = vec![0.0; at.mu.len()];
        let turning = slope(|s| self.reactions(&at.moved(a, &still, s)).as_slice().to_vec());
        DMatrix::from_fn(self.n, self.h, |i, j| by_place[i][j] - turning[j * self.n + i])
    }

    /// `M = ∂²L/∂v²` times a vector
    pub fn inertia(&self, at: &Point, moved: &[f64]) -> Vec<f64> {
        let shifted = |s: f64| at.v.iter().zip(moved).map(|(v, d)| v + s * d).collect();
        slope(|s| self.momenta(&Point { v: shifted(s), mu: Vec::new(), ..at.clone() }))
    }

    /// What is left of a covector when the reactions that come nearest to it are taken away.
    pub fn without_reactions(&self, at: &Point, covector: &[f64]) -> Vec<f64> {
        let (reactions, covector) = (self.reactions(at), DVector::from_row_slice(covector));
        if self.h == 0 {
            return covector.as_slice().to_vec();
        }
        let nearest = reactions.tr_mul(&reactions).lu().solve(&reactions.tr_mul(&covector));
        nearest.map_or(vec![f64::NAN], |nearest| (covector - reactions * nearest).as_slice().to_vec())
    }

    /// The nearest velocities that are admissible, by Newton's method.
    pub fn admissible(&self, at: &Point) -> Option<Point> {
        let mut at = at.clone();
        for _ in 0..50 {
            let f = DVector::from_vec(self.constraints(&at));
            if f.iter().all(|f| f.abs() < 1e-13) {
                return Some(at);
            }
            let reactions = self.reactions(&at);
            let step = &reactions * reactions.tr_mul(&reactions).lu().solve(&f)?;
            at.v.iter_mut().zip(step.iter()).for_each(|(v, d)| *v -= d);
        }
        self.constraints(&at).iter().all(|f| f.abs() < 1e-12).then_some(at)
    }
}
