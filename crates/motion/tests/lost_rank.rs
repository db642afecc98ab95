//! Places where constraints lose rank: no motion leaves one on another branch and says nothing.

use integrate::Method;
use mechanics::State;
use motion::{
    Choice, Ending, Ensemble, EnsembleOptions, Setting, Settings, choices, error_estimate, setting, solve_choice,
};
use scene::Scene;

/// A mechanism with one degree of freedom, whose motion through such a place is known.
struct Mechanism {
    coordinates: [&'static str; 3],
    lagrangian: &'static str,
    /// As positions, and as rates.
    constraints: [&'static [&'static str]; 2],
    /// Positions and velocities of the motion that starts at this phase at speed 1 after so much time.
    truth: fn(f64, f64) -> (Vec<f64>, Vec<f64>),
    /// Phases of starts, and the duration that leads past the place.
    phases: [f64; 2],
    duration: f64,
}

/// `y' = f(y)` by Runge and Kutta's method in many equal steps.
fn advance(mut y: f64, time: f64, f: impl Fn(f64) -> f64) -> f64 {
    let h = time / 2000.0;
    for _ in 0..2000 {
        let a = f(y);
        let b = f(y + h / 2.0 * a);
        let c = f(y + h / 2.0 * b);
        y += h / 6.0 * (a + 2.0 * b + 2.0 * c + f(y + h * c));
    }
    y
}

/// x = cos φ/(1 + sin² φ), y = x sin φ, ds = dφ/√(1 + sin² φ).
fn lemniscate(phase: f64, t: f64) -> (Vec<f64>, Vec<f64>) {
    let rate = |phi: f64| (1.0 + phi.sin().powi(2)).sqrt();
    let phi = advance(phase, t, rate);
    let (s, c) = phi.sin_cos();
    let d = 1.0 + s * s;
    let (x, dx) = (c / d, (-s * d - 2.0 * s * c * c) / (d * d));
    (vec![x, x * s], vec![dx * rate(phi), (dx * s + x * c) * rate(phi)])
}

/// The parallelogram of four equal bars turns at a constant rate.
fn parallelogram(phase: f64, t: f64) -> (Vec<f64>, Vec<f64>) {
    (vec![phase + t, 0.0, phase + t], vec![1.0, 0.0, 1.0])
}

/// Crank and rod of the same length: b = −a, s = 2 cos a, and a'² (2 + 4 sin² a)/2 is the energy.
fn slider(phase: f64, t: f64) -> (Vec<f64>, Vec<f64>) {
    let weight = |a: f64| (2.0 + 4.0 * a.sin().powi(2)).sqrt();
    let a = advance(phase, t, |a| weight(phase) / weight(a));
    let rate = weight(phase) / weight(a);
    (vec![a, -a, 2.0 * a.cos()], vec![rate, -rate, -2.0 * a.sin() * rate])
}

const MECHANISMS: [Mechanism; 3] = [
    Mechanism {
        coordinates: ["x", "y", ""],
        lagrangian: "(x'^2 + y'^2)/2",
        constraints: [&["(x^2 + y^2)^2 - x^2 + y^2"], &["(4*x*(x^2 + y^2) - 2*x)*x' + (4*y*(x^2 + y^2) + 2*y)*y'"]],
        truth: lemniscate,
        phases: [0.0, 0.7],
        duration: 2.0,
    },
    Mechanism {
        coordinates: ["a", "b", "c"],
        lagrangian: "(a'^2 + b'^2 + c'^2)/2",
        constraints: [
            &["cos(a) + cos(b) - cos(c) - 1", "sin(a) + sin(b) - sin(c)"],
            &["sin(a)*a' + sin(b)*b' - sin(c)*c'", "cos(a)*a' + cos(b)*b' - cos(c)*c'"],
        ],
        truth: parallelogram,
        phases: [0.5, 2.5],
        duration: 3.0,
    },
    Mechanism {
        coordinates: ["a", "b", "s"],
        lagrangian: "(a'^2 + b'^2 + s'^2)/2",
        constraints: [
            &["cos(a) + cos(b) - s", "sin(a) + sin(b)"],
            &["sin(a)*a' + sin(b)*b' + s'", "cos(a)*a' + cos(b)*b'"],
        ],
        truth: slider,
        phases: [0.0, 1.3],
        duration: 3.0,
    },
];

