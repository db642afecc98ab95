//! Integrals that are polynomials in the velocities, as Taylor series at a random point.
//!
//! `F = Σ_I k_I(q) s^I`, where `v = N s`. For a field `ξ` of `ker A`, `d/dt(ξᵀMv) = ½ vᵀ(∂_ξM)v − ξ(V) +
//! vᵀMξ̇`: reactions do no work on `ξ`. With `ξ = N_d`, where `∂_ξ M` and `ξ̇` are derivatives along
//! fields,
//!
//! ```text
//! ṡ^c = Γ^c_ab s^a s^b + G^c ,    Γ^c_ab = g^{cd} (½ T_{d,ab} − X_a(g_db)) ,    G^c = −g^{cd} X_d(V) ,
//! T_{d,ab} = N_aᵀ X_d(M) N_b + N_aᵀ M X_b(N_d) + N_bᵀ M X_a(N_d) ,
//! Ḟ = Σ_I s^I s^b X_b(k_I) + k_I Σ_c I_c s^{I−c} ṡ^c = 0 .
//! ```
//!
//! For degree 1 this is `½ (L_ξ M)(v, v) = 0` on `ker A` and `ξ(V) = 0`. It is linear, and of finite type
//! in weighted jets: with `z` of weight `w` along brackets of `w` fields (privileged coordinates), each
//! `X_b` lowers weights by one. [`Killing::kernel`] goes up weight by weight: unknown are the new
//! coefficients and the combinations of what is left. What is left is an upper bound: a coefficient matrix
//! of full rank mod p has that rank. Where nothing new is free and nothing falls away over `step + 1`
//! weights, as many as the relations between brackets reach, all of it is.
//!
//! An integral without terms up to a weight begins with new coefficients that are free there. Their
//! equations are those of the nilpotent approximation, whose fields commute with those of the other side,
//! derivatives along which lower weights by one: where none are free, none are at a higher weight.

use decision::SeriesStart;
use decision::exact::{Echelon, Modular, nullspace};

use crate::Open;
use crate::flag::Flag;
use crate::local::{Local, Reversible, draws, over_factorial, row_times};
use crate::ring::{MOST, Rays, Ring, Series, count, minus};

/// `k_I`, one series for each monomial in the velocities.
pub(crate) type Integral = Vec<Series>;

/// A system in privileged coordinates at a point.
pub(crate) struct Killing {
    pub(crate) ring: Ring,
    /// `q − q₀` in these coordinates.
    pub(crate) chart: Vec<Series>,
    step: usize,
    fields: Vec<Vec<Series>>,
    local: Local,
    /// `Γ^c_ab` and `G^c`.
    gamma: Vec<Vec<Vec<Series>>>,
    force: Vec<Series>,
}

/// Integrals of one degree, up to a weight.
pub(crate) struct Kernel {
    /// Velocity monomials, as sorted places of `s`.
    pub(crate) monomials: Vec<Vec<usize>>,
    pub(crate) integrals: Vec<Integral>,
    /// Whether the number is settled.
    pub(crate) settled: bool,
    pub(crate) order: usize,
}

/// Monomials in `m` velocities of degree `degree`, `degree − 2`, …
pub(crate) fn velocity_monomials(m: usize, degree: usize) -> Vec<Vec<usize>> {
    let mut of_degree: Vec<Vec<Vec<usize>>> = vec![vec![Vec::new()]];
    for d in 1..=degree {
        let longer = |old: &Vec<usize>| {
            (old.last().copied().unwrap_or(0)..m).map(|c| [&old[..], &[c]].concat()).collect::<Vec<_>>()
        };
        of_degree.push(of_degree[d - 1].iter().flat_map(longer).collect());
    }
    (0..=degree).rev().step_by(2).flat_map(|d| of_degree[d].clone()).collect()
}

fn with(monomial: &[usize], more: &[usize]) -> Vec<usize> {
    let mut all = [monomial, more].concat();
    all.sort_unstable();
    all
}

