//! Machines of bodies drawn at random, against Newton's and Euler's equations body by body, in numbers: bodies and contacts as
//! `docs/bodies.md` describes them, with reactions eliminated by Gauss' principle.

use equations::Compiled;
use motion::CHETAEV;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Rotation3, Unit, Vector3};
use scene::Scene;
use symbolic::SplitMix;

use super::support::{equations, must};

type V = Vector3<f64>;

/// A formula `Σ k q + a sin 2t + c q²`.
#[derive(Clone, Default)]
struct Arg {
    text: String,
    linear: Vec<(usize, f64)>,
    wave: f64,
    square: Option<(usize, f64)>,
    constant: f64,
}

/// Its value, gradient, rate, and second rate without accelerations.
struct Value {
    now: f64,
    gradient: Vec<(usize, f64)>,
    rate: f64,
    bias: f64,
}

impl Arg {
    fn number(x: f64) -> Arg {
        Arg { text: format!("{x:?}"), constant: x, ..Arg::default() }
    }

    fn at(&self, t: f64, q: &[f64], v: &[f64]) -> Value {
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
enum Step {
    Shift(V),
    Slide(V, Arg),
    Turn(V, Arg),
    /// The axes of space again.
    Upright,
}

#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Point(V),
    Wheel(f64, f64),
    Ball(f64),
    Ellipsoid(V),
    /// A ball or point on the inner side of a cone or cylinder.
    Inside(f64),
    /// A point in a bowl of these curvatures.
    Bowl(f64, f64),
}

struct Body {
    parent: Option<usize>,
    steps: Vec<Step>,
    mass: f64,
    moments: Matrix3<f64>,
    centre: V,
    /// On a surface: from the frame of the parent to axes that go with the contact, and the outward normal there.
    surface: Option<(Vec<Step>, V)>,
}

enum Between {
    Joint(Arg),
    Points([(Option<usize>, V); 2]),
}

enum Force {
    Spring(f64, f64),
    Damper(f64),
    Motor(f64),
    Loop,
}

#[derive(Clone, Copy, PartialEq)]
enum Law {
    Rolls,
    Blade,
    Slides,
    Rubber,
}

struct Contact {
    of: usize,
    on: Option<usize>,
    shape: Shape,
    law: Law,
}

/// A frame that moves: axes, origin, velocities as rows by `q'`, and accelerations where `q'' = 0`.
#[derive(Clone)]
struct Frame {
    r: Matrix3<f64>,
    p: V,
    of_v: Matrix3xX<f64>,
    of_w: Matrix3xX<f64>,
    v: V,
    w: V,
    a: V,
    alpha: V,
}

impl Frame {
    fn space(n: usize) -> Frame {
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
    fn moved(mut self, x: V) -> Frame {
        self.p += x;
        self.of_v -= x.cross_matrix() * &self.of_w;
        self.v += self.w.cross(&x);
        self.a += self.alpha.cross(&x) + self.w.cross(&self.w.cross(&x));
        self
    }

    fn point(&self, own: V) -> Frame {
        let x = self.r * own;
        self.clone().moved(x)
    }

    fn step(self, step: &Step, (t, q, v): (f64, &[f64], &[f64])) -> Frame {
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

/// A machine, and its text.
struct Machine {
    random: SplitMix,
    head: String,
    coordinates: String,
    definitions: String,
    velocities: String,
    text: String,
    start: Vec<f64>,
    is_angle: Vec<bool>,
    may_be_homogeneous: bool,
    gravity: V,
    bodies: Vec<Body>,
    forces: Vec<(Between, Force)>,
    contacts: Vec<Contact>,
}

fn written(v: V) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

fn letter(c: char) -> V {
    V::ith("xyz".find(c).unwrap_or_default(), 1.0)
}

const WORDS: [&str; 8] = ["zxz", "zxy", "xyz", "yxy", "zyx", "xzx", "yxz", "zx"];

impl Machine {
    fn new(seed: u64) -> Machine {
        let mut random = SplitMix::new(seed);
        let mut number = || ((random.unit() - 0.5) * 1000.0).round() / 100.0;
        let gravity = V::new(number(), number(), number());
        Machine {
            random,
            head: format!("title = \"drawn\"\ngravity = {}\n", written(gravity)),
            coordinates: "[coordinates]\n".into(),
            definitions: "[definitions]\n".into(),
            velocities: String::new(),
            text: String::new(),
            start: Vec::new(),
            is_angle: Vec::new(),
            may_be_homogeneous: false,
            gravity,
            bodies: Vec::new(),
            forces: Vec::new(),
            contacts: Vec::new(),
        }
    }

    fn likely(&mut self, p: f64) -> bool {
        self.random.unit() < p
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.random.unit() * n as f64) as usize).min(n - 1)
    }

    /// A number between −size and size.
    fn number(&mut self, size: f64) -> f64 {
        ((2.0 * self.random.unit() - 1.0) * size * 100.0).round() / 100.0
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        ((from + (to - from) * self.random.unit()) * 100.0).round() / 100.0
    }

    fn vector(&mut self, size: f64) -> V {
        V::new(self.number(size), self.number(size), self.number(size))
    }

    fn axis(&mut self) -> V {
        match self.below(5) {
            k @ 0..3 => V::ith(k, self.number(1.0).signum()),
            _ => self.vector(1.0) + V::new(0.01, 1.5, 0.0),
        }
    }

    fn coordinate(&mut self, is_angle: bool, supplied: bool) -> usize {
        let (k, x, v) = (self.start.len(), self.number(if is_angle { 1.0 } else { 0.5 }), self.number(1.0));
        let unit = if is_angle { "rad" } else { "m" };
        let start = if supplied { format!("guess = {}", x + 0.02) } else { format!("start = {x}") };
        self.coordinates += &format!("q{k} = {{ unit = \"{unit}\", {start} }}\n");
        self.velocities += &format!("\"q{k}'\" = {v}\n");
        self.start.push(x);
        self.is_angle.push(is_angle);
        k
    }

    fn arg(&mut self, is_angle: bool) -> Arg {
        let k = self.coordinate(is_angle, false);
        let others: Vec<usize> = (0..k).filter(|&h| self.is_angle[h] == is_angle).collect();
        let linear = vec![(k, 1.0)];
        let arg = match self.below(12) {
            0 => Arg { text: format!("-q{k}"), linear: vec![(k, -1.0)], ..Arg::default() },
            1 => Arg { text: format!("2*q{k}"), linear: vec![(k, 2.0)], ..Arg::default() },
            2 => Arg { text: format!("q{k} + 0.3*sin(2*t)"), linear, wave: 0.3, ..Arg::default() },
            3 => Arg { text: format!("(q{k} - 0.2*q{k}^2)"), linear, square: Some((k, -0.2)), ..Arg::default() },
            4 => Arg { text: format!("q{k} + pi/2"), linear, constant: std::f64::consts::FRAC_PI_2, ..Arg::default() },
            5..8 if !others.is_empty() => {
                let h = others[self.below(others.len())];
                Arg { text: format!("q{k} - q{h}"), linear: vec![(k, 1.0), (h, -1.0)], ..Arg::default() }
            }
            _ => Arg { text: format!("q{k}"), linear, ..Arg::default() },
        };
        if self.likely(0.8) {
            return arg;
        }
        self.definitions += &format!("d{k} = \"{}\"\n", arg.text);
        Arg { text: format!("d{k}"), ..arg }
    }

    /// Turns about letters, and their formula.
    fn turns(word: &str, angles: Vec<Arg>) -> (String, Vec<Step>) {
        let list: Vec<&str> = angles.iter().map(|arg| arg.text.as_str()).collect();
        let text = format!("rotation({word}, {})", list.join(", "));
        (text, word.chars().zip(angles).map(|(c, arg)| Step::Turn(letter(c), arg)).collect())
    }

    fn word(&mut self) -> &'static str {
        WORDS[self.below(WORDS.len())]
    }

