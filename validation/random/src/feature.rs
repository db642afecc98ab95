//! What a part of the random systems has besides: a switch, a root, a rare function, a start far from the
//! origin.
//!
//! A switch `σ(U)` is off to the last digit where `U = −1`, at the start, and on where `U = 0`. It depends on
//! `q₁`, `U = (q₁ − c)/(c − q₁(t₀))` with `c` on the way that the start velocity takes, or, where time may
//! enter, on `t`. A root is `√(4 + q_i − q_i(t₀))`: real along the way, for far starts nowhere near zero.

use proptest::prelude::*;
use symbolic::{Expr, Function, Graph};

use crate::writings::{WRITINGS, Writing};

/// How a switch goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// `(1 + tanh 20U)/2`
    Tanh,
    /// `exp(−38 U²)`
    Bump,
    /// On for `0 < U < ½`, as `step` has it.
    Step,
}

/// Functions that are written rarely, of what a coordinate has passed, `u`, and of `s`: the time that has
/// passed, or `u²/4` where nothing depends on time.
pub const FORMS: [&str; 14] = [
    "2^(-u/4)",
    "(1/2)^(s/3)",
    "10^(-3*s)",
    "pi^(u/8)",
    "cos(u)^24",
    "(1 + cos(u)/2)^(5/2)",
    "atan2(u, 2 + u^2)",
    "atan2(sin(u), 2 + cos(u))",
    "(1 + u^2)^(u/8)",
    "pow(2 + sin(u), -1/3)",
    "log(1 + exp(u))",
    "asin(tanh(u)/2)",
    "acosh(2 + u^2)",
    "1/(1 + sinh(u/4)^2)",
];

/// Of what a switch, a root or a rare function is a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The constraints: the nonintegrable part of each that has one, the potential `ψ` of the others.
    Constraints,
    /// The kinetic energy.
    Kinetic,
    /// The potential energy.
    Potential,
}

/// Something that is off at the start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Switch {
    /// How it goes.
    pub edge: Edge,
    /// Where it is.
    pub part: Part,
    /// Its strength in eighths, positive.
    pub strength: i64,
    /// When it is reached at the start velocity, in eighths of the run.
    pub at: i64,
    /// Whether it depends on time, where that may enter.
    pub timed: bool,
}

/// A root that is real along the way.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Root {
    /// Where it is.
    pub part: Part,
    /// Its factor in sixteenths, positive.
    pub coefficient: i64,
    /// The coordinate, counted among those allowed.
    pub place: usize,
}

/// One of [`FORMS`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form {
    /// Which.
    pub which: usize,
    /// Where and of what it is, and its factor.
    pub as_root: Root,
}

/// A start far from the origin.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Far {
    /// What is added to the coordinates.
    pub positions: Vec<i64>,
    /// The time of the start.
    pub time: i64,
}

/// What a system has besides.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Features {
    /// Something that begins on the way, if anything does.
    pub switch: Option<Switch>,
    /// A root, if there is one.
    pub root: Option<Root>,
    /// A rare function, if there is one.
    pub form: Option<Form>,
    /// Where the start is, if it is far from the origin.
    pub far: Option<Far>,
    /// Whether its sentences are held against those of another writing, and which.
    pub writing: Option<usize>,
}

