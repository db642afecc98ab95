//! From a film to the word on it.

use mechanics::System;
use nalgebra::{DMatrix, DVector};

use crate::film::STENCILS;
use crate::fits::{Regression, root_mean};
use crate::frame::{Frame, Frames};
use crate::{Film, JudgeError};

/// A number and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// The standard error, by a jackknife.
    pub error: f64,
}

impl Number {
    /// Whether it is over this many standard errors.
    pub fn is_seen(&self, errors: f64) -> bool {
        self.value.abs() > errors * self.error
    }
}

/// What the reaction is.
#[derive(Clone, Debug, PartialEq)]
pub enum Law {
    /// Along the rows of `A`.
    Chetaev,
    /// With ε and drag.
    FirstOrder,
    /// With these multipliers at the first sample.
    Vakonomic(Vec<f64>),
    /// The constraint put into `L`, these velocities eliminated.
    Substitution(Vec<String>),
    /// None of these.
    None,
}

/// A law and what remains of the reaction by it, as a part of forces and inertia together.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// The law.
    pub law: Law,
    /// The rest.
    pub rest: f64,
}

/// What becomes of the constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constraint {
    /// It is kept, to the noise.
    Kept,
    /// `f = −λ/N`.
    Creeps,
    /// `df/dt` is what `d/dt f` has without accelerations.
    LeftOut,
    /// Neither.
    NotKept,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The law with the least rest, unless one with fewer numbers has no more than twice that.
    pub law: Law,
    /// All laws, best first.
    pub rests: Vec<Rest>,
    /// What derivatives of the film are not known to, as the rests are.
    pub noise: f64,
    /// `ε`, a time, and drag `c`, one over a time: force `−c M v`.
    pub epsilon: Number,
    /// See `epsilon`.
    pub drag: Number,
    /// What becomes of the constraint.
    pub constraint: Constraint,
    /// The roots of the means of `Σ fᵢ²` and of `Σ (A_ij v_j)²`, what it is made of.
    pub residual: [f64; 2],
    /// `1/N`.
    pub slip: Number,
    /// `b` and `α` in `df/dt = b (f_q v + f_t) − α f`.
    pub moved: [Number; 2],
}

/// Rests up to this many times the noise are none.
const NOISES: f64 = 5.0;
/// A rest that is no more than this many times another is as good.
const ALIKE: f64 = 2.0;
/// Standard errors that a number has to be over.
const SEEN: f64 = 5.0;
/// A law has to leave no more than this of the reaction.
const LARGEST: f64 = 0.05;
/// Of `f`, as a part of the rates it is made of: nobody integrates better.
const ROUND_OFF: f64 = 1e-11;
/// A part of `f` that is explained.
const EXPLAINED: f64 = 0.2;

/// Judges a film.
///
/// ```
/// // a ball on a table that turns? The smallest film: a blade that moves straight on
/// let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("phi", "rad")]);
/// system.lagrangian = system.expression("(x'^2 + y'^2 + phi'^2)/2")?;
/// system.constraints = vec![system.expression("y'*cos(phi) - x'*sin(phi)")?];
/// // it turns at the rate 1 and has the speed 1: a circle
/// let line = |k: i32| { let t: f64 = 0.02 * f64::from(k); format!("{t},{},{},{t}\n", t.sin(), 1.0 - t.cos()) };
/// let text: String = std::iter::once("t,x,y,phi\n".into()).chain((0..100).map(line)).collect();
/// let found = judge::judge(&system, &judge::Film::read(&text, &system)?)?;
/// assert_eq!(found.law, judge::Law::Chetaev);
/// assert_eq!(found.constraint, judge::Constraint::Kept);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`JudgeError`].
pub fn judge(system: &System, film: &Film) -> Result<Judgement, JudgeError> {
    let mut frames = Frames::new(system)?;
    let mut all = |count: usize| -> Result<Vec<Frame>, JudgeError> {
        film.times().iter().map(|&t| frames.at(&film.at(t, count))).collect()
    };
    let [frames_of_film, coarse] = [all(STENCILS[0])?, all(STENCILS[1])?];
    let film_frames = &frames_of_film;
    let count = film_frames.len();
    let size = root_mean(film_frames.iter().map(|f| f.reaction.norm_squared() + f.acceleration.norm_squared()), count)
        .max(f64::MIN_POSITIVE);
    let tangential: Vec<DVector<f64>> = film_frames.iter().map(|f| f.tangential(&f.reaction)).collect();
    let differences = tangential.iter().zip(&coarse).map(|(y, f)| (y - f.tangential(&f.reaction)).norm_squared());
    let noise = root_mean(differences, count) / size + f64::EPSILON;

    let chetaev = root_mean(tangential.iter().map(DVector::norm_squared), count) / size;
    let (epsilon, drag, first_order) = first_order_law(film_frames);
    let (mu, vakonomic) = vakonomic_law(&mut frames, film, film_frames, &tangential)?;
    let mut rests = vec![
        Rest { law: Law::Chetaev, rest: chetaev },
        Rest { law: Law::FirstOrder, rest: first_order / size },
        Rest { law: Law::Vakonomic(mu), rest: vakonomic / size },
    ];
    rests.extend(substitutions(system, film, film_frames, size));
    rests.sort_by(|a, b| a.rest.total_cmp(&b.rest));
    let least = rests[0].rest.max(NOISES * noise);
    let simplest = |rest: &&Rest| match &rest.law {
        Law::Chetaev => 0,
        Law::Substitution(_) => 1,
        Law::FirstOrder => 2,
        _ => 3,
    };
    let best = rests.iter().filter(|rest| rest.rest <= ALIKE * least).min_by_key(simplest).expect("the least is there");
    let law = if best.rest > LARGEST.max(NOISES * noise) { Law::None } else { best.law.clone() };

    let constraint = Of::new(film_frames, film);
    Ok(Judgement {
        law,
        noise,
        epsilon,
        drag,
        constraint: constraint.word(&coarse),
        residual: constraint.residual,
        slip: constraint.slip,
        moved: constraint.moved,
        rests,
    })
}

