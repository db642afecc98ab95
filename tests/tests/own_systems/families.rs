//! Systems drawn family by family, as scene text.

use symbolic::SplitMix;

/// A family of systems.
pub(super) struct Family {
    pub(super) name: &'static str,
    /// Whether round-off of the equations is no more than that of their states.
    pub(super) is_well_conditioned: bool,
    pub(super) draw: fn(&mut Draw) -> String,
}

pub(super) const FAMILIES: [Family; 12] = [
    family("oscillators in other coordinates", true, curved),
    family("forced oscillators", true, forced),
    family("swings and orbits", true, swings),
    family("nonholonomic", true, nonholonomic),
    family("nonlinear constraints", true, nonlinear),
    family("small scales", true, small),
    family("stiff decays", true, stiff),
    family("forces that cancel", false, cancelling),
    family("forces that cancel mildly", false, mild),
    family("constraint forces that cancel", false, held),
    family("late starts", false, late),
    family("far from the origin", false, far),
];

const fn family(name: &'static str, is_well_conditioned: bool, draw: fn(&mut Draw) -> String) -> Family {
    Family { name, is_well_conditioned, draw }
}

/// Numbers that look random, and what was drawn with them.
pub(super) struct Draw {
    random: SplitMix,
    /// A force that loses digits, and the same one where it does not.
    force: [String; 2],
}

impl Draw {
    pub(super) fn new(seed: u64) -> Draw {
        Draw { random: SplitMix::new(seed), force: Default::default() }
    }

    /// A system as it is asked for, and for the judge.
    pub(super) fn system(&mut self, family: &Family) -> [String; 2] {
        self.force = Default::default();
        let text = (family.draw)(self);
        let [force, same] = &self.force;
        let for_judge = if force.is_empty() { text.clone() } else { text.replace(force, same) };
        [text, for_judge]
    }

    /// A force whose terms are larger by a power of ten between these, below 1. The number in it has few
    /// digits, so that equations are derived in exact ones.
    fn force(&mut self, low: f64, high: f64) -> String {
        let e = format!("{:.2e}", self.power(low, high));
        self.force = self.one_of(&CANCELLING).map(|force| force.replace('E', &e));
        self.force[0].clone()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.unit()
    }

    /// A power of ten.
    fn power(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.between(low, high))
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[(self.random.unit() * all.len() as f64) as usize]
    }
}

/// A scene from coordinates with start and velocity, which is left to the constraints where it is NaN.
fn scene(coordinates: &[(&str, f64, f64)], system: &str, time: f64, duration: f64) -> String {
    let start: String = coordinates.iter().map(|(name, q, _)| format!("{name} = {{ start = {q:?} }}\n")).collect();
    let given = coordinates.iter().filter(|(.., v)| !v.is_nan());
    let velocities: String = given.map(|(name, _, v)| format!("\"{name}'\" = {v:?}\n")).collect();
    format!(
        "title = \"drawn\"\n[coordinates]\n{start}[system]\n{system}\n[start]\ntime = {time:?}\nproject = true\n\
         [start.velocities]\n{velocities}[run]\nduration = {duration:?}\n"
    )
}

/// Free motion, an oscillator or a fall in one coordinate or two that are bent.
fn curved(draw: &mut Draw) -> String {
    let (k, q, v, duration) =
        (draw.power(-1.0, 1.0), draw.between(0.3, 1.0), draw.between(-1.0, 1.0), draw.between(1.0, 20.0));
    match draw.one_of(&[0, 1, 2, 3]) {
        0 => {
            let lagrangian = format!("lagrangian = \"cosh(u)^2*u'^2/2 - {k:?}*sinh(u)^2/2\"");
            scene(&[("u", q, v)], &lagrangian, 0.0, duration)
        }
        1 => {
            let lagrangian = format!("lagrangian = \"exp(2*u)*u'^2/2 - {k:?}*(exp(u) - 2)^2/2\"");
            scene(&[("u", q, 0.3 * v)], &lagrangian, 0.0, duration)
        }
        2 => {
            let lagrangian = format!("lagrangian = \"(r'^2 + r^2*a'^2)/2 - {k:?}*r^2/2\"");
            scene(&[("r", q, v), ("a", 0.0, draw.between(0.5, 2.0))], &lagrangian, 0.0, duration)
        }
        _ => {
            let lagrangian =
                format!("lagrangian = \"((u^2 + w^2)*(u'^2 + w'^2))/2 - {k:?}*(u^2 - w^2)^2/8 - {k:?}*(u*w)^2/2\"");
            scene(&[("u", 1.0 + q, v), ("w", q, draw.between(0.5, 1.0))], &lagrangian, 0.0, 0.5 * duration)
        }
    }
}

