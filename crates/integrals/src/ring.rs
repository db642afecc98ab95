//! Truncated power series in several variables over a finite field.

use std::collections::HashMap;

use decision::exact::{Modular, inverse};
use symbolic::go_on;

/// Most coefficients of a series.
pub(crate) const MOST: usize = 1200;

/// Coefficients of a series, in the order of [`Ring::monomials`].
pub(crate) type Series = Vec<Modular>;

/// Polynomials in `z_1 … z_n` of weights `w_i`, modulo what weighs more than `order`.
pub(crate) struct Ring {
    pub(crate) weights: Vec<usize>,
    pub(crate) order: usize,
    /// Which component of a vector field belongs to each variable; nothing depends on the others.
    components: Vec<usize>,
    /// Exponents, lighter monomials first.
    pub(crate) monomials: Vec<Vec<u8>>,
    /// Where the monomials of each weight begin; one entry more than weights.
    first: Vec<usize>,
    /// Place of the product of the monomials i and j, for all j for which it is not too heavy.
    products: Vec<Vec<u32>>,
    /// Place of the monomial divided by each variable.
    lower: Vec<Vec<Option<u32>>>,
}

/// How many monomials weigh at most `order`; `None` where that is more than `most`.
pub(crate) fn count(weights: &[usize], order: usize, most: usize) -> Option<usize> {
    let mut counts = vec![0_usize; order + 1];
    counts[0] = 1;
    for &w in weights {
        (w..=order).for_each(|k| counts[k] = counts[k].saturating_add(counts[k - w]));
    }
    Some(counts.into_iter().fold(0, usize::saturating_add)).filter(|&count| count <= most)
}

impl Ring {
    /// Of variables with these weights; `components` of vector fields are along them.
    pub(crate) fn new(weights: &[usize], components: Vec<usize>, order: usize) -> Self {
        let mut of_weight: Vec<Vec<Vec<u8>>> = vec![Vec::new(); order + 1];
        of_weight[0].push(vec![0; weights.len()]);
        for (i, &w) in weights.iter().enumerate() {
            for k in w..=order {
                let heavier: Vec<Vec<u8>> = of_weight[k - w].iter().map(|exponents| times(exponents, i)).collect();
                of_weight[k].extend(heavier);
            }
        }
        let mut first = vec![0];
        for monomials in &of_weight {
            first.push(first[first.len() - 1] + monomials.len());
        }
        let monomials: Vec<Vec<u8>> = of_weight.into_iter().flatten().collect();
        let places: HashMap<&[u8], usize> = monomials.iter().enumerate().map(|(i, m)| (&m[..], i)).collect();
        let weight = |m: &[u8]| m.iter().zip(weights).map(|(&e, w)| usize::from(e) * w).sum::<usize>();
        let product = |a: &[u8], b: &[u8]| -> u32 {
            let sum: Vec<u8> = a.iter().zip(b).map(|(a, b)| a + b).collect();
            places[&sum[..]] as u32
        };
        let rows = monomials.iter().map(|a| {
            let room = first[order - weight(a) + 1];
            monomials[..room].iter().map(|b| product(a, b)).collect()
        });
        let products = rows.collect();
        let lower = (0..weights.len()).map(|i| {
            let under = |m: &Vec<u8>| {
                let mut m = m.clone();
                m[i] = m[i].checked_sub(1)?;
                Some(places[&m[..]] as u32)
            };
            monomials.iter().map(under).collect()
        });
        let lower = lower.collect();
        Ring { weights: weights.to_vec(), order, components, first, products, lower, monomials }
    }

    pub(crate) fn len(&self) -> usize {
        self.monomials.len()
    }

    /// Places of the monomials of a weight.
    pub(crate) fn of_weight(&self, weight: usize) -> std::ops::Range<usize> {
        self.first[weight]..self.first[weight + 1]
    }

    pub(crate) fn zero(&self) -> Series {
        vec![Modular::ZERO; self.len()]
    }

    pub(crate) fn constant(&self, c: Modular) -> Series {
        let mut series = self.zero();
        series[0] = c;
        series
    }

