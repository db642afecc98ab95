//! Power series of expressions along a motion: Taylor coefficients order by order.

pub(crate) mod build;
mod dual;
mod expansion;
mod lanes;
mod scalar;

use crate::programs::tape::{Tape, Workspace};
pub use dual::Dual;
use expansion::Expansion;
pub use lanes::{LANES, Lanes};
use scalar::Place;
pub use scalar::{Packs, Product, Products, SeriesScalar};

/// What an input of a [`SeriesTape`] is as a function of time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SeriesInput {
    /// Constant in time.
    Steady,
    /// Time itself: `t₀ + τ`.
    Time,
    /// A state; its rate is the output of this index: `x' = output`.
    State(usize),
    /// An unknown of the implicit equations (block) of this index.
    Unknown(usize),
}

/// A place in the outputs of order 0.
pub(crate) type Slot = u32;
/// A series.
pub(crate) type Row = u32;

/// What is known of an output: a multiple of a series, or a value that is constant in time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    Row(Row, Slot),
    Steady(Slot),
}

/// The products of the coefficients of two series, orders 0 left out, are a series as well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bilinear {
    pub(crate) left: Row,
    pub(crate) right: Row,
}

/// Terms of an addition with and without weights.
pub(crate) const TERMS: usize = 4;

/// `target = Σ plain + Σ weight · row`, of the same order, or `weight · unit · row` of the order before where
/// a term is late. A longer sum goes on from what is in its target already.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Addition {
    pub(crate) target: Row,
    /// How many there are of each.
    pub(crate) counts: [usize; 2],
    pub(crate) plain: [Row; TERMS],
    pub(crate) terms: [Term; TERMS],
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Term {
    pub(crate) weight: Slot,
    /// A series, or a product, numbered from the number of series on, in the order of the groups.
    pub(crate) row: Row,
    pub(crate) late: bool,
}

/// A series whose rate is known: a state, or a function of states.
#[derive(Clone, Copy, Debug)]
pub(crate) struct State {
    pub(crate) row: Row,
    pub(crate) rate: Source,
}

/// Series whose coefficients of one order are computed one after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    pub(crate) states: Vec<State>,
    /// Pairs without and with the factor 1/k.
    pub(crate) products: [Vec<Bilinear>; 2],
    /// (τ x', x)
    pub(crate) slopes: Vec<(Row, Row)>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Implicit {
    pub(crate) unknowns: Vec<Row>,
    pub(crate) residuals: Vec<Source>,
}

/// A flat program that computes Taylor coefficients of expressions whose inputs move by these expressions.
///
/// # How
/// At order 0 a [`Tape`] computes every value and partial derivative of an operation. Its order `k ≥ 1` is
///
/// ```text
/// c_k = Σ_m w_m · (operand m)_k + Σ_p s_p Σ_{i+j=k; i,j≥1} (a_p)_i (b_p)_j · (1 or 1/k)
/// ```
///
/// with weights `w`, `s` of order 0: a product has `w = (b₀, a₀)` and the one pair `(a, b)`; a quotient
/// `c = a/b`, from `b c = a`, `w = (1/b₀, −c₀/b₀)` and the pair `(b, c)` with `−1/b₀`; `e = exp a`, from
/// `e' = a' e`, `w = e₀` and the pair `(τ a', e)` with `1/k`. The other functions satisfy such equations,
/// too, some with a hidden series (`1 + tan²`, `√(1 − a²)`). So two loops, without dispatch on operations, do
/// all: over pairs (of orders below `k`, so none waits for another, and a pair that several values need is
/// multiplied once) and over sums.
///
/// A factor linear in time, as a state with a constant rate, has two coefficients: `(a b)_k = a₀ b_k + a₁
/// b_{k−1}`. A function of a linear combination of states is integrated, `(sin φ)' = φ' cos φ`: equations of
/// motion often contain the pair of that product already. A constant φ' needs none.
///
/// Sources: À. Jorba, M. Zou, *A software package for the numerical integration of ODEs by means of
/// high-order Taylor methods*, Exp. Math. 14 (2005), section 2; A. Griewank, A. Walther, *Evaluating
/// Derivatives*, 2nd ed., SIAM 2008, chapter 13.
///
/// # Time derivatives
/// A value may be declared to be the time derivative of another one, `d = x'`, as `S'` in the acceleration of
/// a velocity `S(q) w`: then `d_k = (k + 1) x_{k+1}`, over the unit of time, takes no product. For this, x is
/// computed one order ahead, as are the states in it, those whose rates need no such value and no unknown:
///
/// ```text
/// w_k → (rates of q)_k → q_{k+1} → x_{k+1} → d_k → unknowns and other rates.
/// ```
///
/// Order 0 of d comes from its own formula, as do all where x cannot be known in time.
///
/// # Implicit equations
/// Inputs may be unknowns `z` of blocks `R(z; …) = 0`. Order 0 is given; at order `k` the caller takes
/// `z_k = −(∂R/∂z)⁻¹ R_k` from the residual `R_k` at `z_k = 0` and `∂R/∂z` of order 0: it is linear in `z_k`.
#[derive(Clone, Debug)]
pub struct SeriesTape {
    /// Outputs: order 0 of each row, then what the slots name.
    pub(crate) first: Tape,
    pub(crate) rows: usize,
    pub(crate) inputs: Vec<Option<Row>>,
    pub(crate) time: Option<Row>,
    pub(crate) outputs: Vec<Source>,
    pub(crate) blocks: Vec<Implicit>,
    /// One order ahead; all others.
    pub(crate) groups: [Group; 2],
    pub(crate) additions: Vec<Addition>,
    /// Linear terms, an odd one in a sum counted twice.
    pub(crate) linear: usize,
    /// Ends of the additions one order ahead, without time derivatives, without unknowns, with those of block
    /// 0, of block 1 …
    pub(crate) stages: Vec<usize>,
    /// (x', x)
    pub(crate) derivatives: Vec<(Row, Row)>,
}

