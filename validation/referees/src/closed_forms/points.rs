//! Motions of points: particle, pendulum.

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

/// Pendulum that swings (does not go over the top), every formulation of `d/dt(x² + y² − ℓ²) = 0`.
///
/// With `θ` from below, `x = ℓ sin θ`, `y = −ℓ cos θ`, `n = √(g/ℓ)`, `k² = sin²(θ₀/2) + θ̇₀²/(4n²) < 1`:
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

/// Jacobi's `(sn, cn, dn)(u)`, modulus `0 ≤ k < 1`, by descending Landen steps (Abramowitz & Stegun 16.4).
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