impl Killing {
    /// In privileged coordinates of the leaf from the frame of `flag`:
    /// `q(z) = Σ z^α/α! (Y_n^{α_n} … Y_1^{α_1} q)(q₀)`, that is `exp(z_1 Y_1) ∘ … ∘ exp(z_n Y_n)(q₀)` up to
    /// the weight of the heaviest; on the leaf beyond it as well.
    pub(crate) fn new(
        system: &Reversible,
        flag: &Flag,
        point: &SeriesStart<Modular>,
        order: usize,
        seed: u64,
    ) -> Result<Killing, Open> {
        let n = flag.fields.len();
        if n < system.dimension() {
            return Err(Open::Integrable { rank: n, dimension: system.dimension() });
        }
        let weights: Vec<usize> = flag.fields.iter().map(|y| y.weight).collect();
        let step = weights.iter().copied().max().unwrap_or(1);
        count(&weights, order, MOST).ok_or(Open::Size { order, most: MOST })?;
        let ring = Ring::new(&weights, (0..n).collect(), order);
        Open::room(flag.fields.len().pow(3).saturating_mul(ring.len()))?;
        let rays = Rays::new(&ring, &mut draws(seed)).ok_or(Open::Accident)?;
        let chart = system.on_leaf(point, &ring, &rays, chart(&ring, flag, step))?;
        let local = system.at(point, &ring, &rays, &chart)?;
        let jacobian: Vec<Vec<Series>> =
            chart.iter().map(|q| (0..n).map(|j| ring.derivative(q, j)).collect()).collect();
        // as many coordinates as the leaf has dimensions determine the others on it
        let mut rows = Echelon::default();
        let own: Vec<usize> =
            (0..jacobian.len()).filter(|&i| rows.add(jacobian[i].iter().map(|x| x[0]).collect())).collect();
        let square: Vec<Vec<Series>> = own.iter().map(|&i| jacobian[i].clone()).collect();
        let over = ring.inverse(&square).ok_or(Open::Accident)?;
        let of = |x: &[Series]| own.iter().map(|&i| x[i].clone()).collect::<Vec<_>>();
        let fields: Vec<Vec<Series>> = local.basis.iter().map(|x| row_times(&ring, &over, &of(x))).collect();
        let (gamma, force) = accelerations(&ring, &local, &fields);
        Ok(Killing { ring, chart, step, fields, local, gamma, force })
    }

    /// `(E, coefficient)` of the terms of `Ḟ` that `k_I` enters without a derivative.
    fn couplings(&self, monomial: &[usize]) -> Vec<(Vec<usize>, Series)> {
        let mut terms: Vec<(Vec<usize>, Series)> = Vec::new();
        let mut add = |to: Vec<usize>, x: &Series| match terms.iter_mut().find(|(other, _)| *other == to) {
            Some((_, sum)) => sum.iter_mut().zip(x).for_each(|(sum, &x)| *sum = *sum + x),
            None => terms.push((to, x.clone())),
        };
        for (place, &c) in monomial.iter().enumerate() {
            let mut rest = monomial.to_vec();
            rest.remove(place);
            for (a, row) in self.gamma[c].iter().enumerate() {
                for (b, x) in row.iter().enumerate() {
                    add(with(&rest, &[a, b]), x);
                }
            }
            add(rest, &self.force[c]);
        }
        terms
    }