/// The series of one thread that works with one [`SeriesTape`].
#[derive(Clone, Debug)]
pub struct SeriesWorkspace<T: SeriesScalar> {
    /// Coefficients, series after series.
    rows: Vec<T>,
    packs: Packs,
    plan: Plan<T>,
}

/// The tape with places instead of numbers of rows, for one order, and what order 0 gives.
#[derive(Clone, Debug)]
struct Plan<T> {
    order: usize,
    stride: usize,
    registers: Workspace<T>,
    /// Outputs of order 0.
    values: Vec<T>,
    groups: [PlacedGroup<T>; 2],
    additions: Vec<Placed<T>>,
    derivatives: Vec<(Place, Place)>,
    /// 1/unit
    frequency: T,
    /// k and 1/k
    orders: Vec<(T, T)>,
    residual: Vec<T>,
}

#[derive(Clone, Debug)]
struct PlacedGroup<T> {
    /// State, rate, and the factor of the latter over the unit of time.
    states: Vec<(Place, Place, T)>,
    products: [Products; 2],
    slopes: Vec<(Place, Place)>,
}

/// An [`Addition`] with places of coefficients of order 1, or 0 where a term is late.
#[derive(Clone, Copy, Debug)]
struct Placed<T> {
    target: Place,
    /// [`Addition::counts`] as one number.
    kind: u8,
    plain: [Place; TERMS],
    terms: [Place; TERMS],
    weights: [T; TERMS],
}

impl<T: SeriesScalar> SeriesWorkspace<T> {
    /// The highest order of the states.
    pub fn order(&self) -> usize {
        self.plan.order
    }

    fn row(&self, row: Row) -> &[T] {
        &self.rows[row as usize * self.plan.stride..][..=self.plan.order]
    }
}

/// Solves the linear equations of an order: `(block, residual)`, to be overwritten by `−(∂R/∂z)⁻¹ residual`.
pub type Correct<'a, T> = &'a mut dyn FnMut(usize, &mut [T]);

impl SeriesTape {
    /// Number of inputs.
    pub fn inputs(&self) -> usize {
        self.inputs.len()
    }

    /// Number of outputs.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// What one order costs: products of series, and linear terms (an odd one in a sum counts as two).
    pub fn work(&self) -> (usize, usize) {
        let products = self.groups.iter().flat_map(|group| &group.products);
        (products.map(Vec::len).sum(), self.linear)
    }

    /// Room for states up to `order ≥ 1` (other values: one less).
    pub fn workspace<T: SeriesScalar>(&self, order: usize) -> SeriesWorkspace<T> {
        let (plan, used) = self.plan(order);
        let packs = if T::GROUP == LANES { used / plan.stride - self.rows } else { 0 };
        let room = plan.order;
        let factors = vec![Lanes([0.0; LANES]); 2 * room * packs];
        SeriesWorkspace { rows: vec![T::from_f64(0.0); used], packs: Packs { factors, room }, plan }
    }

    /// The same room for this order, if it is for another one.
    pub fn reorder<T: SeriesScalar>(&self, workspace: &mut SeriesWorkspace<T>, order: usize) {
        if workspace.order() != order {
            *workspace = self.workspace(order);
        }
    }

