//! T13: systems on which formulations agree, or differ in a known way, with random numbers in them.

use equations::Formulation;
use mechanics::ConstantsRule;
use motion::{CHETAEV, Motion, SolveError, VAKONOMIC, setting, solve};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use scene::Scene;
use symbolic::limits::NOTHING;

use crate::Fault;
use crate::derived::equations;
use crate::finding::{Finding, Findings};
use crate::recipe::tree;
use motion::band::INSTANTS;

/// Numbers for the three null tests.
#[derive(Clone, Debug)]
pub struct NullTest {
    /// Mass, gravity, slope, heading and speed of the Appell–Hamel start; its multiplier.
    pub appell: [f64; 6],
    /// Velocity and multiplier of the Heisenberg start.
    pub heisenberg: [f64; 3],
    /// Heading, roll rate and turn rate of the disc.
    pub disc: [f64; 3],
}

impl NullTest {
    /// A strategy for the numbers.
    pub fn strategy() -> impl Strategy<Value = NullTest> {
        let appell = (
            [eighths(4..=16), eighths(8..=80), eighths(2..=12)],
            [eighths(-24..=24), eighths(8..=40), eighths(-8..=8)],
        );
        let heisenberg = [eighths(-12..=12), eighths(1..=12), eighths(2..=16)];
        let disc = [eighths(-12..=12), eighths(2..=16), eighths(2..=12)];
        (appell, heisenberg, disc).prop_map(|((a, b), heisenberg, disc)| NullTest {
            appell: [a[0], a[1], a[2], b[0], b[1], b[2]],
            heisenberg,
            disc,
        })
    }

    /// Those of `(seed, index)`, with their ways to shrink.
    pub fn draw(seed: u64, index: u64) -> impl ValueTree<Value = NullTest> {
        tree(&NullTest::strategy(), seed, index)
    }
}

