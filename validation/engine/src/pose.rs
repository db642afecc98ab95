//! Where a ball is: its centre, and how it is turned.

use rapier3d_f64::math::{Rotation, Vector};

/// Centre and attitude of a ball in the room frame, `z` up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre, m.
    pub centre: Vector,
    /// Rotation from the ball's axes to those of the room, a unit quaternion; `q` and `−q` are the same.
    pub attitude: Rotation,
}

/// Euler angles z-x-z in rad: ball to room is `Rz(precession) Rx(nutation) Rz(spin)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerAngles {
    /// `ψ`, about the vertical.
    pub precession: f64,
    /// `θ`, about the line of nodes.
    pub nutation: f64,
    /// `φ`, about the ball's own axis.
    pub spin: f64,
}

impl EulerAngles {
    /// The rotation that they stand for.
    pub fn attitude(self) -> Rotation {
        Rotation::from_rotation_z(self.precession)
            * Rotation::from_rotation_x(self.nutation)
            * Rotation::from_rotation_z(self.spin)
    }

    /// Angular velocity in the room frame, rad/s, at the rates `(ψ', θ', φ')`:
    ///
    /// `ω = ψ' e_z + θ' (cos ψ, sin ψ, 0) + φ' (sin θ sin ψ, −sin θ cos ψ, cos θ)`.
    ///
    /// ```
    /// use engine::EulerAngles;
    /// let level = EulerAngles { precession: 0.0, nutation: 0.0, spin: 0.0 };
    /// let rates = EulerAngles { precession: 1.0, nutation: 3.0, spin: 0.5 };
    /// assert_eq!(level.angular_velocity(rates).to_array(), [3.0, 0.0, 1.5]);
    /// ```
    pub fn angular_velocity(self, rates: EulerAngles) -> Vector {
        let (sin_psi, cos_psi) = self.precession.sin_cos();
        let (sin_theta, cos_theta) = self.nutation.sin_cos();
        Vector::new(0.0, 0.0, rates.precession)
            + rates.nutation * Vector::new(cos_psi, sin_psi, 0.0)
            + rates.spin * Vector::new(sin_theta * sin_psi, -sin_theta * cos_psi, cos_theta)
    }
}

impl Pose {
    /// `sqrt(|Δc|² + (k β)²)` in m: the kinetic metric over `sqrt(m)`, with the radius of gyration `k` in m
    /// and the rotation's angle `β ∈ [0, π]` between attitudes. It has no chart: angles need no unwrapping.
    ///
    /// ```
    /// use engine::{EulerAngles, Pose};
    /// let turned = |precession| Pose {
    ///     centre: [0.0, 0.0, precession].into(),
    ///     attitude: EulerAngles { precession, nutation: 0.0, spin: 0.0 }.attitude(),
    /// };
    /// assert!((turned(0.0).distance(&turned(0.3), 4.0 / 3.0) - 0.5).abs() < 1e-15);
    /// ```
    pub fn distance(&self, other: &Pose, gyration: f64) -> f64 {
        // |q₁ − q₂| = 2 sin(β/4) with the nearer sign: accurate for small angles too
        let (q, p) = (self.attitude, other.attitude);
        let chord = (q - p).length().min((q + p).length());
        let angle = 4.0 * (0.5 * chord).min(1.0).asin();
        (self.centre - other.centre).length().hypot(gyration * angle)
    }

    /// Richardson's extrapolation of a method of first order, `2 X(dt/2) − X(dt)`; `self` is that of the
    /// finer step. The quaternions are extrapolated by components, with matching signs, and made units again.
    pub fn extrapolated(&self, coarser: &Pose) -> Pose {
        let sign = if self.attitude.dot(coarser.attitude) < 0.0 { -1.0 } else { 1.0 };
        Pose {
            centre: 2.0 * self.centre - coarser.centre,
            attitude: (self.attitude * 2.0 - coarser.attitude * sign).normalize(),
        }
    }
}
