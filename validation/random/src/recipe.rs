//! Recipes of random systems: plain data with a proptest strategy, so that they can be drawn and shrunk.
//!
//! A recipe holds material for the largest system; a smaller one leaves the rest unused. So every part
//! shrinks alone, the number of coordinates too: towards fewer coordinates, fewer terms, rounder numbers.

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

use super::class::{Classes, classes};
use super::feature::{Features, features, form};
use super::{Kind, Truth};

/// Most coordinates of a random system, except those of the class that has more.
pub const MOST: usize = 6;

/// Most coordinates of that class.
pub const LARGEST: usize = 10;

/// A function of one coordinate, or of the sum of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `x`
    Linear,
    /// `sin x`
    Sine,
    /// `cos x`
    Cosine,
}

/// `coefficient · shape(q_first [+ q_second])`; places count modulo the number of coordinates allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    /// In sixteenths.
    pub coefficient: i64,
    /// The function.
    pub shape: Shape,
    /// First coordinate.
    pub first: usize,
    /// Second coordinate.
    pub second: Option<usize>,
}

/// `½ weight (v_first + ratio v_second)² (1 + ½ shape(q_place))`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MassTerm {
    /// In eighths, not negative.
    pub weight: i64,
    /// In eighths.
    pub ratio: i64,
    /// First velocity.
    pub first: usize,
    /// Second velocity.
    pub second: usize,
    /// The coordinate on which the term depends, if it does.
    pub place: Option<usize>,
}

/// One constraint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// `ψ`.
    pub potential: Vec<Term>,
    /// Strength of the part that is not integrable, in eighths; not zero.
    pub curvature: i64,
    /// Whether that part is a power of `q₁`, rather than a sine.
    pub power: bool,
    /// Rate of the explicit dependence on time, in eighths.
    pub time: i64,
}

/// Everything that a random system is made from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// What is known of it.
    pub kind: Kind,
    /// Number of coordinates, n, unless [`Classes::more`] has more.
    pub coordinates: usize,
    /// Picks the number of constraints among those that the kind allows.
    pub constraints: usize,
    /// Order of the coordinates: first the independent ones, then the dependent.
    pub order: Vec<usize>,
    /// Constant masses above 1, in eighths.
    pub masses: Vec<i64>,
    /// Further kinetic energy.
    pub mass_terms: Vec<MassTerm>,
    /// Terms of the potential energy.
    pub potential: Vec<Term>,
    /// Terms `coefficient · shape(q_first) · v_second`, linear in the velocities.
    pub gyroscopic: Vec<Term>,
    /// Strength of a potential that depends on time, in eighths.
    pub driving: i64,
    /// Constraints.
    pub rows: Vec<Row>,
    /// Recombination: entries under the diagonal in eighths, and whether each varies with `q₁`.
    pub mixing: Vec<(i64, bool)>,
    /// Strength of the velocity in the nonintegrable part, in eighths.
    pub along: i64,
    /// Strength of the drift in the nonintegrable part, in eighths; not zero.
    pub drift: i64,
    /// `−log₁₀` of the angle between two nearly dependent constraints.
    pub closeness: i32,
    /// One dependent coordinate occurs in neither `L` nor the coefficients of `f`.
    pub cyclic: bool,
    /// Hand-written removal: entries under the diagonal and on it, in sixteenths, of `v_i = S(q) u̇`.
    pub removal: Vec<(i64, usize)>,
    /// Start positions in eighths.
    pub positions: Vec<i64>,
    /// Start velocities of the independent coordinates in eighths; the first is not zero.
    pub velocities: Vec<i64>,
    /// Vakonomic multipliers at the start, in eighths.
    pub multipliers: Vec<i64>,
    /// Costates at the start, in eighths.
    pub costates: Vec<i64>,
    /// What it has besides.
    pub features: Features,
    /// What it has of what was drawn later.
    pub drawn: Classes,
}

impl Recipe {
    /// n.
    pub fn n(&self) -> usize {
        match self.drawn.more {
            0 => self.coordinates.max(self.kind.fewest_coordinates()),
            more => MOST + more,
        }
    }

