//! From a scene to a ball, a surface and a start.

use motion::Metric;
use rapier3d_f64::math::Vector;
use scene::Scene;

use crate::{EngineError, EulerAngles, Pose};

/// Standard gravity where a scene has none, m/s²: it presses the ball onto a level table, and a table that is
/// rough without limit does not ask how hard.
const PRESSING: f64 = 9.81;

/// How closely the body has to repeat the scene's start, relative to the size of what is compared.
const TOLERANCE: f64 = 1e-12;

/// A ball whose centre of mass is its centre and whose inertia is the same about every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// `m`, kg.
    pub mass: f64,
    /// `a`, m.
    pub radius: f64,
    /// `k`, m: the moment of inertia about any diameter is `m k²`.
    pub gyration: f64,
}

/// What the ball rolls on. The room frame has `z` up; gravity acts along `−z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// The plane through the origin with normal `(sin α, 0, cos α)`; downhill is `(cos α, 0, −sin α)`.
    Incline {
        /// `α`, rad.
        slope: f64,
    },
    /// The plane `z = 0`, turning about the `z` axis: its point at `(x, y)` moves with `Ω (−y, x)`.
    Table {
        /// `Ω`, rad/s.
        rate: f64,
    },
    /// The inside of the upright cone with its apex at the origin. The generator at azimuth `γ` runs along
    /// `(sin α cos γ, sin α sin γ, cos α)`, its inward normal is `(−cos α cos γ, −cos α sin γ, sin α)`.
    Cone {
        /// `α`, rad, between axis and generator.
        half_angle: f64,
    },
}

impl Surface {
    /// Foot of the perpendicular from `point` onto the surface, and the unit normal towards the ball.
    pub fn foot_and_normal(&self, point: Vector) -> (Vector, Vector) {
        match *self {
            Surface::Incline { slope } => {
                let normal = Vector::new(slope.sin(), 0.0, slope.cos());
                (point - normal * normal.dot(point), normal)
            }
            Surface::Table { .. } => (Vector::new(point.x, point.y, 0.0), Vector::Z),
            Surface::Cone { half_angle } => {
                let (sin, cos) = half_angle.sin_cos();
                let outward = Vector::new(point.x, point.y, 0.0).normalize_or_zero();
                let along = sin * outward + cos * Vector::Z;
                (along * along.dot(point), sin * Vector::Z - cos * outward)
            }
        }
    }

    /// Velocity of the surface's own point at `point`, m/s.
    pub fn velocity(&self, point: Vector) -> Vector {
        match *self {
            Surface::Table { rate } => rate * Vector::Z.cross(point),
            Surface::Incline { .. } | Surface::Cone { .. } => Vector::ZERO,
        }
    }
}

/// Everything that an engine needs to know: no constraint is among it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// The ball.
    pub ball: Ball,
    /// The surface.
    pub surface: Surface,
    /// `g`, m/s², along `−z`.
    pub gravity: f64,
    /// Where the ball starts.
    pub pose: Pose,
    /// Velocity of its centre, m/s.
    pub velocity: Vector,
    /// Angular velocity in the room frame, rad/s.
    pub spin: Vector,
}

impl Setup {
    /// Velocity of the ball's lowest point over the surface, `v − a ω × n − v_s` in m/s, with the normal `n`
    /// at the contact: zero where the ball rolls and does not slip.
    pub fn slip(&self, centre: Vector, velocity: Vector, spin: Vector) -> Vector {
        let (foot, normal) = self.surface.foot_and_normal(centre);
        velocity - self.ball.radius * spin.cross(normal) - self.surface.velocity(foot)
    }

    /// A ball at rest on a plane of slope `α`. While it rolls, its acceleration downhill is
    /// `g sin α/(1 + k²/a²)`, for the homogeneous ball `5/7 g sin α`.
    pub fn incline(slope: f64, ball: Ball, gravity: f64) -> Setup {
        let surface = Surface::Incline { slope };
        let (_, normal) = surface.foot_and_normal(Vector::ZERO);
        let still = EulerAngles { precession: 0.0, nutation: 0.0, spin: 0.0 };
        Setup {
            ball,
            surface,
            gravity,
            pose: Pose { centre: ball.radius * normal, attitude: still.attitude() },
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
        }
    }
}

/// Reads a scene's coordinates as poses of a ball.
///
/// Both scenes: homogeneous balls, `k² = 2a²/5`, Euler angles z-x-z from ball to room ([`EulerAngles`]).
///
/// | scene | centre | `ψ` | surface |
/// |---|---|---|---|
/// | `turntable` | `(x, y, a)` | `psi` | [`Surface::Table`] with `Omega` |
/// | `ball-in-cone` | `ρ (cos γ, sin γ, 0) + z e_z` with `ρ = r sin α − a cos α`, `z = r cos α + a sin α` | `chi + gamma` | [`Surface::Cone`] with `alpha` |
///
/// With these signs `v + ω × (−a n) = v_s` at the contact is the scene's constraint: on the table `x' − a
/// ω_y = −Ω y`, `y' + a ω_x = Ω x`; in the cone along the generator `r' − a ω_γ = 0`, (9), and across it `ρ
/// γ' + a (cos α ω_z + sin α ω_r) = 0`, (8) with `r sin α` before `γ'`. Neimark & Fufaev 1972; Gao 2017.
#[derive(Clone, Debug)]
pub struct Mapping {
    /// What the engine is given.
    pub setup: Setup,
    /// Velocity of the contact point over the surface at the start, m/s, as the engine gets it.
    pub residual: f64,
    coordinates: Vec<usize>,
}

