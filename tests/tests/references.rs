//! Reference states of the paper's examples, default starts, from code that shares nothing with the solvers.
//!
//! `references.csv` is written by `validation/referees/references.py`. SymPy derives the equations from `L`,
//! `f`, MPFR evaluates them in 42 digits, and two methods integrate them: Gragg-Bulirsch-Stoer extrapolation
//! and Gauss-Legendre collocation of order 16. `agreement` is their distance; every digit printed is right.

use std::sync::LazyLock;

/// Which motion of the scene.
#[derive(Debug, PartialEq)]
pub enum Motion {
    /// `d/dt L_v − L_q = Aᵀ λ`.
    Chetaev,
    /// `𝓛 = L + μ·f`.
    Vakonomic {
        /// `μ` at the start, in the order of the scene's constraints.
        multipliers: Vec<f64>,
    },
    /// The scene's first removal, `G = L + P·B`.
    Removed {
        /// `P` at the start by memory variable; what is not named is zero.
        costates: Vec<(&'static str, f64)>,
        /// With natural constants: `P = 0` here (s); `costates` is then what that comes to.
        horizon: Option<f64>,
    },
}

/// The state of one motion at one time.
#[derive(Debug)]
pub struct Reference {
    /// File name of the scene without its ending.
    pub scene: &'static str,
    /// Which motion.
    pub motion: Motion,
    /// s.
    pub t: f64,
    /// Coordinates in the order of the scene.
    pub q: Vec<f64>,
    /// Velocities in the same order.
    pub v: Vec<f64>,
    /// `λ` (Chetaev), `μ` (vakonomic) in the order of constraints, or `P` (removed) in that of `costates`.
    pub multipliers: Vec<f64>,
    /// Largest change of a component by rounding parameters and start to `f64`: no such run can come closer.
    pub rounding: f64,
}

/// All reference states.
pub static REFERENCES: LazyLock<Vec<Reference>> =
    LazyLock::new(|| include_str!("references.csv").lines().skip(1).map(read).collect());

fn number(field: &str) -> f64 {
    field.parse().unwrap_or_else(|_| panic!("`{field}` in references.csv is not a number"))
}

fn read(line: &'static str) -> Reference {
    let [scene, motion, constants, horizon, t, q, v, multipliers, _, rounding] =
        line.split(',').collect::<Vec<_>>().try_into().expect("ten columns");
    let numbers = |field: &str| field.split_whitespace().map(number).collect();
    let named = constants.split_whitespace().filter_map(|pair| pair.split_once('='));
    let motion = match motion {
        "chetaev" => Motion::Chetaev,
        "vakonomic" => Motion::Vakonomic { multipliers: numbers(constants) },
        "removed-constraint" => Motion::Removed {
            costates: named.map(|(name, x)| (name, number(x))).collect(),
            horizon: (!horizon.is_empty()).then(|| number(horizon)),
        },
        other => panic!("`{other}` in references.csv is not a motion"),
    };
    let [t, rounding] = [t, rounding].map(number);
    Reference { scene, motion, t, q: numbers(q), v: numbers(v), multipliers: numbers(multipliers), rounding }
}
