//! What every search for the unknowns of a motion shares: starts that fill a cube evenly, and the ends that
//! they lead to.
//!
//! Starts are one sequence: those of a shorter search are the first ones of a longer search. Each end has the
//! number of the first start that led to it, so that one search says what half of its starts would have found
//! ([`least_from`]).

/// Steps that a run of a search may take, over those of the run from its guess: beside a singularity a run
/// may take a thousand times more, and the search does not get past it.
pub const LONGER: usize = 4;

/// A motion that is found by way of shorter ones begins with this part of the time.
pub const BEGINNING: f64 = 0.1;

/// Steps in a row by the same Jacobian.
pub const CHORDS: usize = 5;

/// A start of a search, or the end that it led to.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// The unknowns.
    pub unknowns: Vec<f64>,
    /// What is minimised there; infinite where it is not known.
    pub value: f64,
    /// Number of the first start that led there, from 0.
    pub first: usize,
    /// Starts that led there.
    pub reached: usize,
}

impl Minimum {
    /// Start `number`, where nothing is known.
    pub fn start(number: usize, unknowns: Vec<f64>) -> Self {
        Minimum { unknowns, value: f64::INFINITY, first: number, reached: 1 }
    }

    /// The largest difference of an unknown, over its scale.
    pub fn distance(&self, other: &Minimum, scale: &[f64]) -> f64 {
        let each = self.unknowns.iter().zip(&other.unknowns).zip(scale).map(|((a, b), s)| ((a - b) / s).abs());
        each.fold(0.0, f64::max)
    }
}

/// The least first, each once: `is_one` says whether the second is the first.
pub fn distinct(minima: &mut Vec<Minimum>, is_one: impl Fn(&Minimum, &Minimum) -> bool) {
    minima.sort_by(|a, b| a.value.total_cmp(&b.value));
    let mut kept: Vec<Minimum> = Vec::new();
    for minimum in minima.drain(..) {
        match kept.iter_mut().find(|other| is_one(other, &minimum)) {
            Some(other) => {
                (other.reached, other.first) = (other.reached + minimum.reached, other.first.min(minimum.first));
            }
            None => kept.push(minimum),
        }
    }
    *minima = kept;
}

/// The least that the first `starts` led to; infinite where they led nowhere.
pub fn least_from(starts: usize, minima: &[Minimum]) -> f64 {
    minima.iter().filter(|minimum| minimum.first < starts).map(|minimum| minimum.value).fold(f64::INFINITY, f64::min)
}

/// Point `number` of a sequence that fills `[−1, 1]ᵈ` evenly: multiples of the powers of `1/φ`,
/// `φ^(d+1) = φ + 1` (Roberts 2018). The first is the centre.
pub fn spread(number: usize, d: usize) -> Vec<f64> {
    let phi = (0..60).fold(2.0_f64, |x, _| (1.0 + x).powf(1.0 / (d + 1) as f64));
    (1..=d as i32).map(|axis| 2.0 * (0.5 + number as f64 * phi.powi(-axis)).fract() - 1.0).collect()
}
