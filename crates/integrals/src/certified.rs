//! Certificates as JSON, which `validation/proof/verify.py` reads. Integers are modulo the prime.

use std::collections::BTreeMap;
use std::fmt::Write;

use decision::{Certificate, Images, PlainScene};
use schemars::JsonSchema;
use serde::Serialize;

/// By name.
type Formulas = BTreeMap<String, String>;

/// A proof that no multipliers make the vakonomic motion Chetaev's.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "certificate/2")]
pub struct NoMultipliers<'a> {
    #[serde(flatten)]
    common: Common,
    /// Whether the start stands for almost every one; it is then not the scene file's.
    almost_every_start: bool,
    order: usize,
    /// Order and coordinate of each row.
    rows: &'a [(usize, usize)],
    minor: u64,
    divided_by: BTreeMap<String, u64>,
    /// Given velocities that are solved from the constraints, which their decimals miss by round-off.
    completed: &'a [String],
    /// Taylor coefficients by coordinate.
    motion: BTreeMap<String, Vec<u64>>,
    reactions: &'a [Vec<u64>],
}

impl<'a> NoMultipliers<'a> {
    /// `set` are the numbers that were set, as they were written.
    pub fn of(found: &'a Certificate, set: &[(String, String)]) -> Self {
        NoMultipliers {
            common: Common::of(&found.scene, &found.images, set),
            almost_every_start: found.almost_every_start,
            order: found.order,
            rows: &found.rows,
            minor: found.minor,
            divided_by: found.divided_by.iter().cloned().collect(),
            completed: &found.completed,
            motion: found.motion.iter().cloned().collect(),
            reactions: &found.reactions,
        }
    }
}

/// What is proved, bounded or written down of the measures and integrals of Chetaev's motion.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "integrals-certificate/1")]
pub struct Certified {
    #[serde(flatten)]
    pub(crate) common: Common,
    #[serde(flatten)]
    pub(crate) proof: Proof,
}

/// Free velocities are called `x'`; the constraints give the others.
#[derive(Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum Proof {
    /// No measure exp(sigma(q)) dq dp is invariant near almost every point.
    #[serde(rename = "no measure")]
    NoMeasure {
        free: Vec<String>,
        /// Fields after those of ker A, each the bracket of two before it.
        brackets: Vec<[usize; 2]>,
        /// Fields Y whose components beside tau_Y make the minor.
        rows: Vec<usize>,
        minor: u64,
    },
    /// This density of dq ds is invariant.
    Measure { free: Vec<String>, density: Exponents },
    /// With dtau = f dt and P = f p Chetaev's motion over the coordinates of s is Hamilton's; density is f.
    Multiplier { free: Vec<String>, density: Exponents },
    /// No f does that, near almost every point.
    #[serde(rename = "no multiplier")]
    NoMultiplier { free: Vec<String> },
    /// At most this many integrals are polynomials of this degree in the velocities, with terms two, four,
    /// ... degrees lower.
    Bound {
        degree: usize,
        free: Vec<String>,
        /// Of the coordinates z of the chart.
        weights: Vec<usize>,
        /// Highest weight of the Taylor coefficients.
        order: usize,
        /// q(z), by coordinate: exponents of z and a coefficient, term by term.
        chart: BTreeMap<String, Vec<(Vec<u8>, u64)>>,
        bound: usize,
    },
    /// It is constant along Chetaev's motions.
    Integral { integral: String },
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct Exponents {
    /// Exponent of |det g|, T = g_ab s^a s^b/2 on the constraints.
    pub(crate) metric: String,
    /// Exponents of |sin| and |cos| by coordinate.
    pub(crate) angles: BTreeMap<String, [String; 2]>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct Common {
    scene: Scene,
    /// SHA-256 of the scene as JSON without spaces.
    #[schemars(extend("pattern" = "^sha256:[0-9a-f]{64}$"))]
    digest: String,
    prime: u64,
    /// M and the image of e^(2 pi i/M).
    unity: (u64, u64),
    exponents: ImagesOfExponents,
    /// Images of the roots of primes.
    roots: BTreeMap<String, u64>,
    /// Numbers that were set, as they were written.
    set: Formulas,
}

/// Images of e^i and e, and a power of both that is 1.
#[derive(Serialize, JsonSchema)]
struct ImagesOfExponents {
    order: u64,
    #[serde(rename = "e^i")]
    circle: u64,
    e: u64,
}

/// The system, and the start or a point that was drawn, in scalar formulas: every number as it was taken.
/// Fields are in the order of the alphabet, in which the digest is taken.
#[derive(Serialize, JsonSchema)]
struct Scene {
    constraints: Vec<String>,
    coordinates: Vec<String>,
    /// Generalized forces Q other than zero, by coordinate; in every formulation they act by virtual work.
    forces: Formulas,
    lagrangian: String,
    parameters: Formulas,
    positions: Formulas,
    time: String,
    /// Those that the constraints do not supply.
    velocities: Formulas,
}

impl Common {
    pub(crate) fn of(plain: &PlainScene, images: &Images, set: &[(String, String)]) -> Self {
        let named = |formulas: &[(String, String)]| formulas.iter().cloned().collect::<Formulas>();
        let scene = Scene {
            constraints: plain.constraints.clone(),
            coordinates: plain.coordinates.clone(),
            forces: named(&plain.forces),
            lagrangian: plain.lagrangian.clone(),
            parameters: named(&plain.parameters),
            positions: named(&plain.positions),
            time: plain.time.clone(),
            velocities: named(&plain.velocities),
        };
        let mut digest = String::from("sha256:");
        for byte in hmac_sha256::Hash::hash(serde_json::json!(scene).to_string().as_bytes()) {
            let _ = write!(digest, "{byte:02x}");
        }
        let (order, circle, e) = images.exponents;
        Common {
            scene,
            digest,
            prime: images.prime,
            unity: images.unity,
            exponents: ImagesOfExponents { order, circle, e },
            roots: images.roots.iter().cloned().collect(),
            set: named(set),
        }
    }
}
