//! Formulas and frames that move, in numbers.

use nalgebra::{Matrix3, Matrix3xX, Rotation3, Unit, Vector3};

pub(super) type V = Vector3<f64>;

/// A formula `Σ k q + a sin 2t + c q²`.
#[derive(Clone, Default)]
pub(super) struct Arg {
    pub(super) text: String,
    pub(super) linear: Vec<(usize, f64)>,
    pub(super) wave: f64,
    pub(super) square: Option<(usize, f64)>,
    pub(super) constant: f64,
}

/// Its value, gradient, rate, and second rate without accelerations.
pub(super) struct Value {
    pub(super) now: f64,
    pub(super) gradient: Vec<(usize, f64)>,
    pub(super) rate: f64,
    pub(super) bias: f64,
}

impl Arg {
    pub(super) fn number(x: f64) -> Arg {
        Arg { text: format!("{x:?}"), constant: x, ..Arg::default() }
    }

    pub(super) fn at(&self, t: f64, q: &[f64], v: &[f64]) -> Value {
        let mut gradient = self.linear.clone();
        let linear: f64 = self.linear.iter().map(|&(k, c)| c * q[k]).sum();
        let (mut now, mut bias) = (self.constant + linear + self.wave * (2.0 * t).sin(), 0.0);
        bias -= 4.0 * self.wave * (2.0 * t).sin();
        if let Some((k, c)) = self.square {
            gradient.push((k, 2.0 * c * q[k]));
            now += c * q[k] * q[k];
            bias += 2.0 * c * v[k] * v[k];
        }
        let rate = gradient.iter().map(|&(k, c)| c * v[k]).sum::<f64>() + 2.0 * self.wave * (2.0 * t).cos();
        Value { now, gradient, rate, bias }
    }
}

/// What leads from the frame of a parent to that of a body.
#[derive(Clone)]
pub(super) enum Step {
    Shift(V),
    Slide(V, Arg),
    Turn(V, Arg),
    /// The axes of space again.
    Upright,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Shape {
    Point(V),
    Wheel(f64, f64),
    Ball(f64),
    Ellipsoid(V),
    /// A ball or point on the inner side of a cone or cylinder.
    Inside(f64),
    /// A point in a bowl of these curvatures.
    Bowl(f64, f64),
}

pub(super) struct Body {
    pub(super) parent: Option<usize>,
    pub(super) steps: Vec<Step>,
    pub(super) mass: f64,
    pub(super) moments: Matrix3<f64>,
    pub(super) centre: V,
    /// On a surface: from the parent's frame to axes that go with the contact, and the outward normal there.
    pub(super) surface: Option<(Vec<Step>, V)>,
}

pub(super) enum Between {
    Joint(Arg),
    Points([(Option<usize>, V); 2]),
}

pub(super) enum Force {
    Spring(f64, f64),
    Damper(f64),
    Motor(f64),
    Loop,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Law {
    Rolls,
    Blade,
    Slides,
    Rubber,
}

pub(super) struct Contact {
    pub(super) of: usize,
    pub(super) on: Option<usize>,
    pub(super) shape: Shape,
    pub(super) law: Law,
}

/// A frame that moves: axes, origin, velocities as rows by `q'`, and accelerations where `q'' = 0`.
#[derive(Clone)]
pub(super) struct Frame {
    pub(super) r: Matrix3<f64>,
    pub(super) p: V,
    pub(super) of_v: Matrix3xX<f64>,
    pub(super) of_w: Matrix3xX<f64>,
    pub(super) v: V,
    pub(super) w: V,
    pub(super) a: V,
    pub(super) alpha: V,
}

impl Frame {
    pub(super) fn space(n: usize) -> Frame {
        let (zero, none) = (V::zeros(), Matrix3xX::zeros(n));
        Frame {
            r: Matrix3::identity(),
            p: zero,
            of_v: none.clone(),
            of_w: none,
            v: zero,
            w: zero,
            a: zero,
            alpha: zero,
        }
    }

    /// The frame with its origin at a material point, `x` away in space.
    pub(super) fn moved(mut self, x: V) -> Frame {
        self.p += x;
        self.of_v -= x.cross_matrix() * &self.of_w;
        self.v += self.w.cross(&x);
        self.a += self.alpha.cross(&x) + self.w.cross(&self.w.cross(&x));
        self
    }

    pub(super) fn point(&self, own: V) -> Frame {
        let x = self.r * own;
        self.clone().moved(x)
    }

    pub(super) fn step(self, step: &Step, (t, q, v): (f64, &[f64], &[f64])) -> Frame {
        match step {
            Step::Shift(x) => self.point(*x),
            Step::Upright => {
                let Frame { p, of_v, v, a, .. } = self;
                Frame { p, of_v, v, a, ..Frame::space(q.len()) }
            }
            Step::Slide(axis, arg) => {
                let (Value { now, gradient, rate, bias }, e) = (arg.at(t, q, v), self.r * axis.normalize());
                let mut next = self.moved(e * now);
                next.a += 2.0 * next.w.cross(&e) * rate + e * bias;
                next.v += e * rate;
                gradient.iter().for_each(|&(k, c)| next.of_v.set_column(k, &(next.of_v.column(k) + e * c)));
                next
            }
            Step::Turn(axis, arg) => {
                let (mut next, axis) = (self, Unit::new_normalize(*axis));
                let (Value { now, gradient, rate, bias }, e) = (arg.at(t, q, v), next.r * axis.into_inner());
                next.alpha += next.w.cross(&e) * rate + e * bias;
                next.w += e * rate;
                gradient.iter().for_each(|&(k, c)| next.of_w.set_column(k, &(next.of_w.column(k) + e * c)));
                next.r *= Rotation3::from_axis_angle(&axis, now).matrix();
                next
            }
        }
    }
}
