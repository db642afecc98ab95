//! Power series of expressions along a motion: Taylor coefficients order by order.

use crate::series_scalar::{LANES, Product, SeriesScalar, Task, Weights};
use crate::tape::{Tape, Workspace};

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

/// What is known of an output: a series, or a value that is constant in time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    Row(Row),
    Steady(Slot),
}

/// `target += scale · left · right`, orders 0 left out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bilinear {
    pub(crate) scale: Slot,
    pub(crate) target: Row,
    pub(crate) left: Row,
    pub(crate) right: Row,
}

/// A series whose coefficient is a sum of `weight · coefficient` of the same order, over `terms`, and of what products put there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Definition {
    pub(crate) row: Row,
    /// Where its products are added up; a row of zeros if it has none.
    pub(crate) products: Row,
    /// End of its terms; they begin where those of the definition before end.
    pub(crate) end: usize,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Implicit {
    pub(crate) unknowns: Vec<Row>,
    pub(crate) residuals: Vec<Source>,
}

/// A flat program that computes Taylor coefficients of expressions whose inputs move by these expressions.
///
/// # How
/// At order 0 every value and every partial derivative of one operation is computed by a [`Tape`]. Whatever the operation, its coefficient of order
/// `k ≥ 1` is
///
/// ```text
/// c_k = Σ_m w_m · (operand m)_k + Σ_p s_p Σ_{i+j=k; i,j≥1} (a_p)_i (b_p)_j · (1 or 1/k)
/// ```
///
/// with weights `w`, `s` of order 0: a product has `w = (b₀, a₀)` and the one pair `(a, b)`; a quotient `c = a/b`, from `b c = a`,
/// `w = (1/b₀, −c₀/b₀)` and the pair `(b, c)` with `−1/b₀`; `e = exp a`, from `e' = a' e`, `w = e₀` and the pair `(τ a', e)` with `1/k`. The other
/// functions satisfy such an equation, too, some with one hidden series (`1 + tan²`, `√(1 − a²)`). So there are two loops
/// and no dispatch on operations: over pairs (these need orders below `k` only, so that none waits for another) and over the linear terms.
/// Sums are taken into what uses them.
///
/// Sources: À. Jorba, M. Zou, *A software package for the numerical integration of ODEs by means of high-order Taylor methods*, Experimental
/// Mathematics 14 (2005), section 2; A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM 2008, chapter 13.
///
/// # Implicit equations
/// Inputs may be unknowns `z` of blocks `R(z; …) = 0`. Order 0 is given; at order `k` the residual with `z_k = 0` is handed to the caller, who takes
/// `z_k = −(∂R/∂z)⁻¹ R_k`, with `∂R/∂z` at order 0: `R_k` is linear in `z_k`, whatever `R` is.
#[derive(Clone, Debug)]
pub struct SeriesTape {
    /// Outputs: order 0 of each row, then what the slots name.
    pub(crate) first: Tape,
    pub(crate) rows: usize,
    pub(crate) inputs: Vec<Option<Row>>,
    pub(crate) time: Option<Row>,
    /// State and its rate.
    pub(crate) states: Vec<(Row, Source)>,
    pub(crate) outputs: Vec<Source>,
    pub(crate) blocks: Vec<Implicit>,
    /// Pairs without and with the factor 1/k.
    pub(crate) products: [Vec<Bilinear>; 2],
    pub(crate) definitions: Vec<Definition>,
    /// Ends of the definitions that depend on no unknown, on those of block 0, of block 1 …
    pub(crate) stages: Vec<usize>,
    pub(crate) terms: Vec<(Slot, Row)>,
    /// (τ x', x)
    pub(crate) slopes: Vec<(Row, Row)>,
}

/// The series of one thread that works with one [`SeriesTape`].
#[derive(Clone, Debug)]
pub struct SeriesWorkspace<T> {
    order: usize,
    stride: usize,
    registers: Workspace<T>,
    /// Outputs of order 0.
    values: Vec<T>,
    /// Coefficients, series after series.
    rows: Vec<T>,
    products: [Vec<Product>; 2],
    scales: [Vec<T>; 2],
    weights: Vec<T>,
    /// First coefficient of the operand of each term.
    operands: Vec<usize>,
    definitions: Vec<Placed>,
    /// Weights of pairs, `stride` a newest order, without and with 1/k.
    halves: [Vec<T>; 2],
    /// 1/k
    reciprocals: Vec<T>,
    residual: Vec<T>,
}

