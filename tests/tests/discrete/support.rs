//! A discrete motion against a continuous one: orders over halvings, and what is left after extrapolation.

use deltaq::Motion;
use mechanics::{Removal, State, System};
use referees::discrete::{Convergence, Discrete, DiscreteError, Ends, RemovedStart, convergence};

/// Steps of the coarsest grid: the first of these whose own estimate of its error is under [`COARSE`].
const STEPS: [usize; 5] = [8, 16, 32, 64, 128];

/// Largest relative error that follows a power series in `h²`; over it, halvings show nothing yet.
const COARSE: f64 = 5e-4;

/// Grids, each twice as fine as the one before.
const LEVELS: usize = 6;

/// The horizon is at most this, s.
pub const HORIZON: f64 = 0.5;

/// Steps of the continuous motion (order 8, at a tolerance of round-off).
const OWN_STEPS: usize = 20;

/// Errors under this are round-off of the march (1/h in differences of positions) or of the motion.
const PLATEAU: f64 = 1e-10;

/// What the measured order may be away from 2, on the last halving above [`PLATEAU`].
pub const ORDER: f64 = 0.1;

/// Sums of what was measured, for the last line.
#[derive(Default)]
pub struct Tally {
    orders: Vec<f64>,
    exact: usize,
    largest: f64,
}

impl Tally {
    pub fn say(&self, what: &str) {
        let (low, high) =
            self.orders.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &o| (a.min(o), b.max(o)));
        println!(
            "{what}: {} motions of order {low:.3} to {high:.3}, {} without an error to measure; largest difference {:.1e}",
            self.orders.len(),
            self.exact,
            self.largest
        );
    }

    pub fn measured(&self) -> usize {
        self.orders.len()
    }
}

/// End of the short run: [`HORIZON`] after the start, at most [`OWN_STEPS`] steps of the continuous motion.
///
/// Near a chart's edge (the ball in the cone after 0.4 s) time scales are a millisecond, unknown to a grid.
pub fn short(motion: &Motion) -> f64 {
    let own = motion.step_times();
    own[OWN_STEPS.min(own.len() - 1)].min(motion.start() + HORIZON)
}

/// Convergence of `discrete` to `motion`, from a grid on that is fine enough for the motion.
pub fn measure(what: &str, discrete: Result<Discrete, DiscreteError>, motion: &mut Motion) -> Convergence {
    let mut discrete = discrete.unwrap_or_else(|e| panic!("{what}: {e}"));
    let mut from = |steps: usize, levels: usize| {
        convergence(&mut discrete, steps, levels, |t| motion.at(t).map(|o| o.coordinates))
    };
    let mut tried = String::new();
    for steps in STEPS {
        match from(steps, 2) {
            Ok(found) if found.estimate < COARSE => {
                return from(steps, LEVELS).unwrap_or_else(|e| panic!("{what}: {e}"));
            }
            Ok(found) => tried = format!("estimate {:.1e}", found.estimate),
            Err(e) => tried = e.to_string(),
        }
    }
    panic!("{what}: no grid is fine enough; the last: {tried}")
}

/// Demands order 2 and, after extrapolation, a difference under `limit`.
pub fn agrees(what: &str, found: &Convergence, limit: f64, tally: &mut Tally) {
    let orders = found.orders(0, PLATEAU);
    println!(
        "{what:<64} orders {orders:5.2?}, {:.1e} -> {:.1e} (± {:.1e})",
        found.finest(),
        found.difference,
        found.estimate
    );
    match orders.last() {
        Some(&order) => {
            assert!((order - 2.0).abs() < ORDER, "{what}: order {order}, errors {:?}", found.errors);
            tally.orders.push(order);
        }
        None => tally.exact += 1,
    }
    assert!(found.difference < limit, "{what}: {:.3e} is over {limit:.0e}; {:?}", found.difference, found.errors);
    tally.largest = tally.largest.max(found.difference);
}

/// A removal's discrete motion from `P(t₀)`, one a memory variable; none for actions not of first order.
pub fn removed(
    system: &System,
    removal: &Removal,
    start: &State,
    costates: &[f64],
    end: f64,
) -> Option<Result<Discrete, DiscreteError>> {
    let discrete = RemovedStart::at(system, removal, start, costates)
        .and_then(|start| Discrete::removed(system, removal, &start, end, Ends::GivenStart));
    match discrete {
        Err(DiscreteError::HighRate { .. }) => None,
        other => Some(other),
    }
}

/// `P(t₀)`, one a memory variable, out of the free constants of a motion; zero for those without a costate.
pub fn costates(motion: &Motion, removal: &Removal) -> Vec<f64> {
    let mut costates = vec![0.0; removal.memory.len()];
    for (constant, &value) in motion.equations.free_constants.iter().zip(&motion.constants) {
        if let Some(i) = constant.memory {
            costates[i] = value;
        }
    }
    costates
}