    /// A body with moments and a mass centre, or without both; its name is its number.
    fn body(&mut self, lines: &str, parent: Option<usize>, steps: Vec<Step>, is_heavy: bool) -> usize {
        let i = self.bodies.len();
        self.text += &format!("[body.b{i}]\n{lines}");
        self.text += &parent.map_or_else(String::new, |parent| format!("on = \"b{parent}\"\n"));
        let mut body = Body { parent, steps, mass: 0.0, moments: Matrix3::zeros(), centre: V::zeros(), surface: None };
        if is_heavy {
            body.mass = self.between(0.5, 3.0);
            self.text += &format!("mass = {:?}\n", body.mass);
            if self.may_be_homogeneous && self.likely(0.4) {
                let text = self.homogeneous(&mut body);
                self.text += &text;
                self.bodies.push(body);
                return i;
            }
            let (a, b, d) = (self.between(0.2, 0.6), self.between(0.2, 0.6), self.between(-0.05, 0.05));
            body.moments = Matrix3::from_diagonal(&V::new(a, b, 0.7));
            let moments = match self.below(3) {
                0 => {
                    (body.moments[(0, 2)], body.moments[(2, 0)]) = (d, d);
                    format!("inertia = [[{a:?}, 0, {d:?}], [0, {b:?}, 0], [{d:?}, 0, 0.7]]\n")
                }
                1 => {
                    body.moments[(2, 2)] = a;
                    format!("inertia = [{a:?}, {b:?}, {a:?}]\n")
                }
                _ => format!("inertia = [{a:?}, {b:?}, 0.7]\n"),
            };
            self.text += &moments;
            if self.likely(0.7) {
                body.centre = self.vector(0.5);
                self.text += &format!("mass-centre = {}\n", written(body.centre));
            }
        }
        self.bodies.push(body);
        i
    }

    /// Moments and mass centre that follow from the shape: ∫(|x|² − x xᵀ) dm.
    fn homogeneous(&mut self, body: &mut Body) -> String {
        let [a, b, c] = [(); 3].map(|()| self.between(0.3, 0.9));
        let [x, y, z] = [V::x(), V::y(), V::z()].map(|e| e * e.transpose());
        // mean squares of one coordinate in the unit interval, disc and ball: ∫rⁿ⁺²/∫rⁿ, a part for each coordinate
        let [line, disc, ball] = [0.0, 1.0, 2.0].map(|n: f64| 1.0 / (n + 3.0));
        let (text, squares) = match self.below(6) {
            0 => (format!("rod\"\nsize = [{a:?}]"), x * (a * a / 4.0 * line)),
            1 => {
                (format!("box\"\nsize = [{a:?}, {b:?}, {c:?}]"), (x * (a * a) + y * (b * b) + z * (c * c)) / 4.0 * line)
            }
            2 => (format!("disc\"\nsize = [{a:?}]"), (x + z) * (a * a * disc)),
            3 => (format!("cylinder\"\nsize = [{a:?}, {b:?}]"), x * (b * b / 4.0 * line) + (y + z) * (a * a * disc)),
            4 => (format!("ball\"\nsize = [{a:?}]"), (x + y + z) * (a * a * ball)),
            _ => {
                (format!("ellipsoid\"\nsize = [{a:?}, {b:?}, {c:?}]"), (x * (a * a) + y * (b * b) + z * (c * c)) * ball)
            }
        };
        if text.starts_with("rod") {
            body.centre = V::x() * a / 2.0;
        }
        body.moments = (Matrix3::identity() * squares.trace() - squares) * body.mass;
        format!("shape = \"{text}\n")
    }

