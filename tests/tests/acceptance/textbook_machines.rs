//! Machines of bodies against what textbooks derive by hand.

use super::machines::{parsed, same_system};

pub(super) const HEAD: &str = "title = \"machine\"\n[run]\nduration = 1\n";

/// `same_system` of bodies and of formulas by hand, with the coordinates of both.
#[track_caller]
pub(super) fn as_by_hand(title: &str, coordinates: &[(&str, f64)], bodies: &str, by_hand: &str) {
    let q: String = coordinates.iter().map(|(q, x)| format!("{q} = {{ start = {x} }}\n")).collect();
    let v: String = coordinates.iter().map(|(q, _)| format!("\"{q}'\" = 0\n")).collect();
    let (gravity, rest) = bodies.split_at(bodies.find("\n[").unwrap_or_default());
    let [scene, by_hand] = [(gravity, rest), ("", by_hand)]
        .map(|(first, rest)| parsed(&format!("{first}\n{HEAD}[coordinates]\n{q}[start.velocities]\n{v}\n{rest}")));
    same_system(title, &by_hand, &scene);
}

#[test]
fn springs_dampers_and_motors_act_on_both_bodies() {
    let bodies = r#"
gravity = [0, 0, -9.81]

[body.cart]
joint = { slider = [1, 0, 0], shift = "x" }
mass = 3
[body.pole]
on = "cart"
joint = { hinge = [0, 1, 0], angle = "-a" }
shape = "rod"
size = [1.2]
mass = 0.5
[body.bob]
on = "pole"
joint = { hinge = [0, 1, 0], angle = "b - (-a)", at = [1.2, 0, 0] }
mass = 0.2
mass-centre = [0.4, 0, 0]
[spring.wall]
joint = "cart"
stiffness = 40
rest = 0.1
[damper.hinge]
joint = "bob"
damping = 0.3
[motor.hinge]
joint = "pole"
force = "2*cos(t)"
[spring.string]
between = { bob = [0.4, 0, 0], space = [0, 0, 2] }
stiffness = 7
rest = 1
"#;
    // the rod points along x turned up by a; the bob's arm down by b
    let by_hand = r#"
[definitions]
px = "x + 0.6*cos(a)"
pz = "0.6*sin(a)"
bx = "x + 1.2*cos(a) + 0.4*cos(b)"
bz = "1.2*sin(a) - 0.4*sin(b)"
l  = "sqrt(bx^2 + (bz - 2)^2)"
[system]
lagrangian = "3/2*x'^2 + 0.25*(px'^2 + pz'^2) + 0.5*1.2^2/24*a'^2 + 0.1*(bx'^2 + bz'^2) - 9.81*(0.5*pz + 0.2*bz) - 20*(x - 0.1)^2 - 3.5*(l - 1)^2"
# the hinge of the pole has the angle -a, that of the bob b + a
[system.forces]
a = "-2*cos(t) - 0.3*(a' + b')"
b = "-0.3*(a' + b')"
"#;
    as_by_hand("cart, pole and bob", &[("x", 0.2), ("a", 0.3), ("b", 0.4)], bodies, by_hand);
}

#[test]
fn a_motor_turns_wheel_and_body_of_a_segway_apart() {
    let bodies = r#"
gravity = [0, 0, -9.81]

[body.body]
at = "[x, 0, 0.2]"
rotation = "rotation(y, th)"
mass = 40
mass-centre = [0, 0, 0.7]
inertia = [5, 6, 2]
[body.wheels]
on = "body"
joint = { hinge = [0, 1, 0], angle = "w - th" }
shape = "wheel"
size = [0.2]
mass = 5
[contact.wheels]
of = "wheels"
law = "rolls"
[motor.wheels]
joint = "wheels"
force = "30*th + 4*th'"
"#;
    let by_hand = r#"
[system]
lagrangian = "45/2*x'^2 + 0.05*w'^2 + 28*x'*th'*cos(th) + (19.6 + 6)/2*th'^2 - 40*9.81*0.7*cos(th)"
constraints = ["x' - 0.2*w'"]
forces = { th = "-30*th - 4*th'", w = "30*th + 4*th'" }
"#;
    as_by_hand("segway", &[("x", 0.2), ("th", 0.1), ("w", 0.4)], bodies, by_hand);
}

