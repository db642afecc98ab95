//! What a reviewer would ask about scenes that can be read.

use scene::Scene;

fn remarks(text: &str) -> Vec<String> {
    let remarks = Scene::remarks::<f64>("scene", text, &[]).unwrap_or_else(|e| panic!("{e}"));
    remarks.iter().map(|remark| remark.to_string().lines().next().unwrap_or_default().to_owned()).collect()
}

const ROBOT: &str = r#"title = "Falling disc with drag"
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
    ("-c*psi'", "0", "scene:6:1: `c` is used by nothing"),
    ("m/2*dot", "-m/2*dot", "scene:17:1: the kinetic energy is negative at the start"),
    ("+ m*R^2*dot(W", "- m*R^2*dot(W", "scene:17:1: the kinetic energy is negative at the start"),
];

#[test]
fn mistakes_are_noticed_with_their_place() {
    assert_eq!(remarks(ROBOT), [""; 0]);
    for (right, wrong, message) in MISTAKES {
        assert!(ROBOT.contains(right), "{right}");
        let found = remarks(&ROBOT.replacen(right, wrong, 1));
        assert!(found.iter().any(|remark| remark.starts_with(message)), "{wrong}: {found:?}");
    }
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