    /// A plane at rest that is turned in space.
    fn slope(&mut self) -> usize {
        let (a, b) = (self.number(0.5), self.number(0.5));
        let (text, steps) = Machine::turns("yx", vec![Arg::number(a), Arg::number(b)]);
        let at = self.vector(0.5);
        let lines = format!("shape = \"plane\"\nsize = [1, 1]\nat = {}\nrotation = \"{text}\"\n", written(at));
        self.body(&lines, None, [vec![Step::Shift(at)], steps].concat(), false)
    }

    /// A body that nothing holds: its place, with a height that contacts may supply, and its rotation.
    fn free(&mut self, on: Option<usize>, word: &str, height: Option<f64>, shape: &str) -> usize {
        let [x, y] = [self.arg(false), self.arg(false)];
        let z = match height {
            Some(height) => {
                let k = self.coordinate(false, true);
                self.coordinates = self.coordinates.rsplitn(2, "guess").last().unwrap_or_default().to_owned();
                self.coordinates += &format!("guess = {height} }}\n");
                Arg { text: format!("q{k}"), linear: vec![(k, 1.0)], ..Arg::default() }
            }
            None => self.arg(false),
        };
        let angles = word.chars().map(|_| self.arg(true)).collect();
        let (rotation, turns) = Machine::turns(word, angles);
        let at = format!("[{}, {}, {}]", x.text, y.text, z.text);
        let steps = "xyz".chars().zip([x, y, z]).map(|(c, arg)| Step::Slide(letter(c), arg));
        let lines = format!("{shape}at = \"{at}\"\nrotation = \"{rotation}\"\n");
        self.body(&lines, on, steps.chain(turns).collect(), true)
    }

    /// A body on a joint of any kind, and the angle or shift of the joint, if it has one.
    fn jointed(&mut self, on: Option<usize>, kind: &str, is_heavy: bool) -> (usize, Option<Arg>) {
        let at = if self.likely(0.8) { self.vector(0.8) } else { V::zeros() };
        let own = if self.likely(0.5) { self.vector(0.5) } else { V::zeros() };
        let (a, b) = (self.number(1.0), self.number(1.0));
        let axes = self.likely(0.4).then(|| ("xz", vec![Arg::number(a), Arg::number(b)]));
        let (mut text, steps, length) = match kind {
            "hinge" | "slider" => {
                let (axis, arg) = (self.axis(), self.arg(kind == "hinge"));
                let by = if kind == "hinge" { "angle" } else { "shift" };
                let text = format!("{kind} = {}, {by} = \"{}\"", written(axis), arg.text);
                let step = if kind == "hinge" { Step::Turn } else { Step::Slide };
                (text, vec![step(axis, arg.clone())], Some(arg))
            }
            "plane" => {
                let [x, y, phi] = [self.arg(false), self.arg(false), self.arg(true)];
                let text = format!("plane = [\"{}\", \"{}\", \"{}\"]", x.text, y.text, phi.text);
                let shifts = [Step::Slide(V::x(), x), Step::Slide(V::y(), y)];
                (text, shifts.into_iter().chain([Step::Turn(V::z(), phi.clone())]).collect(), Some(phi))
            }
            "ball" => {
                let word = self.word();
                let angles = word.chars().map(|_| self.arg(true)).collect();
                let (rotation, steps) = Machine::turns(word, angles);
                (format!("ball = \"{rotation}\""), steps, None)
            }
            _ => ("fixed = true".into(), Vec::new(), None),
        };
        let mut all = vec![Step::Shift(at)];
        text += &format!(", at = {}", written(at));
        if own != V::zeros() {
            text += &format!(", own = {}", written(own));
        }
        match axes {
            Some((word, angles)) => {
                let (rotation, turns) = Machine::turns(word, angles);
                text += &format!(", axes = \"{rotation}\"");
                let back = turns.iter().rev().map(|turn| match turn {
                    Step::Turn(axis, arg) => Step::Turn(*axis, Arg::number(-arg.constant)),
                    other => other.clone(),
                });
                all.extend(turns.iter().cloned().chain(steps).chain(back));
            }
            None => all.extend(steps),
        }
        all.push(Step::Shift(-own));
        (self.body(&format!("joint = {{ {text} }}\n"), on, all, is_heavy), length)
    }

    /// Springs, dampers and motors at a joint, or between two points of bodies or space.
    fn link(&mut self, joint: Option<(usize, Arg)>) {
        let n = self.forces.len();
        let between = match joint {
            Some((i, arg)) => (format!("joint = \"b{i}\"\n"), Between::Joint(arg)),
            None => {
                let (i, own, there) = (self.below(self.bodies.len()), self.vector(0.5), self.vector(2.0));
                let other = Some(self.below(self.bodies.len())).filter(|&h| h != i);
                let name = other.map_or_else(|| "space".into(), |h| format!("b{h}"));
                let text = format!("between = {{ b{i} = {}, {name} = {} }}\n", written(own), written(there));
                (text, Between::Points([(Some(i), own), (other, there)]))
            }
        };
        let (k, rest) = (self.between(1.0, 20.0), self.number(1.0));
        let (kind, values, force) = match self.below(4) {
            0 => ("spring", format!("stiffness = {k:?}\n"), Force::Spring(k, 0.0)),
            1 => ("spring", format!("stiffness = {k:?}\nrest = {rest:?}\n"), Force::Spring(k, rest)),
            2 => ("damper", format!("damping = {k:?}\n"), Force::Damper(k)),
            _ => ("motor", format!("force = \"{k:?}*cos(t)\"\n"), Force::Motor(k)),
        };
        self.text += &format!("[{kind}.l{n}]\n{}{values}", between.0);
        self.forces.push((between.1, force));
    }

