//! What a reviewer would ask about scenes that can be read.

use scene::Scene;

fn remarks(text: &str) -> Vec<String> {
    let (_, remarks) = Scene::remarks::<f64>("scene", text, &[]).unwrap_or_else(|e| panic!("{e}"));
    remarks.iter().map(|remark| remark.to_string().lines().next().unwrap_or_default().to_owned()).collect()
}

const DISC: &str = r#"title = "Falling disc with drag"
[parameters]
m = 1.0
g = 9.81
R = 0.5
c = 0.1
[coordinates]
x     = { start = 0 }
y     = { start = 0 }
phi   = { start = 0.4 }
theta = { start = 0.2 }
psi   = { start = 0 }
[definitions]
centre = "[x, y, 0] + rotation(zx, phi, -theta)*[0, 0, R]"
W = "body_angular_velocity(rotation(zx, phi, -theta)) + [0, psi', 0]"
[system]
lagrangian = "m/2*dot(centre', centre') + m*R^2*dot(W, diag(1, 2, 1)*W)/8 - m*g*centre.z"
constraints = ["x' - R*psi'*cos(phi)", "y' - R*psi'*sin(phi)"]
forces = { psi = "-c*psi'" }
[start.velocities]
"phi'" = 0.7
"theta'" = 0.1
"psi'" = 4
[run]
duration = 1
[view.ground]
shape = "plane"
size = [3, 3]
[view.disc]
shape = "disc"
size = ["R"]
at = "centre"
rotation = "rotation(zxy, phi, -theta, psi)"
touches = { ground = "[x, y, 0]" }
"#;

/// Mistakes as textbooks and theses have them, and what is said of each.
const MISTAKES: &[(&str, &str, &str)] = &[
    ("- m*g*centre.z", "", "scene:4:1: `g` is used by nothing"),
    ("- m*g*centre.z", "+ m*g*centre.z", "scene:17:1: what g gives to L grows with the height of disc"),
    ("x' - R*psi'*cos(phi)", "x' + R*psi'*cos(phi)", "scene:29:7: the contact of `disc` slips on `ground`"),
    ("y' - R*psi'*sin(phi)", "y' - R*psi'*cos(phi)", "scene:29:7: the contact of `disc` slips on `ground`"),
    ("y' - R*psi'*sin(phi)", "y' - psi'*sin(phi)", "scene:29:7: the contact of `disc` slips on `ground`"),
    ("rotation(zxy, phi, -theta, psi)", "rotation(zxy, phi, -theta, -psi)", "scene:29:7: the contact of `disc` slips"),
    ("rotation(zxy, phi, -theta, psi)", "rotation(zxy, phi, theta, psi)", "scene:29:7: the contact of `disc` slips"),
    ("-c*psi'", "c*psi'", "scene:19:1: forces that depend on velocities drive"),
    ("m/2*dot", "-m/2*dot", "scene:17:1: the kinetic energy is negative at the start"),
    ("+ m*R^2*dot(W", "- m*R^2*dot(W", "scene:17:1: the kinetic energy is negative at the start"),
];