fn forced(draw: &mut Draw) -> String {
    let (k, c, w) = (draw.power(-1.0, 2.0), draw.between(0.0, 0.5), draw.between(0.2, 4.0));
    let f = draw.between(0.5, 3.0);
    let force = draw.one_of(&["cos(W*t)", "exp(-W*t)", "sin(W*t)*x", "1/(1 + (W*t)^2)", "tanh(W*(t - 1))"]);
    let force = force.replace('W', &format!("{w:?}"));
    let system = format!("lagrangian = \"x'^2/2 - {k:?}*x^2/2\"\nforces = {{ x = \"{f:?}*{force} - {c:?}*x'\" }}");
    let v = draw.between(-1.0, 1.0);
    scene(&[("x", draw.between(-1.0, 1.0), v)], &system, 0.0, draw.between(1.0, 40.0))
}

fn swings(draw: &mut Draw) -> String {
    let (q, v, duration) = (draw.between(0.2, 2.0), draw.between(-1.0, 1.0), draw.between(2.0, 15.0));
    match draw.one_of(&[0, 1, 2, 3]) {
        0 => scene(&[("a", q, v)], "lagrangian = \"a'^2/2 + 9.81*cos(a)\"", 0.0, duration),
        1 => {
            let lagrangian = "lagrangian = \"(x'^2 + y'^2)/2 + 1/sqrt(x^2 + y^2)\"";
            scene(&[("x", 1.0, 0.0), ("y", 0.0, draw.between(0.8, 1.3))], lagrangian, 0.0, duration)
        }
        2 => {
            let lagrangian = "lagrangian = \"(r'^2 + r^2*a'^2)/2 + 9.81*r*cos(a) - 20*(r - 1)^2\"";
            scene(&[("r", 1.2, 0.0), ("a", 0.5 * q, v)], lagrangian, 0.0, 0.3 * duration)
        }
        _ => {
            let lagrangian = "lagrangian = \"a'^2 + b'^2/2 + a'*b'*cos(a - b) + 2*9.81*cos(a) + 9.81*cos(b)\"";
            scene(&[("a", 0.5 * q, v), ("b", -0.3 * q, 0.0)], lagrangian, 0.0, 0.3 * duration)
        }
    }
}

fn nonholonomic(draw: &mut Draw) -> String {
    let (a, w, duration) = (draw.between(0.0, 1.5), draw.between(0.3, 2.0), draw.between(1.0, 15.0));
    let (k, nan) = (draw.between(0.3, 2.0), f64::NAN);
    match draw.one_of(&[0, 1, 2, 3]) {
        // sledge on a slope
        0 => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2 + {k:?}*a'^2)/2 + 3*x\"\nconstraints = [\"y'*cos(a) - x'*sin(a)\"]"
            );
            let v = draw.between(0.1, 1.0) * a.cos();
            scene(&[("x", 0.0, v), ("y", 0.0, nan), ("a", a, w)], &system, 0.0, duration)
        }
        // Chaplygin's sleigh
        1 => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2)/2 + {k:?}*a'*(y'*cos(a) - x'*sin(a)) + {k:?}^2*a'^2\"\n\
                 constraints = [\"y'*cos(a) - x'*sin(a)\"]"
            );
            scene(&[("x", 0.0, 0.5 * a.cos()), ("y", 0.0, nan), ("a", a, w)], &system, 0.0, 0.5 * duration)
        }
        // disc that rolls upright
        2 => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2)/2 + {k:?}*a'^2/2 + r'^2/4 + 2*x\"\n\
                 constraints = [\"x' - 0.5*r'*cos(a)\", \"y' - 0.5*r'*sin(a)\"]"
            );
            let coordinates = [("x", 0.0, nan), ("y", 0.0, nan), ("a", a, w), ("r", 0.0, draw.between(-2.0, 2.0))];
            scene(&coordinates, &system, 0.0, duration)
        }
        // particle with z' = y x'
        _ => {
            let system =
                format!("lagrangian = \"(x'^2 + y'^2 + z'^2)/2 - {k:?}*(x^2 + y^2)/2\"\nconstraints = [\"z' - y*x'\"]");
            scene(&[("x", a, w), ("y", 0.5, -0.3), ("z", 0.0, nan)], &system, 0.0, duration)
        }
    }
}