    fn contact(&mut self, of: usize, on: Option<usize>, shape: Shape, law: Law) {
        let word = ["rolls", "blade", "slides", "rubber"][law as usize];
        let on_text = on.map_or_else(String::new, |on| format!("on = \"b{on}\"\n"));
        let at = if let Shape::Point(at) = shape { format!("at = {}\n", written(at)) } else { String::new() };
        self.text += &format!("[contact.c{}]\nof = \"b{of}\"\nlaw = \"{word}\"\n{on_text}{at}", self.contacts.len());
        self.contacts.push(Contact { of, on, shape, law });
    }

    fn frames(&self, now: (f64, &[f64], &[f64])) -> Vec<Frame> {
        let mut frames: Vec<Frame> = Vec::new();
        for body in &self.bodies {
            let under = body.parent.map_or_else(|| Frame::space(now.1.len()), |parent| frames[parent].clone());
            frames.push(body.steps.iter().fold(under, |frame, step| frame.step(step, now)));
        }
        frames
    }

    /// `q''`, and the largest violation of places and velocities that are constrained.
    fn accelerations(&self, t: f64, q: &[f64], v: &[f64]) -> (DVector<f64>, f64) {
        let n = q.len();
        let frames = self.frames((t, q, v));
        let (mut mass, mut force) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (body, frame) in self.bodies.iter().zip(&frames) {
            let Frame { r, of_v, of_w, w, a, alpha, .. } = frame.point(body.centre);
            let moments = r * body.moments * r.transpose();
            mass += of_v.transpose() * &of_v * body.mass + of_w.transpose() * moments * &of_w;
            force -= of_v.transpose() * (a - self.gravity) * body.mass;
            force -= of_w.transpose() * (moments * alpha + w.cross(&(moments * w)));
        }
        let (mut rows, mut biases, mut off): (Vec<DVector<f64>>, Vec<f64>, f64) = (Vec::new(), Vec::new(), 0.0);
        let place =
            |&(i, own): &(Option<usize>, V)| i.map_or_else(|| Frame::space(n).point(own), |i| frames[i].point(own));
        for (between, kind) in &self.forces {
            let (length, gradient, rate) = match between {
                Between::Joint(arg) => {
                    let Value { now, gradient, rate, .. } = arg.at(t, q, v);
                    let mut row = DVector::zeros(n);
                    gradient.iter().for_each(|&(k, c)| row[k] += c);
                    (now, row, rate)
                }
                Between::Points(ends) => {
                    let [one, two] = ends.each_ref().map(place);
                    let (gap, slip) = (one.p - two.p, one.v - two.v);
                    if let Force::Loop = kind {
                        rows.extend((&one.of_v - &two.of_v).row_iter().map(|row| row.transpose()));
                        biases.extend((one.a - two.a).iter());
                        off = off.max(gap.amax()).max(slip.amax());
                        continue;
                    }
                    let e = gap.normalize();
                    (gap.norm(), (&one.of_v - &two.of_v).transpose() * e, slip.dot(&e))
                }
            };
            force += gradient
                * match kind {
                    Force::Spring(k, rest) => -k * (length - rest),
                    Force::Damper(c) => -c * rate,
                    Force::Motor(k) => k * t.cos(),
                    Force::Loop => 0.0,
                };
        }
        for contact in &self.contacts {
            let (body, under) =
                (&frames[contact.of], contact.on.map_or_else(|| Frame::space(n), |on| frames[on].clone()));
            let Frame { r: axes, w, .. } = *body;
            if let Shape::Bowl(k, l) = contact.shape {
                let [p, rate] = [body.p - under.p, body.v].map(|x| under.r.transpose() * x);
                let gradient = under.r * V::new(-k * p.x, -l * p.y, 1.0);
                rows.push(body.of_v.transpose() * gradient);
                biases.push(gradient.dot(&body.a) - k * rate.x * rate.x - l * rate.y * rate.y);
                let height = p.z - (k * p.x * p.x + l * p.y * p.y) / 2.0;
                off = off.max(height.abs()).max(gradient.dot(&body.v).abs());
                continue;
            }
            if let (Shape::Inside(a), Some((steps, normal))) = (contact.shape, &self.bodies[contact.of].surface) {
                let axes = steps.iter().fold(under, |frame, step| frame.step(step, (t, q, v)));
                let out = axes.r * normal;
                let (x, rate) = (out * a, axes.w.cross(&out) * a);
                let slip = body.v + w.cross(&x);
                let row = &body.of_v - x.cross_matrix() * &body.of_w;
                let bias = body.a + body.alpha.cross(&x) + w.cross(&rate);
                for e in axes.r.column_iter().filter(|e| contact.law != Law::Slides && e.dot(&out).abs() < 0.5) {
                    rows.push(row.transpose() * e);
                    biases.push(e.dot(&bias));
                    off = off.max(slip.amax());
                }
                if contact.law == Law::Rubber {
                    rows.push(body.of_w.transpose() * out);
                    biases.push(out.dot(&body.alpha) + axes.w.cross(&out).dot(&w));
                    off = off.max(out.dot(&w).abs());
                }
                continue;
            }
            let up = under.r.column(2).into_owned();
            // from the middle to the contact, and the rate of that; for a blade, what is across
            let axle = axes.column(1).into_owned();
            let flat = |e: V| e - up * up.dot(&e);
            let (x, rate, across) = match contact.shape {
                Shape::Point(own) => (axes * own, w.cross(&(axes * own)), up.cross(&(axes.column(0).into_owned()))),
                Shape::Inside(_) | Shape::Bowl(..) => (V::zeros(), V::zeros(), axle),
                Shape::Ball(a) => (-a * up, V::zeros(), axle),
                Shape::Wheel(a, tyre) => {
                    let turning = w.cross(&axle);
                    let (d, turned) = (up - axle * up.dot(&axle), -turning * up.dot(&axle) - axle * up.dot(&turning));
                    let size = d.norm();
                    (-a / size * d - tyre * up, -a * (turned / size - d * d.dot(&turned) / size.powi(3)), flat(axle))
                }
                Shape::Ellipsoid(s) => {
                    let squares = Matrix3::from_diagonal(&s.component_mul(&s));
                    let (nu, own) = (axes.transpose() * up, axes.transpose() * w);
                    let (turned, reach) = (-own.cross(&nu), nu.dot(&(squares * nu)).sqrt());
                    let (x, reached) = (-squares * nu / reach, nu.dot(&(squares * turned)) / reach);
                    let rate = -squares * turned / reach - x * (reached / reach);
                    (axes * x, axes * (own.cross(&x) + rate), axle)
                }
            };
            let rho = body.p + x - under.p;
            let rho_rate = body.v + rate - under.v;
            let slip = body.v + w.cross(&x) - under.v - under.w.cross(&rho);
            let row = &body.of_v - x.cross_matrix() * &body.of_w - (&under.of_v - rho.cross_matrix() * &under.of_w);
            let change = body.a + body.alpha.cross(&x) + w.cross(&rate);
            let bias = change - under.a - under.alpha.cross(&rho) - under.w.cross(&rho_rate);
            let mut add = |e: V, turned: V| {
                rows.push(row.transpose() * e);
                biases.push(e.dot(&bias) + turned.dot(&slip));
                off = off.max(e.dot(&slip).abs());
            };
            add(up, V::zeros());
            match contact.law {
                Law::Slides => {}
                Law::Rolls | Law::Rubber => {
                    [0, 1].into_iter().for_each(|k| add(under.r.column(k).into_owned(), V::zeros()))
                }
                Law::Blade => add(
                    across,
                    if let Shape::Point(_) = contact.shape { w.cross(&across) } else { flat(w.cross(&axle)) },
                ),
            }
            if contact.law == Law::Rubber {
                rows.push((&body.of_w - &under.of_w).transpose() * up);
                biases.push(up.dot(&(body.alpha - under.alpha)));
                off = off.max(up.dot(&(w - under.w)).abs());
            }
            off = off.max(up.dot(&rho).abs());
        }
        let mut found = mass.clone().cholesky().map(|mass| mass.solve(&force)).unwrap_or_else(|| DVector::zeros(0));
        if !rows.is_empty() && found.len() == n {
            let g = DMatrix::from_columns(&rows).transpose();
            let weight = mass.cholesky().map(|mass| mass.solve(&g.transpose())).unwrap_or_else(|| g.transpose());
            let missing = -DVector::from_vec(biases) - &g * &found;
            let inverse = (&g * &weight).pseudo_inverse(1e-9).unwrap_or_else(|e| panic!("{e}"));
            found += weight * (inverse * missing);
        }
        (found, off)
    }