#[test]
fn hitches_behind_the_axle_are_what_the_textbook_has() {
    // hitches 0.3 behind an axle, the next axle 1.1 behind the hitch
    let trailer = |name: &str, on: &str, angle: &str| {
        format!(
            "[body.{name}]\non = \"{on}\"\njoint = {{ hinge = [0, 0, 1], angle = \"{angle}\", at = [-0.3, 0, 0], own = [1.1, 0, 0] }}\nmass = 2\ninertia = [0, 0, 0.5]\n"
        )
    };
    let bodies = format!(
        "\n[body.tractor]\njoint = {{ plane = [\"x\", \"y\", \"a\"] }}\nmass = 3\ninertia = [0, 0, 1]\n{}{}[contact]\n{}",
        trailer("first", "tractor", "b - a"),
        trailer("second", "first", "c - b"),
        ["tractor", "first", "second"]
            .map(|name| format!("{name} = {{ of = \"{name}\", law = \"blade\" }}\n"))
            .concat()
    );
    let by_hand = r#"
[definitions]
x1 = "x - 0.3*cos(a) - 1.1*cos(b)"
y1 = "y - 0.3*sin(a) - 1.1*sin(b)"
x2 = "x1 - 0.3*cos(b) - 1.1*cos(c)"
y2 = "y1 - 0.3*sin(b) - 1.1*sin(c)"
[system]
lagrangian = "1.5*(x'^2 + y'^2) + (x1'^2 + y1'^2) + (x2'^2 + y2'^2) + 0.5*a'^2 + 0.25*(b'^2 + c'^2)"
constraints = [
  "y'*cos(a) - x'*sin(a)",
  "y'*cos(b) - x'*sin(b) - 0.3*a'*cos(b - a) - 1.1*b'",
  "y'*cos(c) - x'*sin(c) - 0.3*a'*cos(c - a) - 1.4*b'*cos(c - b) - 1.1*c'",
]
"#;
    let q = [("x", 0.0), ("y", 0.0), ("a", 0.3), ("b", 0.2), ("c", 0.1)];
    as_by_hand("tractor with two trailers", &q, &bodies, by_hand);
}

/// Links of length 1, each on a blade in its middle, driven at the joints; headings are against space.
#[test]
fn a_snake_of_five_driven_links_is_what_a_loop_writes() {
    let (mut bodies, mut contacts, mut motors) = (String::new(), String::new(), String::new());
    let (mut definitions, mut lagrangian, mut constraints) = (String::new(), String::new(), String::new());
    let mut forces = vec![String::new(); 5];
    for i in 0..5_usize {
        let (x, y) = if i == 0 { ("x".into(), "y".into()) } else { (format!("x{i}"), format!("y{i}")) };
        let joint = match i.checked_sub(1) {
            None => "joint = { plane = [\"x\", \"y\", \"a0\"] }".to_string(),
            Some(h) => {
                let [before_x, before_y] = ["x", "y"].map(|c| if h == 0 { c.into() } else { format!("{c}{h}") });
                definitions += &format!("{x} = \"{before_x} - 0.5*cos(a{h}) - 0.5*cos(a{i})\"\n");
                definitions += &format!("{y} = \"{before_y} - 0.5*sin(a{h}) - 0.5*sin(a{i})\"\n");
                motors += &format!("m{i} = {{ joint = \"l{i}\", force = \"{i}*cos(t)\" }}\n");
                forces[i] += &format!("+ {i}*cos(t)");
                forces[h] += &format!("- {i}*cos(t)");
                let hinge = format!("hinge = \"z\", angle = \"a{i} - a{h}\", at = [-0.5, 0], own = [0.5, 0]");
                format!("on = \"l{h}\"\njoint = {{ {hinge} }}")
            }
        };
        bodies += &format!("[body.l{i}]\n{joint}\nmass = 2\ninertia = [0, 0, 0.1]\n");
        contacts += &format!("c{i} = {{ of = \"l{i}\", law = \"blade\" }}\n");
        lagrangian += &format!("+ {x}'^2 + {y}'^2 + 0.05*a{i}'^2");
        constraints += &format!("\"{y}'*cos(a{i}) - {x}'*sin(a{i})\", ");
    }
    let forces: String = forces.iter().enumerate().map(|(i, q)| format!("a{i} = \"{q}\"\n")).collect();
    let by_hand = format!(
        "[definitions]\n{definitions}[system]\nlagrangian = \"{lagrangian}\"\nconstraints = [{constraints}]\n[system.forces]\n{forces}"
    );
    let bodies = format!("\n{bodies}[contact]\n{contacts}[motor]\n{motors}");
    let q = [("x", 0.0), ("y", 0.0), ("a0", 0.1), ("a1", 0.4), ("a2", 0.2), ("a3", -0.2), ("a4", 0.3)];
    as_by_hand("snake", &q, &bodies, &by_hand);
}