/// `ε`, `c`, and the rest. `λ` depends on both: it is found with those of the round before.
fn first_order_law(frames: &[Frame]) -> (Number, Number, f64) {
    let none = Number { value: 0.0, error: 0.0 };
    let (mut numbers, mut rest) = (vec![none; 2], f64::INFINITY);
    for _ in 0..ROUNDS {
        let lambda = |f: &Frame| {
            let mut lambda = f.multipliers(&f.reaction);
            for _ in 0..ROUNDS {
                let force = &f.reaction + &f.curvature * &lambda * numbers[0].value + &f.velocity * numbers[1].value;
                lambda = f.multipliers(&force);
            }
            lambda
        };
        let columns = frames.iter().map(|f| {
            let trace = -f.tangential(&(&f.curvature * lambda(f)));
            DMatrix::from_columns(&[trace, -f.tangential(&f.velocity)])
        });
        let right = frames.iter().map(|f| f.tangential(&f.reaction)).collect();
        let regression = Regression { columns: columns.collect(), right };
        numbers = regression.numbers();
        rest = regression.rest(&numbers);
    }
    (numbers[0], numbers[1], rest)
}

/// Rounds in which `λ` and the numbers that it depends on are found.
const ROUNDS: usize = 6;

/// Steps of `μ` between two samples.
const STEPS: usize = 4;

/// `μ(t₀)` and the rest: `μ̇ = Γ μ − λ` along the film, `Γ = (Ã Ãᵀ)⁻¹ Ã C̃`, `λ` the multipliers of `ρ`.
fn vakonomic_law(
    frames: &mut Frames,
    film: &Film,
    samples: &[Frame],
    tangential: &[DVector<f64>],
) -> Result<(Vec<f64>, f64), JudgeError> {
    let h = samples[0].constraint.len();
    // columns: what each part of μ(t₀) becomes, and what becomes of zero
    let mut solutions = DMatrix::identity(h, h + 1);
    let rate = |frame: &Frame, solutions: &DMatrix<f64>| -> DMatrix<f64> {
        let curved = &frame.curvature * solutions;
        let mut rates = DMatrix::zeros(h, h + 1);
        for j in 0..=h {
            rates.set_column(j, &frame.multipliers(&curved.column(j).into_owned()));
        }
        let along = frame.multipliers(&frame.reaction);
        let mut last = rates.column_mut(h);
        last -= along;
        rates
    };
    let mut regression = Regression { columns: Vec::new(), right: Vec::new() };
    for (k, frame) in samples.iter().enumerate() {
        let curved = &frame.curvature * &solutions;
        let columns: Vec<DVector<f64>> = (0..h).map(|j| frame.tangential(&curved.column(j).into_owned())).collect();
        regression.columns.push(DMatrix::from_columns(&columns));
        regression.right.push(&tangential[k] - frame.tangential(&curved.column(h).into_owned()));
        let Some(&next) = film.times().get(k + 1) else { break };
        let step = (next - film.times()[k]) / STEPS as f64;
        for i in 0..STEPS {
            let t = film.times()[k] + i as f64 * step;
            let [here, half, there] = [0.0, 0.5, 1.0].map(|part| frames.at(&film.at(t + part * step, STENCILS[0])));
            let (here, half, there) = (here?, half?, there?);
            let k1 = rate(&here, &solutions);
            let k2 = rate(&half, &(&solutions + &k1 * (step / 2.0)));
            let k3 = rate(&half, &(&solutions + &k2 * (step / 2.0)));
            let k4 = rate(&there, &(&solutions + &k3 * step));
            solutions += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (step / 6.0);
        }
        if !solutions.iter().all(|x| x.abs() < 1e12) {
            break;
        }
    }
    let numbers = regression.numbers();
    let rest = regression.rest(&numbers);
    Ok((numbers.iter().map(|number| number.value).collect(), rest))
}

/// Largest number of ways to eliminate velocities that are tried.
const WAYS: usize = 64;
/// A determinant of eliminated columns over the largest one: smaller ones are no way to eliminate.
const REGULAR: f64 = 1e-2;

