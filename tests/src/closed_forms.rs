//! Motions in closed form, to measure solvers against.
//!
//! Nothing here calls a solver. Every motion is written so that its removable limits (a sledge that does not turn, a particle that does
//! not drift) are reached without cancellation. The unit tests put each motion into its equations of motion by central differences.

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
/// `L = ½(ẋ² + ẏ²) + ½k²φ̇² + g x sin α`, `f = ẏ cos φ − ẋ sin φ`. The heading turns uniformly, `φ = φ₀ + ω t`. With
/// `C = ∫₀ᵗ cos φ`, `S = ∫₀ᵗ sin φ` and `g' = g sin α`:
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

    /// How far down a sledge that starts with `v = 0` can ever get, `x − x₀ ≤ g'(1 + |sin φ₀|)²/(2ω²)`, m; infinite at `ω = 0`.
    ///
    /// For `φ₀ = 0` this is the well-known `g'/(2ω²)`. It is reached when the blade first points across the slope.
    #[must_use]
    pub fn descent_bound_from_rest(&self) -> f64 {
        let reach = (1.0 + self.phi.sin().abs()) / self.omega;
        0.5 * self.gravity_along * reach * reach
    }
}

/// Upright rolling disc, Chetaev: uniform roll and uniform turn.
///
/// `L = ½m(ẋ² + ẏ²) + ½Iψ̇² + ½Jφ̇²`, `ẋ = Rψ̇ cos φ`, `ẏ = Rψ̇ sin φ`:
/// `ψ = ψ₀ + ψ̇₀t`, `φ = φ₀ + ωt`, `(x, y) = (x₀, y₀) + Rψ̇₀ ∫(cos φ, sin φ)dt`: a circle of radius `|Rψ̇₀/ω|`, or a line.
/// The masses do not enter. The vakonomic motion with `μ₀ = −m(ẋ₀, ẏ₀)` is the same (Fernandez & Bloch 2008). Source: Bloch 2003, §1.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// `R`, m.
    pub radius: f64,
    /// Start, m.
    pub x: f64,
    /// Start, m.
    pub y: f64,
    /// Roll at the start, rad.
    pub psi: f64,
    /// Heading at the start, rad.
    pub phi: f64,
    /// `ψ̇`, rad/s.
    pub roll_rate: f64,
    /// `φ̇`, rad/s.
    pub turn_rate: f64,
}

impl Disc {
    /// `[x, y, ψ, φ]` after time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 4] {
        let z = self.turn_rate * t;
        let middle = self.phi + 0.5 * z;
        let way = self.radius * self.roll_rate * t * sinc(0.5 * z);
        [self.x + way * middle.cos(), self.y + way * middle.sin(), self.psi + self.roll_rate * t, self.phi + z]
    }
}

/// Ball rolling on a turning table, Chetaev: a circle about any point, at a fixed rate.
///
/// Ball of mass `m`, radius `a`, moment `I`; table rate `Ω`. With the contact force `F`, `m v̇ = F`, `I ω̇ = −a e_z × F`, and the rolling
/// condition `v − a ω × e_z = Ω e_z × r` differentiated:
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
/// `L = ½m((ẋ − aφ̇ sin φ)² + (ẏ + aφ̇ cos φ)²) + ½Iφ̇²`, `f = ẏ cos φ − ẋ sin φ`; `(x, y)` the blade, the mass centre `a` ahead of it.
/// With `J = I + ma²`:
///
/// ```text
/// v̇ = a ω²,  ω̇ = −m a v ω/J
/// v = V tanh(κt + c),  ω = W sech(κt + c),   W² = ω₀² + m v₀²/J,  V = W√(J/m),  κ = aW√(m/J),  sinh c = v₀√(m/J)/|ω₀|
/// φ = φ₀ ± (1/a)√(J/m) (gd(κt + c) − gd(c)),   gd s = 2 atan tanh(s/2)
/// ```
///
/// Closed: `v, ω, φ`. Not closed in general: the blade's path, `∫ v cos φ dt` and `∫ v sin φ dt`, which is elementary only when
/// `(1/a)√(J/m)` is a whole number. The whole turn from `t = −∞` to `∞` is `π√(J/m)/|a|`. Source: Chaplygin 1911; Neimark & Fufaev 1972.
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

