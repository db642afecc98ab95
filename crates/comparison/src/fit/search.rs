//! The free constants with which the largest gap to a motion is least, as far as was found:
//!
//! ```text
//! minimize  max_k |r_k| ,   r_k = R_k (q(t_k; C) − q_target(t_k)) ,   RᵀR = |M| ,   over C .
//! ```
//!
//! There are many minima. Guesses are brought to the minimum of `Σ |r_k|²` over a beginning of the motion,
//! and over longer and longer parts of it: what a long way folds, a short one does not. By how much parts
//! grow decides where that leads, and differs from start to start. Other starts are drawn. From the best ends
//! `Σ |r_k|^p` is minimized for larger and larger `p`. The first half of the starts is a search of its own:
//! where that comes to another gap, the number of starts matters.

use equations::Equations;
use motion::shooting::{BEGINNING, Minimum, least_from, spread};
use motion::{Metric, Motion, Setting, Settings, SolveError};

use super::squares::Power;
use super::{COARSE, Differences, INSTANTS};

/// Number of starts: as many as this work allows (steps times operations times runs), within these bounds.
const WORK: usize = 1_300_000;
const STARTS: [usize; 2] = [24, 96];

/// One start of so many is a guess.
const GUESSES: usize = 3;

/// Guesses are compared after this part of the motion, and the better half of them is followed. The first
/// part that one is fitted to is no longer; the next ones are longer by a factor between these.
const COMPARED: f64 = 0.4;
const FACTORS: [f64; 2] = [1.2, 2.0];

/// Drawn starts are followed whose gap is at most this many times that of the best guess.
const DRAWN: f64 = 1.2;

/// The powers after the second. The largest of `k` gaps at a minimum for the power `p` is at most `k^(1/p)`
/// times the least near it: ends that are farther from the best are left.
const POWERS: [f64; 3] = [8.0, 32.0, 128.0];

/// Drawn starts are from this to that many times the size of the constants away, evenly in the logarithm.
const REACH: [f64; 2] = [1e-2, 4.0];

/// Where a search begins.
pub(crate) struct Aim<'a> {
    /// Constants to begin from.
    pub guesses: &'a [Vec<f64>],
    /// Directions from the first of these in which there may be others that are as good.
    pub directions: &'a [Vec<f64>],
    /// Whether some constants may leave no gap at all.
    pub may_vanish: bool,
}

/// What a search came to.
pub struct Found {
    /// The constants.
    pub constants: Vec<f64>,
    /// Those that the first half of the starts leads to.
    pub by_half: Vec<f64>,
    /// Number of starts.
    pub starts: usize,
    /// How far each constant is not known, where no search has found it.
    pub open: Vec<f64>,
    /// The part of the motion's accelerations to which they were decided.
    pub part: f64,
}

impl Found {
    /// Constants that are known without a search.
    pub fn given(constants: Vec<f64>) -> Found {
        Found { by_half: constants.clone(), constants, starts: 0, open: Vec::new(), part: 0.0 }
    }
}

/// Searches from the guesses and from other starts. `None` where no guess leads to a motion.
///
/// # Errors
/// [`SolveError`] where the motion cannot be started or `target` cannot be read off.
pub(crate) fn search(
    setting: Setting,
    equations: &Equations,
    target: &mut Motion,
    aim: &Aim,
    metric: &mut Metric,
    settings: &Settings,
) -> Result<Option<Found>, SolveError> {
    let mut differences = Differences::new(setting, equations, target, metric, settings)?;
    let Some(first) = differences.closest(aim.guesses) else { return Ok(None) };
    let work = differences.limit_steps(&first) * (1 + first.len());
    let mut count = (WORK / work.max(1)).clamp(STARTS[0], STARTS[1]);
    if !aim.may_vanish && differences.is_close(&first, 1.0) {
        differences.refine(settings);
        count = STARTS[0];
    }
    let limit = DRAWN * differences.largest(&first, 1.0, COARSE);
    let (mut guessed, mut drawn) = (Vec::new(), Vec::new());
    let starts = Starts::new(aim, &first, &differences.sizes_at(&first));
    for number in 0..count {
        let Start { constants, growth } = starts.at(number);
        let Some([part, longer]) = growth else {
            let value = differences.largest(&constants, 1.0, COARSE);
            drawn.extend((value <= limit).then(|| Minimum { value, ..Minimum::start(number, constants) }));
            continue;
        };
        let constants = differences.grown(&constants, part, longer, COMPARED);
        if aim.may_vanish && differences.is_close(&constants, COMPARED) {
            let whole = differences.grown(&constants, COMPARED * longer, longer, 1.0);
            if differences.is_close(&whole, 1.0) {
                let constants = differences.squares(&whole, settings).unwrap_or(whole);
                let starts = aim.guesses.len().max(number + 1);
                return Ok(Some(Found { starts, ..Found::given(constants) }));
            }
        }
        let value = differences.largest(&constants, COMPARED, 1);
        guessed.push(Minimum { value, ..Minimum::start(number, constants) });
    }
    let half = guessed.partition_point(|guess| guess.first < count / 2);
    let better = [&guessed[..half], &guessed].map(better_half);
    guessed.retain(|guess| better.iter().any(|better| better.contains(&guess.first)));
    let mut ends: Vec<Minimum> = guessed.into_iter().chain(drawn).collect();
    for end in &mut ends {
        let [part, longer] = starts.at(end.first).growth.map_or([1.0, 1.0], |[_, longer]| [COMPARED * longer, longer]);
        end.unknowns = differences.grown(&end.unknowns, part, longer, 1.0);
        end.value = differences.largest(&end.unknowns, 1.0, 1);
    }
    for power in POWERS {
        let beyond = (INSTANTS as f64).powf(1.0 / power);
        let limit = beyond * least_from(count, &ends);
        for end in ends.iter_mut().filter(|end| end.value <= limit) {
            let sum = Power { power, scale: end.value, stride: 1, part: 1.0 };
            let unknowns = differences.minimum(&end.unknowns, &sum);
            let value = differences.largest(&unknowns, 1.0, 1);
            if value < end.value {
                (end.unknowns, end.value) = (unknowns, value);
            }
        }
    }
    let mut least = |below: usize| {
        let of = ends.iter().filter(|end| end.first < below);
        let constants = of.min_by(|a, b| a.value.total_cmp(&b.value)).map_or(&first, |end| &end.unknowns);
        let vanishes = aim.may_vanish && differences.is_close(constants, 1.0);
        let exact = if vanishes { differences.squares(constants, settings) } else { None };
        exact.unwrap_or_else(|| constants.clone())
    };
    Ok(Some(Found { by_half: least(count / 2), starts: count, ..Found::given(least(count)) }))
}