fn nonlinear(draw: &mut Draw) -> String {
    let (c, duration) = (draw.between(0.5, 2.0), draw.between(0.5, 6.0));
    let (a, nan) = (draw.between(0.2, 1.3), f64::NAN);
    match draw.one_of(&[0, 1, 2]) {
        // constant speed in a field
        0 => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2)/2 - x^2/2 + 2*y\"\nconstraints = [\"x'^2 + y'^2 - {:?}\"]",
                c * c
            );
            scene(&[("x", 0.3, c * a.cos()), ("y", 0.0, c * a.sin())], &system, 0.0, duration)
        }
        // Appell and Hamel
        1 => {
            let system = "lagrangian = \"(x'^2 + y'^2 + z'^2)/2 - 9.81*z\"\nconstraints = [\"x'^2 + y'^2 - z'^2\"]";
            let v = [c * a.cos(), c * a.sin(), c];
            scene(&[("x", 0.0, v[0]), ("y", 0.0, v[1]), ("z", 0.0, v[2])], system, 0.0, 0.1 * duration)
        }
        _ => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2)/2 - {c:?}*(x^2 + y^2)/2\"\nconstraints = [\"y' - x'^2/2 - x/4\"]"
            );
            scene(&[("x", a, 0.4), ("y", 0.2, nan)], &system, 0.0, duration)
        }
    }
}

/// Masses, lengths and times in units that make small or large numbers.
fn small(draw: &mut Draw) -> String {
    let (m, l, s) = (draw.power(-15.0, 3.0), draw.power(-10.0, 3.0), draw.power(-6.0, 3.0));
    let (k, v) = (m / (s * s), draw.between(-1.0, 1.0) * l / s);
    let duration = draw.between(1.0, 20.0) * s;
    match draw.one_of(&[0, 1]) {
        0 => {
            let system = format!("lagrangian = \"{m:?}*x'^2/2 - {k:?}*x^2/2*(1 + (x/{l:?})^2/2)\"");
            scene(&[("x", l, v)], &system, 0.0, duration)
        }
        _ => {
            let system = format!(
                "lagrangian = \"{m:?}*(x'^2 + y'^2 + {l:?}^2*a'^2)/2 + {m:?}*{:?}*x\"\n\
                 constraints = [\"y'*cos(a) - x'*sin(a)\"]",
                l / (s * s)
            );
            let a = draw.between(0.1, 1.3);
            scene(&[("x", 0.0, v * a.cos()), ("y", 0.0, f64::NAN), ("a", a, 1.0 / s)], &system, 0.0, duration)
        }
    }
}

fn stiff(draw: &mut Draw) -> String {
    let (rate, w) = (draw.power(0.5, 3.0), draw.between(0.5, 3.0));
    let force = draw.one_of(&["-R*(x' - cos(W*t))", "-R*(x' + x^3)", "-R*x' - R*W*sin(x)"]);
    let force = force.replace('R', &format!("{rate:?}")).replace('W', &format!("{w:?}"));
    let system = format!("lagrangian = \"x'^2/2\"\nforces = {{ x = \"{force}\" }}");
    scene(&[("x", draw.between(0.3, 1.0), draw.between(-1.0, 1.0))], &system, 0.0, draw.between(0.5, 3.0))
}

