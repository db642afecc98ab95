//! Each law as what it leaves of the balance of forces, `r = S⁻¹ (E − Q)` at each sample.

use nalgebra::{DMatrix, DVector};
use schemars::JsonSchema;
use serde::Serialize;

use crate::balance::Instant;
use crate::differences::{derivative, halfway};
use crate::regression::{Number, fit, rms};

/// Samples on both sides of one from which the rate of λ is taken.
const REACH: usize = 2;

/// The law of first order, fitted.
#[derive(Clone, Debug)]
pub struct FirstOrder {
    /// `ε`, in `T`; none where no force `C λ` is left beside the reactions.
    pub epsilon: Option<Number>,
    /// `1/N`, in `T [f]²/E`; none where there is no reaction.
    pub slip: Option<Number>,
    /// `γ` of a drag `−γ M v`, in `1/T`; none where nothing moves.
    pub drag: Option<Number>,
    /// Residual of the balance, rms, in `√E/T`; and without ε, without drag.
    pub balance: f64,
    pub without: [f64; 2],
    /// Residual of `ḟ + λ̇/N`, as a force, rms.
    pub constraint: f64,
}

/// Part of `v` that is not a combination of the columns of `basis`, and the coefficients of the other part.
/// Where something is not finite, no combination is found.
fn split(basis: &DMatrix<f64>, v: &DVector<f64>) -> (DVector<f64>, DVector<f64>) {
    if !basis.iter().chain(v).all(|x| x.is_finite()) {
        return (v.clone(), DVector::zeros(basis.ncols()));
    }
    let svd = basis.clone().svd(true, true);
    let coefficients = svd.solve(v, 0.0).unwrap_or_else(|_| DVector::zeros(basis.ncols()));
    (v - basis * &coefficients, coefficients)
}

/// A rate of the constraints as the force that it takes: `|(Aᵀ)⁺ …|`, length of `c` in `(A M⁻¹ Aᵀ)⁻¹`.
pub fn as_force(instant: &Instant, c: &DVector<f64>) -> DVector<f64> {
    let gram = instant.along.transpose() * &instant.along;
    match gram.cholesky() {
        Some(factor) => factor.l().solve_lower_triangular(c).unwrap_or_else(|| c.clone()),
        None => c.clone(),
    }
}

/// Fits `r = (Aᵀ − ε C) λ − γ M v` with λ free at each sample, by Gauss–Newton steps from `ε = 0`, and then
/// `f = −λ/N`.
pub fn first_order(instants: &[Instant]) -> FirstOrder {
    let all = with_numbers(instants, [true, true]);
    let without = [[false, true], [true, false]].map(|with| with_numbers(instants, with).balance);
    FirstOrder { without, ..all }
}

/// The same with ε or drag zero.
fn with_numbers(instants: &[Instant], with: [bool; 2]) -> FirstOrder {
    let mut guess = 0.0;
    let (mut numbers, mut left) = (vec![None; 2], f64::INFINITY);
    let mut reactions = Vec::new();
    for _ in 0..12 {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        let drag = numbers[1].map_or(0.0, |n: Number| n.value);
        let mut forces = Vec::new();
        for i in instants {
            let basis = &i.along - &i.curvature * guess;
            let (rest, along) = split(&basis, &i.balance);
            let (moved, along_moved) = split(&basis, &i.momentum);
            let reaction = along + along_moved * drag;
            let (trace, _) = split(&basis, &(&i.curvature * &reaction));
            // rest = −(ε − guess) trace − γ moved
            let of = |x: f64, i: usize| if with[i] { -x } else { 0.0 };
            x.extend((0..rest.len()).map(|k| vec![of(trace[k], 0), of(moved[k], 1)]));
            y.extend(rest.iter().copied());
            forces.push(reaction);
        }
        numbers = fit(&x, &y);
        let theta = [0, 1].map(|k| numbers[k].map_or(0.0, |n: Number| n.value));
        let of = x.iter().zip(&y).map(|(x, y)| y - x[0] * theta[0] - x[1] * theta[1]);
        left = rms(of) * (y.len() as f64 / instants.len() as f64).sqrt();
        reactions = forces;
        guess += theta[0];
        if let Some(n) = &mut numbers[0] {
            n.value = guess;
        }
        if theta[0].abs() <= 1e-13 * guess.abs() {
            break;
        }
    }
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for (i, reaction) in instants.iter().zip(&reactions) {
        x.extend(as_force(i, reaction).iter().map(|l| vec![-l]));
        y.extend(as_force(i, &i.constraint).iter().copied());
    }
    let slip = fit(&x, &y)[0];
    let creep = slip.map_or(0.0, |n| n.value);
    let t: Vec<f64> = instants.iter().map(|i| i.t).collect();
    let rows: Vec<Vec<f64>> = reactions.iter().map(|l| l.iter().copied().collect()).collect();
    let constraint = rms((REACH..instants.len() - REACH).map(|k| {
        let rate = DVector::from_vec(derivative(&t, &rows, k, REACH, 1));
        as_force(&instants[k], &(&instants[k].driven + &instants[k].rest + rate * creep)).norm()
    }));
    FirstOrder { epsilon: numbers[0], slip, drag: numbers[1], balance: left, without: [left; 2], constraint }
}

