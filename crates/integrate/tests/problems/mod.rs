//! Problems with references, shared by the tests.

mod jet;

use std::rc::Rc;

use integrate::{EvaluationError, Options, Problem, Solution, Start, Status, integrate};
pub use jet::{Jet, solution};

type Rates = Rc<dyn Fn(&Jet, &[Jet]) -> Vec<Jet>>;
type Refusal = fn(f64, &[f64]) -> Option<String>;
type Events = fn(f64, &[f64], &mut [f64]) -> Result<(), EvaluationError>;
type Projection = fn(f64, &mut [f64]) -> Result<f64, EvaluationError>;

/// A problem put together from functions; counts its own evaluations. Rates are written once, for power
/// series: their order 0 are the rates, and order 1 along each component is the Jacobian.
#[derive(Clone)]
pub struct Case {
    pub dimension: usize,
    pub rates: Rates,
    /// Why there are no rates at a point.
    pub refusal: Refusal,
    pub taylor: bool,
    pub events: (usize, Events),
    pub projection: Projection,
    /// Number of accepted states that are refused; the others are recorded.
    pub refuse: usize,
    pub accepted: Vec<(f64, Vec<f64>)>,
    pub evaluations: usize,
    pub jacobians: usize,
}

impl Case {
    pub fn new(dimension: usize, rates: impl Fn(&Jet, &[Jet]) -> Vec<Jet> + 'static) -> Self {
        Self {
            dimension,
            rates: Rc::new(rates),
            refusal: |_, _| None,
            taylor: true,
            events: (0, |_, _, _| Ok(())),
            projection: |_, _| Ok(0.0),
            refuse: 0,
            accepted: Vec::new(),
            evaluations: 0,
            jacobians: 0,
        }
    }
    pub fn with_refusal(self, refusal: Refusal) -> Self {
        Self { refusal, ..self }
    }
    pub fn with_events(self, number: usize, events: Events) -> Self {
        Self { events: (number, events), ..self }
    }
    pub fn with_projection(self, projection: Projection) -> Self {
        Self { projection, ..self }
    }
}

