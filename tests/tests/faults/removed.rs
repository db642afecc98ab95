//! Judge of the removed-constraint equations, by values of `L`, `q(ü, u̇, u, w, t)` with its rate, and `B`.

use std::cell::RefCell;

use mechanics::{Removal, System};
use symbolic::{Evaluator, Symbol};

use super::judge::{Findings, common};
use super::reading::{Instant, Reading, Sample};
use super::truth::{Point, Truth, slope, slopes};

pub struct Parametrized {
    /// Numbers of parameters and of memory variables.
    m: usize,
    k: usize,
    /// `u, u̇, ü, w`
    pub variables: Vec<Symbol>,
    parameters: Vec<String>,
    memory: Vec<String>,
    /// `q, q̇, B` from `t` and the variables
    function: RefCell<Evaluator<f64>>,
}

impl Parametrized {
    pub fn new(system: &System, removal: &Removal) -> Result<Parametrized, String> {
        let system = system.clone();
        let by = |symbol: fn(&mechanics::DisplacementParameter) -> Symbol| removal.parameters.iter().map(symbol);
        let memory = removal.memory.iter().map(|w| w.symbol);
        let variables: Vec<Symbol> =
            by(|u| u.symbol).chain(by(|u| u.rate)).chain(by(|u| u.second_rate)).chain(memory).collect();
        let inputs = [&[system.time][..], &variables].concat();
        let rates: Vec<_> = removal.memory.iter().map(|w| w.rate).collect();
        let outputs = [&removal.coordinates[..], &removal.velocities(&system), &rates].concat();
        let function = system.evaluator(&inputs, &outputs).map_err(|e| e.to_string())?;
        Ok(Parametrized {
            m: removal.parameters.len(),
            k: removal.memory.len(),
            parameters: removal.parameters.iter().map(|u| system.graph.name(u.symbol)).collect(),
            memory: removal.memory.iter().map(|w| system.graph.name(w.symbol)).collect(),
            variables,
            function: RefCell::new(function),
        })
    }

    /// `q, q̇, B`
    pub fn at<'a>(&self, truth: &Truth, values: &'a mut Vec<f64>, t: f64, x: &[f64]) -> [&'a [f64]; 3] {
        *values = self.function.borrow_mut().evaluate(&[&[t][..], x].concat()).to_vec();
        let (q, rest) = values.split_at(truth.n);
        let (v, rates) = rest.split_at(truth.n);
        [q, v, rates]
    }

    /// `G = L + P·B`
    fn generating(&self, truth: &Truth, t: f64, x: &[f64], p: &[f64]) -> f64 {
        let mut values = Vec::new();
        let [q, v, rates] = self.at(truth, &mut values, t, x);
        truth.lagrangian(t, q, v) + p.iter().zip(rates).map(|(p, rate)| p * rate).sum::<f64>()
    }

    /// `Q` at the variables.
    fn forces(&self, truth: &Truth, t: f64, x: &[f64]) -> Vec<f64> {
        let mut values = Vec::new();
        let [q, v, _] = self.at(truth, &mut values, t, x).map(<[f64]>::to_vec);
        truth.forces(&Point { t, q, v, mu: Vec::new() })
    }

    /// `∂G/∂x + (∂q/∂x)ᵀ Q`
    fn gradient(&self, truth: &Truth, t: f64, x: &[f64], p: &[f64]) -> Vec<f64> {
        let forces = self.forces(truth, t, x);
        let both = |x: &[f64]| {
            let mut values = Vec::new();
            let [q, ..] = self.at(truth, &mut values, t, x);
            vec![self.generating(truth, t, x, p) + q.iter().zip(&forces).map(|(q, force)| q * force).sum::<f64>()]
        };
        slopes(x, both).concat()
    }

    /// Values of `(u, u̇, ü, w)` and their rates, where the equations say them.
    fn variables(&self, reading: &Reading, instant: &Instant) -> Option<(Vec<f64>, Vec<f64>)> {
        let m = self.m;
        let place = |i: usize| reading.states.iter().position(|y| *y == self.variables[i]);
        let value = |i: usize| Some(instant.y[place(i)?]);
        let rate = |i: usize| Some(instant.rates[place(i)?]);
        let all = 0..self.variables.len();
        let values = all.clone().map(|i| if (2 * m..3 * m).contains(&i) { rate(i - m) } else { value(i) });
        // third rates move G along only where it contains the second ones
        let rates = all.map(|i| if (2 * m..3 * m).contains(&i) { rate(i).or(Some(0.0)) } else { rate(i) });
        Some((values.collect::<Option<_>>()?, rates.collect::<Option<_>>()?))
    }
}