/// A number of the scene that is another in the motion, or a force that the scene lacks.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Misfit {
    /// `m`, a parameter, or `force along x`.
    pub name: String,
    /// Its part of the parameter, or the force.
    #[serde(flatten)]
    pub by: Number,
    /// What Chetaev's law leaves with it, rms, in `√E/T`.
    pub residual: f64,
}

/// A parameter is off by no more than this part of itself.
const OFF: f64 = 0.5;

/// Each one alone beside Chetaev's law, by what it leaves; none for a parameter that would be off by more
/// than half.
pub fn misfits(instants: &[Instant], parameters: &[(String, f64)], coordinates: &[String]) -> Vec<Misfit> {
    let count = parameters.len();
    let column = |i: &Instant, j: usize| match j.checked_sub(count) {
        None => -&i.by_parameter[j],
        Some(k) => i.unit_forces.column(k).into_owned(),
    };
    let name = |j: usize| match j.checked_sub(count) {
        None => parameters[j].0.clone(),
        Some(k) => format!("force along {}", coordinates[k]),
    };
    let one = |j: usize| -> Option<Misfit> {
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for i in instants {
            x.extend(split(&i.along, &column(i, j)).0.iter().map(|x| vec![*x]));
            y.extend(split(&i.along, &i.balance).0.iter().copied());
        }
        let by = fit(&x, &y)[0].filter(|by| j >= count || by.value.abs() < OFF)?;
        let left = rms(x.iter().zip(&y).map(|(x, y)| y - x[0] * by.value));
        let residual = left * (y.len() as f64 / instants.len() as f64).sqrt();
        Some(Misfit { name: name(j), by, residual })
    };
    let mut found: Vec<Misfit> = (0..count + coordinates.len()).filter_map(one).collect();
    found.sort_by(|a, b| a.residual.total_cmp(&b.residual));
    found
}

/// What is left of the balance, rms, where `μ` moves by `Aᵀ μ̇ = C μ − (E − Q)` from the best `μ₀`, and that
/// `μ₀`, at the first of the instants `before` the others, of which nothing else is asked; none where such a
/// `μ` grows beyond all numbers.
pub fn vakonomic(before: &[Instant], instants: &[Instant]) -> Option<(f64, Vec<Option<Number>>)> {
    let (first, count) = (before.len(), instants.len());
    let instants: Vec<&Instant> = before.iter().chain(instants).collect();
    let h = instants[0].constraint.len();
    let t: Vec<f64> = instants.iter().map(|i| i.t).collect();
    // μ̇ = B⁺C μ − B⁺r, B = S⁻¹Aᵀ: one row of (B⁺C, −B⁺r) a sample
    let rates: Vec<Vec<f64>> = instants
        .iter()
        .map(|i| {
            let both =
                DMatrix::from_fn(
                    i.along.nrows(),
                    h + 1,
                    |r, c| {
                        if c < h { i.curvature[(r, c)] } else { -i.balance[r] }
                    },
                );
            let svd = i.along.clone().svd(true, true);
            svd.solve(&both, 0.0).map(|m| m.as_slice().to_vec()).unwrap_or_default()
        })
        .collect();
    let matrix = |row: &[f64]| DMatrix::from_column_slice(h, h + 1, row);
    let slope = |m: &DMatrix<f64>, y: &DMatrix<f64>| {
        let mut rate = m.columns(0, h) * y;
        let mut last = rate.column_mut(h);
        last += m.column(h);
        rate
    };
    let mut y = DMatrix::identity(h, h + 1);
    let (mut x, mut right) = (Vec::new(), Vec::new());
    for (k, i) in instants.iter().enumerate() {
        let of = |column: usize| split(&i.along, &(&i.curvature * y.column(column))).0;
        let counts = k >= first;
        let columns: Vec<DVector<f64>> = (0..=h).map(of).collect();
        let (rest, _) = split(&i.along, &i.balance);
        for r in 0..if counts { rest.len() } else { 0 } {
            x.push((0..h).map(|c| columns[c][r]).collect::<Vec<f64>>());
            right.push(rest[r] - columns[h][r]);
        }
        if k + 1 < instants.len() {
            let step = t[k + 1] - t[k];
            let [m0, m1, m2] = [matrix(&rates[k]), matrix(&halfway(&t, &rates, k)), matrix(&rates[k + 1])];
            let k1 = slope(&m0, &y);
            let k2 = slope(&m1, &(&y + &k1 * (step / 2.0)));
            let k3 = slope(&m1, &(&y + &k2 * (step / 2.0)));
            let k4 = slope(&m2, &(&y + &k3 * step));
            y += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (step / 6.0);
        }
        if !y.iter().all(|x| x.is_finite()) {
            return None;
        }
    }
    let start = fit(&x, &right);
    let of = |row: &Vec<f64>| row.iter().zip(&start).map(|(x, n)| x * n.map_or(0.0, |n| n.value)).sum::<f64>();
    let left = rms(x.iter().zip(&right).map(|(x, y)| y - of(x)));
    Some((left * (right.len() as f64 / count as f64).sqrt(), start)).filter(|(left, _)| left.is_finite())
}

/// `s` of `A a = −(1 − s)(ḟ − A a)`: 0 where the constraint is differentiated as it is, 1 where the rate of
/// its rows is left out.
pub fn left_out(instants: &[Instant]) -> Option<Number> {
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for i in instants {
        x.extend(as_force(i, &i.rest).iter().map(|b| vec![*b]));
        y.extend(as_force(i, &(&i.driven + &i.rest)).iter().copied());
    }
    fit(&x, &y)[0]
}