impl Problem for Case {
    fn dimension(&self) -> usize {
        self.dimension
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        self.evaluations += 1;
        if let Some(reason) = (self.refusal)(t, y) {
            return Err(EvaluationError { reason });
        }
        let point: Vec<Jet> = y.iter().map(|&y| Jet(vec![y])).collect();
        for (rate, jet) in rates.iter_mut().zip((self.rates)(&Jet(vec![t]), &point)) {
            *rate = jet.0[0];
        }
        Ok(())
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        self.jacobians += 1;
        for column in 0..y.len() {
            let along = |(i, &y): (usize, &f64)| Jet(vec![y, f64::from(u8::from(i == column))]);
            let point: Vec<Jet> = y.iter().enumerate().map(along).collect();
            for (row, rate) in (self.rates)(&Jet(vec![t, 0.0]), &point).iter().enumerate() {
                jacobian[row * y.len() + column] = rate.0[1];
            }
        }
        Ok(())
    }
    fn has_taylor(&self) -> bool {
        self.taylor
    }
    fn taylor(&mut self, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) -> Result<(), EvaluationError> {
        self.rates(t, y, &mut vec![0.0; y.len()])?;
        solution(&*self.rates, t, y, unit, coefficients);
        Ok(())
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, EvaluationError> {
        (self.projection)(t, y)
    }
    fn accepted(&mut self, t: f64, y: &[f64]) -> Result<(), EvaluationError> {
        if self.refuse > 0 {
            self.refuse -= 1;
            return Err(EvaluationError { reason: "not yet".into() });
        }
        self.accepted.push((t, y.to_vec()));
        Ok(())
    }
    fn events(&self) -> usize {
        self.events.0
    }
    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvaluationError> {
        (self.events.1)(t, y, values)
    }
}

/// The run from `y` at `t`, whatever its end.
#[track_caller]
pub fn attempt(problem: &mut dyn Problem, t: f64, y: &[f64], end: f64, options: &Options) -> Solution {
    integrate(problem, &Start { t, y: y.to_vec() }, end, options).unwrap()
}

/// The same, to its end.
#[track_caller]
pub fn run(problem: &mut dyn Problem, t: f64, y: &[f64], end: f64, options: &Options) -> Solution {
    let solution = attempt(problem, t, y, end, options);
    assert_eq!(solution.status, Status::Completed, "{options:?}");
    assert_eq!(solution.dense.end().to_bits(), end.to_bits());
    solution
}

/// The state at `t`.
pub fn state<const N: usize>(solution: &Solution, t: f64) -> [f64; N] {
    let mut y = [0.0; N];
    solution.dense.evaluate(t, &mut y);
    y
}

/// The largest distance from `exact` at `count` equidistant times from 0 on.
pub fn largest_error<const N: usize>(solution: &Solution, count: u32, exact: impl Fn(f64) -> [f64; N]) -> f64 {
    let time = |i: u32| solution.dense.end() * f64::from(i) / f64::from(count);
    (0..=count).map(|i| distance(&state::<N>(solution, time(i)), &exact(time(i)))).fold(0.0, f64::max)
}

/// The largest error at 40 points per step, and at the ends of the steps alone.
pub fn errors<const N: usize>(solution: &Solution, exact: impl Fn(f64) -> [f64; N]) -> (f64, f64) {
    let error = |t: f64| distance(&state::<N>(solution, t), &exact(t));
    let (mut everywhere, mut ends) = (0.0f64, 0.0f64);
    for pair in solution.dense.step_times().windows(2) {
        let within = (1..40).map(|i| error(pair[0] + (pair[1] - pair[0]) * f64::from(i) / 40.0));
        ends = ends.max(error(pair[1]));
        everywhere = within.fold(everywhere.max(ends), f64::max);
    }
    (everywhere, ends)
}

/// y₀' = y₁, y₁' = −y₀; from (1, 0): (cos t, −sin t).
pub fn oscillator() -> Case {
    Case::new(2, |_, y| vec![y[1].clone(), -&y[0]])
}

/// What it does from (1, 0).
pub fn circle(t: f64) -> [f64; 2] {
    [t.cos(), -t.sin()]
}

/// y' = y cos t; from 1 at 0: exp(sin t).
pub fn nonautonomous() -> Case {
    Case::new(1, |t, y| vec![&y[0] * &t.cos()])
}

/// y' = y²; from 1 at 0: 1/(1 − t).
pub fn blow_up() -> Case {
    Case::new(1, |_, y| vec![&y[0] * &y[0]])
}

/// The restricted three-body problem; [`ARENSTORF_START`] is periodic with [`ARENSTORF_PERIOD`].
///
/// Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, (0.1) of section II.0.
pub fn arenstorf() -> Case {
    Case::new(4, |_, y| {
        let mu = 0.012277471;
        let nu = 1.0 - mu;
        let (a, b) = (&y[0] + &y[0].number(mu), &y[0] - &y[0].number(nu));
        let square = &y[1] * &y[1];
        let [d1, d2] = [&a, &b].map(|x| (&(x * x) + &square).powf(-1.5));
        let pull = |x: &Jet, z: &Jet| &(&(x * &d1) * nu) + &(&(z * &d2) * mu);
        vec![
            y[2].clone(),
            y[3].clone(),
            &(&y[0] + &(&y[3] * 2.0)) - &pull(&a, &b),
            &(&y[1] - &(&y[2] * 2.0)) - &pull(&y[1], &y[1]),
        ]
    })
}

pub const ARENSTORF_START: [f64; 4] = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
pub const ARENSTORF_PERIOD: f64 = 17.065_216_560_157_964;

/// Euclidean distance.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Least-squares slope of log(error) over log(cost): an order is −slope.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let xy: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    let xx: f64 = logs.iter().map(|p| (p.0 - mx).powi(2)).sum();
    xy / xx
}

/// Moves onto the unit circle.
pub fn onto_circle(_t: f64, y: &mut [f64]) -> Result<f64, EvaluationError> {
    let radius = y[0].hypot(y[1]);
    y[0] /= radius;
    y[1] /= radius;
    Ok((radius - 1.0).abs())
}

/// Robertson's reactions, from (1, 0, 0).
pub fn robertson() -> Case {
    Case::new(3, |_, y| {
        let first = &(&y[0] * -0.04) + &(&(&y[1] * &y[2]) * 1e4);
        let third = &(&y[1] * &y[1]) * 3e7;
        let second = -&(&first + &third);
        vec![first, second, third]
    })
}

/// Van der Pol's oscillator with μ = 1000, in the time of the slow motion; from (2, 0).
pub fn van_der_pol() -> Case {
    Case::new(2, |_, y| {
        let friction = &y[0].number(1.0) - &(&y[0] * &y[0]);
        vec![y[1].clone(), &(&(&friction * &y[1]) - &y[0]) * 1e6]
    })
}
