//! Points `(q, v, t, parameters)` on the constraints, and what their equations say there of `q̈`.

use decision::exact::Flaw;
use mechanics::State;
use symbolic::{Evaluator, Expr, Graph, SplitMix, Symbol};

use crate::number::{At, Number, constants, eliminate, values};
use crate::reading::Reading;

/// Why a point says nothing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Trouble {
    /// A number has no image, or the constraints have no solution that was found.
    NoPoint(String),
    /// Their equations have no solution there.
    Contradiction,
    /// These accelerations are not determined by their equations.
    Undetermined(Vec<String>),
}

impl Trouble {
    /// What is said of it.
    pub(crate) fn words(&self) -> String {
        match self {
            Trouble::NoPoint(why) => why.clone(),
            Trouble::Contradiction => {
                "no accelerations fulfil all of these equations where the constraints hold".into()
            }
            Trouble::Undetermined(names) => format!("these equations do not determine {}", names.join(", ")),
        }
    }
}

impl From<Flaw> for Trouble {
    fn from(flaw: Flaw) -> Self {
        Trouble::NoPoint(flaw.to_string())
    }
}

/// A state, and `q̈` by their equations.
pub(crate) struct Point<C> {
    /// Parameters, time, coordinates, velocities, unknowns with a rate.
    pub(crate) inputs: Vec<At<C>>,
    /// `q̈` of their variables.
    pub(crate) accelerations: Vec<C>,
    /// Texts of their constraints that do not hold there, although those of the scene do.
    pub(crate) broken: Vec<String>,
}

/// Expressions with their slopes by unknowns: as many, and as many times as many slopes.
pub(crate) struct Linear {
    pub(crate) outputs: Vec<Expr>,
    pub(crate) count: usize,
    pub(crate) unknowns: usize,
}

impl Linear {
    /// `es` at `unknowns` as they are (`at`), or where these are zero.
    pub(crate) fn new(g: &Graph, es: &[Expr], unknowns: &[Symbol], at: bool) -> Self {
        let zeros = unknowns.iter().map(|&s| (s, g.zero())).collect();
        let rest = if at { es.to_vec() } else { g.substitute_all(es, &zeros) };
        let outputs = [&rest[..], g.jacobian(es, unknowns).entries()].concat();
        Linear { outputs, count: es.len(), unknowns: unknowns.len() }
    }

    /// Whether an unknown is left in it.
    pub(crate) fn bends(&self, g: &Graph, unknowns: &[Symbol]) -> bool {
        let symbols = self.outputs.iter().flat_map(|&e| g.symbols_of(e));
        symbols.into_iter().any(|s| unknowns.contains(&s))
    }

    /// Rows of slopes, with the rest behind them.
    pub(crate) fn rows<C: Number>(&self, outputs: &[C]) -> Vec<Vec<C>> {
        let row = |i: usize| {
            let first = self.count + i * self.unknowns;
            [&outputs[first..first + self.unknowns], &[outputs[i]]].concat()
        };
        (0..self.count).map(row).collect()
    }
}

/// What is evaluated at points.
pub(crate) struct Frame<'r> {
    pub(crate) reading: &'r Reading,
    /// Parameters, time, coordinates, velocities, unknowns with a rate.
    pub(crate) inputs: Vec<Symbol>,
    /// Numbers near which floats are drawn.
    centres: Vec<f64>,
    leaf: Linear,
    velocities: Linear,
    kinematic: Linear,
    kinematic_text: Vec<String>,
    motion: Linear,
    supplied: Linear,
    /// Their equations that hold positions, and so need a point on a leaf.
    pub(crate) on_leaf: Vec<String>,
}