    /// The plan, and the number of coefficients that it uses.
    fn plan<T: SeriesScalar>(&self, order: usize) -> (Plan<T>, usize) {
        let order = order.max(1);
        let stride = (order + 1 + T::GROUP).next_multiple_of(T::GROUP);
        let zero = T::from_f64(0.0);
        let place = |place: usize| Place::try_from(place).expect("fewer than 2^32 coefficients");
        let at = |row: Row| place(row as usize * stride);
        // products of a list side by side, as many as a group takes
        let mut places: Vec<Place> = (0..self.rows as Row).map(at).collect();
        let mut used = self.rows;
        let mut products = |list: &Vec<Bilinear>| {
            let first = places.len();
            let target = |i: usize| place((used + i / T::GROUP) * stride + i % T::GROUP);
            places.extend((0..list.len()).map(target));
            let mut placed: Vec<Product> = list
                .iter()
                .zip(&places[first..])
                .map(|(p, target)| Product {
                    target: *target,
                    left: places[p.left as usize],
                    right: places[p.right as usize],
                })
                .collect();
            // what a group lacks is multiplied for nothing
            let groups = list.len().div_ceil(T::GROUP);
            placed.resize(groups * T::GROUP, Product::default());
            let from = used - self.rows;
            used += groups;
            Products { list: placed, from }
        };
        let pair = |&(a, b): &(Row, Row)| (at(a), at(b));
        let moving = |state: &State| match state.rate {
            Source::Row(rate, _) => Some((at(state.row), at(rate), zero)),
            Source::Steady(_) => None,
        };
        let groups = self.groups.each_ref().map(|group| PlacedGroup {
            states: group.states.iter().filter_map(moving).collect(),
            products: group.products.each_ref().map(&mut products),
            slopes: group.slopes.iter().map(pair).collect(),
        });
        let first = |row: &Row| places[*row as usize] + 1;
        let placed = |a: &Addition| Placed {
            target: first(&a.target),
            kind: (a.counts[0] * (TERMS + 1) + a.counts[1]) as u8,
            plain: a.plain.each_ref().map(first),
            terms: a.terms.each_ref().map(|term| first(&term.row) - Place::from(term.late)),
            weights: [zero; TERMS],
        };
        let plan = Plan {
            order,
            stride,
            registers: self.first.workspace(),
            values: vec![zero; self.first.outputs()],
            groups,
            additions: self.additions.iter().map(placed).collect(),
            derivatives: self.derivatives.iter().map(pair).collect(),
            frequency: zero,
            orders: (0..=order + 1).map(|k| T::from_f64(k as f64)).map(|k| (k, T::from_f64(1.0) / k)).collect(),
            residual: vec![zero; self.blocks.iter().map(|b| b.residuals.len()).max().unwrap_or(0)],
        };
        (plan, used * stride)
    }

    /// Computes all orders from the inputs at order 0, where unknowns must solve their equations.
    ///
    /// Coefficients are those of powers of `τ / unit`, with τ the time from where the inputs are given, so
    /// that they neither overflow nor underflow where `unit` is about as long as a step.
    ///
    /// `sweeps` corrections are made at each order of each block: one where `correct` is exact.
    ///
    /// # Panics
    /// If `inputs` has another length than the inputs, or the workspace is of another tape.
    pub fn expand<T: SeriesScalar>(
        &self,
        inputs: &[T],
        unit: T,
        workspace: &mut SeriesWorkspace<T>,
        sweeps: usize,
        correct: Correct<T>,
    ) {
        let SeriesWorkspace { rows, packs, plan } = workspace;
        assert!(
            plan.values.len() == self.first.outputs() && plan.additions.len() == self.additions.len(),
            "the workspace of another tape"
        );
        self.start(inputs, unit, rows, plan);
        let expansion = Expansion { tape: self, plan, packs, sweeps, correct };
        pulp::Arch::new().dispatch(
            #[inline(always)]
            move || expansion.run(rows),
        );
    }

    /// The coefficients of an input, orders 0 to that of the workspace; `None` if it is constant in time.
    pub fn input<'w, T: SeriesScalar>(&self, index: usize, workspace: &'w SeriesWorkspace<T>) -> Option<&'w [T]> {
        self.inputs[index].map(|row| workspace.row(row))
    }

    /// The coefficient of an output; orders up to one less than that of the workspace.
    pub fn output<T: SeriesScalar>(&self, index: usize, order: usize, workspace: &SeriesWorkspace<T>) -> T {
        match self.outputs[index] {
            Source::Row(row, factor) => workspace.row(row)[order] * workspace.plan.values[factor as usize],
            Source::Steady(slot) if order == 0 => workspace.plan.values[slot as usize],
            Source::Steady(_) => T::from_f64(0.0),
        }
    }

    /// Order 0, and all that is known from it.
    fn start<T: SeriesScalar>(&self, inputs: &[T], unit: T, rows: &mut [T], plan: &mut Plan<T>) {
        self.first.evaluate(inputs, &mut plan.registers, &mut plan.values);
        let values = &plan.values;
        let rows = &mut rows[..self.rows * plan.stride];
        for (row, value) in rows.chunks_exact_mut(plan.stride).zip(values) {
            row[0] = *value;
        }
        if let Some(time) = self.time {
            rows[time as usize * plan.stride + 1] = unit;
        }
        plan.frequency = T::from_f64(1.0) / unit;
        for (placed, group) in plan.groups.iter_mut().zip(&self.groups) {
            let mut moving = placed.states.iter_mut();
            for State { row, rate } in &group.states {
                match rate {
                    Source::Steady(slot) => rows[*row as usize * plan.stride + 1] = values[*slot as usize] * unit,
                    Source::Row(_, factor) => {
                        moving.next().expect("a place for each").2 = values[*factor as usize] * unit;
                    }
                }
            }
        }
        for (placed, addition) in plan.additions.iter_mut().zip(&self.additions) {
            for (placed, term) in placed.weights.iter_mut().zip(&addition.terms[..addition.counts[1]]) {
                let weight = values[term.weight as usize];
                *placed = if term.late { weight * unit } else { weight };
            }
        }
    }
}
