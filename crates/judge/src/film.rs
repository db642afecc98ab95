//! A motion that a program has written down: times, and coordinates or their rates.

use mechanics::System;
use symbolic::Expr;

use crate::JudgeError;

/// Samples that a polynomial goes through, and of the second one that tells how well it is known.
pub(crate) const STENCILS: [usize; 2] = [9, 7];

/// What is known of a coordinate.
enum Column {
    /// Its values.
    Place(Vec<f64>),
    /// Those of its rate; the coordinate is in none of the equations.
    Rate(Vec<f64>),
}

/// Samples of a motion, one column per coordinate.
pub struct Film {
    times: Vec<f64>,
    columns: Vec<Column>,
}

/// Place, velocity and acceleration at a time.
pub(crate) struct Instant {
    pub(crate) t: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
}

impl Film {
    /// Reads comma-separated values: a head with `t` and the names of the coordinates of `system`, in any
    /// order. In the place of a coordinate that no equation contains its rate may stand (`psi'`); of other
    /// coordinates rates are not read: they are differences of places. Other columns are left alone.
    ///
    /// # Errors
    /// [`JudgeError::Film`] with the line.
    pub fn read(text: &str, system: &System) -> Result<Film, JudgeError> {
        let wrong = |line: usize, reason: String| JudgeError::Film { line, reason };
        let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
        let fields = |line: &str| -> Vec<String> {
            line.split(',').map(|field| field.trim().trim_matches('"').to_string()).collect()
        };
        let (_, head) = lines.next().ok_or_else(|| wrong(1, "it is empty".into()))?;
        let head = fields(head);
        let place = |name: &str| head.iter().position(|column| column == name);
        let time = place("t").ok_or_else(|| wrong(1, "no column is called `t`".into()))?;
        let is_absent = |symbol| {
            let g = &system.graph;
            let all: Vec<Expr> = system.constraints.iter().chain(&system.forces).copied().collect();
            !all.iter().chain([&system.lagrangian]).any(|&e| g.depends_on(e, symbol))
        };
        let mut found = Vec::new();
        for c in &system.coordinates {
            let rate = place(&format!("{}'", c.name)).filter(|_| is_absent(c.position));
            match (place(&c.name), rate) {
                (_, Some(column)) => found.push((column, true)),
                (Some(column), None) => found.push((column, false)),
                (None, None) => {
                    let reason = format!("no column is called `{}`: the columns are {}", c.name, head.join(", "));
                    return Err(wrong(1, reason));
                }
            }
        }
        let (mut times, mut values) = (Vec::<f64>::new(), vec![Vec::new(); found.len()]);
        for (index, line) in lines {
            let fields = fields(line);
            let number = |column: usize| -> Result<f64, JudgeError> {
                let field = fields.get(column).map_or("", String::as_str);
                let number = field.parse::<f64>().ok().filter(|x| x.is_finite());
                number.ok_or_else(|| wrong(index + 1, format!("`{field}` in column {} is no number", head[column])))
            };
            let t = number(time)?;
            if times.last().is_some_and(|last| t <= *last) {
                return Err(wrong(index + 1, format!("t = {t} does not come after {}", times[times.len() - 1])));
            }
            times.push(t);
            for (values, (column, _)) in values.iter_mut().zip(&found) {
                values.push(number(*column)?);
            }
        }
        let least = 2 * STENCILS[0];
        if times.len() < least {
            return Err(wrong(times.len() + 1, format!("{} samples, {least} are needed", times.len())));
        }
        let column = |(values, (_, is_rate))| if is_rate { Column::Rate(values) } else { Column::Place(values) };
        Ok(Film { times, columns: values.into_iter().zip(found).map(column).collect() })
    }

    /// The times of the samples.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Largest distance of coordinates from another film of the same columns, over the times of both.
    pub fn distance(&self, other: &Film) -> f64 {
        let (first, last) = (other.times[0], other.times[other.times.len() - 1]);
        let shared = self.times.iter().filter(|t| (first..=last).contains(t));
        let apart = shared.map(|&t| {
            let (own, other) = (self.at(t, STENCILS[0]), other.at(t, STENCILS[0]));
            own.q.iter().zip(&other.q).fold(0.0_f64, |largest, (a, b)| largest.max((a - b).abs()))
        });
        apart.fold(0.0, f64::max)
    }

    /// The first of the samples that a polynomial near `t` goes through.
    fn first(&self, t: f64, count: usize) -> usize {
        let next = self.times.partition_point(|&sample| sample < t);
        let nearest = if next > 0 && (next == self.times.len() || t - self.times[next - 1] < self.times[next] - t) {
            next - 1
        } else {
            next
        };
        nearest.saturating_sub(count / 2).min(self.times.len() - count)
    }

    /// By the polynomial through the nearest `count` samples.
    pub(crate) fn at(&self, t: f64, count: usize) -> Instant {
        let first = self.first(t, count);
        let weights = derivative_weights(&self.times[first..][..count], t);
        let sum = |values: &[f64], order: usize| -> f64 {
            values[first..][..count].iter().zip(&weights).map(|(x, w)| x * w[order]).sum()
        };
        let mut instant = Instant { t, q: Vec::new(), v: Vec::new(), a: Vec::new() };
        for column in &self.columns {
            let [q, v, a] = match column {
                Column::Place(values) => [0, 1, 2].map(|order| sum(values, order)),
                Column::Rate(values) => [0.0, sum(values, 0), sum(values, 1)],
            };
            instant.q.push(q);
            instant.v.push(v);
            instant.a.push(a);
        }
        instant
    }

    /// The derivative at the sample of index `k` of what has these values at the samples.
    pub(crate) fn slope(&self, k: usize, values: impl Fn(usize) -> f64) -> f64 {
        let (t, count) = (self.times[k], STENCILS[0]);
        let first = self.first(t, count);
        let weights = derivative_weights(&self.times[first..][..count], t);
        weights.iter().enumerate().map(|(i, w)| values(first + i) * w[1]).sum()
    }
}

/// Orders in the step of films, each made with half the step of the one before, from every three in a row.
///
/// ```text
/// order = log₂ (|q₁ − q₂| / |q₂ − q₃|)
/// ```
pub fn orders(films: &[Film]) -> Vec<f64> {
    let distances: Vec<f64> = films.windows(2).map(|pair| pair[0].distance(&pair[1])).collect();
    distances.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

/// Weights of the values at `nodes` in value, first and second derivative at `t` of the polynomial through
/// them.
///
/// Source: B. Fornberg, *Generation of finite difference formulas on arbitrarily spaced grids*, Mathematics
/// of Computation 51 (1988).
fn derivative_weights(nodes: &[f64], t: f64) -> Vec<[f64; 3]> {
    let mut weights = vec![[0.0; 3]; nodes.len()];
    weights[0][0] = 1.0;
    let (mut c1, mut c4) = (1.0, nodes[0] - t);
    for i in 1..nodes.len() {
        let (mut c2, c5) = (1.0, c4);
        c4 = nodes[i] - t;
        for j in 0..i {
            let c3 = nodes[i] - nodes[j];
            c2 *= c3;
            if j == i - 1 {
                for k in (0..3).rev() {
                    let lower = if k == 0 { 0.0 } else { k as f64 * weights[i - 1][k - 1] };
                    weights[i][k] = c1 * (lower - c5 * weights[i - 1][k]) / c2;
                }
            }
            for k in (0..3).rev() {
                let lower = if k == 0 { 0.0 } else { k as f64 * weights[j][k - 1] };
                weights[j][k] = (c4 * weights[j][k] - lower) / c3;
            }
        }
        c1 = c2;
    }
    weights
}