/// Particle with `ż = y ẋ`, Chetaev.
///
/// `L = ½(ẋ² + ẏ² + ż²)`. `ẏ = v` and `ẋ√(1 + y²) = c` are constant:
///
/// ```text
/// y = y₀ + v t,   x = x₀ + (c/v)(asinh y − asinh y₀),   z = z₀ + (c/v)(√(1 + y²) − √(1 + y₀²))
/// ```
///
/// written so that `v → 0` needs no care. Source: Rosenberg 1977; Bates & Śniatycki 1993.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Start `[x, y, z]`, m.
    pub position: [f64; 3],
    /// `ẋ` at the start, m/s.
    pub x_speed: f64,
    /// `ẏ`, m/s.
    pub y_speed: f64,
}

impl Particle {
    /// `[x, y, z]` after time `t` (s).
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 3] {
        let [x0, y0, z0] = self.position;
        let y = y0 + self.y_speed * t;
        let (s0, s) = (y0.hypot(1.0), y.hypot(1.0));
        let c = self.x_speed * s0;
        // asinh y − asinh y₀ = asinh(y s₀ − y₀ s),  y s₀ − y₀ s = (y − y₀)(1 + s s₀ − y y₀)/(s + s₀)
        let product = y * y0;
        let gap = if product > 0.0 { (1.0 + y * y + y0 * y0) / (s * s0 + product) } else { s * s0 - product };
        let slope = (1.0 + gap) / (s + s0);
        let w = self.y_speed * t * slope;
        let unit = if w.abs() < 1e-5 { 1.0 - w * w / 6.0 } else { w.asinh() / w };
        [x0 + c * t * slope * unit, y, z0 + c * t * (y + y0) / (s + s0)]
    }
}

/// Appell–Hamel system, every formulation: a straight run at a fixed deceleration.
///
/// `L = ½m(ẋ² + ẏ² + ż²) − m g z`, `f = ż² − a²(ẋ² + ẏ²)`. The heading is constant and `ż = ±a v_h` with the sign of the start:
/// `v̇_h = ∓g a/(1 + a²)`. The mass does not enter, nor does `μ₀`. Singular where `v_h = 0`. Source: Appell 1911; Saletan & Cromer 1970.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppellHamel {
    /// `g`, m/s².
    pub gravity: f64,
    /// `a > 0`.
    pub slope: f64,
    /// Start `[x, y, z]`, m.
    pub position: [f64; 3],
    /// Start `[ẋ, ẏ, ż]`, m/s, on the constraint and not zero.
    pub velocity: [f64; 3],
}

impl AppellHamel {
    /// `v̇_h`, m/s².
    #[must_use]
    pub fn acceleration(&self) -> f64 {
        -self.velocity[2].signum() * self.gravity * self.slope / (1.0 + self.slope * self.slope)
    }

    /// When the run comes to rest, s; none if it runs downwards.
    #[must_use]
    pub fn rest_time(&self) -> Option<f64> {
        let acceleration = self.acceleration();
        (acceleration < 0.0).then(|| self.velocity[0].hypot(self.velocity[1]) / -acceleration)
    }

    /// `[x, y, z]` after time `t` (s); none from the moment of rest on.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<[f64; 3]> {
        if self.rest_time().is_some_and(|rest| t >= rest) {
            return None;
        }
        let speed = self.velocity[0].hypot(self.velocity[1]);
        let scale = t * (1.0 + 0.5 * self.acceleration() * t / speed);
        let [x, y, z] = self.position;
        let [vx, vy, vz] = self.velocity;
        Some([x + scale * vx, y + scale * vy, z + scale * vz])
    }
}