    /// Integrals of this degree, and of lower degrees of the same parity beside it; to all weights, or until
    /// their number is settled.
    pub(crate) fn kernel(&self, degree: usize, until_settled: bool) -> Result<Kernel, Open> {
        let m = self.fields.len();
        let ring = &self.ring;
        // C(m + d, d + 1) equations for about as many unknowns over m, each with terms for all of these
        let count = (0..=degree).fold(1, |count, d| count * (m + d) / (d + 1));
        Open::room(count.saturating_mul(count / m.max(1)))?;
        let monomials = velocity_monomials(m, degree);
        Open::room(monomials.len().pow(2).saturating_mul(ring.len()))?;
        let equations = velocity_monomials(m, degree + 1);
        let place = |monomial: &[usize]| equations.iter().position(|e| e == monomial).unwrap_or(0);
        let couplings: Vec<Vec<(usize, Series)>> =
            monomials.iter().map(|i| self.couplings(i).into_iter().map(|(to, x)| (place(&to), x)).collect()).collect();
        let raised: Vec<Vec<usize>> =
            monomials.iter().map(|i| (0..m).map(|b| place(&with(i, &[b]))).collect()).collect();
        let unit = |i: usize| -> Integral {
            (0..monomials.len()).map(|j| ring.constant(if i == j { Modular::one() } else { Modular::ZERO })).collect()
        };
        let mut integrals: Vec<Integral> = (0..monomials.len()).map(unit).collect();
        let (mut quiet, mut free) = (0, 0);
        for weight in 1..=ring.order {
            let below = ring.of_weight(weight - 1);
            let size = below.len();
            let mut columns: Vec<Vec<Modular>> = Vec::new();
            // new coefficients: only the parts of the fields that lower weights count
            let fresh: Vec<(usize, usize)> =
                (0..monomials.len()).flat_map(|i| ring.of_weight(weight).map(move |alpha| (i, alpha))).collect();
            for &(i, alpha) in &fresh {
                let mut column = vec![Modular::ZERO; equations.len() * size];
                let mut one = ring.zero();
                one[alpha] = Modular::one();
                for (field, &to) in self.fields.iter().zip(&raised[i]) {
                    self.add_along(&mut column[to * size..(to + 1) * size], field, &one, weight - 1);
                }
                columns.push(column);
            }
            for integral in &integrals {
                let mut column = vec![Modular::ZERO; equations.len() * size];
                for ((k, raised), couplings) in integral.iter().zip(&raised).zip(&couplings) {
                    for (field, &to) in self.fields.iter().zip(raised) {
                        self.add_along(&mut column[to * size..(to + 1) * size], field, k, weight - 1);
                    }
                    for (to, x) in couplings {
                        ring.add_product_at(&mut column[to * size..(to + 1) * size], x, k, weight - 1);
                    }
                }
                columns.push(column);
            }
            if columns.len() > MOST {
                return Err(Open::Columns { order: weight, most: MOST });
            }
            let before = integrals.len();
            let (now_free, kernel) = nullspace(&columns, fresh.len());
            free = now_free;
            integrals = kernel.iter().map(|x| self.combined(&integrals, &fresh, x)).collect();
            quiet = if free == 0 && integrals.len() == before { quiet + 1 } else { 0 };
            if integrals.is_empty() || (until_settled && quiet > self.step) {
                return Ok(Kernel { monomials, integrals, settled: true, order: weight });
            }
        }
        if free > 0 {
            return Err(Open::Free { order: ring.order, free });
        }
        Ok(Kernel { monomials, integrals, settled: quiet > self.step, order: ring.order })
    }

    /// Adds the part of `X a` of one weight.
    fn add_along(&self, sum: &mut [Modular], field: &[Series], a: &Series, weight: usize) {
        for (i, x) in field.iter().enumerate() {
            self.ring.add_product_at(sum, x, &self.ring.derivative(a, i), weight);
        }
    }

    fn combined(&self, old: &[Integral], fresh: &[(usize, usize)], x: &[Modular]) -> Integral {
        let mut sum: Integral = vec![self.ring.zero(); old.first().map_or(0, Vec::len)];
        for (integral, &c) in old.iter().zip(&x[fresh.len()..]).filter(|(_, c)| !c.is_zero()) {
            for (sum, k) in sum.iter_mut().zip(integral) {
                sum.iter_mut().zip(k).for_each(|(sum, &k)| *sum = *sum + c * k);
            }
        }
        for (&(i, alpha), &c) in fresh.iter().zip(x) {
            sum[i][alpha] = c;
        }
        sum
    }

    /// Those integrals of `degree` that lower ones give: products, and the energy.
    pub(crate) fn trivial(&self, degree: usize, lower: &[Kernel]) -> Vec<Integral> {
        let (m, ring) = (self.fields.len(), &self.ring);
        let monomials = velocity_monomials(m, degree);
        let mut found: Vec<Integral> = Vec::new();
        let embedded = |terms: &mut dyn Iterator<Item = (Vec<usize>, Series)>| -> Integral {
            let mut all = vec![ring.zero(); monomials.len()];
            for (monomial, x) in terms {
                if let Some(at) = monomials.iter().position(|m| *m == monomial) {
                    all[at].iter_mut().zip(&x).for_each(|(sum, &x)| *sum = *sum + x);
                }
            }
            all
        };
        for d in 0..=degree / 2 {
            let (Some(low), Some(high)) = (lower.get(d), lower.get(degree - d)) else { continue };
            for a in &low.integrals {
                for b in &high.integrals {
                    let terms = low.monomials.iter().zip(a).flat_map(|(i, x)| {
                        high.monomials.iter().zip(b).map(move |(j, y)| (with(i, j), ring.product(x, y)))
                    });
                    found.push(embedded(&mut terms.into_iter()));
                }
            }
        }
        if let Some(below) = degree.checked_sub(2).and_then(|d| lower.get(d)) {
            for a in &below.integrals {
                found.push(embedded(&mut below.monomials.iter().cloned().zip(a.iter().cloned())));
            }
        }
        if degree == 2 {
            let half = Modular::new(2).inverse().unwrap_or(Modular::ZERO);
            let metric = self.local.metric.iter().enumerate();
            let kinetic = metric.flat_map(|(a, row)| row.iter().enumerate().map(move |(b, x)| (a, b, x)));
            let kinetic = kinetic.map(|(a, b, x)| (with(&[a], &[b]), x.iter().map(|&x| x * half).collect()));
            found.push(embedded(&mut kinetic.chain([(Vec::new(), self.local.potential.clone())])));
        }
        found
    }
}

