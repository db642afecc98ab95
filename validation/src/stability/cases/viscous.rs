//! Friction in the place of a constraint: stiff.

use motion::CHETAEV;
use nalgebra::Complex;

use crate::stability::question::{Question, Subject};
use crate::stability::reference::Reference;
use random::equations;
use random::realization::with_friction;

pub(super) fn questions(strength: f64) -> Vec<Question> {
    let subject = move || {
        let scene = scene::catalogue::find("sledge", &[]).map_err(|error| error.to_string())?;
        let system = with_friction(&scene.system, strength);
        let mut equations = equations(&system, CHETAEV, None).map_err(|error| error.to_string())?;
        equations.coordinates.truncate(3);
        Ok(Subject {
            system,
            start: scene.start.clone(),
            end: scene.duration,
            equations,
            constants: mechanics::ConstantsRule::Zero,
            choice: None,
            measured: scene.system,
        })
    };
    let motion = Slipping::new(9.81 * 0.4_f64.sin(), 0.3, 0.5, 1.1, strength);
    let reference = Reference::Closed(Box::new(move |t| motion.at(t)));
    vec![Question::new(strength, "Newton, with friction", subject, reference)]
}

/// The slipping sledge from the origin, without slip at first. With `v` along, `s` across, `φ = φ₀ + ωt`
///
/// ```text
/// v̇ =  ω s + g' cos φ,     ṡ = −ω v − g' sin φ − N s
/// (v, s) = Re (2/N − i/ω, 2i/N) g' e^{iφ} + a₁ (ω, σ₁) e^{σ₁t} + a₂ (ω/σ₂, 1) e^{σ₂t},     σ² + Nσ + ω² = 0
/// ẋ + iẏ = (v + i s) e^{iφ}
/// ```
struct Slipping {
    phi: f64,
    omega: f64,
    /// `c e^{λt}`, their sum is `ẋ + iẏ`.
    terms: Vec<(Complex<f64>, Complex<f64>)>,
}

impl Slipping {
    fn new(gravity: f64, phi: f64, speed: f64, omega: f64, strength: f64) -> Slipping {
        let i = Complex::i();
        let real = |x: f64| Complex::new(x, 0.0);
        let forced = [real(2.0 / strength) - i / omega, real(2.0 / strength) * i].map(|c| c * gravity);
        let at_start = (i * phi).exp();
        // the larger root by the formula, the smaller one by their product
        let root = real(strength * strength - 4.0 * omega * omega).sqrt();
        let fast = (-real(strength) - root) / 2.0;
        let slow = real(omega * omega) / fast;
        let (one, two) = ([real(omega), slow], [omega / fast, real(1.0)]);
        let open = [real(speed - (forced[0] * at_start).re), real(-(forced[1] * at_start).re)];
        let determinant = one[0] * two[1] - one[1] * two[0];
        let a = (open[0] * two[1] - open[1] * two[0]) / determinant;
        let b = (one[0] * open[1] - one[1] * open[0]) / determinant;
        let turn = i * omega;
        let along = |c: [Complex<f64>; 2]| c[0] + i * c[1];
        let conjugate = forced.map(|c| c.conj());
        let terms = vec![
            (along(forced) * at_start * at_start / 2.0, turn * 2.0),
            (along(conjugate) / 2.0, real(0.0)),
            (a * along(one) * at_start, slow + turn),
            (b * along(two) * at_start, fast + turn),
        ];
        Slipping { phi, omega, terms }
    }

    fn at(&self, t: f64) -> Vec<f64> {
        let integral = |&(c, rate): &(Complex<f64>, Complex<f64>)| {
            if rate.norm() == 0.0 { c * t } else { c * ((rate * t).exp() - 1.0) / rate }
        };
        let place: Complex<f64> = self.terms.iter().map(integral).sum();
        vec![place.re, place.im, self.phi + self.omega * t]
    }
}