fn eighths(range: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = f64> {
    range.prop_map(|k| f64::from(k) / 8.0)
}

/// A system with a closed form: its scene, if there is one with these numbers, and what is claimed of it.
struct Null {
    scene: fn(&NullTest) -> Option<Scene>,
    claims: fn(&mut Findings, &NullTest, &Scene) -> Result<(), SolveError>,
}

const NULL_TESTS: [Null; 3] = [
    Null { scene: appell_hamel_scene, claims: appell_hamel },
    Null { scene: heisenberg_scene, claims: heisenberg },
    Null { scene: disc_scene, claims: disc },
];

impl Null {
    /// Findings on its scene, if there is one.
    fn run(&self, numbers: &NullTest, fault: &Fault) -> Result<Option<(Findings, Scene)>, SolveError> {
        let Some(mut scene) = (self.scene)(numbers) else { return Ok(None) };
        (fault.null)(&mut scene);
        let mut found = Findings::default();
        (self.claims)(&mut found, numbers, &scene)?;
        Ok(Some((found, scene)))
    }
}

/// Runs the three null tests.
///
/// # Errors
/// [`SolveError`] where a motion cannot be computed.
pub fn null_test(numbers: &NullTest, fault: &Fault) -> Result<Findings, SolveError> {
    let mut all = Findings::default();
    for test in &NULL_TESTS {
        if let Some((found, _)) = test.run(numbers, fault)? {
            all.join(found);
        }
    }
    Ok(all)
}

/// The scene of the first null test that fails with these numbers, and the failure.
pub fn broken_null_test(numbers: &NullTest, fault: &Fault) -> Option<(Scene, Finding)> {
    NULL_TESTS.iter().find_map(|test| {
        let (found, scene) = test.run(numbers, fault).ok()??;
        let failure = found.failures().next()?.clone();
        Some((scene, failure))
    })
}

const APPELL_HAMEL: &str = include_str!("appell-hamel.toml");
const HEISENBERG: &str = include_str!("heisenberg.toml");
const DISC: &str = include_str!("disc.toml");

fn scene(text: &str, overrides: &[(&str, f64)]) -> Scene {
    let overrides: Vec<(String, f64)> = overrides.iter().map(|&(n, x)| (n.to_string(), x)).collect();
    Scene::parse_with("null test", text, &overrides).unwrap_or_else(|error| unreachable!("built in: {error}"))
}

fn motion(scene: &Scene, formulation: &'static Formulation, constants: &[f64]) -> Result<Motion, SolveError> {
    let equations = equations(&scene.system, formulation, None)?;
    solve(setting(scene), equations, &ConstantsRule::Given(constants.to_vec()), &motion::Settings::default())
}

/// Largest distance from a closed form, relative to the distance covered.
fn error(motion: &mut Motion, exact: &dyn Fn(f64) -> Vec<f64>) -> Result<f64, SolveError> {
    if !motion.is_complete() {
        return Ok(f64::INFINITY);
    }
    let start = exact(motion.start());
    let (mut worst, mut way) = (0.0_f64, 1e-3_f64);
    for t in motion.grid(INSTANTS) {
        let (found, exact) = (motion.at(t)?.coordinates, exact(t));
        for ((a, b), s) in found.iter().zip(&exact).zip(&start) {
            worst = worst.max((a - b).abs());
            way = way.max((b - s).abs());
        }
    }
    Ok(worst / way)
}

fn deceleration([_, g, a, ..]: [f64; 6]) -> f64 {
    g * a / (1.0 + a * a)
}

fn appell_hamel_scene(numbers: &NullTest) -> Option<Scene> {
    let [m, g, a, heading, speed, mu] = numbers.appell;
    let overrides = [
        ("m", m),
        ("g", g),
        ("a", a),
        ("x'", speed * heading.cos()),
        ("y'", speed * heading.sin()),
        ("z'", a * speed),
        ("duration", 0.8 * speed / deceleration(numbers.appell)),
    ];
    let regular = (mu - m / (2.0 * a * a)).abs() >= 0.05;
    regular.then(|| Scene { multipliers: vec![mu], ..scene(APPELL_HAMEL, &overrides) })
}

/// Straight lines with `v̇_h = −g a/(1 + a²)`, for Chetaev and for vakonomic with any `μ₀` but `m/(2a²)`.
fn appell_hamel(found: &mut Findings, numbers: &NullTest, scene: &Scene) -> Result<(), SolveError> {
    let ([_, _, a, heading, speed, _], deceleration) = (numbers.appell, deceleration(numbers.appell));
    let exact = |t: f64| {
        let s = speed * t - deceleration * t * t / 2.0;
        vec![s * heading.cos(), s * heading.sin(), a * s]
    };
    found.bound(13, "Appell–Hamel: Chetaev runs straight", error(&mut motion(scene, CHETAEV, &[])?, &exact)?, NOTHING);
    let vakonomic = error(&mut motion(scene, VAKONOMIC, &scene.multipliers)?, &exact)?;
    found.bound(13, "Appell–Hamel: vakonomic runs the same line", vakonomic, NOTHING);
    Ok(())
}

fn heisenberg_scene(numbers: &NullTest) -> Option<Scene> {
    let [vx, vy, mu] = numbers.heisenberg;
    Some(Scene { multipliers: vec![mu], ..scene(HEISENBERG, &[("x'", vx), ("y'", vy)]) })
}

/// Chetaev straight lines, vakonomic circles of rate `μ`.
fn heisenberg(found: &mut Findings, numbers: &NullTest, scene: &Scene) -> Result<(), SolveError> {
    let [vx, vy, mu] = numbers.heisenberg;
    let (x0, y0) = (scene.start.q[0], scene.start.q[1]);
    let z = |x: f64, y: f64| (x0 * y - y0 * x) / 2.0;
    let line = |t: f64| vec![x0 + vx * t, y0 + vy * t, z(x0 + vx * t, y0 + vy * t)];
    found.bound(13, "Heisenberg: Chetaev runs straight", error(&mut motion(scene, CHETAEV, &[])?, &line)?, NOTHING);
    let mut vakonomic = motion(scene, VAKONOMIC, &scene.multipliers)?;
    // v turns at the rate μ, in one sense or the other: d²/dt² v = −μ² v, and speed is kept
    let (mut worst, speed) = (0.0_f64, vx.hypot(vy));
    for t in vakonomic.grid(INSTANTS) {
        let v = vakonomic.at(t)?.velocities;
        let along = (v[0] * vx + v[1] * vy) / (speed * speed);
        worst = worst.max((along - (mu * t).cos()).abs()).max((v[0].hypot(v[1]) / speed - 1.0).abs());
    }
    found.bound(13, "Heisenberg: vakonomic runs in a circle of rate mu", worst, NOTHING);
    Ok(())
}

fn disc_scene(numbers: &NullTest) -> Option<Scene> {
    let [heading, roll, turn] = numbers.disc;
    let scene = scene(DISC, &[("phi", heading), ("psi'", roll), ("phi'", turn), ("duration", 3.0)]);
    let multipliers = scene.start.v[..2].iter().map(|v| -v).collect();
    Some(Scene { multipliers, ..scene })
}

/// `μ₀ = −m (ẋ₀, ẏ₀)` gives the Chetaev motion, with `φ` and `ψ` uniform.
fn disc(found: &mut Findings, numbers: &NullTest, scene: &Scene) -> Result<(), SolveError> {
    let ([heading, roll, turn], radius) = (numbers.disc, 0.5);
    let exact = |t: f64| {
        let angle = heading + turn * t;
        let circle = radius * roll / turn;
        vec![circle * (angle.sin() - heading.sin()), circle * (heading.cos() - angle.cos()), roll * t, angle]
    };
    found.bound(13, "disc: Chetaev rolls uniformly", error(&mut motion(scene, CHETAEV, &[])?, &exact)?, NOTHING);
    let special = error(&mut motion(scene, VAKONOMIC, &scene.multipliers)?, &exact)?;
    found.bound(13, "disc: the special multipliers give the Chetaev motion", special, NOTHING);
    let plain = error(&mut motion(scene, VAKONOMIC, &[0.0, 0.0])?, &exact)?;
    found.require(13, "disc: zero multipliers do not", plain > 1e-6, format!("distance {plain:.1e}"));
    Ok(())
}