/// A [`Definition`] with the places of first coefficients.
#[derive(Clone, Copy, Debug)]
struct Placed {
    row: usize,
    products: usize,
    end: usize,
}

impl<T: SeriesScalar> SeriesWorkspace<T> {
    /// The highest order of the states.
    pub fn order(&self) -> usize {
        self.order
    }

    fn row(&self, row: Row) -> &[T] {
        &self.rows[row as usize * self.stride..][..=self.order]
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

    /// Number of products of series, and of linear terms, in one order: what an order costs.
    pub fn work(&self) -> (usize, usize) {
        (self.products[0].len() + self.products[1].len(), self.terms.len())
    }

    /// TEMP
    pub fn shape(&self) -> String { format!("pairs {}+{} defs {} rows {} slopes {} first {} ops {} outputs stages {:?}", self.products[0].len(), self.products[1].len(), self.definitions.len(), self.rows, self.slopes.len(), self.first.len(), self.first.outputs(), self.stages) }

    /// Room for states up to `order ≥ 1` (other values: one less).
    pub fn workspace<T: SeriesScalar>(&self, order: usize) -> SeriesWorkspace<T> {
        let order = order.max(1);
        let stride = (order + 1 + 2 * LANES).next_multiple_of(LANES);
        let zero = T::from_f64(0.0);
        let at = |row: Row| row as usize * stride;
        let place = |p: &Bilinear| Product { target: at(p.target), left: at(p.left), right: at(p.right) };
        let mut halves = [vec![zero; order * stride], vec![zero; order * stride]];
        for newest in 1..order {
            for j in 1..=newest {
                let half = if j == newest { T::from_f64(0.5) } else { T::from_f64(1.0) };
                halves[0][newest * stride + j] = half;
                halves[1][newest * stride + j] = half / T::from_f64((newest + j) as f64);
            }
        }
        SeriesWorkspace {
            order,
            stride,
            registers: self.first.workspace(),
            values: vec![zero; self.first.outputs()],
            rows: vec![zero; self.rows * stride],
            products: [0, 1].map(|i: usize| self.products[i].iter().map(place).collect()),
            scales: [0, 1].map(|i: usize| vec![zero; self.products[i].len()]),
            weights: vec![zero; self.terms.len()],
            definitions: self
                .definitions
                .iter()
                .map(|d| Placed { row: at(d.row), products: at(d.products), end: d.end })
                .collect(),
            operands: self.terms.iter().map(|(_, row)| at(*row)).collect(),
            halves,
            reciprocals: (0..=order).map(|k| T::from_f64(1.0) / T::from_f64(k as f64)).collect(),
            residual: vec![zero; self.blocks.iter().map(|b| b.residuals.len()).max().unwrap_or(0)],
        }
    }

    /// Computes the coefficients of all orders, from the inputs at order 0; unknowns must solve their equations there.
    ///
    /// Coefficients are those of powers of `τ / unit`, with τ the time from where the inputs are given, so that they neither
    /// overflow nor underflow where `unit` is about as long as a step.
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
        assert_eq!(workspace.rows.len(), self.rows * workspace.stride, "the workspace of another tape");
        T::dispatch(Expansion { tape: self, inputs, unit, workspace, sweeps, correct });
    }