#[test]
fn a_robot_with_two_wheels_and_a_castor_is_what_the_textbook_derives() {
    // two driven wheels and a castor, on five of six rows: the axle's two rows across are one
    let bodies = r#"
[body.robot]
joint = { plane = ["x", "y", "phi"] }
mass = 6
mass-centre = [0.1, 0, 0.2]
inertia = [0, 0, 0.4]
[body.right]
shape = "wheel"
size = [0.1]
mass = 0.5
on = "robot"
joint = { hinge = [0, 1, 0], angle = "r", at = [0, -0.3, 0.1] }
[body.left]
shape = "wheel"
size = [0.1]
mass = 0.5
on = "robot"
joint = { hinge = [0, 1, 0], angle = "l", at = [0, 0.3, 0.1] }
[body.fork]
on = "robot"
joint = { hinge = [0, 0, 1], angle = "c", at = [0.4, 0, 0] }
[body.castor]
shape = "wheel"
size = [0.05]
mass = 0.2
on = "fork"
joint = { hinge = [0, 1, 0], angle = "w", at = [-0.06, 0, 0.05] }
[contact]
right = { of = "right", law = "rolls" }
left = { of = "left", law = "rolls" }
castor = { of = "castor", law = "rolls" }
[motor]
right = { joint = "right", force = 0.8 }
left = { joint = "left", force = "0.5 - 0.01*l'" }
"#;
    let by_hand = r#"
[definitions]
u  = "x'*cos(phi) + y'*sin(phi)"                  # along and across the robot
n  = "y'*cos(phi) - x'*sin(phi)"
px = "u - 0.06*(-sin(c))*(phi' + c')"             # the castor's middle, in the robot's axes
py = "n + 0.4*phi' - 0.06*cos(c)*(phi' + c')"
T  = "3*(u^2 + (n + 0.1*phi')^2) + 0.2*phi'^2"
TW = "0.25*((u + 0.3*phi')^2 + (u - 0.3*phi')^2 + 2*n^2) + 0.5*0.5*0.01/4*phi'^2*2 + 0.5*0.5*0.01/2*(r'^2 + l'^2)"
TC = "0.1*(px^2 + py^2) + 0.5*0.2*0.0025/4*(phi' + c')^2 + 0.5*0.2*0.0025/2*w'^2"
[system]
lagrangian = "T + TW + TC"
constraints = ["n", "u + 0.3*phi' - 0.1*r'", "u - 0.3*phi' - 0.1*l'", "px*cos(c) + py*sin(c) - 0.05*w'", "py*cos(c) - px*sin(c)"]
forces = { r = 0.8, l = "0.5 - 0.01*l'" }
"#;
    let q = ["x", "y", "phi", "r", "l", "c", "w"].map(|q| (q, 0.3));
    as_by_hand("robot with castor", &q, bodies, by_hand);
    let lines = |line: &dyn Fn(&str) -> String| q.iter().map(|(q, _)| line(q)).collect::<String>();
    let (q, v) = (lines(&|q| format!("{q} = {{ start = 0.3 }}\n")), lines(&|q| format!("\"{q}'\" = 0\n")));
    let scene = parsed(&format!("{HEAD}[coordinates]\n{q}[start.velocities]\n{v}{bodies}"));
    let left_out = scene.meant.map(|meant| meant.left_out).unwrap_or_default();
    assert_eq!(left_out, ["contact left: no slip across, as contact right: no slip across says the same"]);
}