/// The rests where the constraint is put into `L`, for each choice of velocities that are eliminated.
fn substitutions(system: &System, film: &Film, frames: &[Frame], size: f64) -> Vec<Rest> {
    let (n, h) = (system.dimension(), system.constraints.len());
    let mut choices: Vec<(Vec<usize>, f64)> = subsets(n, h)
        .take(WAYS)
        .map(|columns| {
            let regular = frames.iter().map(|f| f.rows.select_columns(&columns).determinant().abs());
            let least = regular.fold(f64::INFINITY, f64::min);
            (columns, least)
        })
        .collect();
    let largest = choices.iter().fold(0.0_f64, |largest, choice| largest.max(choice.1));
    choices.retain(|choice| choice.1 > REGULAR * largest);
    let rest = |columns: &[usize]| -> Option<f64> {
        // Aᵀ μ = −∂L/∂v in the rows that are eliminated
        let multipliers = |f: &Frame| {
            let momenta = -f.momenta.select_rows(columns);
            f.rows.select_columns(columns).transpose().lu().solve(&momenta)
        };
        let mu: Vec<DVector<f64>> = frames.iter().map(multipliers).collect::<Option<_>>()?;
        let along: Vec<DVector<f64>> = frames.iter().zip(&mu).map(|(f, mu)| f.rows.transpose() * mu).collect();
        let squares = frames.iter().zip(&mu).enumerate().map(|(k, (f, mu))| {
            let given = f.slopes.transpose() * mu;
            let stay = (0..n).filter(|i| !columns.contains(i));
            let rest = |i: usize| f.balance[i] - given[i] + film.slope(k, |sample| along[sample][i]);
            stay.map(|i| rest(i).powi(2) / f.masses[i]).sum::<f64>()
        });
        Some(root_mean(squares, frames.len()) / size)
    };
    let named = |columns: &[usize]| {
        columns.iter().map(|&i| format!("{}'", system.coordinates[i].name)).collect::<Vec<String>>()
    };
    choices
        .iter()
        .filter_map(|(columns, _)| Some(Rest { law: Law::Substitution(named(columns)), rest: rest(columns)? }))
        .collect()
}

/// All ascending choices of `h` numbers below `n`.
fn subsets(n: usize, h: usize) -> impl Iterator<Item = Vec<usize>> {
    let mut next = (h <= n).then(|| (0..h).collect::<Vec<usize>>());
    std::iter::from_fn(move || {
        let now = next.take()?;
        let mut following = now.clone();
        if let Some(i) = (0..h).rev().find(|&i| now[i] + h - i < n) {
            following[i] += 1;
            (i + 1..h).for_each(|j| following[j] = following[j - 1] + 1);
            next = Some(following);
        }
        Some(now)
    })
}

/// What the constraint does.
struct Of {
    residual: [f64; 2],
    slip: Number,
    moved: [Number; 2],
    /// What of `f` and of `df/dt` remains, as a part of them.
    rests: [f64; 2],
    values: Vec<DVector<f64>>,
}

impl Of {
    fn new(frames: &[Frame], film: &Film) -> Of {
        let (count, h) = (frames.len(), frames[0].constraint.len());
        let values: Vec<DVector<f64>> = frames.iter().map(|f| f.constraint.clone()).collect();
        let own = root_mean(values.iter().map(DVector::norm_squared), count);
        let size = root_mean(frames.iter().map(|f| f.terms), count);
        let single = |columns: Vec<DMatrix<f64>>, right: Vec<DVector<f64>>| {
            let regression = Regression { columns, right };
            let numbers = regression.numbers();
            let whole = root_mean(regression.right.iter().map(DVector::norm_squared), count);
            let rest = regression.rest(&numbers) / whole.max(f64::MIN_POSITIVE);
            (numbers, rest)
        };
        let lambda = |f: &Frame| DMatrix::from_columns(&[-f.multipliers(&f.reaction)]);
        let (slip, by_slip) = single(frames.iter().map(lambda).collect(), values.clone());
        let slopes = (0..count).map(|k| DVector::from_fn(h, |i, _| film.slope(k, |sample| values[sample][i])));
        let parts = |f: &Frame| DMatrix::from_columns(&[f.drift.clone(), -&f.constraint]);
        let (moved, by_parts) = single(frames.iter().map(parts).collect(), slopes.collect());
        Of { residual: [own, size], slip: slip[0], moved: [moved[0], moved[1]], rests: [by_slip, by_parts], values }
    }

    fn word(&self, coarse: &[Frame]) -> Constraint {
        let differences = self.values.iter().zip(coarse).map(|(f, coarse)| (f - &coarse.constraint).norm_squared());
        let noise = root_mean(differences, coarse.len());
        let [own, size] = self.residual;
        if own <= (NOISES * noise).max(ROUND_OFF * size) {
            Constraint::Kept
        } else if self.rests[0] < EXPLAINED.min(self.rests[1]) && self.slip.is_seen(SEEN) {
            Constraint::Creeps
        } else if self.rests[1] < EXPLAINED && (self.moved[0].value - 1.0).abs() < LARGEST {
            Constraint::LeftOut
        } else {
            Constraint::NotKept
        }
    }
}