    /// The coefficients of an input, orders 0 to that of the workspace; `None` if it is constant in time.
    pub fn input<'w, T: SeriesScalar>(&self, index: usize, workspace: &'w SeriesWorkspace<T>) -> Option<&'w [T]> {
        self.inputs[index].map(|row| workspace.row(row))
    }

    /// The coefficient of an output; orders up to one less than that of the workspace.
    pub fn output<T: SeriesScalar>(&self, index: usize, order: usize, workspace: &SeriesWorkspace<T>) -> T {
        self.coefficient(self.outputs[index], order, workspace)
    }

    #[inline(always)]
    fn coefficient<T: SeriesScalar>(&self, source: Source, order: usize, workspace: &SeriesWorkspace<T>) -> T {
        match source {
            Source::Row(row) => workspace.rows[row as usize * workspace.stride + order],
            Source::Steady(slot) if order == 0 => workspace.values[slot as usize],
            Source::Steady(_) => T::from_f64(0.0),
        }
    }

    #[inline(always)]
    fn start<T: SeriesScalar>(&self, inputs: &[T], unit: T, w: &mut SeriesWorkspace<T>) {
        self.first.evaluate(inputs, &mut w.registers, &mut w.values);
        w.rows.fill(T::from_f64(0.0));
        for (row, value) in w.rows.chunks_exact_mut(w.stride).zip(&w.values) {
            row[0] = *value;
        }
        if let Some(time) = self.time {
            w.rows[time as usize * w.stride + 1] = unit;
        }
        for (scales, products) in w.scales.iter_mut().zip(&self.products) {
            for (scale, product) in scales.iter_mut().zip(products) {
                *scale = w.values[product.scale as usize];
            }
        }
        for (weight, (slot, _)) in w.weights.iter_mut().zip(&self.terms) {
            *weight = w.values[*slot as usize];
        }
    }

    /// Pairs with a coefficient of order `k − 1`.
    #[inline(always)]
    fn multiply<T: SeriesScalar>(&self, w: &mut SeriesWorkspace<T>, k: usize) {
        let newest = k - 1;
        if newest == 0 {
            return;
        }
        for i in 0..2 {
            let weights = Weights { of: &w.halves[i][newest * w.stride..][..w.stride], plain: i == 0 };
            T::multiply(&mut w.rows, &w.products[i], &w.scales[i], weights, newest, w.order - 1);
        }
    }

    /// Linear terms of order `k` of the definitions from `from` to `to`.
    #[inline(always)]
    fn add_terms<T: SeriesScalar>(&self, w: &mut SeriesWorkspace<T>, k: usize, from: usize, to: usize) {
        let mut begin = if from == 0 { 0 } else { self.definitions[from - 1].end };
        for definition in &w.definitions[from..to] {
            let mut sum = w.rows[definition.products + k];
            for (weight, operand) in w.weights[begin..definition.end].iter().zip(&w.operands[begin..definition.end]) {
                sum = sum + *weight * w.rows[operand + k];
            }
            w.rows[definition.row + k] = sum;
            begin = definition.end;
        }
    }

    /// The unknowns of one block at order `k`, and what depends on them.
    #[inline(always)]
    fn solve<T: SeriesScalar>(&self, e: &mut Expansion<T>, k: usize, block: usize) {
        let (from, to) = (self.stages[block], self.stages[block + 1]);
        let Expansion { workspace: w, sweeps, correct, .. } = e;
        let Implicit { unknowns, residuals } = &self.blocks[block];
        for _ in 0..*sweeps {
            self.add_terms(w, k, from, to);
            for (i, source) in residuals.iter().enumerate() {
                w.residual[i] = self.coefficient(*source, k, w);
            }
            correct(block, &mut w.residual[..residuals.len()]);
            for (unknown, change) in unknowns.iter().zip(&w.residual) {
                let at = *unknown as usize * w.stride + k;
                w.rows[at] = w.rows[at] + *change;
            }
        }
        self.add_terms(w, k, from, to);
    }
}

struct Expansion<'a, 'c, T> {
    tape: &'a SeriesTape,
    inputs: &'a [T],
    unit: T,
    workspace: &'a mut SeriesWorkspace<T>,
    sweeps: usize,
    correct: Correct<'c, T>,
}

impl<T: SeriesScalar> Task for Expansion<'_, '_, T> {
    type Result = ();

    #[inline(always)]
    fn run(mut self) {
        let tape = self.tape;
        tape.start(self.inputs, self.unit, self.workspace);
        for k in 1..=self.workspace.order {
            if k < self.workspace.order {
                tape.multiply(self.workspace, k);
            }
            // Only now, so that no product waits for a coefficient that was just written.
            let w = &mut *self.workspace;
            let share = self.unit * w.reciprocals[k];
            for (state, rate) in &tape.states {
                let rate = tape.coefficient(*rate, k - 1, w);
                w.rows[*state as usize * w.stride + k] = rate * share;
            }
            if k == self.workspace.order {
                return;
            }
            tape.add_terms(self.workspace, k, 0, tape.stages[0]);
            for block in 0..tape.blocks.len() {
                tape.solve(&mut self, k, block);
            }
            let w = &mut *self.workspace;
            for (slope, of) in &tape.slopes {
                w.rows[*slope as usize * w.stride + k] = w.rows[*of as usize * w.stride + k] * T::from_f64(k as f64);
            }
        }
    }
}
