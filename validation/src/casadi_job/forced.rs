//! Scenes with friction, motors and drives, in every formulation.

/// Name of a built-in scene, and the forces that are added to it.
const FORCED: [(&str, &str); 13] = [
    // friction by both velocities of the contact, and a drive of the heading
    ("sledge", "x = \"-0.3*x'\"\ny = \"-0.3*y'\"\nphi = \"0.2*cos(t) - 0.1*phi'\""),
    // a motor of constant torque, friction at the blade
    ("sleigh", "x = \"-0.2*x'\"\ny = \"-0.2*y'\"\nphi = \"0.3 - 0.1*phi'\""),
    // linear friction, and a drive of what nothing but the constraint holds
    ("heisenberg", "x = \"-0.4*x'\"\ny = \"-0.4*y'\"\nz = \"0.1*sin(t)\""),
    // a motor of speed-dependent torque, friction of rolling and spinning, wind
    ("disc", "x = \"0.1 - 0.05*x'\"\npsi = \"0.2 - 0.03*psi'\"\nphi = \"-0.01*phi'\""),
    // the car pulls, and steers by a drive
    (
        "trailer",
        "x = \"0.4*cos(theta0)\"\ny = \"0.4*sin(theta0)\"\ntheta0 = \"0.1*cos(2*t)\"\ntheta3 = \"-0.1*theta3'\"",
    ),
    // drag of the centre, friction of spinning
    ("turntable", "x = \"-0.1*x'\"\ny = \"-0.1*y'\"\npsi = \"-0.001*psi'\""),
    ("ball-in-cone", "r = \"-0.1*r'\"\ngamma = \"-0.2*r^2*gamma'\"\nphi = \"0.0005\""),
    // what is eliminated with memory in it is braked, and driven
    ("three-cylinders", "x = \"-0.1*x'\"\ny = \"0.05*sin(t)\"\ntheta = \"-0.02*theta'\"\nphi1 = \"0.01\""),
    ("ball-in-cone-as-printed", "r = \"-0.1*r'\"\ngamma = \"0.05*cos(t)\""),
    // friction across and along, one of them cross
    ("particle", "x = \"-0.2*x' + 0.1*z\"\ny = \"0.3*cos(t)\"\nz = \"-0.1*y'\""),
    // constraints that can be integrated
    ("velocity-pendulum", "x = \"-0.3*x'\"\ny = \"-0.3*y'\""),
    ("bowl", "x = \"-0.1*x'*sqrt(1 + x'^2)\"\ny = \"0.2*x\"\nz = \"-0.3*z'\""),
    // a constraint that is not linear in the velocities
    ("appell-hamel", "x = \"-0.2*x'\"\ny = \"-0.1*y' + 0.3*sin(t)\"\nz = \"-0.2*z'\""),
];

/// Positions that contain the rate of a parameter, and one that contains memory: forces do work on `δu̇`.
const BY_RATE: &str = r#"
title = "Driven oscillator with friction, a parameter of second order"
[coordinates]
x = { start = 1 }
y = { start = 0.2 }
[system]
lagrangian = "(x'^2 + y'^2)/2 - x^2*y/3"
constraints = []
forces = { x = "cos(t) - 0.3*x'*y", y = "-0.2*y' + 0.1*x*x'" }
[start.velocities]
"x'" = 0.4
"y'" = 1
[removal.second-order]
parameters = ["u", "w"]
direct = { x = "u + u'/2 + u'^2/9", y = "w" }
constants = "zero"
[removal.by-rate]
parameters = ["u", "y"]
rates = { x = "u'*(2 + y)" }
constants = "zero"
[run]
duration = 1
"#;

/// What the names of such scenes end with.
pub(super) const SUFFIX: &str = " with forces";

/// Names and texts of scenes in which forces act.
pub fn forced() -> Vec<(String, String)> {
    let pushed = FORCED.iter().map(|(name, forces)| {
        let text = scene::catalogue::text_of(name).unwrap_or_default();
        (format!("{name}{SUFFIX}"), format!("{text}\n[system.forces]\n{forces}\n"))
    });
    pushed.chain([(format!("by-rate{SUFFIX}"), BY_RATE.to_string())]).collect()
}