impl<'r> Frame<'r> {
    /// That of what was read; `start` has numbers near which floats are drawn.
    ///
    /// # Errors
    /// The text of an equation that is not linear in accelerations and unknowns.
    pub(crate) fn new(reading: &'r Reading, start: &State) -> Result<Self, String> {
        let g = &reading.system.graph;
        let column = |k: usize| reading.coordinates.iter().map(|c| c[k]).collect::<Vec<Symbol>>();
        let (q, v, a) = (column(0), column(1), column(2));
        let states: Vec<Symbol> = reading.states.iter().map(|s| s[0]).collect();
        let rates: Vec<Symbol> = reading.states.iter().map(|s| s[1]).collect();
        let unknowns = [&reading.multipliers[..], &rates, &a].concat();
        let contains = |e: Expr, of: &[Symbol]| of.iter().any(|&s| g.depends_on(e, s));
        let (mut moves, mut kinematic, mut leaf) = (Vec::new(), Vec::new(), Vec::new());
        for stated in reading.equations.iter().filter(|stated| !g.is_zero(stated.expression)) {
            let e = stated.expression;
            if contains(e, &unknowns) {
                moves.push(e);
            } else if contains(e, &v) || contains(e, &states) {
                kinematic.push(stated);
            } else {
                leaf.push(stated);
            }
        }
        let flow = reading.flow();
        let constraints = reading.of_scene(g, &reading.system.constraints);
        let on_leaf: Vec<String> = leaf.iter().map(|s| s.text.clone()).collect();
        let leaf: Vec<Expr> = leaf.iter().map(|s| s.expression).collect();
        let slides = g.total_derivatives(&leaf, &flow);
        let held: Vec<Expr> = kinematic.iter().map(|s| s.expression).collect();
        moves.extend(g.total_derivatives(&held, &flow));
        moves.extend(g.total_derivatives(&slides, &flow));
        let motion = Linear::new(g, &moves, &unknowns, false);
        if motion.bends(g, &unknowns) {
            let bent =
                |e: &&crate::reading::Stated| Linear::new(g, &[e.expression], &unknowns, false).bends(g, &unknowns);
            return Err(reading.equations.iter().find(bent).map_or(String::new(), |e| e.text.clone()));
        }
        let parameters = reading.parameters.iter().map(|p| p.0);
        let inputs: Vec<Symbol> =
            parameters.chain([reading.system.time]).chain(q.clone()).chain(v.clone()).chain(states.clone()).collect();
        let values = reading.parameters.iter().map(|p| p.1);
        let start = reading.system.values_at(start);
        let centre = |s: &Symbol| start.get(s).copied().unwrap_or(0.7);
        let centres = values.chain(inputs[reading.parameters.len()..].iter().map(centre)).collect();
        Ok(Frame {
            leaf: Linear::new(g, &leaf, &q, true),
            velocities: Linear::new(g, &[&constraints[..], &slides].concat(), &v, true),
            kinematic: Linear::new(g, &held, &states, false),
            kinematic_text: kinematic.iter().map(|s| s.text.clone()).collect(),
            supplied: Linear::new(g, &g.total_derivatives(&constraints, &flow), &a, false),
            motion,
            inputs,
            centres,
            reading,
            on_leaf,
        })
    }

    /// A point of its own for each seed; the start for `bits = 0`, in floats. Parameters may be those of the
    /// scene.
    pub(crate) fn draw<C: Number>(&self, seed: u64, bits: u32, own: bool) -> Result<Vec<At<C>>, Trouble> {
        let mut random = SplitMix::new(seed);
        let mut inputs: Vec<At<C>> = self.centres.iter().map(|&x| C::draw(&mut random, bits, x)).collect();
        for (input, &x) in inputs.iter_mut().zip(&self.centres[..if own { self.reading.parameters.len() } else { 0 }]) {
            *input = At::of(x);
        }
        let (n, first) = (self.reading.coordinates.len(), self.reading.parameters.len() + 1);
        self.solve(&self.leaf, &mut inputs, first..first + n)?;
        self.hold(&mut inputs)?;
        Ok(inputs)
    }

    /// Moves velocities until the constraints hold.
    pub(crate) fn hold<C: Number>(&self, inputs: &mut [At<C>]) -> Result<(), Trouble> {
        let (n, first) = (self.reading.coordinates.len(), self.reading.parameters.len() + 1);
        self.solve(&self.velocities, inputs, first + n..first + 2 * n)
    }

    /// Places of velocities that constraints linear in them leave free at a position.
    pub(crate) fn free_velocities<C: Number>(&self, inputs: &[At<C>]) -> Option<Vec<usize>> {
        let n = self.reading.coordinates.len();
        let outputs = values(&mut self.evaluator(&self.velocities).ok()?, inputs).ok()?;
        let mut rows = self.velocities.rows(&outputs);
        let pivots = eliminate(&mut rows, n);
        Some((0..n).filter(|j| !pivots.contains(j)).collect())
    }

    /// Parameters of `L`, `f` and `Q` that stand in none of their equations.
    pub(crate) fn absent(&self) -> Vec<String> {
        let g = &self.reading.system.graph;
        let [own, theirs] = self.formulas();
        let stands = |es: &[Expr], s: Symbol| es.iter().any(|&e| g.depends_on(e, s));
        let parameters = self.reading.parameters.iter().map(|p| p.0);
        parameters.filter(|&s| stands(&own, s) && !stands(&theirs, s)).map(|s| g.name(s)).collect()
    }

    /// Whether something stands under a root, or has a kink.
    pub(crate) fn has_roots(&self) -> bool {
        !self.reading.system.graph.ends_of_pieces(&self.formulas().concat()).is_empty()
    }