/// Heisenberg system `L = ½(ẋ² + ẏ²)`, `f = ż − ½(xẏ − yẋ)`: vakonomic, and Chetaev at `μ = 0`.
///
/// With `𝓛 = L + μ f`, `μ` is constant and `ẍ = −μẏ`, `ÿ = μẋ`: the velocity turns at the rate `+μ` on a circle of radius `|v|/|μ|`,
/// and `z` gains the swept area, `z = z₀ + ½(x₀Y − y₀X) + ½v²(μt − sin μt)/μ²` with `X = x − x₀`, `Y = y − y₀`.
/// The Chetaev motion is the straight line, whatever `μ` would be. Source: Brockett 1981; Bloch 2003, §1.8.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heisenberg {
    /// `μ`, rad/s; 0 for Chetaev.
    pub multiplier: f64,
    /// Start `[x, y, z]`.
    pub position: [f64; 3],
    /// Start `[ẋ, ẏ]`.
    pub velocity: [f64; 2],
}

impl Heisenberg {
    /// `[x, y, z]` after time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 3] {
        let z = self.multiplier * t;
        let [vx, vy] = self.velocity;
        let (sin, cos) = (0.5 * z).sin_cos();
        let chord = t * sinc(0.5 * z);
        let (dx, dy) = (chord * (vx * cos - vy * sin), chord * (vx * sin + vy * cos));
        let [x0, y0, z0] = self.position;
        let lobe = 0.5 * (vx * vx + vy * vy) * t * t * z * sine_defect(z);
        [x0 + dx, y0 + dy, z0 + 0.5 * (x0 * dy - y0 * dx) + lobe]
    }
}

/// Pendulum that swings (does not go over the top), every formulation of `d/dt(x² + y² − ℓ²) = 0`.
///
/// With `θ` from the downward vertical, `x = ℓ sin θ`, `y = −ℓ cos θ`, `n = √(g/ℓ)`, `k² = sin²(θ₀/2) + θ̇₀²/(4n²) < 1`:
///
/// ```text
/// sin(θ/2) = k sn(nt + u₀ | k),   cos(θ/2) = dn,   θ̇ = 2 n k cn
/// ```
///
/// The addition theorem takes the place of `u₀`. Source: Whittaker, Analytical Dynamics, §44.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// `ℓ`, m.
    pub length: f64,
    /// `g`, m/s².
    pub gravity: f64,
    /// `θ` at the start, rad, in `(−π, π)`.
    pub angle: f64,
    /// `θ̇` at the start, rad/s.
    pub rate: f64,
}

impl Pendulum {
    /// `k`, the sine of half the amplitude.
    #[must_use]
    pub fn modulus(&self) -> f64 {
        let n = (self.gravity / self.length).sqrt();
        (0.5 * self.angle).sin().hypot(0.5 * self.rate / n)
    }

    /// Period `4K(k)/n = 2π/(n agm(1, √(1 − k²)))`, s; none if it goes over the top.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        let k = self.modulus();
        if k >= 1.0 {
            return None;
        }
        let (mut a, mut b) = (1.0_f64, ((1.0 - k) * (1.0 + k)).sqrt());
        while (a - b).abs() > 1e-15 * a {
            (a, b) = (0.5 * (a + b), (a * b).sqrt());
        }
        Some(std::f64::consts::TAU / (a * (self.gravity / self.length).sqrt()))
    }

    /// `[x, y, ẋ, ẏ]` after time `t` (s); none if it goes over the top.
    #[must_use]
    pub fn at(&self, t: f64) -> Option<[f64; 4]> {
        let k = self.modulus();
        if k >= 1.0 {
            return None;
        }
        let n = (self.gravity / self.length).sqrt();
        let (sn, cn, dn) = jacobi(n * t, k);
        // k sn, k cn and dn at the start, then the addition theorem
        let (s0, d0) = (0.5 * self.angle).sin_cos();
        let c0 = 0.5 * self.rate / n;
        let denominator = 1.0 - s0 * s0 * sn * sn;
        let sine = (s0 * cn * dn + c0 * d0 * sn) / denominator;
        let cosine = (d0 * dn - s0 * c0 * sn * cn) / denominator;
        let rate = 2.0 * n * (c0 * cn - s0 * d0 * sn * dn) / denominator;
        let (x, y) = (2.0 * self.length * sine * cosine, self.length * (sine * sine - cosine * cosine));
        Some([x, y, -y * rate, x * rate])
    }
}