#[test]
fn a_wheel_with_a_tyre_and_a_leaning_wheel_roll_as_circle_and_ball() {
    // a torus whose circle has no radius to speak of is a ball; a ball's rows lie along x and y
    let body = |shape: &str| {
        format!(
            "{HEAD}[coordinates]\nx = {{ start = 0.1 }}\ny = {{ start = 0.2 }}\nz = {{ start = 0.3 }}\npsi = {{ start = 0.3 }}\ntheta = {{ start = 1.1 }}\nphi = {{ start = 0.2 }}\n[body.b]\n{shape}\nmass = 1\ninertia = [0.1, 0.2, 0.3]\nat = \"[x, y, z]\"\nrotation = \"rotation(yxy, psi, theta, phi)\"\n[contact.b]\nof = \"b\"\nlaw = \"rubber\"\n[start.velocities]\n\"psi'\" = 0\n\"theta'\" = 0\n"
        )
    };
    let ball = parsed(&body("shape = \"ball\"\nsize = [0.3]"));
    let thick = parsed(&body("shape = \"wheel\"\nsize = [0, 0.3]"));
    same_system("torus without a circle", &ball, &thick);
    let round = parsed(&body("shape = \"ellipsoid\"\nsize = [0.3, 0.3, 0.3]"));
    same_system("round ellipsoid", &ball, &round);
}

/// Four wheels that roll, the front ones steered apart: two rows each, and those of the rear axle share one.
#[test]
fn an_ackermann_car_is_what_the_textbook_has() {
    let wheel = |name: &str, on: &str, angle: &str, at: &str| {
        format!(
            "[body.{name}]\non = \"{on}\"\njoint = {{ hinge = \"y\", angle = \"{angle}\", at = {at} }}\nshape = \"wheel\"\nsize = [0.3]\nmass = 8\n"
        )
    };
    let knuckle = |name: &str, angle: &str, at: &str| {
        format!("[body.{name}]\non = \"car\"\njoint = {{ hinge = \"z\", angle = \"{angle}\", at = {at} }}\n")
    };
    let bodies = [
        "\n[body.car]\njoint = { plane = [\"x\", \"y\", \"phi\"], at = [0, 0, 0.3] }\nmass = 900\nmass-centre = [1.2, 0, 0.2]\ninertia = [0, 0, 1100]\n".into(),
        wheel("rr", "car", "a", "[0, -0.7, 0]"),
        wheel("rl", "car", "b", "[0, 0.7, 0]"),
        knuckle("kr", "d", "[2.6, -0.7, 0]"),
        knuckle("kl", "e", "[2.6, 0.7, 0]"),
        wheel("fr", "kr", "f", "[0, 0, 0]"),
        wheel("fl", "kl", "g", "[0, 0, 0]"),
        "[contact]\n".into(),
        ["rr", "rl", "fr", "fl"].map(|name| format!("{name} = {{ of = \"{name}\", law = \"rolls\" }}\n")).concat(),
    ]
    .concat();
    // moments of a disc of 8 kg: 0.36 about its axle, 0.18 about the vertical
    let by_hand = r#"
[definitions]
u = "x'*cos(phi) + y'*sin(phi)"
n = "y'*cos(phi) - x'*sin(phi)"
w = "n + 2.6*phi'"
T = "450*(u^2 + (n + 1.2*phi')^2) + 550*phi'^2"
TR = "4*(2*u^2 + 2*n^2 + 2*0.49*phi'^2) + 0.18*phi'^2 + 0.18*(a'^2 + b'^2)"
TF = "4*((u + 0.7*phi')^2 + (u - 0.7*phi')^2 + 2*w^2) + 0.09*((phi' + d')^2 + (phi' + e')^2) + 0.18*(f'^2 + g'^2)"
[system]
lagrangian = "T + TR + TF"
constraints = [
  "u + 0.7*phi' - 0.3*a'", "u - 0.7*phi' - 0.3*b'", "n",
  "(u + 0.7*phi')*cos(d) + w*sin(d) - 0.3*f'", "w*cos(d) - (u + 0.7*phi')*sin(d)",
  "(u - 0.7*phi')*cos(e) + w*sin(e) - 0.3*g'", "w*cos(e) - (u - 0.7*phi')*sin(e)",
]
"#;
    let q = ["x", "y", "phi", "a", "b", "d", "e", "f", "g"].map(|q| (q, 0.2));
    as_by_hand("Ackermann car", &q, &bodies, by_hand);
}