    /// h.
    pub fn h(&self) -> usize {
        let (least, most) = self.kind.constraints(self.n()).unwrap_or((0, 0));
        least + self.constraints % (most - least + 1)
    }

    /// Indices of the independent coordinates, m = n − h of them.
    pub fn independent(&self) -> Vec<usize> {
        self.ordered()[..self.n() - self.h()].to_vec()
    }

    /// Indices of the dependent coordinates, one per constraint.
    pub fn dependent(&self) -> Vec<usize> {
        self.ordered()[self.n() - self.h()..].to_vec()
    }

    /// What Frobenius' test has to find.
    pub fn truth(&self) -> Truth {
        match self.kind {
            Kind::Free => Truth::Unconstrained,
            Kind::Nonlinear => Truth::NotLinear,
            kind if kind.is_integrable() => Truth::Integrable,
            Kind::PartlyIntegrable => Truth::PartlyIntegrable { integrals: self.integrals() },
            _ => Truth::Nonintegrable,
        }
    }

    /// Number of constraints that are integrable by construction.
    pub(crate) fn integrals(&self) -> usize {
        match self.kind {
            kind if kind.is_integrable() => self.h(),
            Kind::PartlyIntegrable => 1 + self.constraints % (self.h() - 1),
            _ => 0,
        }
    }

    /// `q_i(t₀)` in eighths.
    pub(crate) fn first_position(&self, i: usize) -> i64 {
        self.positions[i] + 8 * self.shift(i)
    }

    /// What is added to the start of coordinate `i`.
    pub(crate) fn shift(&self, i: usize) -> i64 {
        self.farther(self.features.shift(i))
    }

    /// `t₀`
    pub(crate) fn first_time(&self) -> i64 {
        self.farther(self.features.time())
    }

    fn farther(&self, far: i64) -> i64 {
        far * 10_i64.pow(self.drawn.farther)
    }

    /// Whether time may enter.
    pub(crate) fn moves(&self) -> bool {
        match self.kind {
            Kind::TimeDependent => true,
            Kind::Integrable | Kind::HiddenIntegrable => self.driving > 0,
            _ => false,
        }
    }

    /// Start velocities of the independent coordinates, in eighths.
    pub(crate) fn first_velocities(&self) -> Vec<i64> {
        if self.drawn.rest { vec![0; self.velocities.len()] } else { self.velocities.clone() }
    }

    /// Whether constraints are homogeneous in the velocities where nothing depends on time.
    pub fn is_homogeneous(&self) -> bool {
        !self.kind.has_drift() && self.drawn.surface.is_homogeneous()
    }

    fn ordered(&self) -> Vec<usize> {
        let mut ordered: Vec<usize> =
            self.order.iter().copied().chain(MOST..LARGEST).filter(|&i| i < self.n()).collect();
        if self.drawn.more > 0 {
            // those beyond are not the dependent ones always
            ordered.rotate_left(self.constraints);
        }
        ordered
    }
}

/// Not zero, shrinking towards 4 (a half).
fn nonzero() -> impl Strategy<Value = i64> {
    prop_oneof![Just(4), 2..=8_i64, -8..=-2_i64]
}

fn shape() -> impl Strategy<Value = Shape> {
    prop_oneof![Just(Shape::Linear), Just(Shape::Sine), Just(Shape::Cosine)]
}

fn term(largest: i64) -> impl Strategy<Value = Term> {
    (-largest..=largest, shape(), 0..MOST, prop::option::weighted(0.3, 0..MOST))
        .prop_map(|(coefficient, shape, first, second)| Term { coefficient, shape, first, second })
}

fn mass_term() -> impl Strategy<Value = MassTerm> {
    (0..=6_i64, -8..=8_i64, 0..MOST, 0..MOST, prop::option::of(0..MOST))
        .prop_map(|(weight, ratio, first, second, place)| MassTerm { weight, ratio, first, second, place })
}

fn row() -> impl Strategy<Value = Row> {
    (vec(term(3), 0..=2), nonzero(), any::<bool>(), 0..=4_i64).prop_map(|(potential, curvature, power, time)| Row {
        potential,
        curvature,
        power,
        time,
    })
}