/// Jacobi's `(sn, cn, dn)` of argument `u` and modulus `k`, `0 ≤ k < 1`, by descending Landen steps (Abramowitz & Stegun 16.4).
#[must_use]
pub fn jacobi(u: f64, k: f64) -> (f64, f64, f64) {
    let mut a = vec![1.0];
    let mut c = vec![k];
    let mut b = ((1.0 - k) * (1.0 + k)).sqrt();
    while c[c.len() - 1] > 1e-17 {
        let last = a[a.len() - 1];
        a.push(0.5 * (last + b));
        c.push(0.5 * (last - b).max(0.0));
        b = (last * b).sqrt();
    }
    let steps = a.len() - 1;
    let mut phi = 2.0_f64.powi(i32::try_from(steps).unwrap_or(i32::MAX)) * a[steps] * u;
    for i in (1..=steps).rev() {
        phi = 0.5 * (phi + (c[i] / a[i] * phi.sin()).asin());
    }
    let (sn, cn) = phi.sin_cos();
    (sn, cn, (1.0 - (k * sn) * (k * sn)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First derivative by an eight-point central difference, error `O(h⁸)`.
    fn derivative<const N: usize>(f: impl Fn(f64) -> [f64; N], t: f64) -> [f64; N] {
        let h = 2e-2;
        let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
        let mut out = [0.0; N];
        for (i, w) in (1..=4).zip(weights) {
            let d = h * f64::from(i);
            let (ahead, behind) = (f(t + d), f(t - d));
            for j in 0..N {
                out[j] += w * (ahead[j] - behind[j]) / h;
            }
        }
        out
    }

    #[track_caller]
    fn close(left: f64, right: f64, tolerance: f64) {
        assert!((left - right).abs() <= tolerance * (1.0 + right.abs()), "{left} is not {right}");
    }

    /// Nine-digit comparison: what eight-point differences of step 0.02 leave.
    #[track_caller]
    fn same<const N: usize>(left: [f64; N], right: [f64; N]) {
        for (l, r) in left.into_iter().zip(right) {
            close(l, r, 1e-9);
        }
    }

    #[test]
    fn small_argument_functions_join() {
        for z in [1.0 - 1e-12, 1.0 + 1e-12, -1.0 - 1e-12] {
            close(sine_defect(z), 1.0 - 1.0_f64.sin(), 1e-12);
        }
        close(sine_defect(1e-9), 1.0 / 6.0, 1e-16);
        close(sinc(1e-4 * (1.0 - 1e-9)), sinc(1e-4 * (1.0 + 1e-9)), 1e-15);
    }

    #[test]
    fn sledge_obeys_its_equations() {
        for omega in [1.1, -0.4, 0.0, 1e-9, 1e-5] {
            let sledge = Sledge { gravity_along: 3.8, x: 0.1, y: -0.2, phi: 0.3, speed: 0.5, omega };
            for t in [0.0, 0.7, 4.0] {
                let at = |t| {
                    let s = sledge.at(t);
                    [s.x, s.y, s.run]
                };
                let state = sledge.at(t);
                let (sin, cos) = state.phi.sin_cos();
                let velocity = |t| derivative(at, t);
                same(velocity(t), [state.speed * cos, state.speed * sin, state.speed]);
                let exact_velocity = |t| {
                    let s = sledge.at(t);
                    [s.speed * s.phi.cos(), s.speed * s.phi.sin()]
                };
                // ẍ = g' − λ sin φ, ÿ = λ cos φ
                same(derivative(exact_velocity, t), [3.8 - state.reaction * sin, state.reaction * cos]);
            }
        }
    }

    #[test]
    fn sledge_agrees_with_the_independent_references() {
        use crate::references::{Motion, REFERENCES};
        let sledge = Sledge { gravity_along: 9.81 * 0.4_f64.sin(), x: 0.0, y: 0.0, phi: 0.3, speed: 0.5, omega: 1.1 };
        let ours = REFERENCES.iter().filter(|r| r.scene == "sledge" && r.motion == Motion::Chetaev);
        assert_eq!(ours.clone().count(), 2);
        for reference in ours {
            let state = sledge.at(reference.t);
            for (a, b) in [state.x, state.y, state.phi].into_iter().zip(reference.q) {
                close(a, *b, 1e-14);
            }
            close(state.reaction, reference.multipliers[0], 1e-14);
        }
    }

    #[test]
    fn sledge_is_continuous_through_no_turning() {
        let start = Sledge { gravity_along: 3.8, x: 0.0, y: 0.0, phi: 0.3, speed: 0.5, omega: 0.0 };
        let still = start.at(5.0);
        let slow = Sledge { omega: 1e-9, ..start }.at(5.0);
        for (a, b) in [(slow.x, still.x), (slow.y, still.y), (slow.run, still.run), (slow.speed, still.speed)] {
            close(a, b, 3e-8);
        }
        // the first-order change with ω of y: ∂y/∂ω = v₀ t² cos φ₀/2 + g' t³ (cos 2φ₀/4 + 1/12), to the digits that 1e-9 leaves
        let expected = 1e-9 * (0.5 * 12.5 * 0.3_f64.cos() + 3.8 * 125.0 * (0.6_f64.cos() / 4.0 + 1.0 / 12.0));
        assert!((slow.y - still.y - expected).abs() < 1e-14);
    }

    #[test]
    fn sledge_from_rest_stays_above_its_bound_and_reaches_it() {
        for phi in [0.0, 0.4, -0.9] {
            let sledge = Sledge { gravity_along: 3.8, x: 0.0, y: 0.0, phi, speed: 0.0, omega: 0.7 };
            let bound = sledge.descent_bound_from_rest();
            let deepest = (0..100_000).map(|i| sledge.at(f64::from(i) * 2e-4).x).fold(0.0, f64::max);
            assert!(deepest <= bound * (1.0 + 1e-14));
            close(deepest, bound, 1e-6);
            if phi == 0.0 {
                close(bound, 3.8 / (2.0 * 0.49), 1e-15);
            }
        }
    }

    #[test]
    fn disc_rolls_and_vakonomic_special_multiplier_fits() {
        let disc = Disc { radius: 0.5, x: 0.0, y: 0.0, psi: 0.0, phi: 0.4, roll_rate: 2.0, turn_rate: 0.7 };
        for t in [0.3, 5.0] {
            let [_, _, _, phi] = disc.at(t);
            same(derivative(|t| disc.at(t), t), [phi.cos(), phi.sin(), 2.0, 0.7]);
            // d/dt 𝓛_v − 𝓛_q = 0 with μ = −m(ẋ, ẏ) all the way: every row, m = 1
            let m = |t: f64| {
                let phi = disc.at(t)[3];
                [-phi.cos(), -phi.sin()]
            };
            let momenta = |t: f64| {
                let phi = disc.at(t)[3];
                let mu = m(t);
                [
                    phi.cos() + mu[0],
                    phi.sin() + mu[1],
                    0.125 * 2.0 - 0.5 * (mu[0] * phi.cos() + mu[1] * phi.sin()),
                    0.0625 * 0.7,
                ]
            };
            let mu = m(t);
            // 𝓛_φ = R ψ̇ (μ_x sin φ − μ_y cos φ)
            same(derivative(momenta, t), [0.0, 0.0, 0.0, 0.5 * 2.0 * (mu[0] * phi.sin() - mu[1] * phi.cos())]);
        }
        let straight = Disc { turn_rate: 0.0, ..disc }.at(3.0);
        same(straight, [3.0 * 0.4_f64.cos(), 3.0 * 0.4_f64.sin(), 6.0, 0.4]);
    }

    #[test]
    fn turntable_ball_circles_and_rolls() {
        let (m, a, table) = (1.3, 0.1, 0.7);
        let inertia = 0.4 * m * a * a;
        let ball = TurntableBall::homogeneous(table, [0.65, 0.0], [0.0, 0.12]);
        close(ball.radius(), 0.6, 1e-14);
        same(ball.centre(), [0.05, 0.0]);
        for t in [0.0, 3.0, 11.0] {
            let [x, y, vx, vy] = ball.at(t);
            let d = derivative(|t| ball.at(t), t);
            same([d[0], d[1]], [vx, vy]);
            close((x - 0.05).hypot(y), 0.6, 1e-14);
            // spin from rolling, a ω_y = ẋ + Ωy, a ω_x = Ωx − ẏ; its rate must be that of the contact force m v̇: I ω̇ = −a e_z × m v̇
            let spin = |t: f64| {
                let [x, y, vx, vy] = ball.at(t);
                [(table * x - vy) / a, (vx + table * y) / a]
            };
            let turn = derivative(spin, t);
            same([inertia * turn[0], inertia * turn[1]], [a * m * d[3], -a * m * d[2]]);
        }
    }

    #[test]
    fn sleigh_obeys_its_equations() {
        for (offset, speed, omega) in
            [(0.4, -0.6, 1.5), (0.4, 0.6, -1.5), (-0.3, 0.2, 0.9), (1e-7, 0.3, 1.0), (0.0, 0.3, 1.0), (0.4, 0.7, 0.0)]
        {
            let sleigh = Sleigh { mass: 1.2, inertia: 0.3, offset, phi: 0.2, speed, omega };
            let j = 0.3 + 1.2 * offset * offset;
            let at = |t| {
                let s = sleigh.at(t);
                [s.speed, s.omega, s.phi]
            };
            same(at(0.0), [speed, omega, 0.2]);
            for t in [0.1, 1.0, 3.0] {
                let s = sleigh.at(t);
                same(derivative(at, t), [offset * s.omega * s.omega, -1.2 * offset * s.speed * s.omega / j, s.omega]);
                close(1.2 * s.speed * s.speed + j * s.omega * s.omega, 1.2 * speed * speed + j * omega * omega, 1e-13);
            }
        }
        // far ahead and far back: finite, the whole turn is π√(J/m)/a
        let sleigh = Sleigh { mass: 1.0, inertia: 0.3, offset: 0.4, phi: 0.0, speed: -0.6, omega: 1.5 };
        let turn = sleigh.at(1e6).phi - sleigh.at(-1e6).phi;
        close(turn, std::f64::consts::PI * 0.46_f64.sqrt() / 0.4, 1e-14);
    }

    #[test]
    fn particle_obeys_its_equations() {
        for (y0, vy) in [(-1.0, 0.5), (2.0, 0.7), (-3.0, -1e-9), (1.5, 0.0), (0.0, 1e-3)] {
            let particle = Particle { position: [0.3, y0, -0.2], x_speed: 1.2, y_speed: vy };
            let velocity = |t| derivative(|t| particle.at(t), t);
            for t in [0.0, 0.5, 2.0, 6.0] {
                let y = particle.at(t)[1];
                let [dx, dy, dz] = velocity(t);
                close(dy, vy, 1e-9);
                close(dz, y * dx, 1e-9);
                close(dx * y.hypot(1.0), 1.2 * y0.hypot(1.0), 1e-9);
                // ẍ = −y λ, z̈ = λ  ⇒  ẍ + y z̈ = 0
                let [ax, _, az] = derivative(velocity, t);
                close(ax + y * az, 0.0, 1e-7);
            }
        }
    }

    #[test]
    fn appell_hamel_obeys_chetaev_and_vakonomic() {
        let run = AppellHamel { gravity: 9.81, slope: 0.5, position: [0.0; 3], velocity: [3.0, 4.0, 2.5] };
        close(run.rest_time().unwrap(), 5.0 / 3.924, 1e-14);
        assert!(run.at(1.3).is_none());
        let t = 0.6;
        let velocity = |t| derivative(|t| run.at(t).unwrap(), t);
        let v = velocity(t);
        close(v[2] * v[2], 0.25 * (v[0] * v[0] + v[1] * v[1]), 1e-9);
        let a = derivative(velocity, t);
        // m a + m g e_z = λ f_v, f_v = (−2a²ẋ, −2a²ẏ, 2ż)
        let reaction = (a[2] + 9.81) / (2.0 * v[2]);
        close(a[0], -0.5 * reaction * v[0], 1e-7);
        close(a[1], -0.5 * reaction * v[1], 1e-7);
        // vakonomic: (1 − 2a²μ) v_h = const gives μ; then d/dt((1 + 2μ)ż) = −g must hold
        for mu0 in [0.0, 0.3, -2.0] {
            let vertical = |t: f64| {
                let v = velocity(t);
                let horizontal = v[0].hypot(v[1]);
                let mu = 2.0 * (1.0 - (1.0 - 0.5 * mu0) * 5.0 / horizontal);
                [(1.0 + 2.0 * mu) * v[2]]
            };
            close(derivative(vertical, t)[0], -9.81, 1e-7);
        }
        assert!(AppellHamel { velocity: [3.0, 4.0, -2.5], ..run }.at(100.0).is_some());
    }

    #[test]
    fn heisenberg_obeys_its_equations() {
        for multiplier in [0.8, -1.7, 0.0, 1e-9] {
            let system = Heisenberg { multiplier, position: [0.5, -0.3, 0.1], velocity: [0.6, 0.8] };
            let velocity = |t| derivative(|t| system.at(t), t);
            for t in [0.0, 1.0, 8.0] {
                let [x, y, _] = system.at(t);
                let [dx, dy, dz] = velocity(t);
                close(dz, 0.5 * (x * dy - y * dx), 1e-9);
                let [ax, ay, _] = derivative(velocity, t);
                close(ax, -multiplier * dy, 1e-7);
                close(ay, multiplier * dx, 1e-7);
            }
        }
    }

    #[test]
    fn pendulum_obeys_its_equations_and_a_reference() {
        let pendulum = Pendulum { length: 1.0, gravity: 9.81, angle: 0.6_f64.asin(), rate: 1.5 };
        same(pendulum.at(0.0).unwrap(), [0.6, -0.8, 1.2, 0.9]);
        for t in [0.0, 1.0, 10.0] {
            let [x, y, vx, vy] = pendulum.at(t).unwrap();
            let [dx, dy, ax, ay] = derivative(|t| pendulum.at(t).unwrap(), t);
            same([dx, dy], [vx, vy]);
            close(x * x + y * y, 1.0, 1e-14);
            // a + g e_y along (x, y)
            close(ax * y - (ay + 9.81) * x, 0.0, 1e-7);
        }
        let period = pendulum.period().unwrap();
        same(pendulum.at(period).unwrap(), pendulum.at(0.0).unwrap());
        // mpmath, 30 digits: ellipfun/ellipk, and odefun on θ̈ = −g sin θ, which agree
        close(period, 2.092_827_185_826_671_7, 4e-16);
        let reference = [
            (
                1.0,
                [-0.537_735_194_321_850_1, -0.843_113_788_754_306_9, -1.483_471_238_258_761_9, 0.946_153_064_053_865_4],
            ),
            (
                10.0,
                [-0.379_583_687_366_694_2, -0.925_157_405_139_851_7, 2.006_885_487_821_232_3, -0.823_406_902_822_915_1],
            ),
        ];
        for (t, expected) in reference {
            for (ours, theirs) in pendulum.at(t).unwrap().into_iter().zip(expected) {
                close(ours, theirs, 4e-14);
            }
        }
        assert!(Pendulum { rate: 7.0, ..pendulum }.at(1.0).is_none());
    }
}