/// A body that stands on a ball, by a motor between both.
#[test]
fn a_robot_on_a_ball_is_what_the_textbook_derives() {
    let bodies = r#"
gravity = [0, 0, -9.81]

[body.ball]
at = "[x, y, 0.1]"
rotation = "rotation(zxz, psi, theta, chi)"
shape = "ball"
size = [0.1]
mass = 2
[body.body]
at = "[x, y, 0.1]"
rotation = "rotation(xy, p, r)"
mass = 8
mass-centre = [0, 0, 0.4]
inertia = [0.5, 0.4, 0.1]
[contact.ball]
of = "ball"
law = "rolls"
"#;
    let by_hand = r#"
[definitions]
wx = "theta'*cos(psi) + chi'*sin(theta)*sin(psi)"
wy = "theta'*sin(psi) - chi'*sin(theta)*cos(psi)"
gx = "x' + 0.4*r'*cos(r)"
gy = "y' + 0.4*(r'*sin(p)*sin(r) - p'*cos(p)*cos(r))"
gz = "-0.4*(p'*sin(p)*cos(r) + r'*cos(p)*sin(r))"
TB = "x'^2 + y'^2 + 0.004*(psi'^2 + theta'^2 + chi'^2 + 2*psi'*chi'*cos(theta))"
[system]
lagrangian = "TB + 4*(gx^2 + gy^2 + gz^2) + 0.25*p'^2*cos(r)^2 + 0.2*r'^2 + 0.05*p'^2*sin(r)^2 - 8*9.81*0.4*cos(p)*cos(r)"
constraints = ["x' - 0.1*wy", "y' + 0.1*wx"]
"#;
    let q = [("x", 0.0), ("y", 0.0), ("psi", 0.3), ("theta", 1.1), ("chi", 0.2), ("p", 0.1), ("r", 0.2)];
    as_by_hand("robot on a ball", &q, bodies, by_hand);
}

/// An arm of two links, driven at its elbow, each on a skate.
#[test]
fn an_arm_on_two_skates_is_what_the_textbook_has() {
    let bodies = r#"
[body.first]
joint = { plane = ["x", "y", "a"] }
mass = 3
mass-centre = [0.5, 0]
inertia = [0, 0, 0.3]
[body.second]
on = "first"
joint = { hinge = "z", angle = "b - a", at = [1, 0] }
mass = 2
mass-centre = [0.4, 0]
inertia = [0, 0, 0.2]
[contact]
first = { of = "first", law = "blade", at = [0.2, 0] }
second = { of = "second", law = "blade", at = [0.9, 0] }
[motor.elbow]
joint = "second"
force = "3*sin(t)"
[spring.elbow]
joint = "second"
stiffness = 5
rest = 0.2
"#;
    let by_hand = r#"
[definitions]
fx = "x' - 0.5*a'*sin(a)"
fy = "y' + 0.5*a'*cos(a)"
sx = "x' - a'*sin(a) - 0.4*b'*sin(b)"
sy = "y' + a'*cos(a) + 0.4*b'*cos(b)"
[system]
lagrangian = "1.5*(fx^2 + fy^2) + 0.15*a'^2 + sx^2 + sy^2 + 0.1*b'^2 - 2.5*(b - a - 0.2)^2"
constraints = ["y'*cos(a) - x'*sin(a) + 0.2*a'", "y'*cos(b) - x'*sin(b) + a'*cos(b - a) + 0.9*b'"]
forces = { a = "-3*sin(t)", b = "3*sin(t)" }
"#;
    as_by_hand("arm on two skates", &[("x", 0.1), ("y", 0.2), ("a", 0.3), ("b", 0.7)], bodies, by_hand);
}
