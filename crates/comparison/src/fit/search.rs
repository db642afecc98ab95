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

use super::squares::Power;
use super::{COARSE, Differences, FINE, LOOKED_AT, MANY_TOLERANCE};
use motion::{Metric, Motion, Setting, Settings, SolveError};

/// Number of starts: as many as this work allows (steps times operations times runs), within these bounds.
const WORK: usize = 1_300_000;
const STARTS: [usize; 2] = [24, 96];

/// One start of so many is a guess.
const GUESSES: usize = 3;

/// Guesses are compared after this part of the motion, and the better half of them is followed. The first
/// part that one is fitted to is at least that long; the next ones are longer by a factor between these.
const BEGINNING: f64 = 0.4;
const EARLIEST: f64 = 0.05;
const LONGER: [f64; 2] = [1.2, 2.0];

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
}

impl Found {
    /// Constants that are known without a search.
    pub fn given(constants: Vec<f64>) -> Found {
        Found { by_half: constants.clone(), constants, starts: 0 }
    }
}

/// A start.
struct Start {
    constants: Vec<f64>,
    /// Of a guess, the first part of the motion that it is fitted to, and the factor of the next ones.
    growth: Option<[f64; 2]>,
}

/// Constants on their way to a minimum, and the largest gap as far as they were followed.
struct Candidate {
    start: usize,
    constants: Vec<f64>,
    gap: f64,
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
    let mut differences = Differences::new(setting, equations, target, LOOKED_AT, metric, settings)?;
    differences.tolerance = MANY_TOLERANCE;
    let Some(first) = differences.closest(aim.guesses) else { return Ok(None) };
    let work = differences.limit_steps(&first) * (1 + first.len());
    let mut count = (WORK / work.max(1)).clamp(STARTS[0], STARTS[1]);
    if !aim.may_vanish && differences.is_close(&first, 1.0) {
        differences.refine(settings);
        count = STARTS[0];
    }
    let limit = DRAWN * differences.largest(&first, 1.0, COARSE);
    let starts = starts(aim, &first, &differences.sizes_at(&first), count);
    let (mut guessed, mut drawn) = (Vec::new(), Vec::new());
    for (i, Start { constants, growth }) in starts.iter().enumerate() {
        let Some([part, longer]) = *growth else {
            let gap = differences.largest(constants, 1.0, COARSE);
            drawn.extend((gap <= limit).then(|| Candidate { start: i, constants: constants.clone(), gap }));
            continue;
        };
        let constants = differences.grown(constants, part, longer, BEGINNING);
        let gap = differences.largest(&constants, BEGINNING, FINE);
        if aim.may_vanish && differences.is_close(&constants, BEGINNING) {
            let whole = differences.grown(&constants, BEGINNING * longer, longer, 1.0);
            if differences.is_close(&whole, 1.0) {
                let constants = differences.squares(&whole, settings).unwrap_or(whole);
                return Ok(Some(Found { by_half: constants.clone(), constants, starts: aim.guesses.len().max(i + 1) }));
            }
        }
        guessed.push(Candidate { start: i, constants, gap });
    }
    let half = guessed.partition_point(|guess| guess.start < count / 2);
    let mut best = [&guessed[..half], &guessed].map(better_half).concat();
    best.sort_unstable();
    best.dedup();
    let guessed = guessed.into_iter().filter(|guess| best.contains(&guess.start));
    let mut ends: Vec<Candidate> = guessed.chain(drawn).collect();
    for end in &mut ends {
        let [part, longer] = starts[end.start].growth.map_or([1.0, 1.0], |[_, longer]| [BEGINNING * longer, longer]);
        end.constants = differences.grown(&end.constants, part, longer, 1.0);
        end.gap = differences.largest(&end.constants, 1.0, FINE);
    }
    for power in POWERS {
        let beyond = ((LOOKED_AT / FINE) as f64).powf(1.0 / power);
        let limit = beyond * ends.iter().fold(f64::INFINITY, |least, end| least.min(end.gap));
        for end in ends.iter_mut().filter(|end| end.gap <= limit) {
            let sum = Power { power, scale: end.gap, stride: FINE, part: 1.0 };
            let constants = differences.minimum(&end.constants, &sum);
            let gap = differences.largest(&constants, 1.0, FINE);
            if gap < end.gap {
                (end.constants, end.gap) = (constants, gap);
            }
        }
    }
    let mut least = |below: usize| {
        let of = ends.iter().filter(|end| end.start < below);
        let constants = of.min_by(|a, b| a.gap.total_cmp(&b.gap)).map_or(&first, |end| &end.constants);
        let vanishes = aim.may_vanish && differences.is_close(constants, 1.0);
        let exact = if vanishes { differences.squares(constants, settings) } else { None };
        exact.unwrap_or_else(|| constants.clone())
    };
    Ok(Some(Found { constants: least(count), by_half: least(count / 2), starts: count }))
}