impl Features {
    /// In words, for reports.
    pub fn names(&self) -> Vec<&'static str> {
        let names = ["a switch", "a root", "a rare function", "a start far from the origin"];
        let has = [self.switch.is_some(), self.root.is_some(), self.form.is_some(), self.far.is_some()];
        let own = names.into_iter().zip(has).filter(|(_, has)| *has).map(|(name, _)| name);
        own.chain(self.writing().map(|_| "another writing")).collect()
    }

    /// The other writing.
    pub fn writing(&self) -> Option<&'static Writing> {
        self.writing.map(|i| &WRITINGS[i % WRITINGS.len()])
    }

    /// What is added to the start of coordinate `i`.
    pub fn shift(&self, i: usize) -> i64 {
        self.far.as_ref().map_or(0, |far| far.positions[i % far.positions.len()])
    }

    /// `t₀`.
    pub fn time(&self) -> i64 {
        self.far.as_ref().map_or(0, |far| far.time)
    }

    /// `strength/over · σ` if the switch is in `part`, else zero; `passed` since the start, `way` until it
    /// is on.
    pub(crate) fn switched(&self, g: &Graph, part: Part, over: i64, [passed, way]: [Expr; 2]) -> Expr {
        let Some(switch) = self.switch.as_ref().filter(|switch| switch.part == part) else { return g.zero() };
        let u = g.sub(g.div(passed, way), g.one());
        let edge = |behind: Expr| g.call(Function::Tanh, g.mul(g.integer(20), g.sub(u, behind)));
        let sigma = match switch.edge {
            Edge::Tanh => g.mul(g.ratio(1, 2), g.add(g.one(), edge(g.zero()))),
            Edge::Bump => g.call(Function::Exp, g.mul(g.integer(-38), g.powi(u, 2))),
            Edge::Step => g.mul(g.ratio(1, 2), g.sub(edge(g.zero()), edge(g.ratio(1, 2)))),
        };
        g.mul(g.ratio(switch.strength, over), sigma)
    }

    /// `coefficient/16 √(4 + passed)` and `coefficient/16` times the rare function, as far as they are in
    /// `part`; `passed` by the coordinate at the place it is given, `clock` is the time that has passed.
    pub(crate) fn rooted(&self, g: &Graph, part: Part, passed: impl Fn(usize) -> Expr, clock: Option<Expr>) -> Expr {
        let term = |root: &Root, of: &dyn Fn(Expr) -> Expr| match root.part == part {
            true => g.mul(g.ratio(root.coefficient, 16), of(passed(root.place))),
            false => g.zero(),
        };
        let root = self.root.iter().map(|root| term(root, &|u| g.sqrt(g.add(g.integer(4), u))));
        let form = self.form.iter().map(|form| term(&form.as_root, &|u| form.of(g, u, clock)));
        g.sum(&root.chain(form).collect::<Vec<_>>())
    }
}

impl Form {
    fn of(&self, g: &Graph, u: Expr, clock: Option<Expr>) -> Expr {
        let quarter = g.mul(g.ratio(1, 4), g.powi(u, 2));
        let scope = |name: &str| match name {
            "u" => Some(u),
            "s" => Some(clock.unwrap_or(quarter)),
            _ => None,
        };
        let read = g.parse(FORMS[self.which % FORMS.len()], &scope);
        read.unwrap_or_else(|fault| unreachable!("a rare function cannot be read: {fault}"))
    }
}

fn part() -> impl Strategy<Value = Part> {
    prop_oneof![2 => Just(Part::Constraints), 1 => Just(Part::Kinetic), 1 => Just(Part::Potential)]
}

/// A switch, a root, a far start: each on a part of the systems, with a limit on the number of coordinates.
pub(crate) fn features(most: usize) -> impl Strategy<Value = Features> {
    let edge = prop_oneof![Just(Edge::Tanh), Just(Edge::Bump), Just(Edge::Step)];
    let switch = (edge, part(), 2..=8_i64, 2..=6_i64, any::<bool>())
        .prop_map(|(edge, part, strength, at, timed)| Switch { edge, part, strength, at, timed });
    let root = root(most);
    let far = prop_oneof![24..=36_i64, -36..=-24_i64];
    let far = (prop::collection::vec(far, most), 16..=24_i64).prop_map(|(positions, time)| Far { positions, time });
    let (switch, root) = (prop::option::weighted(0.12, switch), prop::option::weighted(0.12, root));
    let all = (switch, root, prop::option::weighted(0.2, far));
    all.prop_map(|(switch, root, far)| Features { switch, root, far, form: None, writing: None })
}

fn root(most: usize) -> impl Strategy<Value = Root> {
    (part(), 1..=4_i64, 0..most).prop_map(|(part, coefficient, place)| Root { part, coefficient, place })
}

/// A rare function on a part of the systems.
pub(crate) fn form(most: usize) -> impl Strategy<Value = Option<Form>> {
    let form = (0..FORMS.len(), root(most)).prop_map(|(which, as_root)| Form { which, as_root });
    prop::option::weighted(0.15, form)
}