/// Rank of integrals up to a weight.
pub(crate) fn rank(ring: &Ring, integrals: &[Integral], order: usize) -> usize {
    let mut rows = Echelon::default();
    let last = ring.of_weight(order).end;
    integrals.iter().filter(|x| rows.add(x.iter().flat_map(|k| k[..last].to_vec()).collect())).count()
}

fn chart(ring: &Ring, flag: &Flag, step: usize) -> Vec<Series> {
    let n = flag.fields.first().map_or(0, |y| y.components.len());
    let mut derived: Vec<Option<Vec<Series>>> = Vec::new();
    let mut chart = vec![ring.zero(); n];
    for (place, alpha) in ring.monomials.iter().enumerate().take(ring.of_weight(step.min(ring.order)).end) {
        let last = alpha.iter().rposition(|&e| e > 0);
        let values = last.and_then(|k| {
            let mut under = alpha.clone();
            under[k] -= 1;
            let field = &flag.fields[k].components;
            let before = ring.monomials.iter().position(|m| *m == under)?;
            match &derived[before] {
                None => Some(field.clone()),
                Some(values) => Some(values.iter().map(|x| flag.ring.along(field, x)).collect()),
            }
        });
        if let Some(values) = &values {
            let over = alpha.iter().fold(Modular::one(), |product, &e| product * over_factorial(e));
            chart.iter_mut().zip(values).for_each(|(q, x)| q[place] = x[0] * over);
        }
        derived.push(values);
    }
    chart
}

/// `Γ` and `G`.
fn accelerations(ring: &Ring, local: &Local, fields: &[Vec<Series>]) -> (Vec<Vec<Vec<Series>>>, Vec<Series>) {
    let m = fields.len();
    let half = Modular::new(2).inverse().unwrap_or(Modular::ZERO);
    let momenta: Vec<Vec<Series>> = local.basis.iter().map(|x| row_times(ring, &local.mass, x)).collect();
    let zero = || vec![vec![ring.zero(); m]; m];
    // −X_a(g_db) + ½ T_{d,ab}, by d
    let mut lowered = vec![zero(); m];
    for (d, lowered) in lowered.iter_mut().enumerate() {
        let slopes: Vec<Vec<Series>> =
            local.mass.iter().map(|row| row.iter().map(|x| ring.along(&fields[d], x)).collect()).collect();
        // X_c(N_d), column by column
        let turned: Vec<Vec<Series>> =
            fields.iter().map(|x| local.basis[d].iter().map(|y| ring.along(x, y)).collect()).collect();
        for a in 0..m {
            let pushed = row_times(ring, &slopes, &local.basis[a]);
            for b in 0..m {
                let sums = [
                    ring.dot(local.basis[b].iter().zip(&pushed)),
                    ring.dot(momenta[a].iter().zip(&turned[b])),
                    ring.dot(momenta[b].iter().zip(&turned[a])),
                ];
                let slope = ring.along(&fields[a], &local.metric[d][b]);
                lowered[a][b] =
                    (0..ring.len()).map(|i| (sums[0][i] + sums[1][i] + sums[2][i]) * half - slope[i]).collect();
            }
        }
    }
    let raise = |over: &[Series], of: &dyn Fn(usize) -> Series| -> Series {
        let parts: Vec<Series> = (0..m).map(of).collect();
        ring.dot(over.iter().zip(&parts))
    };
    let gamma = local
        .inverse
        .iter()
        .map(|over| (0..m).map(|a| (0..m).map(|b| raise(over, &|d| lowered[d][a][b].clone())).collect()).collect());
    let force = local
        .inverse
        .iter()
        .map(|over| raise(over, &|d| minus(&ring.zero(), &ring.along(&fields[d], &local.potential))));
    (gamma.collect(), force.collect())
}
