//! Motions in closed form, to measure solvers against.
//!
//! Nothing here calls a solver. Removable limits (a sledge without turn, a particle without drift) are
//! reached without cancellation. Tests put each motion into its equations by central differences.

mod points;

pub use points::{Particle, Pendulum, jacobi};

/// `sin z / z`, 1 at 0.
#[must_use]
pub fn sinc(z: f64) -> f64 {
    if z.abs() < 1e-4 { 1.0 - z * z / 6.0 } else { z.sin() / z }
}

/// `(z − sin z)/z³`, 1/6 at 0, with no loss of digits near 0.
#[must_use]
pub fn sine_defect(z: f64) -> f64 {
    if z.abs() > 1.0 {
        return (z - z.sin()) / (z * z * z);
    }
    // Σ (−z²)ⁿ / (2n+3)!
    let (mut term, mut sum) = (1.0 / 6.0, 1.0 / 6.0);
    for n in 1..10 {
        let n = f64::from(n);
        term *= -z * z / ((2.0 * n + 2.0) * (2.0 * n + 3.0));
        sum += term;
    }
    sum
}

/// Ice sledge on an incline, Chetaev.
///
/// `L = ½(ẋ² + ẏ²) + ½k²φ̇² + g x sin α`, `f = ẏ cos φ − ẋ sin φ`. The heading turns uniformly,
/// `φ = φ₀ + ω t`. With `C = ∫₀ᵗ cos φ`, `S = ∫₀ᵗ sin φ` and `g' = g sin α`:
///
/// ```text
/// v = v₀ + g' C                                   speed along the blade
/// x = x₀ + v₀ C + ½ g' C²
/// y = y₀ + v₀ S + ½ g' (C S + (ω t − sin ω t)/ω²)
/// λ = ω v + g' sin φ                              d/dt L_v − L_q = Aᵀ λ
/// ```
///
/// `k` does not enter. Any `ω`, 0 included. Source: Neimark & Fufaev 1972, ch. III; derived again here.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sledge {
    /// `g sin α`, m/s².
    pub gravity_along: f64,
    /// Start, m.
    pub x: f64,
    /// Start, m.
    pub y: f64,
    /// Heading at the start, rad.
    pub phi: f64,
    /// Speed along the blade at the start, m/s.
    pub speed: f64,
    /// Turning rate `ω = φ̇`, rad/s.
    pub omega: f64,
}

/// Where a [`Sledge`] is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SledgeState {
    /// m, down the slope.
    pub x: f64,
    /// m, across the slope.
    pub y: f64,
    /// rad.
    pub phi: f64,
    /// Distance run along the blade since the start, `∫ v dt`, m (the paper's `u`).
    pub run: f64,
    /// `v`, m/s (the paper's `u̇`).
    pub speed: f64,
    /// `λ`, N for unit mass.
    pub reaction: f64,
}

impl Sledge {
    /// The state after time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> SledgeState {
        let Self { gravity_along, x, y, phi: phi0, speed: v0, omega } = *self;
        let z = omega * t;
        let phi = phi0 + z;
        let middle = phi0 + 0.5 * z;
        let half = sinc(0.5 * z);
        let c = t * middle.cos() * half;
        let s = t * middle.sin() * half;
        let lobe = t * t * z * sine_defect(z);
        // ∫ C dt = t² (cos φ₀ (1 − cos z)/z² − sin φ₀ (z − sin z)/z²)
        let c_integral = 0.5 * t * t * half * half * phi0.cos() - lobe * phi0.sin();
        let speed = v0 + gravity_along * c;
        SledgeState {
            x: x + v0 * c + 0.5 * gravity_along * c * c,
            y: y + v0 * s + 0.5 * gravity_along * (c * s + lobe),
            phi,
            run: v0 * t + gravity_along * c_integral,
            speed,
            reaction: omega * speed + gravity_along * phi.sin(),
        }
    }
}

/// Ball rolling on a turning table, Chetaev: a circle about any point, at a fixed rate.
///
/// Ball of mass `m`, radius `a`, moment `I`; table rate `Ω`. With the contact force `F`, `m v̇ = F`,
/// `I ω̇ = −a e_z × F`, and the rolling condition `v − a ω × e_z = Ω e_z × r` differentiated:
///
/// ```text
/// v̇ = Ω' e_z × v,   Ω' = Ω I/(I + m a²) = 2Ω/7 for a homogeneous ball
/// ```
///
/// `ω_z` is constant and does not enter. Source: Neimark & Fufaev 1972; Lewis & Murray 1995.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurntableBall {
    /// `Ω'`, rad/s.
    pub rate: f64,
    /// Start of the ball's centre, m.
    pub position: [f64; 2],
    /// m/s.
    pub velocity: [f64; 2],
}

