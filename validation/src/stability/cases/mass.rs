//! Masses of very different size, put in (added mass) or given (mass ratios).

use mechanics::{ConstantsRule, State};
use motion::{CHETAEV, REMOVED_CONSTRAINT, Setting};
use referees::closed_forms::Particle;
use scene::Scene;

use super::FORMULATIONS;
use crate::stability::question::{Question, Subject};
use crate::stability::reference::Reference;
use random::equations;
use random::realization::{at_momentum, with_added_mass};

/// `μ₀` of the added mass.
const MULTIPLIER: f64 = 0.4;

/// The scene's start.
const START: ([f64; 3], [f64; 3]) = ([0.0, -1.0, 0.0], [1.0, 0.5, -1.0]);

pub(super) fn added(strength: f64) -> Vec<Question> {
    // from the start that f64 can hold: μ₀ = N f₀, and f₀ is a difference of velocities
    let start = massive(strength).map(|subject| subject.start);
    let (q, v, multiplier) = start.map_or((START.0, START.1, MULTIPLIER), |State { q, v, .. }| {
        ([q[0], q[1], q[2]], [v[0], v[1], v[2]], strength * (-q[1]).mul_add(v[0], v[2]))
    });
    let reference = Reduced { z_mass: 1.0, weakness: 1.0 / strength }.from((q, v), multiplier);
    vec![Question::new(strength, "Newton, with added mass", move || massive(strength), reference)]
}

fn massive(strength: f64) -> Result<Subject, String> {
    let scene = scene::catalogue::find("particle", &[]).map_err(|error| error.to_string())?;
    let system = with_added_mass(&scene.system, strength);
    let setting = Setting { system: &scene.system, start: &scene.start, end: scene.duration };
    let start = at_momentum(setting, &system, &[MULTIPLIER]).map_err(|error| error.to_string())?;
    let equations = equations(&system, CHETAEV, None).map_err(|error| error.to_string())?;
    Ok(Subject {
        system,
        start,
        end: scene.duration,
        equations,
        constants: ConstantsRule::Zero,
        choice: None,
        measured: scene.system,
    })
}

pub(super) fn ratio(mass: f64) -> Vec<Question> {
    let text =
        include_str!("../../../../crates/scene/scenes/particle.toml").replace("z'^2)/2", &format!("{mass:?}*z'^2)/2"));
    super::questions(
        mass,
        move || Scene::parse("particle", &text),
        &FORMULATIONS,
        |formulation| match formulation {
            own if own == CHETAEV => {
                let s = mass.sqrt();
                let [x, y, z] = START.0;
                let particle = Particle { position: [x, s * y, s * z], x_speed: START.1[0], y_speed: s * START.1[1] };
                Reference::Closed(Box::new(move |t| {
                    let [x, y, z] = particle.at(t);
                    vec![x, y / s, z / s]
                }))
            }
            // P(t₀) = 0: the vakonomic motion of the multiplier that leaves z no momentum (T2)
            own if own == REMOVED_CONSTRAINT => Reduced { z_mass: mass, weakness: 0.0 }.from(START, -mass * START.1[2]),
            _ => Reduced { z_mass: mass, weakness: 0.0 }.from(START, 0.0),
        },
    )
}

/// The particle with mass `m` along z and constraint `f = ż − yẋ`, by vakonomic mechanics (`ε = 0`) or by
/// added mass `½f²/ε`. The momenta `p_x = ẋ − yμ` and `p_z = mż + μ` are constant, and
///
/// ```text
/// H = ½p_y² + V(y),   V = ½ (ε (m p_x² + p_z²) + (p_x + y p_z)²) / D,   D = εm + 1 + m y²
/// ẋ = (εm p_x + p_x + y p_z)/D,    ż = (ε p_z + y (p_x + y p_z))/D
/// ```
struct Reduced {
    z_mass: f64,
    weakness: f64,
}

impl Reduced {
    /// From positions and velocities on the constraint, with multiplier `μ₀`.
    fn from(self, (q, v): ([f64; 3], [f64; 3]), multiplier: f64) -> Reference {
        let Reduced { z_mass: m, weakness: e } = self;
        let (px, pz) = (v[0] - q[1] * multiplier, m * v[2] + multiplier);
        Reference::Ode {
            y: vec![q[1], v[1], q[0], q[2]],
            rates: Box::new(move |_, state, rates| {
                let y = state[0];
                let (along, d) = (px + y * pz, e * m + 1.0 + m * y * y);
                let potential = 0.5 * (e * (m * px * px + pz * pz) + along * along) / d;
                rates[0] = state[1];
                rates[1] = (2.0 * m * y * potential - along * pz) / d;
                rates[2] = (e * m * px + along) / d;
                rates[3] = (e * pz + y * along) / d;
            }),
            read: Box::new(|_, state| vec![state[2], state[0], state[3]]),
        }
    }
}
