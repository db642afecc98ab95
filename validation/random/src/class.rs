//! Classes of systems that were drawn later than the rest: each on a part of them, after all else is drawn,
//! so that what else a seed gives stays as it was.

use mechanics::System;
use proptest::prelude::*;
use symbolic::{Expr, Function, Graph};

use super::feature::Features;
use super::{Kind, Scaling};

/// What a system has of these; nothing by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Classes {
    /// The constraints are recombined, so that `∂f/∂v_d` is not triangular; where they are linear.
    pub mixed: bool,
    /// `L` depends on time: strength of `q₁ cos t` and `½ v₁² (2 + sin t)`, in sixteenths.
    pub driven: Option<(i64, i64)>,
    /// The independent coordinates are at rest at the start; where no switch waits for them.
    pub rest: bool,
    /// `L` is not quadratic in the velocities: it has `v_i⁴` of this coordinate, in sixteenths.
    pub quartic: Option<(i64, usize)>,
    /// What a nonlinear constraint is.
    pub surface: Surface,
    /// Forces, one for each coordinate, which act in every formulation.
    pub forces: Option<Vec<Force>>,
    /// The units in which motions are compared with those in the scene's.
    pub units: Option<Units>,
    /// Coordinates beyond [`crate::MOST`].
    pub more: usize,
    /// `−log₁₀` of the angle between two nearly dependent constraints, instead of the recipe's.
    pub closeness: Option<i32>,
    /// `q₁` has a negative inertia, so that `M` is indefinite, on the velocities that constraints allow as
    /// well.
    pub indefinite: bool,
    /// A force that is switched on, at a time that is a breakpoint.
    pub sudden: Option<Sudden>,
    /// The power of ten by which a far start is farther: positions and time.
    pub farther: u32,
    /// Constants that are natural at the end of the run are looked for.
    pub natural: bool,
}

/// `strength/16 q₁ (1 + tanh((t − b)/w))/2` in `L`, with `b = t₀ + at/8 T` and `w = 10^-sharpness T`, `T` the
/// length of the run; `b` is a breakpoint, and a time before the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sudden {
    /// In sixteenths.
    pub strength: i64,
    /// When, in eighths of the run.
    pub at: i64,
    /// How suddenly.
    pub sharpness: i32,
}

/// Powers of ten by which units are larger than the scene's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Units {
    /// Of the coordinates.
    pub lengths: Vec<i32>,
    /// Of time, action (by division) and constraints (in the same way).
    pub others: [i32; 3],
}

/// `Q_i = strength/16 f(q_place) − drag/16 v_i`
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Force {
    /// Sine of the coordinate, or cosine.
    pub sine: bool,
    /// In sixteenths.
    pub strength: i64,
    /// The coordinate.
    pub place: usize,
    /// In sixteenths.
    pub drag: i64,
}

/// A nonlinear constraint on `v_d`, with `c(q) > 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Surface {
    /// `v_d² − c² |v_i|²`
    #[default]
    Cone,
    /// `v_d − c |v_i|²/2`, not homogeneous.
    Paraboloid,
    /// `v_d² − c² (1 + |v_i|²)`, not homogeneous.
    Hyperboloid,
    /// `v_d³ − c³ v₁³`: a plane that is not written as one.
    Plane,
}

impl Surface {
    /// The constraint.
    pub(crate) fn constraint(self, g: &Graph, v_d: Expr, c: Expr, v_i: &[Expr]) -> Expr {
        let (power, rate) = match self {
            Surface::Paraboloid => (1, self.rate(g, c, v_i)),
            Surface::Plane => (3, g.powi(self.rate(g, c, v_i), 3)),
            Surface::Cone | Surface::Hyperboloid => (2, g.mul(g.powi(c, 2), self.square(g, v_i))),
        };
        g.sub(g.powi(v_d, power), rate)
    }

    /// `v_d`, positive where `v₁` is.
    pub(crate) fn rate(self, g: &Graph, c: Expr, v_i: &[Expr]) -> Expr {
        let along = match self {
            Surface::Plane => v_i[0],
            Surface::Paraboloid => g.mul(g.ratio(1, 2), self.square(g, v_i)),
            Surface::Cone | Surface::Hyperboloid => g.sqrt(self.square(g, v_i)),
        };
        g.mul(c, along)
    }

    fn square(self, g: &Graph, v_i: &[Expr]) -> Expr {
        let squares: Vec<Expr> = v_i.iter().map(|&v| g.powi(v, 2)).collect();
        g.add(g.integer(i64::from(self == Surface::Hyperboloid)), g.sum(&squares))
    }

    /// Whether the constraint is homogeneous in the velocities.
    pub(crate) fn is_homogeneous(self) -> bool {
        matches!(self, Surface::Cone | Surface::Plane)
    }
}

