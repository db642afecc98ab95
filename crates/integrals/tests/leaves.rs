//! Constraints on positions and kinks: answers hold on the leaf and branch of the start.

use decision::ExactStart;
use integrals::{Integrals, Measure, constants, reversible};
use motion::choices;
use scene::Scene;

fn asked(text: &str) -> Integrals {
    let degree = 1;
    let scene = Scene::parse("asked", text).unwrap_or_else(|error| panic!("{error}"));
    Integrals::find(&scene, &choices(&scene)[0], degree, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Rotation by a quaternion, in either of two spellings that agree on `a² + b² + c² + d² = 1`.
fn quaternions(lagrangian: &str, more: &str, square: &str) -> String {
    format!(
        r#"
title = "Quaternions"
[parameters]
A = 1
B = 2
C = 3
[coordinates]
{more}
a = {{ start = 1 }}
b = {{ start = 0 }}
c = {{ start = 0 }}
d = {{ start = 0 }}
[definitions]
W = "2*[a*b' - b*a' - c*d' + d*c', a*c' - c*a' - d*b' + b*d', a*d' - d*a' - b*c' + c*b']"
R = "[[{square}-2*(c^2+d^2), 2*(b*c-a*d), 2*(b*d+a*c)], [2*(b*c+a*d), {square}-2*(b^2+d^2), 2*(c*d-a*b)], [2*(b*d-a*c), 2*(c*d+a*b), {square}-2*(b^2+c^2)]]"
K = "R*[A*W.x, B*W.y, C*W.z]"
[system]
lagrangian = "{lagrangian}"
"#
    )
}

const BODY: &str = "(A*W.x^2 + B*W.y^2 + C*W.z^2)/2 + (a*a'+b*b'+c*c'+d*d')^2/2";
const RATES: &str = "\"b'\" = 0.5\n\"c'\" = 0.2\n\"d'\" = 0.3\n[run]\nduration = 2\n";

/// Euler's free body: its angular momentum is constant in space.
#[test]
fn eulers_body_in_unit_quaternions_keeps_its_angular_momentum() {
    let text = quaternions(BODY, "", "1")
        + "constraints = [\"a^2 + b^2 + c^2 + d^2 - 1\"]\n[invariants]\nKx = \"K.x\"\nKy = \"K.y\"\nKz = \"K.z\"\nW3 = \"W.z\"\n\
           [start.velocities]\n"
        + RATES;
    let found = asked(&text);
    let held: Vec<bool> = found.invariants.clone().expect("an answer").into_iter().map(|(_, held)| held).collect();
    assert_eq!(held, [true, true, true, true, false]);
    assert!(matches!(&found.reversed, Some(found) if matches!(found.measure, Measure::Local { density: Some(_), .. })));
    // linear near a point: the three parts of the angular momentum
    let linear = found.reversed.as_ref().map(|found| found.integrals[0].clone()).expect("Chetaev's motion");
    assert_eq!(linear.map(|linear| (linear.count, linear.settled)), Ok((3, true)));
    // they would be about other leaves, too, on which some of it is false
    assert!(found.certificates(&[]).expect("an answer").iter().all(|(_, certificate)| certificate.is_err()));
    let domain = "near almost every place q of the leaf of this start; ";
    assert!(found.where_it_holds().is_some_and(|words| words.starts_with(domain)));
}

/// Chaplygin's sphere, radius 1 and mass 1, as its rolling `x' = ω_y`, `y' = −ω_x`; its measure and its
/// angular momentum about the contact (Chaplygin 1903). With the matrix spelled either way.
#[test]
fn chaplygins_sphere_in_unit_quaternions_has_its_measure() {
    for square in ["1", "(a^2+b^2+c^2+d^2)"] {
        let rolling = quaternions(&format!("{BODY} + (x'^2 + y'^2)/2"), "x = { start = 0 }\ny = { start = 0 }", square)
            .replace("K = \"R*[A*W.x, B*W.y, C*W.z]\"", "K = \"R*[A*W.x, B*W.y, C*W.z] + [-y', x', 0]\"\nO = \"R*W\"");
        let text = rolling
            + "constraints = [\"a^2 + b^2 + c^2 + d^2 - 1\", \"x' - O.y\", \"y' + O.x\"]\n[invariants]\nKx = \"K.x\"\n\
               Kz = \"K.z\"\n[start.velocities]\n"
            + RATES;
        let scene = Scene::parse("sphere", &text).unwrap_or_else(|error| panic!("{error}"));
        let start = ExactStart::new(&scene.system, &scene.start, &scene.completion, None).expect("a start");
        let found = reversible(&scene.system, &start, 0);
        assert!(matches!(found.measure, Measure::Local { .. }), "{square}: {:?}", found.measure);
        let equations = motion::derive(&scene.system, &choices(&scene)[0]);
        let own: Vec<_> = scene.system.watched.iter().map(|watched| watched.expression).collect();
        let held = constants(&scene.system, &equations.expect("equations"), &start, &own).expect("an answer");
        assert_eq!(held, [true; 3], "{square}");
    }
}

fn sleigh(l: &str, s: f64, more: &str) -> String {
    format!(
        r#"
title = "Sleigh"
[coordinates]
x = {{ start = 0 }}
y = {{ start = 0 }}
phi = {{ start = 0 }}
s = {{ start = {s} }}
[definitions]
l = "{l}"
[system]
lagrangian = "((x' - l*sin(phi)*phi')^2 + (y' + l*cos(phi)*phi')^2)/2 + phi'^2/10 + s'^2/2{more}"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start.velocities]
"x'" = 0.6
"phi'" = 0.5
"s'" = 0.1
[run]
duration = 2
"#
    )
}

/// The offset `√(s²) − s` is 0 on one side and `−2 s` on the other, whose answers are those of that formula.
#[test]
fn each_branch_has_the_answers_of_its_formula() {
    let measure = |l: &str, s: f64| {
        let found = asked(&sleigh(l, s, ""));
        let reversed = found.reversed.clone().expect("Chetaev's motion");
        (matches!(reversed.measure, Measure::None { proved: true }), found.where_it_holds().expect("a domain"))
    };
    for (s, formula) in [(2.0, "0*s"), (-2.0, "-2*s")] {
        let (none, domain) = measure("sqrt(s^2) - s", s);
        assert_eq!(none, measure(formula, s).0, "{s}");
        assert!(domain.starts_with("near almost every place q of the branch of this start; "), "{domain}");
    }
}

/// A buffer from `s = 2.1` on: what is constant up to there is said to be so on the branch of the start.
#[test]
fn a_motion_that_leaves_its_branch_is_told() {
    let words = |duration: &str| {
        let text = sleigh("0*s", 2.0, " - 20*(sqrt((s - 21/10)^2) + s - 21/10)^2").replace("duration = 2", duration);
        let lines = asked(&text).lines();
        lines.into_iter().find(|(_, words)| words.starts_with("s' = const")).expect("an integral").1
    };
    assert!(words("duration = 0.5").starts_with("s' = const (drift"), "{}", words("duration = 0.5"));
    let left = words("duration = 3");
    assert!(left.starts_with("s' = const on the branch of this start (drift") && left.contains("leaves it"), "{left}");
}

/// A minor of the size of a leaf: the sleigh has no measure, however its heading is written.
#[test]
fn the_sleigh_has_no_measure_with_a_unit_vector_either() {
    let text = r#"
title = "Sleigh"
[coordinates]
x = { start = 0 }
y = { start = 0 }
c = { start = 0.6 }
s = { start = 0.8 }
[definitions]
w = "c*s' - s*c'"
[system]
lagrangian = "((x' - 0.3*s*w)^2 + (y' + 0.3*c*w)^2)/2 + w^2/10 + (c*c' + s*s')^2/2"
constraints = ["c^2 + s^2 - 1", "y'*c - x'*s"]
[invariants]
energy = "((x'*c + y'*s)^2 + 0.09*w^2)/2 + w^2/10"
[start.velocities]
"x'" = 0.6
"c'" = -0.8
[run]
duration = 2
"#;
    let found = asked(text);
    assert!(found.invariants.clone().expect("an answer").iter().all(|(_, held)| *held));
    let reversed = found.reversed.expect("Chetaev's motion");
    assert_eq!(reversed.measure, Measure::None { proved: true });
    // as of its angle: two, without a period
    assert_eq!(reversed.integrals[0].clone().map(|linear| (linear.count, linear.settled)), Ok((2, true)));
}