/// Material for the largest system: what there is, over and over.
fn over<T: Clone>(material: Vec<T>, length: usize) -> Vec<T> {
    material.iter().cycle().take(length).cloned().collect()
}

/// Recipes of one kind.
pub fn recipes(kind: Kind) -> impl Strategy<Value = Recipe> {
    let inertia = (
        vec(0..=8_i64, MOST),
        vec(mass_term(), 0..=2),
        vec(term(16), 0..=3),
        prop::option::weighted(0.3, term(8)),
        prop::option::weighted(0.2, 1..=6_i64),
    );
    let constraint = (
        vec(row(), MOST - 1),
        vec((-4..=4_i64, any::<bool>()), MOST * (MOST - 1) / 2),
        nonzero(),
        nonzero(),
        1..=3_i32,
        prop::bool::weighted(0.3),
    );
    let start = (
        vec(-8..=8_i64, MOST),
        vec(-12..=12_i64, MOST - 1).prop_flat_map(|v| nonzero().prop_map(move |first| [&[first], &v[..]].concat())),
        prop_oneof![Just(vec![0; MOST]), vec(-8..=8_i64, MOST)],
        prop_oneof![Just(vec![0; MOST]), vec(-8..=8_i64, MOST)],
    );
    let sizes = (2..=MOST, 0..MOST, Just((0..MOST).collect::<Vec<_>>()).prop_shuffle());
    let removal = vec((-3..=3_i64, 0..MOST), MOST * (MOST + 1) / 2);
    let all = (sizes, inertia, constraint, removal, start, features(MOST), classes(MOST, LARGEST));
    // drawn last: the same number makes the same system as before
    let all = (all, prop::option::weighted(0.3, 0..8_usize), form(MOST));
    all.prop_map(move |((sizes, inertia, constraint, removal, start, features, drawn), writing, form)| {
        let features = Features { writing, form, ..features };
        let (coordinates, constraints, order) = sizes;
        let (masses, mass_terms, potential, gyroscopic, driving) = inertia;
        let (rows, mixing, along, drift, closeness, cyclic) = constraint;
        let (positions, velocities, multipliers, costates) = start;
        Recipe {
            kind,
            coordinates,
            constraints,
            order,
            masses: over(masses, LARGEST),
            mass_terms,
            potential,
            gyroscopic: gyroscopic.into_iter().collect(),
            driving: driving.unwrap_or(0),
            rows: over(rows, LARGEST - 1),
            mixing: over(mixing, LARGEST * (LARGEST - 1) / 2),
            along,
            drift,
            closeness,
            cyclic,
            removal: over(removal, LARGEST * (LARGEST + 1) / 2),
            positions: over(positions, LARGEST),
            velocities: over(velocities, LARGEST),
            multipliers: over(multipliers, LARGEST),
            costates: over(costates, LARGEST),
            drawn: drawn.of(kind, &features),
            features,
        }
    })
}

/// Recipes of several kinds.
pub fn recipes_of(kinds: &[Kind]) -> impl Strategy<Value = Recipe> + use<> {
    prop::sample::select(kinds.to_vec()).prop_flat_map(recipes)
}

/// The recipe of `(seed, index)` with its ways to shrink: a pure function of the two and of the kinds.
pub fn draw(seed: u64, index: u64, kinds: &[Kind]) -> impl ValueTree<Value = Recipe> + use<> {
    tree(&recipes(kinds[index as usize % kinds.len()]), seed, index)
}

/// The recipe of [`draw`], without its ways to shrink.
pub fn draw_recipe(seed: u64, index: u64, kinds: &[Kind]) -> Recipe {
    draw(seed, index, kinds).current()
}

/// What `strategy` gives for `(seed, index)`: a pure function of the two.
pub(crate) fn tree<S: Strategy>(strategy: &S, seed: u64, index: u64) -> S::Tree {
    let mut bytes = [0_u8; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    bytes[8..16].copy_from_slice(&index.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    strategy.new_tree(&mut runner).unwrap_or_else(|reason| unreachable!("the strategy filters nothing: {reason}"))
}