    /// `Σ a_i b_i`.
    pub(crate) fn dot<'a>(&self, pairs: impl IntoIterator<Item = (&'a Series, &'a Series)>) -> Series {
        let mut sum = self.zero();
        for (a, b) in pairs {
            self.add_product(&mut sum, a, b);
        }
        sum
    }

    pub(crate) fn product(&self, a: &Series, b: &Series) -> Series {
        self.dot([(a, b)])
    }

    fn add_product(&self, sum: &mut Series, a: &Series, b: &Series) {
        go_on();
        // many series are polynomials in few variables
        let sparse: Vec<(usize, Modular)> = b.iter().copied().enumerate().filter(|(_, y)| !y.is_zero()).collect();
        for (&x, places) in a.iter().zip(&self.products).filter(|(x, _)| !x.is_zero()) {
            for &(j, y) in sparse.iter().take_while(|(j, _)| *j < places.len()) {
                let place = places[j] as usize;
                sum[place] = sum[place] + x * y;
            }
        }
    }

    /// Adds the part of `a b` of one weight to `sum`, the coefficients of that weight.
    pub(crate) fn add_product_at(&self, sum: &mut [Modular], a: &Series, b: &Series, weight: usize) {
        let from = self.first[weight];
        for low in 0..=weight {
            let others = self.of_weight(weight - low);
            for i in self.of_weight(low) {
                if !a[i].is_zero() {
                    for j in others.clone() {
                        let place = self.products[i][j] as usize - from;
                        sum[place] = sum[place] + a[i] * b[j];
                    }
                }
            }
        }
    }

    /// `∂a/∂z_i`, known to the weight of `z_i` less than `a`.
    pub(crate) fn derivative(&self, a: &Series, i: usize) -> Series {
        let mut slope = self.zero();
        for (place, &x) in a.iter().enumerate() {
            if let Some(lower) = self.lower[i][place].filter(|_| !x.is_zero()) {
                slope[lower as usize] = x * Modular::new(self.monomials[place][i].into());
            }
        }
        slope
    }

    /// `Y a = Σ Y^i ∂a/∂z_i`.
    pub(crate) fn along(&self, field: &[Series], a: &Series) -> Series {
        let slopes: Vec<Series> = (0..self.weights.len()).map(|i| self.derivative(a, i)).collect();
        self.dot(self.components.iter().map(|&i| &field[i]).zip(&slopes))
    }

    /// `Σ ∂Y^i/∂z_i`.
    pub(crate) fn divergence(&self, field: &[Series]) -> Series {
        let parts = self.components.iter().enumerate().map(|(i, &of)| self.derivative(&field[of], i));
        parts.fold(self.zero(), |sum, part| sum.iter().zip(&part).map(|(&a, &b)| a + b).collect())
    }

    /// `[Y, Z]`.
    pub(crate) fn bracket(&self, y: &[Series], z: &[Series]) -> Vec<Series> {
        z.iter().zip(y).map(|(of_z, of_y)| minus(&self.along(y, of_z), &self.along(z, of_y))).collect()
    }

    /// `1/a`; `None` where that has no constant term.
    pub(crate) fn reciprocal(&self, a: &Series) -> Option<Series> {
        let mut over = self.constant(a[0].inverse()?);
        let mut right = 0;
        while right < self.order {
            // 2 − a x
            let mut rest = minus(&self.zero(), &self.product(a, &over));
            rest[0] = rest[0] + Modular::new(2);
            over = self.product(&over, &rest);
            right = 2 * right + 1;
        }
        Some(over)
    }

    /// Gauss–Jordan elimination of `rows` in their first `width` columns, a pivot each with a constant term.
    /// Columns of the pivots, row by row; `None` where a row is neither zero nor has one.
    pub(crate) fn eliminate(&self, rows: &mut Vec<Vec<Series>>, width: usize) -> Option<Vec<usize>> {
        let mut pivots = Vec::new();
        while pivots.len() < rows.len() {
            let at = pivots.len();
            let places = (at..rows.len()).flat_map(|i| (0..width).map(move |j| (i, j)));
            let Some((row, column)) = places.into_iter().find(|&(i, j)| !rows[i][j][0].is_zero()) else {
                let rest = rows.split_off(at);
                let zero = |series: &Series| series.iter().all(|x| x.is_zero());
                return rest.iter().all(|row| row.iter().all(zero)).then_some(pivots);
            };
            rows.swap(at, row);
            let over = self.reciprocal(&rows[at][column])?;
            let pivot: Vec<Series> = rows[at].iter().map(|x| self.product(x, &over)).collect();
            for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != at) {
                let factor = row[column].clone();
                if factor.iter().any(|x| !x.is_zero()) {
                    row.iter_mut().zip(&pivot).for_each(|(x, p)| *x = minus(x, &self.product(&factor, p)));
                }
            }
            rows[at] = pivot;
            pivots.push(column);
        }
        Some(pivots)
    }

    /// The inverse of a square matrix; `None` where that is singular at the point.
    pub(crate) fn inverse(&self, matrix: &[Vec<Series>]) -> Option<Vec<Vec<Series>>> {
        let n = matrix.len();
        let unit = |i: usize, j: usize| self.constant(if i == j { Modular::one() } else { Modular::ZERO });
        let row = |(i, row): (usize, &Vec<Series>)| row.iter().cloned().chain((0..n).map(|j| unit(i, j))).collect();
        let mut rows: Vec<Vec<Series>> = matrix.iter().enumerate().map(row).collect();
        let pivots = self.eliminate(&mut rows, n).filter(|pivots| pivots.len() == n)?;
        let mut over = vec![Vec::new(); n];
        for (mut row, pivot) in rows.into_iter().zip(pivots) {
            over[pivot] = row.split_off(n);
        }
        Some(over)
    }

    /// Values of all monomials at a point.
    pub(crate) fn values(&self, point: &[Modular]) -> Vec<Modular> {
        let mut values = vec![Modular::one(); self.len()];
        for place in 1..self.len() {
            let under = (0..point.len()).find_map(|i| Some((i, self.lower[i][place]?)));
            if let Some((i, lower)) = under {
                values[place] = values[lower as usize] * point[i];
            }
        }
        values
    }
}

