//! The parts of a machine, drawn, and their text.

use nalgebra::Matrix3;
use symbolic::SplitMix;

use super::frame::{Arg, Between, Body, Contact, Force, Law, Shape, Step, V};

/// A machine, and its text.
pub(super) struct Machine {
    pub(super) random: SplitMix,
    pub(super) head: String,
    pub(super) coordinates: String,
    pub(super) definitions: String,
    pub(super) velocities: String,
    pub(super) text: String,
    pub(super) start: Vec<f64>,
    pub(super) is_angle: Vec<bool>,
    pub(super) may_be_homogeneous: bool,
    pub(super) gravity: V,
    pub(super) bodies: Vec<Body>,
    pub(super) forces: Vec<(Between, Force)>,
    pub(super) contacts: Vec<Contact>,
}

pub(super) fn written(v: V) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

pub(super) fn letter(c: char) -> V {
    V::ith("xyz".find(c).unwrap_or_default(), 1.0)
}

pub(super) const WORDS: [&str; 8] = ["zxz", "zxy", "xyz", "yxy", "zyx", "xzx", "yxz", "zx"];

impl Machine {
    pub(super) fn new(seed: u64) -> Machine {
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

    pub(super) fn likely(&mut self, p: f64) -> bool {
        self.random.unit() < p
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        ((self.random.unit() * n as f64) as usize).min(n - 1)
    }

    /// A number between −size and size.
    pub(super) fn number(&mut self, size: f64) -> f64 {
        ((2.0 * self.random.unit() - 1.0) * size * 100.0).round() / 100.0
    }

    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        ((from + (to - from) * self.random.unit()) * 100.0).round() / 100.0
    }

    pub(super) fn vector(&mut self, size: f64) -> V {
        V::new(self.number(size), self.number(size), self.number(size))
    }

    pub(super) fn axis(&mut self) -> V {
        match self.below(5) {
            k @ 0..3 => V::ith(k, self.number(1.0).signum()),
            _ => self.vector(1.0) + V::new(0.01, 1.5, 0.0),
        }
    }

    pub(super) fn coordinate(&mut self, is_angle: bool, supplied: bool) -> usize {
        let (k, x, v) = (self.start.len(), self.number(if is_angle { 1.0 } else { 0.5 }), self.number(1.0));
        let unit = if is_angle { "rad" } else { "m" };
        let start = if supplied { format!("guess = {}", x + 0.02) } else { format!("start = {x}") };
        self.coordinates += &format!("q{k} = {{ unit = \"{unit}\", {start} }}\n");
        self.velocities += &format!("\"q{k}'\" = {v}\n");
        self.start.push(x);
        self.is_angle.push(is_angle);
        k
    }

    pub(super) fn arg(&mut self, is_angle: bool) -> Arg {
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
    pub(super) fn turns(word: &str, angles: Vec<Arg>) -> (String, Vec<Step>) {
        let list: Vec<&str> = angles.iter().map(|arg| arg.text.as_str()).collect();
        let text = format!("rotation({word}, {})", list.join(", "));
        (text, word.chars().zip(angles).map(|(c, arg)| Step::Turn(letter(c), arg)).collect())
    }

    pub(super) fn word(&mut self) -> &'static str {
        WORDS[self.below(WORDS.len())]
    }

    /// A body with moments and a mass centre, or without both; its name is its number.
    pub(super) fn body(&mut self, lines: &str, parent: Option<usize>, steps: Vec<Step>, is_heavy: bool) -> usize {
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
    pub(super) fn homogeneous(&mut self, body: &mut Body) -> String {
        let [a, b, c] = [(); 3].map(|()| self.between(0.3, 0.9));
        let [x, y, z] = [V::x(), V::y(), V::z()].map(|e| e * e.transpose());
        // mean squares of one coordinate over interval, disc and ball of radius 1
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
    pub(super) fn slope(&mut self) -> usize {
        let (a, b) = (self.number(0.5), self.number(0.5));
        let (text, steps) = Machine::turns("yx", vec![Arg::number(a), Arg::number(b)]);
        let at = self.vector(0.5);
        let lines = format!("shape = \"plane\"\nsize = [1, 1]\nat = {}\nrotation = \"{text}\"\n", written(at));
        self.body(&lines, None, [vec![Step::Shift(at)], steps].concat(), false)
    }

    /// A body that nothing holds: its place, with a height that contacts may supply, and its rotation.
    pub(super) fn free(&mut self, on: Option<usize>, word: &str, height: Option<f64>, shape: &str) -> usize {
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
    pub(super) fn jointed(&mut self, on: Option<usize>, kind: &str, is_heavy: bool) -> (usize, Option<Arg>) {
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
    pub(super) fn link(&mut self, joint: Option<(usize, Arg)>) {
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

    pub(super) fn contact(&mut self, of: usize, on: Option<usize>, shape: Shape, law: Law) {
        let word = ["rolls", "blade", "slides", "rubber"][law as usize];
        let on_text = on.map_or_else(String::new, |on| format!("on = \"b{on}\"\n"));
        let at = if let Shape::Point(at) = shape { format!("at = {}\n", written(at)) } else { String::new() };
        self.text += &format!("[contact.c{}]\nof = \"b{of}\"\nlaw = \"{word}\"\n{on_text}{at}", self.contacts.len());
        self.contacts.push(Contact { of, on, shape, law });
    }

    pub(super) fn scene_text(&self) -> String {
        let Machine { head, coordinates, definitions, velocities, text, .. } = self;
        format!(
            "{head}{coordinates}{definitions}[start]\ntime = 0.4\nproject = true\n[start.velocities]\n{velocities}[run]\nduration = 1\n{text}"
        )
    }
}
