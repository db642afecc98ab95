//! Truncated power series, so that problems which are plain functions can be integrated by Taylor series.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Coefficients, order 0 first.
#[derive(Clone, Debug)]
pub struct Jet(pub Vec<f64>);

impl Jet {
    /// A number, with as many orders as `self`.
    pub fn number(&self, x: f64) -> Jet {
        let mut c = vec![0.0; self.0.len()];
        c[0] = x;
        Jet(c)
    }

    /// sin and cos
    pub fn sin_cos(&self) -> (Jet, Jet) {
        let (mut s, mut c) = (self.number(self.0[0].sin()), self.number(self.0[0].cos()));
        for k in 1..self.0.len() {
            let sum = |other: &[f64]| (1..=k).map(|j| j as f64 * self.0[j] * other[k - j]).sum::<f64>() / k as f64;
            (s.0[k], c.0[k]) = (sum(&c.0), -sum(&s.0));
        }
        (s, c)
    }

    pub fn sin(&self) -> Jet {
        self.sin_cos().0
    }

    pub fn cos(&self) -> Jet {
        self.sin_cos().1
    }

    /// A real power, from `a p' = r a' p`.
    pub fn powf(&self, r: f64) -> Jet {
        let mut p = self.number(self.0[0].powf(r));
        for k in 1..self.0.len() {
            let sum: f64 = (1..=k).map(|j| (r * j as f64 - (k - j) as f64) * self.0[j] * p.0[k - j]).sum();
            p.0[k] = sum / (k as f64 * self.0[0]);
        }
        p
    }
}

impl Add for &Jet {
    type Output = Jet;
    fn add(self, other: &Jet) -> Jet {
        Jet(self.0.iter().zip(&other.0).map(|(a, b)| a + b).collect())
    }
}

impl Sub for &Jet {
    type Output = Jet;
    fn sub(self, other: &Jet) -> Jet {
        Jet(self.0.iter().zip(&other.0).map(|(a, b)| a - b).collect())
    }
}

impl Neg for &Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        self * -1.0
    }
}

impl Mul<f64> for &Jet {
    type Output = Jet;
    fn mul(self, factor: f64) -> Jet {
        Jet(self.0.iter().map(|a| a * factor).collect())
    }
}

impl Mul for &Jet {
    type Output = Jet;
    fn mul(self, other: &Jet) -> Jet {
        Jet((0..self.0.len()).map(|k| (0..=k).map(|j| self.0[j] * other.0[k - j]).sum()).collect())
    }
}

impl Div for &Jet {
    type Output = Jet;
    fn div(self, other: &Jet) -> Jet {
        self * &other.powf(-1.0)
    }
}

/// Coefficients of the solution of `y' = F(t, y)`: each order of the rates gives the next of the states.
pub fn solution(rates: &dyn Fn(&Jet, &[Jet]) -> Vec<Jet>, t: f64, y: &[f64], unit: f64, coefficients: &mut [f64]) {
    let n = y.len();
    let orders = coefficients.len() / n;
    let mut series: Vec<Jet> = y.iter().map(|&y| Jet(vec![y])).collect();
    for k in 0..orders - 1 {
        let mut time = vec![0.0; k + 1];
        time[0] = t;
        if k > 0 {
            time[1] = unit;
        }
        let rates = rates(&Jet(time), &series);
        for (y, rate) in series.iter_mut().zip(rates) {
            y.0.push(unit * rate.0[k] / (k + 1) as f64);
        }
    }
    for (row, y) in coefficients.chunks_exact_mut(orders).zip(&series) {
        row.copy_from_slice(&y.0);
    }
}
