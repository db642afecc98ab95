//! Brackets of a basis of `ker A`, and the condition on an invariant measure along each of them.
//!
//! Along Chetaev's motion, with `p_a = g_ab s^b` and `[X_a, X_b] = C_ab^c X_c + (M-orthogonal to ker A)`,
//!
//! ```text
//! q̇ = X_b s^b ,   ṗ_a = −X_a(H) − C_ab^c s^b p_c ,   H = ½ g^{ab} p_a p_b + V ,
//! div(q̇, ṗ) = θ_b s^b ,   θ_b = div X_b + Σ_a C_ba^a :
//! ```
//!
//! the terms with `X_a(s^a)` cancel, and `C_ab^c g^{ab} = 0`. So `e^σ dq dp` is invariant iff `X_b σ = −θ_b`.
//! From `Yσ = τ_Y`, `Zσ = τ_Z` follows `[Y, Z]σ = Y(τ_Z) − Z(τ_Y)`.

use decision::SeriesStart;
use decision::exact::{Echelon, Modular};

use crate::Open;
use crate::local::{Local, Reversible, row_times};
use crate::ring::{Ring, Series, minus};

/// A vector field, made of `weight` fields of `ker A`; and what `σ` has as its derivative along it.
#[derive(Clone)]
pub(crate) struct Field {
    pub(crate) components: Vec<Series>,
    pub(crate) rate: Series,
    pub(crate) weight: usize,
    /// Its place among all fields that were looked at, those that brackets begin with first.
    place: usize,
}

/// Brackets that are independent at a random point, and the ranks there.
pub(crate) struct Flag {
    pub(crate) ring: Ring,
    /// Places of the free velocities.
    pub(crate) free: Vec<usize>,
    pub(crate) fields: Vec<Field>,
    /// Brackets that were looked at, as two places; they have the places after the fields they begin with.
    pub(crate) brackets: Vec<[usize; 2]>,
    /// Fields that are independent beside their rates `τ`, as places and `(Y, τ)` at the point; more than
    /// there are `fields`: no measure.
    pub(crate) with_rates: Vec<(usize, Vec<Modular>)>,
}

impl Flag {
    /// Of the fields of `ker A`, and of `∂/∂q` for each coordinate of `held`, which the system does not
    /// contain: a density that is free of these does not change along them.
    ///
    /// # Errors
    /// [`Open`]: what has no image, is singular, or would take too long.
    pub(crate) fn new(
        system: &Reversible,
        point: &SeriesStart<Modular>,
        seed: u64,
        held: &[usize],
    ) -> Result<Flag, Open> {
        let n = system.coordinates;
        // every round but the last adds one field at least, and loses one order
        let order = system.constraints + 2;
        let (ring, local) = system.near(point, order, seed)?;
        let mut basis = fields_with_rates(&ring, &local);
        for &i in held {
            let unit = |j: usize| ring.constant(if i == j { Modular::one() } else { Modular::ZERO });
            let components = (0..n).map(unit).collect();
            basis.push(Field { components, rate: ring.zero(), weight: 1, place: basis.len() });
        }
        let (mut span, mut beside) = (Echelon::default(), Echelon::default());
        let mut fields: Vec<Field> = Vec::new();
        let (mut brackets, mut with_rates) = (Vec::new(), Vec::new());
        let mut candidates = basis.clone();
        for weight in 2.. {
            let begin = fields.len();
            for field in candidates {
                let mut row: Vec<Modular> = field.components.iter().map(|x| x[0]).collect();
                let grows = span.add(row.clone());
                row.push(field.rate[0]);
                if beside.add(row.clone()) {
                    with_rates.push((field.place, row));
                }
                if grows {
                    fields.push(field);
                }
            }
            if fields.len() == begin {
                break;
            }
            let last = &fields[begin..];
            candidates = Vec::new();
            for (x, y) in basis.iter().flat_map(|x| last.iter().map(move |y| (x, y))) {
                let place = basis.len() + brackets.len();
                brackets.push([x.place, y.place]);
                candidates.push(bracket(&ring, x, y, weight, place));
            }
        }
        Ok(Flag { free: local.free, fields, brackets, with_rates, ring })
    }
}

fn bracket(ring: &Ring, y: &Field, z: &Field, weight: usize, place: usize) -> Field {
    let components = ring.bracket(&y.components, &z.components);
    let rate = minus(&ring.along(&y.components, &z.rate), &ring.along(&z.components, &y.rate));
    Field { components, rate, weight, place }
}

/// The fields `X_b` with their rates `−θ_b`.
pub(crate) fn fields_with_rates(ring: &Ring, local: &Local) -> Vec<Field> {
    let reciprocal: Vec<Vec<Series>> = local.inverse.iter().map(|over| combined(ring, &local.basis, over)).collect();
    // M times Σ_d g^{ad} N_d: what C^a is taken with
    let covectors: Vec<Vec<Series>> = reciprocal.iter().map(|x| row_times(ring, &local.mass, x)).collect();
    let of = |(place, x): (usize, &Vec<Series>)| {
        let divergence = ring.divergence(x);
        let traces = local.basis.iter().zip(&covectors).map(|(a, covector)| {
            let commutator = ring.bracket(x, a);
            ring.dot(commutator.iter().zip(covector))
        });
        let rate = traces.fold(minus(&ring.zero(), &divergence), |sum, trace| minus(&sum, &trace));
        Field { components: x.clone(), rate, weight: 1, place }
    };
    local.basis.iter().enumerate().map(of).collect()
}

/// `Σ_d c_d N_d`.
fn combined(ring: &Ring, basis: &[Vec<Series>], c: &[Series]) -> Vec<Series> {
    (0..basis.first().map_or(0, Vec::len)).map(|i| ring.dot(basis.iter().map(|x| &x[i]).zip(c))).collect()
}
