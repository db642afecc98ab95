//! Chaplygin's reducing multiplier: a change of time that makes a reduced motion Hamilton's.
//!
//! Let `f = 0` give `ż = B(q) ṙ`, where `q = (r, z)`; the basis `X_a` of `ker A` are the lifts of `∂/∂r_a`,
//! `[X_a, X_b]` are along `z`, and Chetaev's motion has, with `p = g ṙ` ([`crate::flag`]),
//!
//! ```text
//! ṗ_a = −X_a(H) − C_ab^c ṙ^b p_c ,    g_cd C_ab^c = c_abd = N_dᵀ M [X_a, X_b] .
//! ```
//!
//! The system is Chaplygin's in these coordinates where `g`, `V` and `c` contain `r` alone: then this is a
//! motion over `r`. With `dτ = f(r) dt`, `P = f p`, `φ = log f` it is Hamilton's motion of `H(r, P/f)` iff
//!
//! ```text
//! C_ab^c ṙ^b p_c − ṙ^b φ_b p_a + φ_a ṙ^b p_b = 0 ,  φ_a = ∂_a φ ,  for all ṙ, that is
//! c_abd + c_adb = φ_b g_ad + φ_d g_ab − 2 φ_a g_bd .                                              (H)
//! ```
//!
//! Its trace over `b, d` gives the `φ_a`: `(m − 1) φ_a = −Σ_b C_ab^b`, so `f^{m−1} dr dp` is an invariant
//! measure. There is a multiplier iff these solve (H) and `∂_a φ_b = ∂_b φ_a`. For `m = 2` they solve (H)
//! always: Chaplygin's theorem (1911).
//!
//! Source: L. García-Naranjo, J. Marrero, J. Geom. Mech. 12 (2020), arXiv:1812.01422.

use decision::exact::{Exact, FIELDS, Modular, agreed};
use decision::{ExactStart, SeriesStart};
use symbolic::Fraction;

use crate::density::density;
use crate::local::{Local, Reversible, at_random, row_times};
use crate::ring::{Ring, Series, minus};
use crate::{Density, Open};

/// Seeds of the random points, one per field.
const SEEDS: [u64; FIELDS.len()] = [0x17e6_0011, 0x17e6_0012, 0x17e6_0013, 0x17e6_0014];
/// Of the series: two derivatives of `g`, one of `c`.
const ORDER: usize = 2;

/// Choices of `r` that are looked at.
const CHOICES: usize = 100;

/// A motion over some of the coordinates, which is Chetaev's for whatever values of the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    /// Places of `r`.
    pub over: Vec<usize>,
    /// Whether a change of time makes it Hamilton's, near almost every point.
    pub multiplier: Multiplier,
}

/// What a [`Reduction`] has.
#[derive(Clone, Debug, PartialEq)]
pub enum Multiplier {
    /// None: proved, as a number that would be zero is not modulo a prime.
    None,
    /// One, by numbers at random points of two fields: it, if it can be written down.
    Local(Option<Density>),
}

/// At one point: whether the system is Chaplygin's over `r`, and whether the `φ_a` solve (H) and are the
/// derivatives of a function.
type Seen = (bool, bool);

/// All choices of `r` for which the system is Chaplygin's; multipliers are written down where a measure's
/// density is.
///
/// # Errors
/// [`Open`].
pub(crate) fn reductions(system: &Reversible, start: &ExactStart, has_density: bool) -> Result<Vec<Reduction>, Open> {
    let n = system.coordinates;
    // of as many as there are of one constraint less or of one coordinate less, and so on
    let found = (0..system.constraints).fold(1_usize, |found, k| found.saturating_mul(n - k) / (k + 1));
    if found > CHOICES {
        return Err(Open::Choices { found, most: CHOICES });
    }
    let mut choices: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..system.constraints {
        let longer = |chosen: &Vec<usize>| {
            (chosen.last().map_or(0, |last| last + 1)..n).map(|i| [&chosen[..], &[i]].concat()).collect::<Vec<_>>()
        };
        choices = choices.iter().flat_map(longer).collect();
    }
    let mut found = Vec::new();
    for dependent in choices.iter().filter(|_| system.constraints > 0) {
        let solved = system.clone().solved_for(dependent);
        let at = |seed| at_random(start, seed, |point| seen(&solved, point, seed, dependent));
        let (is_chaplygin, is_hamiltonian) = agreed(SEEDS, at, |(is, _)| !is).map_err(Open::or_accident)?;
        if is_chaplygin {
            let multiplier = match is_hamiltonian {
                false => Multiplier::None,
                true if !has_density => Multiplier::Local(None),
                true => Multiplier::Local(density(&solved, start)?.and_then(|density| root(&density))),
            };
            found.push(Reduction { over: (0..n).filter(|i| !dependent.contains(i)).collect(), multiplier });
        }
    }
    Ok(found)
}