    /// Whether a wheel is turned about z, then about x by more than 90°: then its rows are those of its highest point.
    fn leans_past_flat(&self, t: f64, q: &[f64]) -> bool {
        let still = vec![0.0; q.len()];
        self.contacts.iter().any(|contact| match (contact.shape, &self.bodies[contact.of].steps[..]) {
            (Shape::Wheel(..), [.., Step::Turn(z, _), Step::Turn(x, lean), Step::Turn(..)]) => {
                *z == V::z() && *x == V::x() && lean.at(t, q, &still).now.cos() < 0.0
            }
            _ => false,
        })
    }

    fn scene_text(&self) -> String {
        let Machine { head, coordinates, definitions, velocities, text, .. } = self;
        format!(
            "{head}{coordinates}{definitions}[start]\ntime = 0.4\nproject = true\n[start.velocities]\n{velocities}[run]\nduration = 1\n{text}"
        )
    }
}

const KINDS: [&str; 6] = ["hinge", "hinge", "slider", "plane", "ball", "fixed"];

/// A tree of two to four bodies with forces between them, in space or on a slope.
fn tree(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    m.may_be_homogeneous = true;
    let slope = m.likely(0.3).then(|| m.slope());
    let mut joints = Vec::new();
    let roots = m.bodies.len();
    if m.likely(0.4) {
        let word = m.word();
        m.free(slope, word, None, "");
    }
    for _ in 0..2 + m.below(2) {
        let on = if m.bodies.len() > roots { Some(roots + m.below(m.bodies.len() - roots)) } else { slope };
        let kind = KINDS[m.below(KINDS.len())];
        let (i, length) = m.jointed(on, kind, true);
        joints.extend(length.map(|arg| (i, arg)));
    }
    for _ in 0..m.below(4) {
        let joint = if joints.is_empty() || m.likely(0.4) { None } else { Some(joints[m.below(joints.len())].clone()) };
        m.link(joint);
    }
    m
}

/// A body that rolls, slides or cuts, on the ground, a slope or a turning table, perhaps with another body on it.
fn rolling(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let (on, stands) = match m.below(4) {
        0 => {
            let slope = m.slope();
            (Some(slope), Some(slope))
        }
        1 => {
            let arg = Arg { text: "0.3*sin(2*t)".into(), wave: 0.3, ..Arg::default() };
            let lines =
                format!("shape = \"table\"\nsize = [1]\njoint = {{ hinge = \"z\", angle = \"{}\" }}\n", arg.text);
            let table = m.body(&lines, None, vec![Step::Turn(V::z(), arg)], false);
            (Some(table), m.likely(0.4).then_some(table))
        }
        _ => (None, None),
    };
    let (a, b, c) = (m.between(0.2, 0.5), m.between(0.2, 0.5), m.between(0.2, 0.5));
    let point = m.vector(0.5);
    let (shape, lines, height) = match m.below(5) {
        0 => (Shape::Ball(a), format!("shape = \"ball\"\nsize = [{a:?}]\n"), a),
        1 => (Shape::Ellipsoid(V::new(a, b, c)), format!("shape = \"ellipsoid\"\nsize = [{a:?}, {b:?}, {c:?}]\n"), b),
        2 => (Shape::Wheel(a, 0.1), format!("shape = \"wheel\"\nsize = [{a:?}, 0.1]\n"), 0.7 * a),
        3 => (Shape::Wheel(a, 0.0), format!("shape = \"disc\"\nsize = [{a:?}]\n"), 0.7 * a),
        _ => (Shape::Point(point), String::new(), 0.3),
    };
    let law = [Law::Rolls, Law::Rolls, Law::Rubber, Law::Slides, Law::Blade][m.below(5)];
    let word = match shape {
        Shape::Point(_) if law == Law::Blade => ["z", "zx"][m.below(2)],
        Shape::Wheel(..) if m.likely(0.5) => "zxy",
        _ => m.word(),
    };
    let law =
        if law == Law::Blade && matches!(shape, Shape::Ball(_) | Shape::Ellipsoid(_)) { Law::Slides } else { law };
    let body = m.free(stands, word, Some(height), &lines);
    m.contact(body, on, shape, law);
    if m.likely(0.5) {
        let kind = ["hinge", "slider", "ball"][m.below(3)];
        let (i, length) = m.jointed(Some(body), kind, true);
        if let Some(arg) = length {
            m.link(Some((i, arg)));
        }
    }
    m
}

/// A ball or a point in a cone, a cylinder or a bowl, which stands somewhere and is turned.
fn inside(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let (a, b, at) = (m.number(0.5), m.number(0.5), m.vector(0.5));
    let (rotation, turns) = Machine::turns("yx", vec![Arg::number(a), Arg::number(b)]);
    let (size, curved) = (m.between(0.4, 0.8), m.between(0.3, 0.9));
    let kind = ["cone", "cylinder", "bowl"][m.below(3)];
    let sizes = match kind {
        "cone" => format!("{size:?}, 2"),
        "cylinder" => format!("{size:?}, 3"),
        _ => format!("{size:?}, {curved:?}, 2"),
    };
    let placed =
        if m.likely(0.7) { format!("at = {}\nrotation = \"{rotation}\"\n", written(at)) } else { String::new() };
    let steps = if placed.is_empty() { Vec::new() } else { [vec![Step::Shift(at)], turns].concat() };
    let under = m.body(&format!("shape = \"{kind}\"\nsize = [{sizes}]\n{placed}"), None, steps, false);
    if kind == "bowl" {
        let body = m.free(None, "zx", Some(0.3), "");
        m.contact(body, Some(under), Shape::Bowl(size, curved), Law::Slides);
        return m;
    }
    let (k, v) = (m.coordinate(false, false), m.arg(true));
    let u = Arg { text: format!("0.8 + q{k}"), linear: vec![(k, 1.0)], constant: 0.8, ..Arg::default() };
    let is_ball = m.likely(0.7);
    let radius = if is_ball { m.between(0.05, 0.2) } else { 0.0 };
    let (along, normal) = match kind {
        "cone" => (vec![Step::Turn(V::z(), v.clone()), Step::Turn(V::y(), Arg::number(size))], V::x()),
        _ => (vec![Step::Turn(V::x(), v.clone())], -V::z()),
    };
    let place = match kind {
        "cone" => vec![Step::Slide(V::z(), u.clone()), Step::Shift(-V::x() * radius)],
        _ => vec![Step::Slide(V::x(), u.clone()), Step::Shift(V::z() * (radius - size))],
    };
    let mut steps = [along.clone(), place, vec![Step::Upright]].concat();
    let mut joint = format!("surface = [\"{}\", \"{}\"]", u.text, v.text);
    let mut lines = "shape = \"point\"\nsize = [0.1]\n".to_string();
    if is_ball {
        let word = m.word();
        let angles = word.chars().map(|_| m.arg(true)).collect();
        let (rotation, turns) = Machine::turns(word, angles);
        joint += &format!(", rotation = \"{rotation}\"");
        lines = format!("shape = \"ball\"\nsize = [{radius:?}]\n");
        steps.extend(turns);
    }
    let body = m.body(&format!("{lines}joint = {{ {joint} }}\n"), Some(under), steps, true);
    m.bodies[body].surface = Some((along, normal));
    if is_ball {
        let law = [Law::Rolls, Law::Rubber, Law::Slides][m.below(3)];
        m.contact(body, Some(under), Shape::Inside(radius), law);
    }
    m
}

/// A robot on wheels: a body in the plane, arms and forks on it, and wheels, upright or with camber, and blades.
fn robot(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let height = m.between(0.1, 0.5);
    let [x, y, phi] = [m.arg(false), m.arg(false), m.arg(true)];
    let joint =
        format!("joint = {{ plane = [\"{}\", \"{}\", \"{}\"], at = [0, 0, {height:?}] }}\n", x.text, y.text, phi.text);
    let steps =
        vec![Step::Shift(V::z() * height), Step::Slide(V::x(), x), Step::Slide(V::y(), y), Step::Turn(V::z(), phi)];
    let mut carriers = vec![m.body(&joint, None, steps, true)];
    for _ in 0..m.below(3) {
        let on = carriers[m.below(carriers.len())];
        let (at, arg) = (V::new(m.number(0.8), m.number(0.8), 0.0), m.arg(true));
        let lines = format!("joint = {{ hinge = \"z\", angle = \"{}\", at = {} }}\n", arg.text, written(at));
        let is_heavy = m.likely(0.7);
        let i = m.body(&lines, Some(on), vec![Step::Shift(at), Step::Turn(V::z(), arg.clone())], is_heavy);
        carriers.push(i);
        m.link(Some((i, arg)));
    }
    for &on in &carriers.clone() {
        let (a, camber) = (m.between(0.1, 0.4), if m.likely(0.3) { m.number(0.4) } else { 0.0 });
        let at = V::new(m.number(0.5), m.number(0.5), a * camber.cos() - height);
        if m.likely(0.25) {
            m.contact(on, None, Shape::Point(V::new(at.x, at.y, -height)), Law::Blade);
            continue;
        }
        for side in if m.likely(0.4) { &[1.0, -1.0][..] } else { &[1.0] } {
            let at = V::new(at.x, at.y * side, at.z);
            let arg = m.arg(true);
            let law = if m.likely(0.8) { Law::Rolls } else { Law::Blade };
            let lines = format!("at = {}\nrotation = \"rotation(x, {camber:?})\"\n", written(at));
            let knuckle = vec![Step::Shift(at), Step::Turn(V::x(), Arg::number(camber))];
            let knuckle = m.body(&lines, Some(on), knuckle, false);
            let hinge = format!("joint = {{ hinge = \"y\", angle = \"{}\" }}\n", arg.text);
            let lines = format!("shape = \"wheel\"\nsize = [{a:?}]\n{hinge}");
            let i = m.body(&lines, Some(knuckle), vec![Step::Turn(V::y(), arg.clone())], true);
            m.contact(i, None, Shape::Wheel(a, 0.0), law);
            m.link(Some((i, arg)));
        }
    }
    m
}

/// A chain whose end is held where it is at the start, by a point that closes the loop.
fn closed(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    m.may_be_homogeneous = true;
    let slope = m.likely(0.3).then(|| m.slope());
    let is_flat = m.likely(0.5);
    let mut on = slope;
    for _ in 0..if is_flat { 3 } else { 4 } {
        let (i, _) = if is_flat {
            let (at, arg) = (V::new(0.6, m.number(0.3), 0.0), m.arg(true));
            let lines = format!("joint = {{ hinge = \"z\", angle = \"{}\", at = {} }}\n", arg.text, written(at));
            (m.body(&lines, on, vec![Step::Shift(at), Step::Turn(V::z(), arg)], true), None)
        } else {
            let kind = if m.likely(0.8) { "hinge" } else { "ball" };
            m.jointed(on, kind, true)
        };
        on = Some(i);
    }
    let last = m.bodies.len() - 1;
    let end = V::new(0.7, m.number(0.3), if is_flat { 0.0 } else { 0.2 });
    let still = vec![0.0; m.start.len()];
    let frames = m.frames((0.4, &m.start, &still));
    let (to, name) = if m.likely(0.3) && slope.is_some() { (slope, "b0") } else { (None, "space") };
    let there = frames[last].point(end).p;
    let own = to.map_or(there, |i| frames[i].r.transpose() * (there - frames[i].p));
    m.text += &format!("[loop.pin]\nbetween = {{ b{last} = {}, {name} = {} }}\n", written(end), written(own));
    m.forces.push((Between::Points([(Some(last), end), (to, own)]), Force::Loop));
    m
}

/// The benchmark bicycle whose rider leans: a torso on a hinge along the frame, with a spring and a damper.
fn rider(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    m.gravity = V::new(0.0, 0.0, -9.81);
    m.head = "title = \"bicycle\"\ngravity = [0, 0, -9.81]\n".into();
    let [x, y, yaw, lean] = ["m", "m", "rad", "rad"].map(|unit| m.coordinate(unit == "rad", false));
    let pitch = m.coordinate(true, true);
    m.coordinates = m.coordinates.replace(&format!("guess = {}", m.start[pitch] + 0.02), "guess = 0");
    let [steer, rear, front, torso] = [(); 4].map(|()| m.coordinate(true, false));
    let arg = |k: usize| Arg { text: format!("q{k}"), linear: vec![(k, 1.0)], ..Arg::default() };
    let turn = |axis: V, k: usize| Step::Turn(axis, arg(k));
    let tilt = |angle: f64| Step::Turn(V::y(), Arg::number(angle));
    let upright = vec![Step::Slide(V::x(), arg(x)), Step::Slide(V::y(), arg(y)), turn(V::z(), yaw), turn(V::x(), lean)];
    let upright = [upright, vec![Step::Shift(V::z() * 0.3)]].concat();
    let hub = "at = \"[q0, q1, 0] + rotation(zx, q2, q3)*[0, 0, 0.3]\"\nrotation = \"rotation(zxy, q2, q3";
    let (axis, on_fork) = (V::new(1.1, 0.0, -0.3), V::new(1.02, 0.0, 0.05));
    let seat = V::new(0.1, 0.0, 0.5);
    let parts: [(String, Option<usize>, Vec<Step>, f64, V, [f64; 4]); 5] = [
        (
            format!("{hub}, q{rear})\"\nshape = \"wheel\"\nsize = [0.3]\n"),
            None,
            [upright.clone(), vec![turn(V::y(), rear)]].concat(),
            2.0,
            V::zeros(),
            [0.0603, 0.12, 0.0603, 0.0],
        ),
        (
            format!("{hub}, q{pitch})\"\n"),
            None,
            [upright, vec![turn(V::y(), pitch)]].concat(),
            25.0,
            V::new(0.4, 0.0, 0.2),
            [2.2, 4.0, 2.0, -0.4],
        ),
        (
            format!(
                "joint = {{ hinge = \"z\", angle = \"q{steer}\", at = {a}, own = {a}, axes = \"rotation(y, -0.3)\" }}\n",
                a = written(axis)
            ),
            Some(1),
            vec![Step::Shift(axis), tilt(-0.3), turn(V::z(), steer), tilt(0.3), Step::Shift(-axis)],
            4.0,
            V::new(0.9, 0.0, 0.4),
            [0.05892, 0.06, 0.00708, 0.00756],
        ),
        (
            format!(
                "joint = {{ hinge = \"y\", angle = \"q{front}\", at = {} }}\nshape = \"wheel\"\nsize = [0.35]\n",
                written(on_fork)
            ),
            Some(2),
            vec![Step::Shift(on_fork), turn(V::y(), front)],
            3.0,
            V::zeros(),
            [0.1405, 0.28, 0.1405, 0.0],
        ),
        (
            format!("joint = {{ hinge = \"x\", angle = \"q{torso}\", at = {} }}\n", written(seat)),
            Some(1),
            vec![Step::Shift(seat), turn(V::x(), torso)],
            60.0,
            V::new(0.1, 0.0, 0.35),
            [4.0, 3.5, 1.5, 0.2],
        ),
    ];
    for (i, (lines, parent, steps, mass, centre, [a, b, c, d])) in parts.into_iter().enumerate() {
        let on = parent.map_or_else(String::new, |on| format!("on = \"b{on}\"\n"));
        let mass_centre =
            if centre == V::zeros() { String::new() } else { format!("mass-centre = {}\n", written(centre)) };
        m.text += &format!(
            "[body.b{i}]\n{on}{lines}mass = {mass:?}\n{mass_centre}inertia = [[{a:?}, 0, {d:?}], [0, {b:?}, 0], [{d:?}, 0, {c:?}]]\n"
        );
        let moments = Matrix3::new(a, 0.0, d, 0.0, b, 0.0, d, 0.0, c);
        m.bodies.push(Body { parent, steps, mass, moments, centre, surface: None });
    }
    m.contact(0, None, Shape::Wheel(0.3, 0.0), Law::Rolls);
    m.contact(3, None, Shape::Wheel(0.35, 0.0), Law::Rolls);
    for (kind, key, force) in
        [("spring", "stiffness = 40.0", Force::Spring(40.0, 0.0)), ("damper", "damping = 3.0", Force::Damper(3.0))]
    {
        m.text += &format!("[{kind}.torso]\njoint = \"b4\"\n{key}\n");
        m.forces.push((Between::Joint(arg(torso)), force));
    }
    m
}

/// Whether a fault says rightly that a drawn machine is none.
fn is_no_machine(fault: &str) -> bool {
    [
        "nothing to move",
        "is empty",
        "no start of",
        "configurations",
        "configuration",
        "a heading only",
        "singular",
        "no solution",
    ]
    .iter()
    .any(|words| fault.contains(words))
}

#[test]
fn drawn_machines_move_as_newton_and_euler_have_it() {
    let (mut compared, mut faults, mut worst) = (0, Vec::new(), 0.0_f64);
    for (kind, make, count) in [
        ("tree", tree as fn(u64) -> Machine, 80_u64),
        ("rolling", rolling, 80),
        ("robot", robot, 60),
        ("loop", closed, 40),
        ("inside", inside, 80),
        ("bicycle with a leaning rider", rider, 5),
    ] {
        let (mut of_kind, mut largest) = (0, 0.0_f64);
        for seed in 0..count {
            let machine = make(1000 * seed + 76);
            let text = machine.scene_text();
            let scene = match Scene::parse("drawn", &text) {
                Ok(scene) => scene,
                Err(fault) if is_no_machine(&fault.to_string()) => {
                    println!("{kind} {seed}: {}", fault.to_string().lines().next().unwrap_or_default());
                    continue;
                }
                Err(fault) => {
                    faults.push(format!("{kind} {seed}: {fault}\n{text}"));
                    continue;
                }
            };
            let (t, q, v) = (scene.start.t, &scene.start.q, &scene.start.v);
            let (expected, off) = machine.accelerations(t, q, v);
            if expected.len() < q.len() {
                println!("{kind} {seed}: something without mass");
                continue;
            }
            if machine.leans_past_flat(t, q) {
                println!("{kind} {seed}: leans past flat");
                continue;
            }
            let mut rates = vec![0.0; 2 * q.len()];
            let equations = equations(&scene.system, CHETAEV, None);
            let mut compiled = Compiled::new(&equations).unwrap_or_else(|e| panic!("{e}"));
            if let Err(fault) = compiled.rates(t, &[&q[..], v].concat(), &mut rates) {
                faults.push(format!("{kind} {seed}: {fault}\n{text}"));
                continue;
            }
            let found = DVector::from_row_slice(&rates[q.len()..]);
            let apart = (&found - &expected).amax() / expected.amax().max(1.0);
            of_kind += 1;
            if apart.max(off).partial_cmp(&1e-10) != Some(std::cmp::Ordering::Less) {
                faults
                    .push(format!("{kind} {seed}: {apart:.1e} apart, start {off:.1e} off\n{text}\n{found}{expected}"));
            } else {
                largest = largest.max(apart);
            }
        }
        println!("{kind}: {of_kind} of {count} compared, largest difference {largest:.1e}");
        compared += of_kind;
        worst = worst.max(largest);
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n\n"));
    assert!(compared >= 200, "{compared} machines");
    must("drawn machines: accelerations", worst, 1e-10);
}
