//! One run of the engine.

use rapier3d_f64::math::Vector;
use rapier3d_f64::prelude::{
    ActiveHooks, ColliderBuilder, ContactModificationContext, FrictionModel, HalfSpace, MassProperties, PhysicsHooks,
    PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, SharedShape, SpringCoefficients,
};

use crate::{EngineError, Pose, Setup, Surface};

/// A coefficient of friction that no motion here exhausts: the ball sticks.
const ROUGH: f64 = 1e9;

/// Contact settings of the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contacts {
    /// Every parameter but the time step as the engine ships it: soft contacts, four substeps, a simplified
    /// friction, contacts kept while the pair has moved little.
    AsShipped,
    /// Contacts of a given natural frequency at a damping ratio of 1, one solver iteration, Coulomb friction
    /// at each contact point, contacts found anew in every step, no continuous collision detection.
    Stiff {
        /// Natural frequency of a contact, Hz. It yields noticeably unless steps are long beside its period.
        frequency: f64,
    },
}

impl Contacts {
    /// 1 GHz: hard at every step used here.
    pub const HARD: Contacts = Contacts::Stiff { frequency: 1e9 };
    /// 1 MHz, the stiffest of the engine's own (for joints): steps of some microseconds notice it yield.
    pub const YIELDING: Contacts = Contacts::Stiff { frequency: 1e6 };
}

/// Parameters of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// How contacts are held.
    pub contacts: Contacts,
    /// Length of the run, s.
    pub duration: f64,
    /// Steps of equal length, a multiple of the samples.
    pub steps: usize,
    /// Equidistant times at which the pose is kept, besides the start.
    pub samples: usize,
}

/// Where the ball was.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    /// `samples + 1` poses, the start first.
    pub poses: Vec<Pose>,
    /// Velocity of the centre, m/s, and angular velocity in the room frame, rad/s, at each of them.
    pub rates: Vec<[Vector; 2]>,
    /// Largest distance of the ball's skin from the surface at the samples, m.
    pub off_surface: f64,
    /// Largest velocity of the contact point over the surface at the samples, m/s.
    pub slip: f64,
}

impl Run {
    /// Lets the engine move the ball.
    ///
    /// The engine gets masses, shapes, velocities and gravity. Contacts on planes are its own. It has no
    /// hollow cone, only triangles, so there each step gets the contact of ball and cone in closed form
    /// ([`Surface::foot_and_normal`]): a point, a normal, a distance. What follows is left to it.
    ///
    /// # Errors
    /// [`EngineError::Steps`], [`EngineError::Lost`].
    pub fn of(&self, setup: &Setup) -> Result<Trajectory, EngineError> {
        if self.samples == 0 || self.steps == 0 || !self.steps.is_multiple_of(self.samples) {
            return Err(EngineError::Steps(self.steps, self.samples));
        }
        let (mut world, ball) = world(setup);
        let parameters = &mut world.integration_parameters;
        parameters.dt = self.duration / self.steps as f64;
        if let Contacts::Stiff { frequency } = self.contacts {
            parameters.contact_softness = SpringCoefficients::new(frequency, 1.0);
            parameters.static_contact_softness = SpringCoefficients::new(frequency, 1.0);
            parameters.num_solver_iterations = 1;
            parameters.friction_model = FrictionModel::Coulomb;
            parameters.contact_recycling = false;
            parameters.max_ccd_substeps = 0;
        }
        let hooks = ClosedForm { setup: *setup, ball };
        let mut trajectory = Trajectory {
            poses: vec![setup.pose],
            rates: vec![[setup.velocity, setup.spin]],
            off_surface: 0.0,
            slip: 0.0,
        };
        for step in 1..=self.steps {
            world.step_with_events(&hooks, &());
            if step.is_multiple_of(self.steps / self.samples) {
                trajectory
                    .keep(setup, &world, ball)
                    .ok_or(EngineError::Lost(self.duration * step as f64 / self.steps as f64))?;
            }
        }
        Ok(trajectory)
    }
}

impl Trajectory {
    /// Adds where the ball is now; `None` where it is gone or not finite.
    fn keep(&mut self, setup: &Setup, world: &PhysicsWorld, ball: RigidBodyHandle) -> Option<()> {
        let body = world.bodies.get(ball)?;
        let pose = Pose { centre: body.translation(), attitude: *body.rotation() };
        if !(pose.centre.is_finite() && pose.attitude.is_finite()) {
            return None;
        }
        let (foot, normal) = setup.surface.foot_and_normal(pose.centre);
        let height = (pose.centre - foot).dot(normal) - setup.ball.radius;
        self.off_surface = self.off_surface.max(height.abs());
        self.slip = self.slip.max(setup.slip(pose.centre, body.linvel(), body.angvel()).length());
        self.poses.push(pose);
        self.rates.push([body.linvel(), body.angvel()]);
        Some(())
    }
}

fn world(setup: &Setup) -> (PhysicsWorld, RigidBodyHandle) {
    let mut world = PhysicsWorld::new();
    world.gravity = -setup.gravity * Vector::Z;
    let (ground, shape) = match setup.surface {
        Surface::Incline { .. } => {
            let (_, normal) = setup.surface.foot_and_normal(Vector::ZERO);
            (RigidBodyBuilder::fixed(), HalfSpace::new(normal))
        }
        Surface::Table { rate } => {
            (RigidBodyBuilder::kinematic_velocity_based().angvel(rate * Vector::Z), HalfSpace::new(Vector::Z))
        }
        // stands for the cone: everything under a plane above the ball, so that the two are always in contact
        Surface::Cone { .. } => (RigidBodyBuilder::fixed().translation(100.0 * Vector::Z), HalfSpace::new(Vector::Z)),
    };
    let ground = world.bodies.insert(ground.build());
    let collider = ColliderBuilder::new(SharedShape::new(shape)).friction(ROUGH).build();
    world.colliders.insert_with_parent(collider, ground, &mut world.bodies);

    let inertia = setup.ball.mass * setup.ball.gyration.powi(2);
    let mass = MassProperties::new(Vector::ZERO, setup.ball.mass, Vector::splat(inertia));
    let body = RigidBodyBuilder::dynamic()
        .translation(setup.pose.centre)
        .rotation(setup.pose.attitude.to_scaled_axis())
        .linvel(setup.velocity)
        .angvel(setup.spin)
        .can_sleep(false);
    let ball = world.bodies.insert(body.build());
    let mut collider = ColliderBuilder::ball(setup.ball.radius).mass_properties(mass).friction(ROUGH);
    if matches!(setup.surface, Surface::Cone { .. }) {
        collider = collider.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
    }
    world.colliders.insert_with_parent(collider.build(), ball, &mut world.bodies);
    (world, ball)
}

/// Puts the contact of the ball with its surface in the place of the one that the engine found.
struct ClosedForm {
    setup: Setup,
    ball: RigidBodyHandle,
}

impl PhysicsHooks for ClosedForm {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let Some(centre) = context.bodies.get(self.ball).map(|body| body.translation()) else { return };
        let ball_first = context.rigid_body1 == Some(self.ball);
        let (foot, normal) = self.setup.surface.foot_and_normal(centre);
        let skin = centre - self.setup.ball.radius * normal;
        let Some(rigid) = context.rigid_mut() else { return };
        // the engine's normal points from the first body of the pair to the second
        *rigid.normal = if ball_first { -normal } else { normal };
        for contact in rigid.solver_contacts.iter_mut() {
            (contact.anchor1, contact.anchor2) = if ball_first { (skin, foot) } else { (foot, skin) };
            contact.dist = (skin - foot).dot(normal);
        }
    }
}