/// `f` from the density of `dr dṙ`: `dr dp = det g dr dṙ`. One degree of freedom needs no multiplier.
fn root(density: &Density) -> Option<Density> {
    let over = Fraction::new(1, density.free.len() as i128 - 1);
    let part = |x: Fraction| over.map_or(Some(Fraction::ZERO), |over| x.checked_mul(over));
    let angle = |&(i, [sine, cosine]): &(usize, [Fraction; 2])| Some((i, [part(sine)?, part(cosine)?]));
    let of_angles: Vec<_> = density.of_angles.iter().map(angle).collect::<Option<_>>()?;
    let of_metric = part(density.of_metric.checked_add(Fraction::ONE.minus())?)?;
    let over_r = of_angles.iter().all(|(i, _)| density.free.contains(i));
    over_r.then(|| Density { of_metric, of_angles, free: density.free.clone() })
}

fn seen(system: &Reversible, point: &SeriesStart<Modular>, seed: u64, dependent: &[usize]) -> Result<Seen, Open> {
    let (ring, local) = system.near(point, ORDER, seed)?;
    if local.free.iter().any(|i| dependent.contains(i)) {
        return Ok((false, false));
    }
    let m = local.free.len();
    let momenta: Vec<Vec<Series>> = local.basis.iter().map(|x| row_times(&ring, &local.mass, x)).collect();
    let c: Vec<Series> = (0..m * m * m)
        .map(|i| {
            let turned = ring.bracket(&local.basis[i / m / m], &local.basis[i / m % m]);
            ring.dot(turned.iter().zip(&momenta[i % m]))
        })
        .collect();
    let contained = |(place, z): (usize, &usize)| {
        let all = c.iter().chain(local.metric.iter().flatten()).chain([&local.potential]);
        dependent.contains(z) && all.into_iter().any(|x| !ring.derivative(x, place)[0].is_zero())
    };
    let is_chaplygin = !system.present.iter().enumerate().any(contained);
    Ok((is_chaplygin, is_chaplygin && is_hamiltonian(&ring, &local, &c)))
}

fn is_hamiltonian(ring: &Ring, local: &Local, c: &[Series]) -> bool {
    let m = local.free.len();
    let over = Exact::ratio(-1, m.max(2) as i128 - 1).and_then(Modular::fraction).unwrap_or(Modular::ZERO);
    let at = |a: usize, b: usize, d: usize| &c[(a * m + b) * m + d];
    let phi: Vec<Series> = (0..m)
        .map(|a| {
            let trace = ring.dot((0..m * m).map(|i| (at(a, i / m, i % m), &local.inverse[i / m][i % m])));
            trace.into_iter().map(|x| x * over).collect()
        })
        .collect();
    let g = |a: usize, b: usize| local.metric[a][b][0];
    let solved = |a: usize, b: usize, d: usize| {
        let given = phi[b][0] * g(a, d) + phi[d][0] * g(a, b) - Modular::new(2) * phi[a][0] * g(b, d);
        (at(a, b, d)[0] + at(a, d, b)[0] - given).is_zero()
    };
    let closed = |a: usize, b: usize| {
        minus(&ring.along(&local.basis[a], &phi[b]), &ring.along(&local.basis[b], &phi[a]))[0].is_zero()
    };
    (0..m).all(|a| (0..m).all(|b| closed(a, b) && (b..m).all(|d| solved(a, b, d))))
}
