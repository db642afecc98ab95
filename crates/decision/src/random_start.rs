//! Starts drawn at random on the constraint, for what holds at almost every start.

use symbolic::limits::HALF_THE_DIGITS;
use symbolic::{Evaluator, SplitMix};

use crate::exact::{Coefficient, Exact, Flaw, Jet, Modular};
use crate::leaf::{PART, Short};
use crate::series::SeriesStart;
use crate::start::{ExactStart, NoExactStart};

/// Random times, positions and velocities are integers of either sign up to 2 to one of these powers, tried
/// in this order: exact functions of large integers may not fit.
const BITS: [u32; 3] = [20, 8, 3];

/// An integer of either sign, not zero, up to `2^bits`.
pub fn random_integer(random: &mut SplitMix, bits: u32) -> i128 {
    let x = random.bits();
    let size = i128::from(x % (1 << bits)) + 1;
    if x >> 63 == 0 { size } else { -size }
}

/// Maximum number of draws until the constraints have roots: a square has one for every second draw.
const DRAWS: usize = 256;
/// Number of draws with a root after which a square counts as that of a function: one other in 2^64 has as
/// many.
const ROOTED: usize = 64;

/// The number with this place, where it is not zero; else the least of the others, or 1.
fn size(numbers: &[Short], place: usize) -> Short {
    let known = |x: &Short| x.exact().filter(|x| !x.is_zero()).map(|exact| exact.to_f64().abs());
    let own = numbers.get(place).filter(|x| known(x).is_some());
    let least = || {
        numbers
            .iter()
            .filter(|x| known(x).is_some())
            .min_by(|a, b| f64::total_cmp(&known(a).unwrap_or(0.0), &known(b).unwrap_or(0.0)))
    };
    own.or_else(least).copied().unwrap_or(Jet::constant(Modular::one(), Some(Exact::ONE)))
}

/// `compute` at a random start, of the largest numbers with which that succeeds.
///
/// # Errors
/// Why it does not with the largest.
pub fn at_random<T>(
    start: &ExactStart,
    seed: u64,
    mut compute: impl FnMut(SeriesStart<Modular>) -> Result<T, String>,
) -> Result<T, String> {
    let mut fault = None;
    for bits in BITS {
        let found = start.random(seed, bits);
        let is_product = matches!(found, Err(NoExactStart::Product));
        match found.map_err(|fault| fault.to_string()).and_then(&mut compute) {
            Ok(found) => return Ok(found),
            Err(reason) => fault = fault.or(Some(reason)),
        }
        // it is one at numbers of any size
        if is_product {
            break;
        }
    }
    Err(fault.unwrap_or_default())
}

impl ExactStart {
    /// Random integers for time, positions and velocities, the others from the constraints, on the surface
    /// that the start is on: near the start, on its branch, if something varies under roots; roots in a
    /// constant ratio keep the ratio that they have there. Any other square must once have no root. The
    /// square of a function always has one; without such the surface is in one piece. Positions are on the
    /// leaf of the start, where constraints on positions hold.
    pub(crate) fn random(&self, seed: u64, bits: u32) -> Result<SeriesStart<Modular>, NoExactStart> {
        let short = |numbers: &[Jet<Modular>]| numbers.iter().map(Jet::resized).collect::<Vec<Short>>();
        let long = |numbers: &[Short]| numbers.iter().map(Short::resized).collect::<Vec<Jet<Modular>>>();
        let (given, time) = self.given();
        let parameters = short(&given);
        let near = if self.domain.branch { Some(self.series()?.0) } else { None };
        let (near_q, near_v) = near.as_ref().map(|near| (short(&near.positions), short(&near.velocities))).unzip();
        let mut random = SplitMix::new(seed);
        let mut draw = || {
            let over = if near.is_some() { PART } else { 1 };
            let exact = Exact::ratio(random_integer(&mut random, bits), over).ok_or(Flaw::Number)?;
            Modular::of(exact).map(|value| Jet::constant(value, Some(exact)))
        };
        let n = self.system.dimension();
        let mut draws = |centre: Option<&[Short]>| -> Result<Vec<Short>, Flaw> {
            (0..n).map(|i| draw().map(|x| centre.map_or(x, |centre| centre[i] + x * size(centre, i)))).collect()
        };
        let times = vec![time.resized(); n];
        let choices = [&self.supplied, &self.spare];
        let usual = choices.into_iter().find(|choice| choice.len() == self.system.constraints.len());
        let own =
            if self.domain.leaf { self.written_state(&given, time, &[])?.first().map(|q| short(q)) } else { None };
        let (mut rootless, mut rooted) = (vec![false; self.system.constraints.len()], 0);
        let mut leaf_rootless = vec![false; self.leaf.constraints()];
        let (mut found, mut is_one_piece) = (None, false);
        for _ in 0..DRAWS {
            let q = draws(near_q.as_deref())?;
            let v = draws(near_v.as_deref())?;
            let time = draws(near.as_ref().map(|_| &times[..]))?[0];
            let placed = match &own {
                None => Ok(Some((q, Vec::new()))),
                Some(own) => self.leaf.placed(&parameters, time, own, q, near.is_some(), &mut leaf_rootless),
            };
            let Some((q, on_leaf)) = placed.map_err(|_| NoExactStart::Positions)? else { continue };
            let velocities = match self.solved(&parameters, time, &q, &v, usual.unwrap_or(&self.spare)) {
                Err(NoExactStart::Nonlinear) => self.with_roots(&parameters, time, &q, &v)?,
                solved => Solved::At { velocities: solved?, free: Vec::new() },
            };
            match velocities {
                Solved::Rootless(constraint) => rootless[constraint] = true,
                Solved::At { velocities, free } => {
                    rooted += 1;
                    found.get_or_insert((time, q, velocities, free, on_leaf));
                }
            }
            let one_piece = |free: &[usize], rootless: &[bool]| free.iter().all(|&i| rootless[i]);
            is_one_piece = found.as_ref().is_some_and(|(.., free, on_leaf): &(_, _, _, Vec<usize>, Vec<usize>)| {
                one_piece(free, &rootless) && one_piece(on_leaf, &leaf_rootless)
            });
            if rooted == ROOTED || is_one_piece {
                break;
            }
        }
        match found {
            Some((time, q, v, ..)) if is_one_piece => {
                Ok(SeriesStart { parameters: given, time: time.resized(), positions: long(&q), velocities: long(&v) })
            }
            Some(_) => Err(NoExactStart::Product),
            None => Err(NoExactStart::Nonlinear),
        }
    }