/// The starts of the better half.
fn better_half(guessed: &[Candidate]) -> Vec<usize> {
    let mut best: Vec<&Candidate> = guessed.iter().filter(|guess| guess.gap.is_finite()).collect();
    best.sort_by(|a, b| a.gap.total_cmp(&b.gap));
    best.into_iter().take(guessed.len().div_ceil(2)).map(|guess| guess.start).collect()
}

impl Differences {
    /// A minimum of the sum of squares over a part of the motion, then over parts longer by a factor.
    fn grown(&mut self, constants: &[f64], mut part: f64, longer: f64, to: f64) -> Vec<f64> {
        let mut constants = constants.to_vec();
        loop {
            let sum = Power { power: 2.0, scale: 1.0, stride: FINE, part: part.min(to) };
            constants = self.minimum(&constants, &sum);
            if part >= to {
                return constants;
            }
            part *= longer;
        }
    }
}

/// Guesses, among them some along the directions; and drawn starts around zero and around `near`, spread
/// evenly (Roberts' sequence).
fn starts(aim: &Aim, near: &[f64], sizes: &[f64], count: usize) -> Vec<Start> {
    let n = sizes.len();
    let size = |direction: &[f64]| direction.iter().zip(sizes).map(|(d, s)| (d * s).abs()).fold(0.0, f64::max);
    let along = aim.directions.iter().flat_map(|direction| {
        let moved = |by: f64| aim.guesses[0].iter().zip(direction).map(|(c, d)| c + by * d).collect();
        [size(direction), -size(direction)].map(moved)
    });
    let mut guesses: Vec<Vec<f64>> = Vec::new();
    for guess in aim.guesses.iter().cloned().chain([vec![0.0; n]]).chain(along) {
        if !guesses.contains(&guess) {
            guesses.push(guess);
        }
    }
    // the root of x^(n + 3) = x + 1
    let root = (0..60).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (n + 3) as f64));
    let geometric = |[from, to]: [f64; 2], part: f64| from * (to / from).powf(part);
    let start = |i: usize| {
        let part = |j: usize| (0.5 + i as f64 * root.powi(-(j as i32 + 1))).fract();
        if i < guesses.len() || i.is_multiple_of(GUESSES) {
            let guess = if i < guesses.len() { i } else { i / GUESSES };
            let growth = [geometric([EARLIEST, BEGINNING], part(n + 1)), geometric(LONGER, part(n))];
            return Start { constants: guesses[guess % guesses.len()].clone(), growth: Some(growth) };
        }
        let radius = geometric(REACH, part(n));
        let center = |j: usize| if i.is_multiple_of(2) { 0.0 } else { near[j] };
        let constants = (0..n).map(|j| center(j) + radius * sizes[j] * (2.0 * part(j) - 1.0)).collect();
        Start { constants, growth: None }
    };
    (0..count).map(start).collect()
}