const ROBOT: &str = r#"title = "Robot with a castor"
[parameters]
m = 6
mc = 0.2
J = 0.4
d = 0.1
a = 0.1
ac = 0.05
b = 0.3
e = 0.4
trail = 0.06
loss = 0.01
[coordinates]
x   = { start = 0 }
y   = { start = 0 }
phi = { start = 0.4 }
r   = { start = 0 }
l   = { start = 0 }
c   = { start = 0.4 }
w   = { start = 0 }
[definitions]
u  = "x'*cos(phi) + y'*sin(phi)"
n  = "y'*cos(phi) - x'*sin(phi)"
px = "u + trail*sin(c)*(phi' + c')"
py = "n + e*phi' - trail*cos(c)*(phi' + c')"
T  = "m/2*(u^2 + (n + d*phi')^2) + J/2*phi'^2 + m*a^2/4*(r'^2 + l'^2)"
TC = "mc/2*(px^2 + py^2) + mc*ac^2/8*(phi' + c')^2 + mc*ac^2/4*w'^2"
[system]
lagrangian = "T + TC"
constraints = ["n", "u + b*phi' - a*r'", "u - b*phi' - a*l'", "px*cos(c) + py*sin(c) - ac*w'", "py*cos(c) - px*sin(c)"]
forces = { r = "-loss*r'", l = "-loss*l'" }
[start.velocities]
"r'" = 4
"l'" = 2
[run]
duration = 1
[view.ground]
shape = "plane"
size = [3, 3]
[view.right]
shape = "disc"
size = ["a"]
at = "[x, y, a] + rotation(z, phi)*[0, -b, 0]"
rotation = "rotation(zy, phi, r)"
touches = { ground = "[x, y, 0] + rotation(z, phi)*[0, -b, 0]" }
[view.left]
shape = "disc"
size = ["a"]
at = "[x, y, a] + rotation(z, phi)*[0, b, 0]"
rotation = "rotation(zy, phi, l)"
touches = { ground = "[x, y, 0] + rotation(z, phi)*[0, b, 0]" }
[view.castor]
shape = "disc"
size = ["ac"]
at = "[x, y, ac] + rotation(z, phi)*[e, 0, 0] + rotation(z, phi + c)*[-trail, 0, 0]"
rotation = "rotation(zy, phi + c, w)"
touches = { ground = "[x, y, 0] + rotation(z, phi)*[e, 0, 0] + rotation(z, phi + c)*[-trail, 0, 0]" }
"#;

/// The same of the robot; nothing is said of what is left of the message.
const MISTAKES_OF_THE_ROBOT: &[(&str, &str, &str)] = &[
    ("- trail*cos(c)", "+ trail*cos(c)", "scene:52:7: the contact of `castor` slips on `ground`"),
    ("trail*sin(c)*(phi' + c')", "trail*sin(c)*c'", "scene:52:7: the contact of `castor` slips on `ground`"),
    ("- ac*w'", "- a*w'", "scene:52:7: the contact of `castor` slips on `ground`"),
    ("u + b*phi' - a*r'", "u + 2*b*phi' - a*r'", "scene:40:7: the contact of `right` slips on `ground`"),
    ("- a*l'", "+ a*l'", "scene:46:7: the contact of `left` slips on `ground`"),
    ("-loss", "loss", "scene:31:1: forces that depend on velocities drive"),
    (" + TC\"", "\"", "scene:4:1: `mc` is used by nothing"),
    // from L alone these are other robots
    ("J/2*phi'^2", "J*phi'^2", ""),
    ("m*a^2/4*(r'", "m*a/4*(r'", ""),
];

#[test]
fn mistakes_are_noticed_with_their_place() {
    let (mut count, mut noticed) = (0, 0);
    for (machine, mistakes) in [(DISC, MISTAKES), (ROBOT, MISTAKES_OF_THE_ROBOT)] {
        assert_eq!(remarks(machine), [""; 0]);
        for (right, wrong, message) in mistakes {
            assert!(machine.contains(right), "{right}");
            let found = remarks(&machine.replace(right, wrong));
            let is_noticed = found.iter().any(|remark| !message.is_empty() && remark.starts_with(message));
            assert_eq!(is_noticed, !message.is_empty(), "{wrong}: {found:?}");
            assert!(!message.is_empty() || found.is_empty(), "{wrong}: {found:?}");
            count += 1;
            noticed += usize::from(is_noticed);
        }
    }
    assert_eq!((noticed, count), (17, 19));
}

#[test]
fn bodies_that_cannot_be_are_noticed() {
    let text = r#"title = "Two bodies"
[parameters]
m = -2
[coordinates]
a = { start = 0 }
b = { start = 0 }
[body.first]
rotation = "rotation(zx, a, b)"
inertia = [1, 1, 3]
mass = "m"
at = [0, 0, 1]
[start.velocities]
"a'" = 0
"b'" = 0
[run]
duration = 1
"#;
    let found = remarks(text);
    assert!(found[0].starts_with("scene:9:11: no body has the moments [1.0, 1.0, 3.0]"), "{found:?}");
    assert!(found[1].starts_with("scene:10:8: the mass of [body.first] is -2, below zero"), "{found:?}");
    let found = remarks(&text.replace("[1, 1, 3]", "[[1, 0, 0], [0, -1, 0], [0, 0, 1]]"));
    assert!(found.iter().any(|remark| remark.contains("a moment of [body.first] is -1, below zero")), "{found:?}");
}
