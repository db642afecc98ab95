//! Densities of invariant measures as formulas.
//!
//! With `σ = Σ c_k log B_k` the condition `X_b σ = −θ_b` is linear in the `c_k`: a few random points of a
//! field give more rows than there are unknowns. `B_0 = det g`, for which `X_b log det g = g^{ac}
//! X_b(g_ca)`; the others are sines and cosines of single coordinates. In coordinates and the free
//! velocities `s` instead of `p_a = g_ab s^b` the exponent of `det g` is one more: `dq dp = det g dq ds`.

use decision::exact::{Exact, FIELDS, Jet, Modular, in_field, nullspace};
use decision::{ExactStart, SeriesStart};
use symbolic::{Fraction, Scalar};

use crate::Open;
use crate::flag::fields_with_rates;
use crate::local::{Reversible, at_random};

/// A density `Π B_k^{c_k}` of `dq ds`, on coordinates and free velocities.
#[derive(Clone, Debug, PartialEq)]
pub struct Density {
    /// Exponent of the determinant of `g`, where `½ g_ab s^a s^b` is the kinetic energy on the constraints.
    pub of_metric: Fraction,
    /// Places of coordinates with the exponents of their sines and cosines.
    pub of_angles: Vec<(usize, [Fraction; 2])>,
    /// Places of the free velocities `s`; the constraints give the others.
    pub free: Vec<usize>,
}

/// The one there is, if these functions make it.
///
/// # Errors
/// [`Open`], where the numbers are not taken.
pub(crate) fn density(system: &Reversible, start: &ExactStart) -> Result<Option<Density>, Open> {
    let of = |field: usize| in_field(&FIELDS[field], || in_one_field(system, start, field as u64 + 11));
    let (one, other) = (of(0)?, of(1)?);
    let agreed = one == other;
    Ok(one.filter(|_| agreed).map(|(exponents, free)| {
        let pairs = exponents[1..].chunks_exact(2).map(|x| [x[0], x[1]]);
        let of_angles = system.present.iter().copied().zip(pairs);
        Density {
            of_metric: exponents[0],
            of_angles: of_angles.filter(|(_, x)| x.iter().any(|x| !x.is_zero())).collect(),
            free,
        }
    }))
}

/// Exponents, and the free velocities.
type Exponents = (Vec<Fraction>, Vec<usize>);

fn in_one_field(system: &Reversible, start: &ExactStart, seed: u64) -> Result<Option<Exponents>, Open> {
    let mut columns = vec![Vec::new(); 2 + 2 * system.present.len()];
    let last = columns.len() - 1;
    let mut free = Vec::new();
    for point in 0..columns.len() as u64 + 2 {
        let (rows, of) = at_random(start, seed << 32 | point, |at| logarithms(system, at, seed))?;
        for row in rows {
            columns.iter_mut().zip(row).for_each(|(column, x)| column.push(x));
        }
        free = of;
    }
    let kernel = nullspace(&columns, 0).1;
    let Some(solution) = kernel.iter().find(|x| !x[last].is_zero()) else { return Ok(None) };
    let Some(over) = (-solution[last]).inverse() else { return Ok(None) };
    let exponents = solution[..last].iter().map(|&x| (x * over).small_fraction().map(Exact::fraction));
    let exponents: Option<Vec<Fraction>> = exponents.collect();
    Ok(exponents.and_then(|mut x| {
        x[0] = x[0].checked_add(Fraction::ONE)?;
        Some((x, free))
    }))
}

/// `X_b log B_k` and `−θ_b`, a row for each b; and the free velocities.
type Logarithms = (Vec<Vec<Modular>>, Vec<usize>);

fn logarithms(system: &Reversible, point: &SeriesStart<Modular>, seed: u64) -> Result<Logarithms, Open> {
    let (ring, local) = system.near(point, 1, seed)?;
    // a root of the field has no sine: such a coordinate is no angle
    let angles = system.present.iter().map(|&i| slopes(&point.positions[i]).unwrap_or([Modular::ZERO; 2]));
    let angles: Vec<[Modular; 2]> = angles.collect();
    let rows = fields_with_rates(&ring, &local).into_iter().map(|x| {
        let pairs = local.inverse.iter().flatten().zip(local.metric.iter().flatten());
        let of_metric = pairs.fold(Modular::ZERO, |sum, (over, g)| sum + over[0] * ring.along(&x.components, g)[0]);
        let of_angles =
            system.present.iter().zip(&angles).flat_map(|(&i, slopes)| slopes.map(|slope| x.components[i][0] * slope));
        std::iter::once(of_metric).chain(of_angles).chain([x.rate[0]]).collect()
    });
    Ok((rows.collect(), local.free))
}

/// Slopes of `log sin q` and `log cos q`.
fn slopes(q: &Jet<Modular>) -> Option<[Modular; 2]> {
    let (sine, cosine) = Jet::series(&[q.coefficient(0), Modular::one()], q.exact()).sin_cos();
    let of = |x: Jet<Modular>| Some(x.coefficient(1) * x.coefficient(0).inverse()?);
    Some([of(sine)?, of(cosine)?])
}