impl TurntableBall {
    /// A homogeneous ball on a table that turns at `table_rate` (rad/s).
    #[must_use]
    pub fn homogeneous(table_rate: f64, position: [f64; 2], velocity: [f64; 2]) -> Self {
        Self { rate: 2.0 * table_rate / 7.0, position, velocity }
    }

    /// Centre of the circle, `r − (ẏ, −ẋ)/Ω'`, m; not finite when the table stands still.
    #[must_use]
    pub fn centre(&self) -> [f64; 2] {
        [self.position[0] - self.velocity[1] / self.rate, self.position[1] + self.velocity[0] / self.rate]
    }

    /// Radius of the circle, `|v|/|Ω'|`, m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.velocity[0].hypot(self.velocity[1]) / self.rate.abs()
    }

    /// `[x, y, ẋ, ẏ]` after time `t` (s); also for `Ω' = 0`.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 4] {
        let z = self.rate * t;
        let [vx, vy] = self.velocity;
        let (sin, cos) = z.sin_cos();
        let (half_sin, half_cos) = (0.5 * z).sin_cos();
        let chord = t * sinc(0.5 * z);
        [
            self.position[0] + chord * (vx * half_cos - vy * half_sin),
            self.position[1] + chord * (vx * half_sin + vy * half_cos),
            vx * cos - vy * sin,
            vx * sin + vy * cos,
        ]
    }
}

/// Chaplygin sleigh, Chetaev.
///
/// `L = ½m((ẋ − aφ̇ sin φ)² + (ẏ + aφ̇ cos φ)²) + ½Iφ̇²`, `f = ẏ cos φ − ẋ sin φ`; `(x, y)` the blade, the
/// mass centre `a` ahead of it. With `J = I + ma²`:
///
/// ```text
/// v̇ = a ω²,  ω̇ = −m a v ω/J
/// v = V tanh(κt+c), ω = W sech(κt+c), W² = ω₀² + m v₀²/J, V = W√(J/m), κ = aW√(m/J), sinh c = v₀√(m/J)/|ω₀|
/// φ = φ₀ ± (1/a)√(J/m) (gd(κt + c) − gd(c)),   gd s = 2 atan tanh(s/2)
/// ```
///
/// Closed: `v, ω, φ`. Not closed: the blade's path, `∫ v cos φ dt` and `∫ v sin φ dt`, unless `(1/a)√(J/m)`
/// is whole. The whole turn from `t = −∞` to `∞` is `π√(J/m)/|a|`. Chaplygin 1911; Neimark & Fufaev 1972.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sleigh {
    /// `m`, kg.
    pub mass: f64,
    /// `I`, kg m², about the mass centre.
    pub inertia: f64,
    /// `a`, m, of either sign or 0.
    pub offset: f64,
    /// Heading at the start, rad.
    pub phi: f64,
    /// Blade speed at the start, m/s.
    pub speed: f64,
    /// `ω` at the start, rad/s.
    pub omega: f64,
}

/// What of a [`Sleigh`] is known in closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SleighState {
    /// `v`, m/s.
    pub speed: f64,
    /// `ω`, rad/s.
    pub omega: f64,
    /// `φ`, rad.
    pub phi: f64,
}

impl Sleigh {
    /// The state after time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> SleighState {
        let Self { mass, inertia, offset, phi, speed, omega } = *self;
        let j = inertia + mass * offset * offset;
        let ratio = (mass / j).sqrt();
        if omega == 0.0 || offset == 0.0 {
            return SleighState { speed, omega, phi: phi + omega * t };
        }
        let w = omega.hypot(ratio * speed);
        let kappa = offset * w * ratio;
        let c = (ratio * speed / omega.abs()).asinh();
        let s = kappa * t + c;
        // gd(s) − gd(c) = 2 atan(sinh((s−c)/2)/cosh((s+c)/2)), written with decaying exponentials only
        let (d, e) = (0.5 * kappa * t, 0.5 * kappa * t + c);
        let quotient = -(d.abs() - e.abs()).exp() * (-2.0 * d.abs()).exp_m1() / (1.0 + (-2.0 * e.abs()).exp());
        let turn = 2.0 * (quotient * d.signum()).atan();
        SleighState {
            speed: w / ratio * s.tanh(),
            omega: omega.signum() * w / s.cosh(),
            phi: phi + omega.signum() * turn / (offset * ratio),
        }
    }
}
