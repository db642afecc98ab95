//! From a recipe to a scene.
//!
//! With m independent coordinates `q_i` (first `q₁`, `q₂`) and dependent ones `q_d`, constraint r is
//!
//! ```text
//! f_r = d/dt (q_dr + ψ_r) − s_r(q₁) τ_r(t) (γ v₂ + β) ,
//! ```
//!
//! where `ψ_r` contains `q_i`, `q_d1 … q_dr` and, for some kinds, `t`, with small coefficients: `∂f/∂v_d` is
//! lower triangular with a positive diagonal, full rank everywhere. In `(q_i, y)`, `y_r = q_dr + ψ_r`, the
//! admissible directions are `X₁ = ∂₁`, `X₂ = ∂₂ + γ Σ s_r τ_r ∂_yr`, `T = ∂_t + β Σ s_r τ_r ∂_yr`, the
//! others `∂_i`. All brackets are those of `X₁` with the others, `ad_X₁ᵏ X₂ = γ Σ s_r⁽ᵏ⁾ τ_r ∂_yr`. So the
//! constraints with `s_r ≡ 0` are the integrals, the others completely nonintegrable where the Wronskian of
//! their `s_r′` is not zero: for distinct powers or frequencies of sines.

use std::collections::HashMap;

use mechanics::{Completion, State, System, View};
use scene::Scene;
use symbolic::{Expr, Function, Graph, Symbol};

mod removal;

use super::Kind;
use super::class::Sudden;
use super::feature::Part;
use super::recipe::{MassTerm, Recipe, Shape, Term};

/// Length of the run of a random scene.
pub const DURATION: f64 = 1.5;

/// Name of the removal that every random scene has, in the part of one written by hand.
pub const REMOVAL: &str = "random";

impl Recipe {
    /// The scene, with a start on its constraint and a removal of its own.
    pub fn scene(&self, name: &str) -> Scene {
        Builder::new(self).scene(name)
    }
}

struct Builder<'a> {
    recipe: &'a Recipe,
    system: System,
    independent: Vec<usize>,
    dependent: Vec<usize>,
    /// Coordinates that `L` and the coefficients of `f` may contain.
    occurring: Vec<usize>,
}

impl<'a> Builder<'a> {
    fn new(recipe: &'a Recipe) -> Self {
        let names: Vec<String> = (1..=recipe.n()).map(|i| format!("q{i}")).collect();
        let coordinates: Vec<(&str, &str)> = names.iter().map(|name| (name.as_str(), "1")).collect();
        let system = System::new(Graph::new(), &coordinates);
        let (independent, dependent) = (recipe.independent(), recipe.dependent());
        let mut occurring = independent.clone();
        if recipe.kind != Kind::ChaplyginIntegrable {
            let kept = dependent.len().saturating_sub(usize::from(recipe.cyclic));
            occurring.extend(&dependent[..kept]);
        }
        Builder { recipe, system, independent, dependent, occurring }
    }

    fn q(&self, i: usize) -> Expr {
        self.system.graph.variable(self.system.coordinates[i].position)
    }

    fn v(&self, i: usize) -> Expr {
        self.system.graph.variable(self.system.coordinates[i].velocity)
    }

    fn time(&self) -> Expr {
        self.system.graph.variable(self.system.time)
    }

    /// `shape(q_first [+ q_second])`, places among `allowed`.
    fn shape(&self, shape: Shape, first: usize, second: Option<usize>, allowed: &[usize]) -> Expr {
        let g = &self.system.graph;
        let at = |place: usize| self.q(allowed[place % allowed.len()]);
        let argument = second.map_or(at(first), |second| g.add(at(first), at(second)));
        match shape {
            Shape::Linear => argument,
            Shape::Sine => g.call(Function::Sin, argument),
            Shape::Cosine => g.call(Function::Cos, argument),
        }
    }

    fn term(&self, term: &Term, allowed: &[usize]) -> Expr {
        let g = &self.system.graph;
        g.mul(g.ratio(term.coefficient, 16), self.shape(term.shape, term.first, term.second, allowed))
    }

    /// `1 + numerator/16 sin q_place`.
    fn factor(&self, numerator: i64, place: usize, allowed: &[usize]) -> Expr {
        let g = &self.system.graph;
        g.add(g.one(), g.mul(g.ratio(numerator, 16), self.shape(Shape::Sine, place, None, allowed)))
    }

