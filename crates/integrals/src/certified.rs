//! Certificates as JSON, which `validation/proof/verify.py` reads. Integers are modulo the prime.

use std::collections::BTreeMap;
use std::fmt::Write;

use decision::{Certificate, Formulas, Images, PlainScene};
use schemars::JsonSchema;
use serde::Serialize;

/// A proof that no multipliers make the vakonomic motion Chetaev's.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "certificate/2")]
pub struct NoMultipliers<'a> {
    #[serde(flatten)]
    common: Common,
    #[serde(flatten)]
    found: &'a Certificate,
}

impl<'a> NoMultipliers<'a> {
    /// `set` are the numbers that were set, as they were written.
    pub fn of(found: &'a Certificate, set: &[(String, String)]) -> Self {
        NoMultipliers { common: Common::of(&found.scene, &found.images, set), found }
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
    scene: PlainScene,
    /// SHA-256 of the scene as JSON without spaces.
    #[schemars(extend("pattern" = "^sha256:[0-9a-f]{64}$"))]
    digest: String,
    #[serde(flatten)]
    images: Images,
    /// Numbers that were set, as they were written.
    set: Formulas,
}

impl Common {
    pub(crate) fn of(scene: &PlainScene, images: &Images, set: &[(String, String)]) -> Self {
        let mut digest = String::from("sha256:");
        for byte in hmac_sha256::Hash::hash(serde_json::json!(scene).to_string().as_bytes()) {
            let _ = write!(digest, "{byte:02x}");
        }
        Common { scene: scene.clone(), digest, images: images.clone(), set: set.iter().cloned().collect() }
    }
}