/// The starts of the better half.
fn better_half(guessed: &[Minimum]) -> Vec<usize> {
    let mut best: Vec<&Minimum> = guessed.iter().filter(|guess| guess.value.is_finite()).collect();
    best.sort_by(|a, b| a.value.total_cmp(&b.value));
    best.into_iter().take(guessed.len().div_ceil(2)).map(|guess| guess.first).collect()
}

impl Differences {
    /// A minimum of the sum of squares over a part of the motion, then over parts longer by a factor.
    fn grown(&mut self, constants: &[f64], mut part: f64, longer: f64, to: f64) -> Vec<f64> {
        let mut constants = constants.to_vec();
        loop {
            let sum = Power { power: 2.0, scale: 1.0, stride: 1, part: part.min(to) };
            constants = self.minimum(&constants, &sum);
            if part >= to {
                return constants;
            }
            part *= longer;
        }
    }
}

/// A start.
struct Start {
    constants: Vec<f64>,
    /// Of a guess, the first part of the motion that it is fitted to, and the factor of the next ones.
    growth: Option<[f64; 2]>,
}

/// Guesses, among them some along the directions; and drawn starts around zero and around `near`, spread
/// evenly.
struct Starts<'a> {
    guesses: Vec<Vec<f64>>,
    near: &'a [f64],
    sizes: Vec<f64>,
}

impl<'a> Starts<'a> {
    fn new(aim: &Aim, near: &'a [f64], sizes: &[f64]) -> Self {
        let size = |direction: &[f64]| direction.iter().zip(sizes).map(|(d, s)| (d * s).abs()).fold(0.0, f64::max);
        let along = aim.directions.iter().flat_map(|direction| {
            let moved = |by: f64| aim.guesses[0].iter().zip(direction).map(|(c, d)| c + by * d).collect();
            [size(direction), -size(direction)].map(moved)
        });
        let mut guesses: Vec<Vec<f64>> = Vec::new();
        for guess in aim.guesses.iter().cloned().chain([vec![0.0; near.len()]]).chain(along) {
            if !guesses.contains(&guess) {
                guesses.push(guess);
            }
        }
        Starts { guesses, near, sizes: sizes.to_vec() }
    }

    fn at(&self, number: usize) -> Start {
        let n = self.near.len();
        let geometric = |[from, to]: [f64; 2], by: f64| from * (to / from).powf(0.5 * (1.0 + by));
        let by = spread(number, n + 2);
        if number < self.guesses.len() || number.is_multiple_of(GUESSES) {
            let guess = if number < self.guesses.len() { number } else { number / GUESSES };
            let growth = [geometric([BEGINNING, COMPARED], by[n + 1]), geometric(FACTORS, by[n])];
            return Start { constants: self.guesses[guess % self.guesses.len()].clone(), growth: Some(growth) };
        }
        let radius = geometric(REACH, by[n]);
        let center = |j: usize| if number.is_multiple_of(2) { 0.0 } else { self.near[j] };
        let constants = (0..n).map(|j| center(j) + radius * self.sizes[j] * by[j]).collect();
        Start { constants, growth: None }
    }
}
