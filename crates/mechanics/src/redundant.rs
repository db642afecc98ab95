//! Constraints that follow from the others: dependent rows of constant rank.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use symbolic::limits::{ITERATIONS, NOTHING, SAME};
use symbolic::{Evaluator, Expr, SplitMix};

use crate::elimination::{LinearForms, PIVOT_CHOICE, eliminate, largest, open};
use crate::{SingularValues, System};

/// Singular values under this part of the largest are zero behind a way from the start.
const BEHIND: f64 = 1e-5;
/// Ways in random directions that the constraints allow, each as long as changes their matrix by this part,
/// in steps that double.
const WAYS: u64 = 6;
const CHANGE: f64 = 0.05;

impl System {
    /// Indices of constraints that all others follow from, in their order, where some do: of `A v + b = 0`,
    /// linear in the velocities, whose `[A b]` has less than full rank at `(t, q)` and, as far as six ways
    /// along which `A dq + b dt = 0` tell, no more elsewhere. `None` where all are independent, or where
    /// they depend at this place only.
    ///
    /// ```
    /// # let mut system = mechanics::System::new(Default::default(), &[("x", "m"), ("y", "m"), ("z", "m")]);
    /// for f in ["x*x' + y*y'", "z' - x'", "2*x*x' + 2*y*y' + x*(z' - x')"] {
    ///     system.constraints.push(system.expression(f)?);
    /// }
    /// assert_eq!(system.independent_constraints(0.0, &[1.0, 0.5, 0.0]).map(|kept| kept.len()), Some(2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn independent_constraints(&self, t: f64, q: &[f64]) -> Option<Vec<usize>> {
        let place: Vec<f64> = q.iter().copied().chain([t]).collect();
        let mut rows = Rows::new(self)?;
        let start = rows.at(&place)?;
        if SingularValues::least_at_least(&start) > NOTHING * start.norm() {
            return None;
        }
        let rank_of = |matrix: &DMatrix<f64>| SingularValues::of(matrix).rank(NOTHING);
        let rank = rank_of(&start);
        if rank == rows.count || rank_of(&start.columns(0, q.len()).into_owned()) < rank {
            return None;
        }
        let stays = (0..WAYS).all(|way| rows.keeps_rank(&place, &start, rank, way) == Some(true));
        // what follows from constraints on positions holds on their leaf
        let is_first = |i: &usize| self.on_positions.iter().any(|(place, _)| place == i);
        let mut order: Vec<usize> = (0..rows.count).collect();
        order.sort_by_key(|i| !is_first(i));
        stays.then(|| independent_rows(&start, rank, &order))
    }
}

impl System {
    /// All constraints in the order in which they were given, those that follow from the others among them.
    pub fn all_constraints(&self) -> System {
        let own = self.constraint_numbers().into_iter().zip(self.constraints.iter().copied());
        let mut all: Vec<(usize, Expr)> = own.chain(self.redundant.iter().copied()).collect();
        all.sort_by_key(|(number, _)| *number);
        let numbers = self.constraint_numbers();
        let on_positions = self.on_positions.iter().map(|&(place, g)| (numbers[place] - 1, g)).collect();
        System {
            on_positions,
            constraints: all.into_iter().map(|(_, f)| f).collect(),
            redundant: Vec::new(),
            ..self.clone()
        }
    }

    /// The system with these of its constraints, by their indices, and the others as those that follow.
    pub fn keeping(&self, kept: &[usize]) -> System {
        let (own, rest): (Vec<_>, Vec<_>) =
            self.constraints.iter().copied().enumerate().partition(|(i, _)| kept.contains(i));
        let place = |of: usize| own.iter().position(|(i, _)| *i == of);
        let on_positions = self.on_positions.iter().filter_map(|&(of, g)| Some((place(of)?, g))).collect();
        System {
            on_positions,
            constraints: own.into_iter().map(|(_, f)| f).collect(),
            redundant: rest.into_iter().map(|(i, f)| (i + 1, f)).collect(),
            ..self.clone()
        }
    }
}