impl Classes {
    /// Those that a system of that kind may have.
    pub(crate) fn of(self, kind: Kind, features: &Features) -> Classes {
        let nonlinear = kind == Kind::Nonlinear;
        let rest = self.rest && !nonlinear && features.switch.is_none();
        Classes {
            mixed: self.mixed && matches!(kind, Kind::Linear | Kind::Affine | Kind::TimeDependent),
            rest,
            // where nothing moves, costates are round-off
            natural: self.natural && !rest,
            farther: if features.far.is_some() { self.farther } else { 0 },
            closeness: self.closeness.filter(|_| kind == Kind::NearRankLoss),
            surface: if nonlinear { self.surface } else { Surface::Cone },
            ..self
        }
    }

    /// Other units for a system of `n` coordinates.
    pub(crate) fn scaling(&self, n: usize) -> Scaling {
        let power = |exponent: &i32| 10_f64.powi(*exponent);
        match &self.units {
            None => {
                let lengths = [4.0, 0.125, 10.0, 0.3, 1.0, 25.0].into_iter().cycle().take(n).collect();
                Scaling { lengths, time: 0.2, action: 7.0, constraint: 0.05 }
            }
            Some(Units { lengths, others }) => {
                let [time, action, constraint] = others.map(|exponent| power(&exponent));
                Scaling { lengths: lengths[..n].iter().map(power).collect(), time, action, constraint }
            }
        }
    }

    /// The forces on a system, zero where there are none.
    pub(crate) fn forces(&self, system: &System) -> Vec<Expr> {
        let (g, q, v) = (&system.graph, system.positions(), system.velocities());
        let force = |(i, force): (usize, &Force)| {
            let function = if force.sine { Function::Sin } else { Function::Cos };
            let pull = g.call(function, g.variable(q[force.place % q.len()]));
            g.sub(g.mul(g.ratio(force.strength, 16), pull), g.mul(g.ratio(force.drag, 16), g.variable(v[i])))
        };
        match &self.forces {
            Some(forces) => forces[..q.len()].iter().enumerate().map(force).collect(),
            None => vec![g.zero(); q.len()],
        }
    }

    /// In words, for reports.
    pub fn names(&self) -> Vec<&'static str> {
        let all = [
            ("constraints that are not triangular", self.mixed),
            ("an L that depends on time", self.driven.is_some()),
            ("a start at rest", self.rest),
            ("an L that is not quadratic in the velocities", self.quartic.is_some()),
            ("forces", self.forces.is_some()),
            ("units by powers of ten", self.units.is_some()),
            ("a constraint that is not a cone", self.surface != Surface::Cone),
            ("more than six coordinates", self.more > 0),
            ("constraints nearer than 1e-3", self.closeness.is_some()),
            ("an indefinite M", self.indefinite),
            ("a breakpoint", self.sudden.is_some()),
            ("a start farther than 100", self.farther > 0),
            ("constants natural at a horizon", self.natural),
        ];
        all.into_iter().filter(|(_, has)| *has).map(|(name, _)| name).collect()
    }
}

/// Each class on a part of the systems of at most `most` coordinates, or `largest`.
pub(crate) fn classes(most: usize, largest: usize) -> impl Strategy<Value = Classes> {
    let surface = [Surface::Cone, Surface::Paraboloid, Surface::Hyperboloid, Surface::Plane];
    let force = (any::<bool>(), -8..=8_i64, 0..largest, 0..=6_i64).prop_map(|(sine, strength, place, drag)| Force {
        sine,
        strength,
        place,
        drag,
    });
    let sudden = (prop_oneof![2..=8_i64, -8..=-2_i64], 2..=6_i64, 2..=5_i32)
        .prop_map(|(strength, at, sharpness)| Sudden { strength, at, sharpness });
    let units = (prop::collection::vec(-4..=4_i32, largest), -3..=3_i32, -12..=12_i32, -4..=4_i32)
        .prop_map(|(lengths, time, action, constraint)| Units { lengths, others: [time, action, constraint] });
    let first = (
        prop::bool::weighted(0.3),
        prop::option::weighted(0.2, (1..=6_i64, 0..=4_i64)),
        prop::bool::weighted(0.1),
        prop::option::weighted(0.15, (1..=6_i64, 0..largest)),
        prop::sample::select(surface.to_vec()),
        prop::option::weighted(0.2, prop::collection::vec(force, largest)),
        prop::option::weighted(0.5, units),
    );
    let first = first.prop_map(|(mixed, driven, rest, quartic, surface, forces, units)| {
        let none = Classes::default();
        Classes { mixed, driven, rest, quartic, surface, forces, units, ..none }
    });
    let further = (
        prop_oneof![24 => Just(0), 1 => 1..=largest - most],
        prop::option::weighted(0.1, 4..=6_i32),
        prop::bool::weighted(0.1),
        prop::option::weighted(0.1, sudden),
        prop_oneof![1 => Just(0), 1 => 1..=3_u32],
        prop::bool::weighted(0.1),
    );
    (first, further).prop_map(|(first, (more, closeness, indefinite, sudden, farther, natural))| Classes {
        more,
        closeness,
        indefinite,
        sudden,
        farther,
        natural,
        ..first
    })
}