impl Mapping {
    /// The mapping of a scene, checked at its start: the contact point does not slip, and the kinetic energy
    /// is that of the scene's Lagrangian, both to 1e-12.
    ///
    /// # Errors
    /// [`EngineError::NotMapped`] for any scene but the two; [`EngineError::Missing`],
    /// [`EngineError::Mapping`] where the scene is not the one that the mapping was written for.
    ///
    /// ```
    /// let scene = scene::catalogue::find("turntable", &[])?;
    /// let mapping = engine::Mapping::new(&scene)?;
    /// assert!(mapping.residual < 1e-15);
    /// assert!((mapping.setup.spin.z - 0.2).abs() < 1e-15);
    /// # Ok::<(), engine::EngineError>(())
    /// ```
    pub fn new(scene: &Scene) -> Result<Mapping, EngineError> {
        let missing = |name: &str| EngineError::Missing(scene.name.clone(), name.into());
        let graph = &scene.system.graph;
        let parameter = |name: &str| {
            let found = scene.system.parameters.iter().find(|p| graph.name(p.symbol) == name);
            found.map(|p| p.value).ok_or_else(|| missing(name))
        };
        let names = match scene.name.as_str() {
            "turntable" => ["x", "y", "phi", "psi", "theta"],
            "ball-in-cone" => ["r", "gamma", "phi", "chi", "theta"],
            _ => return Err(EngineError::NotMapped(scene.name.clone())),
        };
        let find = |name: &str| {
            let found = scene.system.coordinates.iter().position(|c| c.name == name);
            found.ok_or_else(|| missing(name))
        };
        let coordinates = names.iter().map(|name| find(name)).collect::<Result<Vec<usize>, EngineError>>()?;
        let radius = parameter("a")?;
        let ball = Ball { mass: parameter("m")?, radius, gyration: (0.4_f64).sqrt() * radius };
        let (surface, gravity) = match scene.name.as_str() {
            "turntable" => (Surface::Table { rate: parameter("Omega")? }, PRESSING),
            _ => (Surface::Cone { half_angle: parameter("alpha")? }, parameter("g")?),
        };
        let angles = EulerAngles { precession: 0.0, nutation: 0.0, spin: 0.0 };
        let pose = Pose { centre: Vector::ZERO, attitude: angles.attitude() };
        let setup = Setup { ball, surface, gravity, pose, velocity: Vector::ZERO, spin: Vector::ZERO };
        let mut mapping = Mapping { setup, residual: 0.0, coordinates };
        let (q, v) = (&scene.start.q, &scene.start.v);
        mapping.setup.pose = mapping.pose(q);
        (mapping.setup.velocity, mapping.setup.spin) = mapping.velocities(q, v);
        let Setup { velocity, spin, .. } = mapping.setup;
        mapping.residual = mapping.setup.slip(mapping.setup.pose.centre, velocity, spin).length();
        let wrong = |what, body, expected| EngineError::Mapping { scene: scene.name.clone(), what, body, expected };
        if mapping.residual > TOLERANCE * (1.0 + velocity.length()) {
            return Err(wrong("velocity of the contact point", mapping.residual, 0.0));
        }
        let body = (ball.mass * (velocity.length_squared() + ball.gyration.powi(2) * spin.length_squared())).sqrt();
        let expected = Metric::new(&scene.system)?.length(scene.start.t, q, v, v);
        if (body - expected).abs() > TOLERANCE * expected {
            return Err(wrong("kinetic length of the velocity", body, expected));
        }
        Ok(mapping)
    }

    /// The values of a vector over the scene's coordinates, in the order in which the mapping names them.
    fn ordered(&self, values: &[f64]) -> [f64; 5] {
        std::array::from_fn(|i| values[self.coordinates[i]])
    }

    /// Pose at the coordinates `q` of the scene.
    pub fn pose(&self, q: &[f64]) -> Pose {
        let [first, second, spin, precession, nutation] = self.ordered(q);
        let a = self.setup.ball.radius;
        match self.setup.surface {
            Surface::Cone { half_angle } => {
                let (sin, cos) = half_angle.sin_cos();
                let (rho, height) = (first * sin - a * cos, first * cos + a * sin);
                let angles = EulerAngles { precession: precession + second, nutation, spin };
                let centre = Vector::new(rho * second.cos(), rho * second.sin(), height);
                Pose { centre, attitude: angles.attitude() }
            }
            Surface::Table { .. } | Surface::Incline { .. } => {
                let angles = EulerAngles { precession, nutation, spin };
                Pose { centre: Vector::new(first, second, a), attitude: angles.attitude() }
            }
        }
    }

    /// Velocity of the centre and angular velocity, room frame, at `(q, v)` of the scene.
    pub fn velocities(&self, q: &[f64], v: &[f64]) -> (Vector, Vector) {
        let [first, second, spin, precession, nutation] = self.ordered(q);
        let [first_rate, second_rate, spin_rate, precession_rate, nutation_rate] = self.ordered(v);
        let a = self.setup.ball.radius;
        let mut angles = EulerAngles { precession, nutation, spin };
        let mut rates = EulerAngles { precession: precession_rate, nutation: nutation_rate, spin: spin_rate };
        let velocity = match self.setup.surface {
            Surface::Cone { half_angle } => {
                let (sin, cos) = half_angle.sin_cos();
                angles.precession += second;
                rates.precession += second_rate;
                let outward = Vector::new(second.cos(), second.sin(), 0.0);
                let around = Vector::new(-second.sin(), second.cos(), 0.0);
                first_rate * (sin * outward + cos * Vector::Z) + (first * sin - a * cos) * second_rate * around
            }
            Surface::Table { .. } | Surface::Incline { .. } => Vector::new(first_rate, second_rate, 0.0),
        };
        (velocity, angles.angular_velocity(rates))
    }
}