    fn lagrangian(&self) -> Expr {
        let g = &self.system.graph;
        let n = self.recipe.n();
        let mut terms = Vec::new();
        for i in 0..n {
            let mass = g.ratio(8 + self.recipe.masses[i], 16);
            terms.push(g.mul(mass, g.powi(self.v(i), 2)));
        }
        for MassTerm { weight, ratio, first, second, place } in &self.recipe.mass_terms {
            let speed = g.add(self.v(first % n), g.mul(g.ratio(*ratio, 8), self.v(second % n)));
            let variation = place.map_or(g.one(), |place| self.factor(8, place, &self.occurring));
            terms.push(g.product(&[g.ratio(*weight, 16), g.powi(speed, 2), variation]));
        }
        for term in &self.recipe.gyroscopic {
            let coefficient = self.term(&Term { second: None, ..term.clone() }, &self.occurring);
            terms.push(g.mul(coefficient, self.v(term.second.unwrap_or(0) % n)));
        }
        terms.extend(self.recipe.potential.iter().map(|term| self.term(term, &self.occurring)));
        if self.recipe.kind == Kind::TimeDependent && self.recipe.driving > 0 {
            let strength = g.ratio(self.recipe.driving, 8);
            terms.push(g.product(&[strength, self.q(self.independent[0]), g.call(Function::Cos, self.time())]));
        }
        terms.extend(self.later());
        let last = g.powi(self.v(n - 1), 2);
        terms.push(g.mul(self.switched(Part::Kinetic, 16), last));
        terms.push(g.mul(self.rooted(Part::Kinetic, &self.occurring), last));
        terms.push(g.mul(self.switched(Part::Potential, 32), self.to_the_switch()[1]));
        terms.push(self.rooted(Part::Potential, &self.occurring));
        g.sum(&terms)
    }