    /// Those of the scene, and theirs.
    fn formulas(&self) -> [Vec<Expr>; 2] {
        let system = &self.reading.system;
        let theirs = self.reading.equations.iter().map(|s| s.expression).collect();
        [self.reading.of_scene(&system.graph, &system.written()), theirs]
    }

    fn evaluator<C: Number>(&self, linear: &Linear) -> Result<Evaluator<At<C>>, Trouble> {
        let tape = self.reading.system.graph.compile(&self.inputs, &linear.outputs, &<_>::default());
        tape.map(Evaluator::new).map_err(|fault| Trouble::NoPoint(fault.to_string()))
    }

    /// Moves the inputs in `places` until `linear` vanishes: at once in a field, by Newton's steps in floats.
    fn solve<C: Number>(
        &self,
        linear: &Linear,
        inputs: &mut [At<C>],
        places: std::ops::Range<usize>,
    ) -> Result<(), Trouble> {
        if linear.count == 0 {
            return Ok(());
        }
        let mut program = self.evaluator(linear)?;
        for _ in 0..if C::PROVES { 2 } else { 40 } {
            let outputs = values(&mut program, inputs)?;
            if outputs[..linear.count].iter().all(|f| f.vanishes()) {
                return Ok(());
            }
            let mut rows = linear.rows(&outputs);
            let pivots = eliminate(&mut rows, linear.unknowns);
            for (row, &column) in rows.iter().zip(&pivots) {
                let x = &mut inputs[places.start + column];
                *x = constants(&[(x.coefficient(0) - row[linear.unknowns]).fresh()])[0];
            }
        }
        Err(Trouble::NoPoint("the constraints are not linear in the velocities, or hold positions".into()))
    }

    /// What their equations say at a state.
    pub(crate) fn at<C: Number>(&self, mut inputs: Vec<At<C>>) -> Result<Point<C>, Trouble> {
        let broken = self.unknown_states(&mut inputs)?;
        let outputs = values(&mut self.evaluator(&self.motion)?, &inputs)?;
        let mut rows = self.motion.rows(&outputs);
        let (all, n) = (self.motion.unknowns, self.reading.coordinates.len());
        // what is no acceleration is eliminated first
        let others = eliminate(&mut rows, all - n).len();
        let mut rows: Vec<Vec<C>> = rows[others..].iter().map(|row| row[all - n..].to_vec()).collect();
        let mut pivots = eliminate(&mut rows, n);
        if rows[pivots.len()..].iter().any(|row| !row[n].vanishes()) {
            return Err(Trouble::Contradiction);
        }
        rows.truncate(pivots.len());
        // the scene's constraints determine what theirs leave open
        if pivots.len() < n {
            let outputs = values(&mut self.evaluator(&self.supplied)?, &inputs)?;
            for row in self.supplied.rows(&outputs) {
                let known = rows.len();
                rows.push(row);
                pivots = eliminate(&mut rows, n);
                rows.truncate(pivots.len().max(known));
            }
        }
        let open: Vec<String> = (0..n)
            .filter(|j| !pivots.contains(j))
            .map(|j| self.reading.system.graph.name(self.reading.coordinates[j][2]))
            .collect();
        if !open.is_empty() {
            return Err(Trouble::Undetermined(open));
        }
        let mut accelerations = vec![C::ZERO; n];
        pivots.iter().zip(&rows).for_each(|(&j, row)| accelerations[j] = -row[n]);
        Ok(Point { inputs, accelerations, broken })
    }

    /// Solves kinematic equations for unknowns with a rate; the others keep their values. Which do not hold.
    fn unknown_states<C: Number>(&self, inputs: &mut [At<C>]) -> Result<Vec<String>, Trouble> {
        let linear = &self.kinematic;
        let first = inputs.len() - linear.unknowns;
        let outputs = values(&mut self.evaluator(linear)?, inputs)?;
        let mut rows = linear.rows(&outputs);
        let pivots = eliminate(&mut rows, linear.unknowns);
        for (row, &column) in rows.iter().zip(&pivots) {
            let others = (0..linear.unknowns).filter(|j| !pivots.contains(j));
            let rest = others.fold(row[linear.unknowns], |sum, j| sum + row[j] * inputs[first + j].coefficient(0));
            inputs[first + column] = constants(&[-rest])[0];
        }
        if rows[pivots.len()..].iter().all(|row| row[linear.unknowns].vanishes()) {
            return Ok(Vec::new());
        }
        // those without unknowns are constraints, each of which holds or not
        let alone =
            |i: &usize| outputs[linear.count + i * linear.unknowns..][..linear.unknowns].iter().all(|x| x.vanishes());
        let broken = (0..linear.count).filter(|i| alone(i) && !outputs[*i].vanishes());
        Ok(broken.map(|i| self.kinematic_text[i].clone()).collect())
    }
}