pub fn judge(truth: &Truth, removed: &Parametrized, samples: &[Sample], reading: &Reading) -> Findings {
    let (m, k) = (removed.m, removed.k);
    let mut findings = Findings::new();
    let multiplier = |name: String| reading.multipliers.iter().position(|found| *found == name);
    let costates: Vec<_> = removed.memory.iter().map(|w| multiplier(format!("P_{w}"))).collect();
    let momenta: Vec<_> = removed.parameters.iter().map(|u| multiplier(format!("p_{u}"))).collect();
    findings.must("a momentum for each parameter", momenta.iter().all(Option::is_some));
    let mut moves = vec![false; m + 1];
    let mut needed = vec![false; k];
    for (sample, instant) in samples.iter().zip(&reading.instants) {
        let at = common(&mut findings, sample, instant);
        let Some((x, rates)) = removed.variables(reading, instant) else {
            findings.must("a state for each variable", false);
            return findings;
        };
        let known: std::collections::HashMap<_, _> = sample.known.iter().copied().collect();
        for (symbol, x) in removed.variables.iter().zip(&x) {
            if let Some(wanted) = known.get(symbol) {
                findings.same("variables at the start", &[*x], &[*wanted]);
            }
        }
        let p: Vec<f64> = costates.iter().map(|p| p.map_or(0.0, |p| instant.now.multipliers[p])).collect();
        let p_rates: Vec<f64> = costates.iter().map(|p| p.map_or(0.0, |p| instant.along.multipliers[p])).collect();
        let given = costates.iter().flatten().zip(&sample.constants);
        given.for_each(|(&p, c)| findings.same("costates at the start", &[instant.now.multipliers[p]], &[*c]));
        findings.same("rates of parameters", &rates[..m], &x[m..2 * m]);
        let mut values = Vec::new();
        let [_, _, b] = removed.at(truth, &mut values, at.t, &x);
        findings.same("rates of memory", &rates[3 * m..], b);
        let moved = |list: &[f64], rates: &[f64], s: f64| -> Vec<f64> {
            list.iter().zip(rates).map(|(x, rate)| x + s * rate).collect()
        };
        let along = |s: f64| removed.gradient(truth, at.t + s, &moved(&x, &rates, s), &moved(&p, &p_rates, s));
        let (gradient, turned) = (along(0.0), slope(along));
        let size = gradient.iter().chain(&turned).map(|x| x.abs()).sum::<f64>();
        let minus: Vec<f64> = gradient[3 * m..].iter().map(|x| -x).collect();
        findings.zero("costates", &p_rates.iter().zip(minus).map(|(a, b)| a - b).collect::<Vec<_>>(), size);
        let momentum: Vec<f64> = (0..m).map(|i| gradient[m + i] - turned[2 * m + i]).collect();
        for (i, place) in momenta.iter().enumerate() {
            let Some(place) = *place else { continue };
            findings.same("momenta", &[instant.now.multipliers[place]], &momentum[i..=i]);
            findings.zero("the principle", &[instant.along.multipliers[place] - gradient[i]], size);
            moves[i] |= gradient[i].abs() > 1e-6 * (1.0 + size);
        }
        let by_time = slope(|s| vec![removed.generating(truth, at.t + s, &x, &p)]);
        let driven = removed.forces(truth, at.t, &x);
        moves[m] |= by_time.iter().chain(&driven).any(|x| x.abs() > 1e-6 * (1.0 + size));
        let power: f64 = (0..m).map(|i| x[m + i] * momentum[i] + x[2 * m + i] * gradient[2 * m + i]).sum();
        let energy = power - removed.generating(truth, at.t, &x, &p);
        for (i, (name, value)) in reading.invariants.iter().zip(&instant.now.invariants).enumerate() {
            let place = removed.parameters.iter().position(|u| *name == format!("momentum {u}"));
            let wanted = place.map_or(energy, |i| momentum[i]);
            findings.same("value of an invariant", &[*value], &[wanted]);
            findings.zero("an invariant along the motion", &instant.along.invariants[i..=i], size);
        }
        // the smallest set of costates that is consistent
        for _ in 0..k {
            let p: Vec<f64> =
                needed.iter().enumerate().map(|(i, &on)| if on { 0.3 + 0.1 * i as f64 } else { 0.0 }).collect();
            let gradient = removed.gradient(truth, at.t, &x, &p);
            needed.iter_mut().zip(&gradient[3 * m..]).for_each(|(on, slope)| *on |= slope.abs() > 1e-6 * (1.0 + size));
        }
    }
    findings.must("guards", reading.guarded.iter().all(|singular| *singular));
    for (i, moves) in moves.into_iter().enumerate() {
        let name = removed.parameters.get(i).map_or("energy".into(), |u| format!("momentum {u}"));
        findings.must("invariants", reading.invariants.contains(&name) != moves);
    }
    findings.must("a costate for each variable that needs one", costates.iter().map(Option::is_some).eq(needed));
    findings
}
