//! Problems with references, shared by the tests.

mod jet;

use integrate::{EvaluationError, Problem};
pub use jet::{Jet, solution};

type Rates = fn(f64, &[f64], &mut [f64]) -> Result<(), EvaluationError>;
type Series = fn(&Jet, &[Jet]) -> Vec<Jet>;
type Jacobian = fn(f64, &[f64], &mut [f64]);
type Events = fn(f64, &[f64], &mut [f64]) -> Result<(), EvaluationError>;
type Projection = fn(f64, &mut [f64]) -> Result<f64, EvaluationError>;

/// A problem put together from functions; counts its own evaluations.
#[derive(Clone)]
pub struct Case {
    pub dimension: usize,
    pub rates: Rates,
    /// The same rates for power series.
    pub series: Option<Series>,
    pub jacobian: Jacobian,
    pub events: (usize, Events),
    pub projection: Projection,
    pub evaluations: usize,
    pub jacobians: usize,
}

impl Case {
    pub fn new(dimension: usize, rates: Rates, jacobian: Jacobian) -> Self {
        let events: (usize, Events) = (0, |_, _, _| Ok(()));
        Self {
            dimension,
            rates,
            series: None,
            jacobian,
            events,
            projection: |_, _| Ok(0.0),
            evaluations: 0,
            jacobians: 0,
        }
    }
    pub fn with_series(mut self, series: Series) -> Self {
        self.series = Some(series);
        self
    }
    pub fn with_events(mut self, number: usize, events: Events) -> Self {
        self.events = (number, events);
        self
    }
    pub fn with_projection(mut self, projection: Projection) -> Self {
        self.projection = projection;
        self
    }
}

impl Problem for Case {
    fn dimension(&self) -> usize {
        self.dimension
    }
    fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), EvaluationError> {
        self.evaluations += 1;
        (self.rates)(t, y, rates)
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), EvaluationError> {
        self.jacobians += 1;
        (self.jacobian)(t, y, jacobian);
        Ok(())
    }
    fn has_taylor(&self) -> bool {
        self.series.is_some()
    }
    fn taylor(&mut self, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) -> Result<(), EvaluationError> {
        let mut rates = vec![0.0; y.len()];
        self.rates(t, y, &mut rates)?;
        solution(self.series.expect("a series"), t, y, unit, coefficients);
        // Where the rates are not what the series says, as behind a wall, the rates count.
        let orders = coefficients.len() / y.len();
        for (row, rate) in coefficients.chunks_exact_mut(orders).zip(rates) {
            row[1] += 0.0 * rate;
        }
        Ok(())
    }
    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<f64, EvaluationError> {
        (self.projection)(t, y)
    }
    fn events(&self) -> usize {
        self.events.0
    }
    fn event_values(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), EvaluationError> {
        (self.events.1)(t, y, values)
    }
}

/// y₀' = y₁, y₁' = −y₀; from (1, 0): (cos t, −sin t).
pub fn oscillator() -> Case {
    Case::new(
        2,
        |_, y, r| {
            (r[0], r[1]) = (y[1], -y[0]);
            Ok(())
        },
        |_, _, j| j.copy_from_slice(&[0.0, 1.0, -1.0, 0.0]),
    )
    .with_series(|_, y| vec![y[1].clone(), -&y[0]])
}

/// y' = y cos t; from 1 at 0: exp(sin t).
pub fn nonautonomous() -> Case {
    Case::new(
        1,
        |t, y, r| {
            r[0] = y[0] * t.cos();
            Ok(())
        },
        |t, _, j| j[0] = t.cos(),
    )
    .with_series(|t, y| vec![&y[0] * &t.cos()])
}

/// y' = y²; from 1 at 0: 1/(1 − t).
pub fn blow_up() -> Case {
    Case::new(
        1,
        |_, y, r| {
            r[0] = y[0] * y[0];
            Ok(())
        },
        |_, y, j| j[0] = 2.0 * y[0],
    )
    .with_series(|_, y| vec![&y[0] * &y[0]])
}

/// The restricted three-body problem; [`ARENSTORF_START`] is periodic with [`ARENSTORF_PERIOD`]. For explicit methods.
///
/// Hairer, Nørsett, Wanner, *Solving Ordinary Differential Equations I*, (0.1) of section II.0.
pub fn arenstorf() -> Case {
    Case::new(
        4,
        |_, y, r| {
            let mu = 0.012277471;
            let nu = 1.0 - mu;
            let d1 = ((y[0] + mu).powi(2) + y[1].powi(2)).powf(1.5);
            let d2 = ((y[0] - nu).powi(2) + y[1].powi(2)).powf(1.5);
            (r[0], r[1]) = (y[2], y[3]);
            r[2] = y[0] + 2.0 * y[3] - nu * (y[0] + mu) / d1 - mu * (y[0] - nu) / d2;
            r[3] = y[1] - 2.0 * y[2] - nu * y[1] / d1 - mu * y[1] / d2;
            Ok(())
        },
        |_, _, j| j.fill(f64::NAN),
    )
    .with_series(|_, y| {
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
    Case::new(
        3,
        |_, y, r| {
            r[0] = -0.04 * y[0] + 1e4 * y[1] * y[2];
            r[2] = 3e7 * y[1] * y[1];
            r[1] = -r[0] - r[2];
            Ok(())
        },
        |_, y, j| {
            j[..3].copy_from_slice(&[-0.04, 1e4 * y[2], 1e4 * y[1]]);
            j[3..6].copy_from_slice(&[0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]]);
            j[6..].copy_from_slice(&[0.0, 6e7 * y[1], 0.0]);
        },
    )
}

/// Van der Pol's oscillator with μ = 1000, in the time of the slow motion; from (2, 0).
pub fn van_der_pol() -> Case {
    Case::new(
        2,
        |_, y, r| {
            (r[0], r[1]) = (y[1], 1e6 * ((1.0 - y[0] * y[0]) * y[1] - y[0]));
            Ok(())
        },
        |_, y, j| j.copy_from_slice(&[0.0, 1.0, 1e6 * (-2.0 * y[0] * y[1] - 1.0), 1e6 * (1.0 - y[0] * y[0])]),
    )
}