    /// What `L` has of [`crate::Classes`].
    fn later(&self) -> Vec<Expr> {
        let (g, drawn, first) = (&self.system.graph, &self.recipe.drawn, self.independent[0]);
        let mut terms = Vec::new();
        if let Some((pull, inertia)) = drawn.driven {
            let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| g.call(function, self.time()));
            let varying = g.mul(g.powi(self.v(first), 2), g.add(g.integer(2), sine));
            terms.push(g.product(&[g.ratio(pull, 16), self.q(first), cosine]));
            terms.push(g.mul(g.ratio(inertia, 32), varying));
        }
        if let Some(Sudden { strength, sharpness, at }) = drawn.sudden {
            let passed = g.sub(self.time(), g.number(self.after(at)));
            let width = g.number(DURATION * 10_f64.powi(-sharpness));
            let on = g.add(g.one(), g.call(Function::Tanh, g.div(passed, width)));
            terms.push(g.product(&[g.ratio(strength, 32), self.q(first), on]));
        }
        if drawn.indefinite {
            // more than what else, by the constraints too, moves with v₁
            let inertia = 4 + 4 * self.dependent.len() as i64;
            terms.push(g.mul(g.integer(-inertia), g.powi(self.v(first), 2)));
        }
        terms.extend(drawn.quartic.map(|(c, place)| g.mul(g.ratio(c, 64), g.powi(self.v(place % self.recipe.n()), 4))));
        terms
    }

    /// `s_r(q₁) τ_r(t) (γ v₂ + β)`: what is not integrable of constraint `r`.
    fn nonintegrable(&self, r: usize) -> Expr {
        let g = &self.system.graph;
        let row = &self.recipe.rows[r];
        if r < self.recipe.integrals() {
            return g.zero();
        }
        let first = self.independent[0];
        // powers of what is far are no well-conditioned functions
        let q1 = g.sub(self.q(first), g.integer(self.recipe.shift(first)));
        let order = (r + 1 - self.recipe.integrals()) as i64;
        // high powers are large, or nothing
        let function = if self.recipe.rows[0].power && self.recipe.drawn.more == 0 {
            g.powi(q1, order as i32)
        } else {
            g.call(Function::Sin, g.mul(g.ratio(order + 1, 2), q1))
        };
        let motion = match self.recipe.kind {
            Kind::TimeDependent if row.time > 0 => {
                let rate = g.mul(g.ratio(row.time, 8), self.time());
                g.add(g.one(), g.mul(g.ratio(1, 2), g.call(Function::Sin, rate)))
            }
            _ => g.one(),
        };
        let along = self.independent.get(1).map_or(g.zero(), |&i| g.mul(g.ratio(self.recipe.along, 8), self.v(i)));
        let drift = if self.recipe.kind.has_drift() { g.ratio(self.recipe.drift, 8) } else { g.zero() };
        let switch = g.add(g.one(), self.switched(Part::Constraints, 8));
        g.product(&[g.ratio(row.curvature, 8), function, motion, switch, g.add(along, drift)])
    }

    /// `strength/over · σ` for its part. It is in `q₁` or in `t`, and on after `at/8` of the run at the start
    /// velocity.
    fn switched(&self, part: Part, over: i64) -> Expr {
        let g = &self.system.graph;
        self.recipe.features.switched(g, part, over, self.to_the_switch())
    }

    /// What has passed of that in which the switch is, and what passes until it is on.
    fn to_the_switch(&self) -> [Expr; 2] {
        let g = &self.system.graph;
        let (at, timed) = self.recipe.features.switch.as_ref().map_or((1, false), |switch| (switch.at, switch.timed));
        match timed && self.recipe.moves() {
            true => [g.sub(self.time(), g.integer(self.recipe.first_time())), g.ratio(3 * at, 16)],
            false => [self.passed(self.independent[0]), g.ratio(3 * at * self.recipe.velocities[0], 128)],
        }
    }

    /// The root and the rare function for their part, in one of the `allowed` coordinates each.
    fn rooted(&self, part: Part, allowed: &[usize]) -> Expr {
        let g = &self.system.graph;
        let passed = |place: usize| self.passed(allowed[place % allowed.len()]);
        let clock = self.recipe.moves().then(|| g.sub(self.time(), g.integer(self.recipe.first_time())));
        self.recipe.features.rooted(g, part, passed, clock)
    }

    /// The time after this number of eighths of the run.
    fn after(&self, eighths: i64) -> f64 {
        self.recipe.first_time() as f64 + eighths as f64 * DURATION / 8.0
    }

    /// `q_i − q_i(t₀)`
    fn passed(&self, i: usize) -> Expr {
        let g = &self.system.graph;
        g.sub(self.q(i), g.ratio(self.recipe.first_position(i), 8))
    }

    /// Rates of the dependent coordinates, by the constraints, in the rates `of_independent` of the others.
    fn dependent_rates(&self, of_independent: &[Expr]) -> Vec<Expr> {
        let g = &self.system.graph;
        if self.recipe.kind == Kind::Nonlinear {
            let rate = |r: usize| self.recipe.drawn.surface.rate(g, self.slope(r), of_independent);
            return (0..self.dependent.len()).map(rate).collect();
        }
        let mut rates: Vec<(Symbol, Expr)> = vec![(self.system.time, g.one())];
        rates.extend(self.independent.iter().zip(of_independent).map(|(&i, &v)| (self.position(i), v)));
        let as_rates: HashMap<Symbol, Expr> =
            self.independent.iter().zip(of_independent).map(|(&i, &v)| (self.velocity(i), v)).collect();
        for (r, &d) in self.dependent.iter().enumerate() {
            let psi = self.psi(r);
            let known = g.total_derivative(psi, &rates);
            let coefficient = g.add(g.one(), g.derivative(psi, self.position(d)));
            let rate = g.div(g.sub(g.substitute(self.nonintegrable(r), &as_rates), known), coefficient);
            rates.push((self.position(d), rate));
        }
        rates.split_off(1 + self.independent.len()).into_iter().map(|(_, rate)| rate).collect()
    }

    fn position(&self, i: usize) -> Symbol {
        self.system.coordinates[i].position
    }

    fn velocity(&self, i: usize) -> Symbol {
        self.system.coordinates[i].velocity
    }

    /// `ψ_r(q, t)`.
    fn psi(&self, r: usize) -> Expr {
        let g = &self.system.graph;
        let row = &self.recipe.rows[r];
        let allowed: Vec<usize> =
            self.occurring.iter().copied().filter(|i| !self.dependent[r + 1..].contains(i)).collect();
        let mut terms: Vec<Expr> = row.potential.iter().map(|term| self.term(term, &allowed)).collect();
        if self.recipe.moves() && row.time > 0 {
            let along = self.q(self.independent[0]);
            terms.push(g.product(&[g.ratio(row.time, 16), g.call(Function::Sin, g.add(self.time(), along))]));
        }
        if r < self.recipe.integrals() {
            terms.push(g.mul(self.switched(Part::Constraints, 32), self.to_the_switch()[1]));
        }
        terms.push(self.rooted(Part::Constraints, &allowed));
        g.sum(&terms)
    }

    /// `c_r(q)` of the nonlinear kind, positive.
    fn slope(&self, r: usize) -> Expr {
        let g = &self.system.graph;
        let row = &self.recipe.rows[r];
        let place = row.potential.first().map_or(0, |term| term.first);
        let varying = row.potential.first().map_or(0, |term| 2 * term.coefficient);
        let more = [self.switched(Part::Constraints, 8), self.rooted(Part::Constraints, &self.occurring)];
        let factor = g.sum(&[self.factor(varying, place, &self.occurring), more[0], more[1]]);
        g.mul(g.ratio(row.curvature.abs(), 8), factor)
    }

    fn constraints(&self) -> Vec<Expr> {
        let g = &self.system.graph;
        let rows: Vec<Expr> = (0..self.dependent.len())
            .map(|r| {
                if self.recipe.kind == Kind::Nonlinear {
                    let along: Vec<Expr> = self.independent.iter().map(|&i| self.v(i)).collect();
                    let v_d = self.v(self.dependent[r]);
                    return self.recipe.drawn.surface.constraint(g, v_d, self.slope(r), &along);
                }
                let flow = self.system.flow();
                let exact = g.add(self.q(self.dependent[r]), self.psi(r));
                g.sub(g.total_derivative(exact, &flow), self.nonintegrable(r))
            })
            .collect();
        match self.recipe.kind {
            Kind::HiddenIntegrable | Kind::PartlyIntegrable => self.recombined(&rows),
            _ if self.recipe.drawn.mixed => self.recombined(&rows),
            Kind::NearRankLoss => {
                let mut rows = rows;
                let closeness = self.recipe.drawn.closeness.unwrap_or(self.recipe.closeness);
                let angle = g.number(10f64.powi(-closeness));
                rows[1] = g.add(rows[0], g.mul(angle, rows[1]));
                rows
            }
            _ => rows,
        }
    }

    /// `G f`: `G` is lower triangular, the diagonal `1 + ¼ sin q₁`, then upper triangular with ones.
    fn recombined(&self, rows: &[Expr]) -> Vec<Expr> {
        let g = &self.system.graph;
        let mut rows = rows.to_vec();
        let mut entries = self.recipe.mixing.iter();
        let q1 = &self.independent[..1];
        for r in 0..rows.len() {
            for s in 0..r {
                let Some(&(coefficient, varies)) = entries.next() else { continue };
                let factor = if varies { self.factor(8, 0, q1) } else { g.one() };
                let entry = g.mul(g.ratio(coefficient, 8), factor);
                rows[r] = g.add(rows[r], g.mul(entry, rows[s]));
            }
        }
        for r in 0..rows.len() {
            rows[r] = g.mul(self.factor(4, 0, q1), rows[r]);
            if let Some(&next) = rows.get(r + 1) {
                rows[r] = g.add(rows[r], g.mul(g.ratio(self.recipe.mixing[r].0, 8), next));
            }
        }
        rows
    }

    fn start(&self) -> State {
        let eighths = |x: i64| x as f64 / 8.0;
        let (n, t) = (self.recipe.n(), self.recipe.first_time() as f64);
        let q: Vec<f64> = (0..n).map(|i| eighths(self.recipe.first_position(i))).collect();
        let mut v = vec![0.0; n];
        for (&i, x) in self.independent.iter().zip(self.recipe.first_velocities()) {
            v[i] = eighths(x);
        }
        let independent: Vec<Expr> = self.independent.iter().map(|&i| self.v(i)).collect();
        let values = self.system.values_at(&State { t, q: q.clone(), v: v.clone() });
        for (&d, rate) in self.dependent.iter().zip(self.dependent_rates(&independent)) {
            v[d] = self.system.graph.evaluate(rate, &values).unwrap_or(f64::NAN);
        }
        State { t, q, v }
    }

    /// Start velocities, roots unevaluated; empty where constraints are linear: solved in exact numbers.
    fn written(&self) -> Vec<(Symbol, Expr)> {
        if self.recipe.kind != Kind::Nonlinear {
            return Vec::new();
        }
        let g = &self.system.graph;
        let given = self.recipe.velocities.iter().map(|&x| g.ratio(x, 8));
        let independent: Vec<Expr> = given.take(self.independent.len()).collect();
        let dependent = self.dependent_rates(&independent);
        let places = self.independent.iter().chain(&self.dependent);
        places.map(|&i| self.velocity(i)).zip(independent.into_iter().chain(dependent)).collect()
    }

    fn scene(mut self, name: &str) -> Scene {
        self.system.lagrangian = self.lagrangian();
        self.system.constraints = self.constraints();
        self.system.forces = self.recipe.drawn.forces(&self.system);
        // one outside of the run does not count
        self.system.breakpoints =
            self.recipe.drawn.sudden.iter().flat_map(|sudden| [self.after(sudden.at), self.after(-1)]).collect();
        let (removal, start) = (self.removal(), self.start());
        Scene {
            name: name.into(),
            title: format!("Random system, {}", self.recipe.kind),
            source: String::new(),
            notes: String::new(),
            start,
            completion: Completion { written: self.written(), ..Completion::default() },
            removals: vec![removal],
            multipliers: self.recipe.multipliers[..self.dependent.len()].iter().map(|&x| x as f64 / 8.0).collect(),
            duration: DURATION,
            film: Vec::new(),
            view: View::default(),
            meant: None,
            system: self.system,
        }
    }
}