/// Forces of size x, as differences of terms that are larger by 1/E, and without them.
const CANCELLING: [[&str; 2]; 10] = [
    ["(exp(E*x) - 1)/E", "2*exp(E*x/2)*sinh(E*x/2)/E"],
    ["2*(1 - cos(E*x))/E^2*x", "4*sin(E*x/2)^2/E^2*x"],
    ["(sqrt(1 + 2*E*x) - 1)/E", "2*x/(1 + sqrt(1 + 2*E*x))"],
    ["(1/(1 - E*x) - 1)/E", "x/(1 - E*x)"],
    ["((x + 1/E)^2 - 1/E^2 - x^2)*E/2", "x"],
    ["log(1 + E*x)/E", "log(1 + E*x)/E"],
    ["(cos(1 - E*x) - cos(1))/E", "2*sin(1 - E*x/2)*sin(E*x/2)/E"],
    ["((1 + E*x)^5 - 1)/(5*E)", "(x + 2*E*x^2 + 2*E^2*x^3 + E^3*x^4 + E^4*x^5/5)"],
    ["((x + 1/E)^3 - 1/E^3)*E^2/3", "(x + E*x^2 + E^2*x^3/3)"],
    ["(tan(0.5 + E*x) - tan(0.5))/E", "sin(E*x)/(cos(0.5 + E*x)*cos(0.5)*E)"],
];

fn cancels(draw: &mut Draw, low: f64, high: f64) -> String {
    let force = draw.force(low, high);
    let k = draw.power(-0.5, 1.0);
    let system = format!("lagrangian = \"x'^2/2\"\nforces = {{ x = \"-{k:?}*({force})\" }}");
    scene(&[("x", draw.between(0.0, 1.0), draw.between(0.3, 1.0))], &system, 0.0, draw.between(0.5, 15.0))
}

fn cancelling(draw: &mut Draw) -> String {
    cancels(draw, -9.0, -3.0)
}

fn mild(draw: &mut Draw) -> String {
    cancels(draw, -3.0, -0.7)
}

/// A sledge, and a particle whose velocity is held, under such forces.
fn held(draw: &mut Draw) -> String {
    let force = draw.force(-8.0, -1.0);
    let a = draw.between(0.2, 1.2);
    match draw.one_of(&[0, 1]) {
        0 => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2 + a'^2)/2\"\nconstraints = [\"y'*cos(a) - x'*sin(a)\"]\n\
                 forces = {{ x = \"-({force})\" }}"
            );
            let v = draw.between(0.2, 1.0);
            scene(&[("x", 0.5, v), ("y", 0.0, f64::NAN), ("a", a, 0.5)], &system, 0.0, draw.between(1.0, 8.0))
        }
        _ => {
            let system = format!(
                "lagrangian = \"(x'^2 + y'^2)/2 - x^2/2\"\nconstraints = [\"y' - 0.3*x'\"]\n\
                 forces = {{ y = \"-({force})\" }}"
            );
            scene(&[("x", 0.2, a), ("y", 0.0, f64::NAN)], &system, 0.0, draw.between(1.0, 10.0))
        }
    }
}

/// Forces of the time since a start that is late.
fn late(draw: &mut Draw) -> String {
    let (start, w) = (draw.power(2.0, 8.0), draw.between(0.5, 3.0));
    let force = draw.one_of(&["cos(W*t)", "sin(W*(t - S))", "exp(-(t - S)/W)", "sin(W*t)*x", "1/(1 + W*(t - S)^2)"]);
    let force = force.replace('W', &format!("{w:?}")).replace('S', &format!("{start:?}"));
    let k = draw.power(-1.0, 1.0);
    let system = format!("lagrangian = \"x'^2/2 - {k:?}*x^2/2\"\nforces = {{ x = \"{force}\" }}");
    scene(&[("x", draw.between(0.0, 1.0), draw.between(-1.0, 1.0))], &system, start, draw.between(1.0, 10.0))
}

/// Springs and wells at a place far away.
fn far(draw: &mut Draw) -> String {
    let (place, k) = (draw.power(2.0, 8.0), draw.power(-1.0, 1.0));
    let potential = draw.one_of(&["(x - P)^2/2", "((x - P)^2 + (x - P)^4)/4", "-cos(x - P)", "-exp(-(x - P)^2)"]);
    let potential = potential.replace('P', &format!("{place:?}"));
    let system = format!("lagrangian = \"x'^2/2 - {k:?}*({potential})\"");
    let start = place + draw.between(0.1, 0.8);
    scene(&[("x", start, draw.between(-0.5, 0.5))], &system, 0.0, draw.between(1.0, 10.0))
}
