//! Where no mistake explains equations: in which terms of the velocities their accelerations differ, at one
//! position.

use schemars::JsonSchema;
use serde::Serialize;
use symbolic::{Bounded, Scalar};

use crate::base::Base;
use crate::frame::Frame;
use crate::number::{At, Number};

/// The coefficient of a monomial of independent velocities in an acceleration, at the position of a state.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Coefficient {
    /// The acceleration, `x''`.
    pub name: String,
    /// `1`, `phi'`, `phi'*x'`.
    pub monomial: String,
    /// In their equations.
    #[schemars(with = "Option<f64>")]
    pub theirs: f64,
    /// In the right ones.
    #[schemars(with = "Option<f64>")]
    pub right: f64,
}

/// Accelerations of both sides, their first, in one row of `2n`.
type Both = Vec<Bounded>;

/// The coefficients that differ; none where accelerations are not polynomials of degree 2 in the velocities
/// that the constraints leave free.
pub(crate) fn differing(frame: &Frame, base: &Base, position: &[At<Bounded>]) -> Option<Vec<Coefficient>> {
    let n = frame.reading.coordinates.len();
    let signs = base.signs(frame).into_iter().next()?;
    let mut program = base.program(frame).ok()?;
    let free = frame.free_velocities(position)?;
    let first = frame.reading.parameters.len() + 1 + n;
    let mut of = |v: &[f64]| -> Option<Both> {
        let mut inputs = position.to_vec();
        inputs[first..first + n].fill(At::of(0.0));
        free.iter().zip(v).for_each(|(&j, &x)| inputs[first + j] = At::of(x));
        frame.hold(&mut inputs).ok()?;
        let point = frame.at(inputs).ok()?;
        let right = base.accelerations(&mut program, &point, &signs)?;
        Some([point.accelerations, right].concat())
    };
    let m = free.len();
    let unit = |entries: &[(usize, f64)]| {
        let mut v = vec![0.0; m];
        entries.iter().for_each(|&(j, x)| v[j] += x);
        v
    };
    let sum = |parts: &[(f64, &Both)]| -> Both {
        let entry = |i: usize| parts.iter().fold(Bounded::from_f64(0.0), |s, (c, x)| s + Bounded::from_f64(*c) * x[i]);
        (0..2 * n).map(entry).collect()
    };
    let rest = of(&unit(&[]))?;
    let mut terms: Vec<(Vec<usize>, Both)> = Vec::new();
    let mut ups = Vec::new();
    for j in 0..m {
        let (up, down) = (of(&unit(&[(j, 1.0)]))?, of(&unit(&[(j, -1.0)]))?);
        terms.push((vec![j], sum(&[(0.5, &up), (-0.5, &down)])));
        terms.push((vec![j, j], sum(&[(0.5, &up), (0.5, &down), (-1.0, &rest)])));
        ups.push(up);
    }
    for j in 0..m {
        for k in j + 1..m {
            let both = of(&unit(&[(j, 1.0), (k, 1.0)]))?;
            terms.push((vec![j, k], sum(&[(1.0, &both), (-1.0, &ups[j]), (-1.0, &ups[k]), (1.0, &rest)])));
        }
    }
    terms.insert(0, (Vec::new(), rest));
    // they are such polynomials if a further point agrees
    let v: Vec<f64> = (0..m).map(|j| 0.7 + 0.6 * j as f64).collect();
    let weight = |of: &[usize]| of.iter().map(|&j| v[j]).product::<f64>();
    let parts: Vec<(f64, &Both)> = terms.iter().map(|(of, x)| (weight(of), x)).collect();
    if sum(&parts).iter().zip(of(&v)?).any(|(&a, b)| !(a - b).vanishes()) {
        return None;
    }
    let g = &frame.reading.system.graph;
    let name = |k: usize, j: usize| g.name(frame.reading.coordinates[j][k]);
    let mut found = Vec::new();
    for (i, (of, x)) in (0..n).flat_map(|i| terms.iter().map(move |term| (i, term))) {
        if !(x[i] - x[n + i]).vanishes() {
            let monomial: Vec<String> = of.iter().map(|&j| name(1, free[j])).collect();
            let monomial = if monomial.is_empty() { "1".into() } else { monomial.join("*") };
            found.push(Coefficient { name: name(2, i), monomial, theirs: x[i].value, right: x[n + i].value });
        }
    }
    Some(found)
}