impl Mechanism {
    fn scene(&self, rates: bool, phase: f64) -> Scene {
        let (q, v) = (self.truth)(phase, 0.0);
        let names = self.coordinates.iter().take(q.len());
        let coordinates: String =
            names.clone().zip(&q).map(|(name, x)| format!("{name} = {{ start = {x:?} }}\n")).collect();
        let velocities: String = names.zip(&v).map(|(name, x)| format!("\"{name}'\" = {x:?}\n")).collect();
        let text = format!(
            "title = \"branches\"\n[coordinates]\n{coordinates}[system]\nlagrangian = \"{}\"\nconstraints = {:?}\n\
             [start.velocities]\n{velocities}[run]\nduration = {:?}\n",
            self.lagrangian,
            self.constraints[usize::from(rates)],
            self.duration
        );
        Scene::parse("branches", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
    }

    fn phase(&self, share: f64) -> f64 {
        self.phases[0] + share * (self.phases[1] - self.phases[0])
    }

    fn is_right(&self, phase: f64, q: &[f64], error: f64) -> bool {
        let apart = (self.truth)(phase, self.duration).0;
        let apart = apart.iter().zip(q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        apart <= 10.0 * error + 1e-9
    }
}

fn chetaev(scene: &Scene) -> Choice {
    choices(scene).into_iter().find(|choice| choice.formulation == motion::CHETAEV).expect("a choice")
}

/// How many went through right, stopped with the reason, and were wrong and said nothing.
type Count = [usize; 3];

fn alone(mechanism: &Mechanism, rates: bool, phase: f64, settings: &Settings, count: &mut Count) {
    let scene = mechanism.scene(rates, phase);
    let mut motion = solve_choice(&scene, &chetaev(&scene), settings).expect("a motion");
    let estimate = error_estimate(&mut motion, setting(&scene)).expect("an estimate");
    let (status, words) = estimate.status(&motion);
    let place = match status {
        "completed" => {
            let end = motion.at(motion.end()).expect("its end");
            let error = estimate.coordinates.iter().copied().fold(0.0, f64::max);
            if mechanism.is_right(phase, &end.coordinates, error) { 0 } else { 2 }
        }
        _ => {
            let words = words.unwrap_or_default();
            assert!(words.contains("says nothing of the velocities at"), "{phase}, {settings:?}: {words}");
            1
        }
    };
    count[place] += 1;
    assert!(
        place < 2,
        "{}, rates {rates}, phase {phase}, {:e}: silently wrong",
        mechanism.lagrangian,
        settings.tolerance
    );
}

#[test]
fn no_motion_changes_branches_silently() {
    let mut count = [0; 3];
    for mechanism in &MECHANISMS {
        for rates in [false, true] {
            for i in 0..STARTS {
                let share = (0.5 + i as f64) / STARTS as f64;
                let tolerance = [1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12][i % 8];
                let settings = Settings { tolerance, ..Settings::default() };
                alone(mechanism, rates, mechanism.phase(share), &settings, &mut count);
                if i % 10 == 0 {
                    for method in [Method::Dop853, Method::Radau5] {
                        let settings = Settings { method: Some(method), ..Settings::default() };
                        alone(mechanism, rates, mechanism.phase(share), &settings, &mut count);
                    }
                }
            }
        }
    }
    println!("{count:?}: went through, stopped with the reason, wrong");
    assert!(count[0] + count[1] >= 6 * STARTS && count[2] == 0, "{count:?}");
}

/// Starts of each kind.
const STARTS: usize = 200;

#[test]
fn no_member_changes_branches_silently() {
    for mechanism in &MECHANISMS {
        for rates in [false, true] {
            for tolerance in [1e-5, 1e-8, 1e-12] {
                let scene = mechanism.scene(rates, mechanism.phase(0.5));
                let settings = Settings { tolerance, ..Settings::default() };
                let mut ensemble = Ensemble::new(&scene, &chetaev(&scene), &[], &settings).expect("an ensemble");
                let phases: Vec<f64> = (0..STARTS).map(|i| mechanism.phase((0.5 + i as f64) / STARTS as f64)).collect();
                let start = |phase: &f64| {
                    let (q, v) = (mechanism.truth)(*phase, 0.0);
                    let of_scene = motion::EnsembleStart::of(&scene, &[], chetaev(&scene).constants);
                    motion::EnsembleStart { state: State { t: 0.0, q, v }, ..of_scene }
                };
                let members: Vec<_> =
                    phases.iter().map(|phase| ensemble.member_at(&start(phase)).expect("a member")).collect();
                let Setting { end, .. } = setting(&scene);
                let motions = ensemble.motions(&members, &[end], &EnsembleOptions::default());
                for (phase, motion) in phases.iter().zip(motions) {
                    let motion = motion.expect("a motion");
                    let estimate = motion.estimate.clone().expect("an estimate");
                    match &motion.run.ending {
                        Ending::Completed if motion.doubt.is_some() || estimate.complaint().is_some() => {}
                        Ending::Completed => {
                            let error = estimate.coordinates.iter().copied().fold(0.0, f64::max);
                            let q = &motion.outputs[motion.outputs.len() - 1].coordinates;
                            assert!(mechanism.is_right(*phase, q, error), "{phase}, {tolerance:e}: silently wrong");
                        }
                        Ending::Stopped { cause, .. } => {
                            assert!(cause.contains("says nothing of the velocities at"), "{phase}: {cause}");
                        }
                    }
                }
            }
        }
    }
}

/// A robot with two drive wheels and a castor; the constraints as they are written for each wheel, or five
/// of them that are independent at every heading.
fn robot(constraints: &str, duration: f64) -> Scene {
    let text = format!(
        "title = \"robot\"\n[parameters]\nb = 0.17\nr = 0.08\na = 0.22\ne = 0.04\nrc = 0.03\n[coordinates]\n\
         x = {{ start = 0 }}\ny = {{ start = 0 }}\nphi = {{ start = 0.1 }}\nright = {{ start = 0 }}\n\
         left = {{ start = 0 }}\ncastor = {{ start = 2.5 }}\nroll = {{ start = 0 }}\n[definitions]\n\
         CR = \"[x + b*sin(phi), y - b*cos(phi), 0]\"\nCL = \"[x - b*sin(phi), y + b*cos(phi), 0]\"\n\
         CC = \"[x + a*cos(phi) - e*cos(phi + castor), y + a*sin(phi) - e*sin(phi + castor), 0]\"\n\
         c = \"[cos(phi), sin(phi), 0]\"\nk = \"[cos(phi + castor), sin(phi + castor), 0]\"\n\
         n = \"[-sin(phi), cos(phi), 0]\"\n[system]\n\
         lagrangian = \"4*dot(CR' + CL', CR' + CL')/4 + 0.4*phi'^2 + 0.01*(right'^2 + left'^2) + \
         0.05*dot(CC', CC') + 1e-3*(phi' + castor')^2 + 1e-4*roll'^2\"\nconstraints = [{constraints}]\n\
         forces = {{ right = \"0.05 - 0.01*right'\", left = \"0.025 - 0.01*left'\" }}\n[start.velocities]\n\
         \"right'\" = 3\n\"left'\" = 2.5\n[run]\nduration = {duration:?}\n"
    );
    Scene::parse("robot", &text).unwrap_or_else(|e| panic!("{text}: {e}"))
}

const EACH_WHEEL: &str = "\"CR' - r*right'*c\", \"CL' - r*left'*c\", \"CC' - rc*roll'*k\"";
const INDEPENDENT: &str = "\"dot(CR', c) - r*right'\", \"dot(CR', n)\", \"dot(CL', c) - r*left'\", \"(CC' - rc*roll'*k).x\", \
                           \"(CC' - rc*roll'*k).y\"";

/// Two wheels on one axle cannot both slip: one of the four rows follows from the others, and which one may
/// be left out changes with the heading. The judge is the same robot by rows that are independent everywhere.
#[test]
fn dependent_rows_of_constant_rank_are_changed_on_the_way() {
    let (written, judge) = (robot(EACH_WHEEL, 40.0), robot(INDEPENDENT, 40.0));
    assert_eq!((written.system.constraints.len(), written.system.redundant.len()), (5, 1));
    for formulation in [motion::CHETAEV, motion::VAKONOMIC] {
        let of = |scene: &Scene| choices(scene).into_iter().find(|c| c.formulation == formulation).expect("a choice");
        for method in [None, Some(Method::Radau5)] {
            let duration = if formulation == motion::CHETAEV { 40.0 } else { 4.0 };
            let end = |scene: &Scene| {
                let setting = Setting { end: duration, ..setting(scene) };
                let settings = Settings { method, ..Settings::default() };
                let mut motion = motion::solve_from(setting, &of(scene), &settings).expect("a motion");
                assert_eq!(motion.ending, Ending::Completed);
                let turned = !motion.charts.is_empty();
                (motion.at(duration).expect("its end").coordinates, turned)
            };
            let ((one, turned), (two, _)) = (end(&written), end(&judge));
            let off = one.iter().zip(&two).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max);
            assert!(off < 1e-7, "{}, {method:?}: {one:?} {two:?}", formulation.name);
            assert!(turned || duration < 40.0, "no other rows were taken");
        }
    }
}

/// Three cranks on one coupler: the coupler stays level, and its end is a pendulum.
#[test]
fn redundant_positions_leave_a_degree_of_freedom() {
    let constraints = "\"dot(c, c) - 1\", \"dot(c + e - [1, 0], c + e - [1, 0]) - 1\", \
                       \"dot(c + 2*e - [2, 0], c + 2*e - [2, 0]) - 1\", \"x*x' + y*y'\"";
    let text = format!(
        "title = \"cranks\"\n[coordinates]\nx = {{ start = 0 }}\ny = {{ start = 1 }}\na = {{ start = 0 }}\n[definitions]\n\
         c = \"[x, y]\"\ne = \"[cos(a), sin(a)]\"\n[system]\nlagrangian = \"(x'^2 + y'^2)/2 + a'^2/24 - 9.81*y\"\n\
         constraints = [{constraints}]\n[start.velocities]\n\"x'\" = 1\n[run]\nduration = 0.4\n"
    );
    let scene = Scene::parse("cranks", &text).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((scene.system.constraints.len(), scene.system.redundant.len()), (2, 2));
    // θ'' = g sin θ from the top at θ' = 1, by its energy
    let theta = advance(0.0, 0.4, |theta| (1.0 + 2.0 * 9.81 * (1.0 - theta.cos())).sqrt());
    let mut motion = solve_choice(&scene, &chetaev(&scene), &Settings::default()).expect("a motion");
    let end = motion.at(0.4).expect("its end");
    let off = [theta.sin() - end.coordinates[0], theta.cos() - end.coordinates[1], end.coordinates[2]];
    assert!(off.iter().all(|x| x.abs() < 1e-10), "{off:?}");
    let left_out: Vec<&str> = motion.equations.left_out.iter().map(|left| &left.words[..]).collect();
    assert!(left_out.iter().filter(|words| words.contains("follows from the others")).count() == 2, "{left_out:?}");
    // and where rows depend at the start only, they do not follow from one another
    let text = text.replace("y = { start = 1 }", "y = { start = 0 }").replace("x = { start = 0 }", "x = { start = 1 }");
    Scene::parse("cranks", &text).expect_err("a place where the rank falls");
}

/// One constraint, however it is written: every form stops at x = 1, at one time and in the same words.
#[test]
fn writings_of_one_constraint_have_one_end() {
    let writings = [
        "(x - 1)*(z' - y*x')",
        "(1 - x)*(z' - y*x')",
        "(1 - x)*(y*x' - z')",
        "x*z' - z' - x*y*x' + y*x'",
        "z'*(x - 1) + (1 - x)*y*x'",
        "(x^2 - 1)/(1 + x)*(z' - y*x')",
        "(x - 1)^3*(z' - y*x')",
        "(exp(x - 1) - 1)*(z' - y*x')",
        "sin(x - 1)*(y*x' - z')",
        "1e6*(2 - 2*x)*(z' - y*x')",
        "log(x)*(z' - y*x')",
        "(sqrt(x) - 1)*(z' - y*x')*exp(y)",
        "z'*x - (z' + y*x'*(x - 1))",
        "(1 - x)*z' + y*x'*x - y*x'",
    ];
    for formulation in [motion::CHETAEV, motion::VAKONOMIC, motion::REMOVED_CONSTRAINT] {
        let mut first: Option<(f64, String)> = None;
        for writing in writings {
            let text = format!(
                "title = \"writings\"\n[coordinates]\nx = {{ start = 0.125 }}\ny = {{ start = 0.25 }}\nz = {{ start = 0 }}\n\
                 [system]\nlagrangian = \"(x'^2 + y'^2 + z'^2 - y^2)/2\"\nconstraints = [\"{writing}\"]\n\
                 [start.velocities]\n\"x'\" = 0.75\n\"y'\" = 0.25\n[run]\nduration = 2\n"
            );
            let scene = Scene::parse("writings", &text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let choice = choices(&scene).into_iter().find(|c| c.formulation == formulation).expect("a choice");
            for form in [motion::Form::Suited, motion::Form::Named] {
                let motion =
                    solve_choice(&scene, &choice, &Settings { form, ..Settings::default() }).expect("a motion");
                let Ending::Stopped { t, cause } = motion.ending else { panic!("{}, {writing}", choice.label) };
                let (before, words) = first.get_or_insert((t, cause.clone()));
                assert_eq!(*words, cause, "{}, {writing}", choice.label);
                assert!((*before - t).abs() < 1e-3, "{}, {writing}: {t}, {before}", choice.label);
                assert!(cause.starts_with("constraint 1 says nothing of the velocities at x = 1, "), "{cause}");
            }
        }
    }
}