    /// `v` on quadratic constraints, each for a velocity that the fewest contain.
    fn with_roots(&self, parameters: &[Short], time: Short, q: &[Short], v: &[Short]) -> Result<Solved, NoExactStart> {
        let (h, n) = (self.system.constraints.len(), v.len());
        let mut program = Evaluator::<Short>::new(self.constraints.clone());
        let inputs = |v: &[Short]| [parameters, &[time], q, v].concat();
        let values = program.evaluate(&inputs(v)).to_vec();
        let contains = |i: usize, j: usize| !values[h + i * n + j].coefficient(0).is_zero();
        let mut v = v.to_vec();
        let mut open: Vec<usize> = (0..n).collect();
        let mut roots: Vec<Root> = Vec::new();
        let mut free = Vec::new();
        for i in 0..h {
            let others = |j: &usize| (0..h).filter(|&i| contains(i, *j)).count();
            let Some(j) = open.iter().copied().filter(|&j| contains(i, j)).min_by_key(others) else {
                return Err(NoExactStart::Nonlinear);
            };
            open.retain(|&other| other != j);
            let before = v[j].coefficient(0);
            // v_j + s: coefficients are those of the constraint as a polynomial in s
            let (zero, one) = (Modular::ZERO, Modular::one());
            v[j] = Short::series(&[before, one, zero, zero, zero], None);
            let f = program.evaluate(&inputs(&v))[i];
            let [c, b, a, third, fourth] = std::array::from_fn(|k| f.coefficient(k));
            if f.flaw().is_some() || !third.is_zero() || !fourth.is_zero() {
                return Err(NoExactStart::Nonlinear);
            }
            let two = Modular::new(2);
            let change = match (two * a).inverse() {
                Some(over) => {
                    let (square, at_start) = (b * b - two * two * a * c, self.slopes[i * n + j]);
                    let kept = roots.iter().find_map(|root| root.times_constant(square, at_start));
                    let Some(value) = kept.or_else(|| square.square_root()) else { return Ok(Solved::Rootless(i)) };
                    if kept.is_none() {
                        free.push(i);
                    }
                    roots.push(Root { value, at_start });
                    (value - b) * over
                }
                None => match b.inverse() {
                    Some(over) => -c * over,
                    None => return Err(NoExactStart::Nonlinear),
                },
            };
            v[j] = Short::constant(before + change, None);
        }
        let velocities = self.solved(parameters, time, q, &v, &[])?;
        Ok(Solved::At { velocities, free })
    }
}

/// What became of a draw.
enum Solved {
    /// Velocities on the constraints; places of the constraints whose root was free in its sign.
    At { velocities: Vec<Short>, free: Vec<usize> },
    /// This constraint has no root there.
    Rootless(usize),
}

/// `∂f_i/∂v_j = √(b² − 4 a c)` of the constraint `a v_j² + b v_j + c`.
struct Root {
    value: Modular,
    /// Its value at the start itself.
    at_start: f64,
}

impl Root {
    /// The root of `square` that is to this one as at the start; `None` unless the same fraction is so here.
    fn times_constant(&self, square: Modular, at_start: f64) -> Option<Modular> {
        let there = at_start / self.at_start;
        let ratio = (square * (self.value * self.value).inverse()?).small_fraction_near(there * there)?;
        if (ratio.to_f64() - there * there).abs() > HALF_THE_DIGITS * ratio.to_f64() {
            return None;
        }
        let root = Modular::root(ratio).ok()?.0 * self.value;
        Some(if there < 0.0 { -root } else { root })
    }
}