/// Curves `z_i = d_i s^{w_i}`, on which the coefficient of `s^k` of a series is its part of weight k at `d`.
pub(crate) struct Rays {
    /// Values of all monomials, ray by ray.
    pub(crate) values: Vec<Vec<Modular>>,
    /// For each weight: part of that weight from its values at as many rays.
    parts: Vec<Vec<Modular>>,
}

impl Rays {
    /// `None` where random rays are dependent, an accident.
    pub(crate) fn new(ring: &Ring, draw: &mut impl FnMut() -> Modular) -> Option<Self> {
        let most = (0..=ring.order).map(|k| ring.of_weight(k).len()).max().unwrap_or(1);
        let point =
            |draw: &mut dyn FnMut() -> Modular| -> Vec<Modular> { ring.weights.iter().map(|_| draw()).collect() };
        let values: Vec<Vec<Modular>> = (0..most).map(|_| ring.values(&point(draw))).collect();
        let parts = (0..=ring.order).map(|k| {
            let places = ring.of_weight(k);
            let size = places.len();
            let matrix: Vec<Modular> = values[..size].iter().flat_map(|row| row[places.clone()].to_vec()).collect();
            Some(inverse(&matrix, size, Modular::one())?.0)
        });
        Some(Rays { parts: parts.collect::<Option<_>>()?, values })
    }

    /// A series from `along`, its values on each ray, weight by weight.
    pub(crate) fn series(&self, ring: &Ring, along: &dyn Fn(usize, usize) -> Modular) -> Series {
        let mut series = ring.zero();
        for (k, part) in self.parts.iter().enumerate() {
            let places = ring.of_weight(k);
            let values: Vec<Modular> = (0..places.len()).map(|ray| along(ray, k)).collect();
            for (place, row) in places.zip(part.chunks_exact(values.len().max(1))) {
                series[place] = row.iter().zip(&values).fold(Modular::ZERO, |sum, (&x, &y)| sum + x * y);
            }
        }
        series
    }
}

pub(crate) fn minus(a: &Series, b: &Series) -> Series {
    a.iter().zip(b).map(|(&a, &b)| a - b).collect()
}

fn times(exponents: &[u8], i: usize) -> Vec<u8> {
    let mut exponents = exponents.to_vec();
    exponents[i] += 1;
    exponents
}