/// Indices of `rank` rows that are well apart, the first ones in this order where several would do.
fn independent_rows(matrix: &DMatrix<f64>, rank: usize, order: &[usize]) -> Vec<usize> {
    let row = |&i: &usize| matrix.row(i).iter().copied().collect();
    let mut rows: Vec<Vec<f64>> = order.iter().map(row).collect();
    let mut places: Vec<usize> = (0..rows.len()).collect();
    let pivots = eliminate(&mut rows, |rows, done| {
        if done.len() == rank {
            return None;
        }
        let open = || open(rows, done, matrix.ncols());
        let size = |(i, j): (usize, usize)| rows[i][j].abs();
        let most = size(largest(rows, open())?);
        let first = open().filter(|&at| size(at) >= PIVOT_CHOICE * most).map(|(i, _)| i).min_by_key(|&i| places[i])?;
        places.swap(done.len(), first);
        largest(rows, open().filter(|(i, _)| *i == first))
    });
    let mut taken: Vec<usize> = places.iter().take(pivots.len()).map(|&place| order[place]).collect();
    taken.sort_unstable();
    taken
}

/// `[A b]` with rows and columns scaled to a largest entry of 1 at the first place.
struct Rows {
    program: Evaluator<f64>,
    count: usize,
    columns: Option<[DVector<f64>; 2]>,
}

impl Rows {
    fn new(system: &System) -> Option<Self> {
        let g = &system.graph;
        let LinearForms { rows, offsets } = system.linear_constraints().ok()?;
        let (count, n) = (rows.len(), system.dimension());
        if count == 0 {
            return None;
        }
        let row = |(row, b): (&BTreeMap<usize, Expr>, &Expr)| {
            (0..n).map(|j| row.get(&j).copied().unwrap_or(g.zero())).chain([*b]).collect::<Vec<_>>()
        };
        let entries: Vec<Expr> = rows.iter().zip(&offsets).flat_map(row).collect();
        let inputs: Vec<_> = system.positions().into_iter().chain([system.time]).collect();
        let program = Evaluator::new(g.compile(&inputs, &entries, &system.parameter_values()).ok()?);
        Some(Rows { program, count, columns: None })
    }

    /// At `(q, t)`.
    fn at(&mut self, place: &[f64]) -> Option<DMatrix<f64>> {
        let entries = self.program.evaluate(place);
        if !entries.iter().all(|x| x.is_finite()) {
            return None;
        }
        let matrix = DMatrix::from_row_slice(self.count, place.len(), entries);
        let inverse = |x: f64| if x > 0.0 { x.recip() } else { 1.0 };
        let [rows, columns] = self.columns.get_or_insert_with(|| {
            let columns = DVector::from_iterator(place.len(), matrix.column_iter().map(|c| inverse(c.amax())));
            let scaled = DMatrix::from_fn(self.count, place.len(), |i, j| matrix[(i, j)] * columns[j]);
            [DVector::from_iterator(matrix.nrows(), scaled.row_iter().map(|r| inverse(r.amax()))), columns]
        });
        Some(DMatrix::from_fn(self.count, place.len(), |i, j| rows[i] * matrix[(i, j)] * columns[j]))
    }

    /// The direction nearest to `wanted` that the constraints allow, in the units of places.
    fn allowed(&mut self, place: &[f64], wanted: &DVector<f64>, rank: usize) -> Option<DVector<f64>> {
        let right = SingularValues::of(&self.at(place)?).right;
        let kept = right.rows(0, rank);
        let along = wanted - kept.transpose() * (kept * wanted);
        Some(self.columns.as_ref()?[1].component_mul(&along))
    }

    /// Whether the rank is the same behind a way from the start.
    fn keeps_rank(&mut self, start: &[f64], first: &DMatrix<f64>, rank: usize, way: u64) -> Option<bool> {
        let mut random = SplitMix::new(way);
        let wanted = DVector::from_fn(start.len(), |_, _| 2.0 * random.unit() - 1.0);
        let (mut place, mut step) = (DVector::from_column_slice(start), SAME);
        for _ in 0..ITERATIONS {
            // by Runge and Kutta's method
            let a = self.allowed(place.as_slice(), &wanted, rank)?;
            let b = self.allowed((&place + &a * (step / 2.0)).as_slice(), &wanted, rank)?;
            let c = self.allowed((&place + &b * (step / 2.0)).as_slice(), &wanted, rank)?;
            let d = self.allowed((&place + &c * step).as_slice(), &wanted, rank)?;
            place += (a + (b + c) * 2.0 + d) * (step / 6.0);
            if (self.at(place.as_slice())? - first).norm() > CHANGE * first.norm() {
                break;
            }
            step *= 2.0;
        }
        Some(SingularValues::of(&self.at(place.as_slice())?).rank(BEHIND) <= rank)
    }
}
