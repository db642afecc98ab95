//! An unconstrained body, its velocities along a turning frame: removal itself put to the test (T14).

use super::support::{at, chetaev, complete, error, must, must_exceed, removal, removed, scene};

const START: [(&str, f64); 6] = [("x", 1.0), ("y", -0.4), ("phi", 0.2), ("x'", 0.3), ("y'", 0.9), ("phi'", 0.8)];

#[test]
fn removal_of_nothing_is_newtons_motion_only_for_the_right_constants() {
    // L = ½(ẋ² + ẏ² + φ̇²) − ½(x² + 2y²), h = 0; ẋ = u̇ cos φ − ẇ sin φ, ẏ = u̇ sin φ + ẇ cos φ
    let scene = scene("planar-body", &START);
    let frame = removal(&scene, "turning-frame");
    frame.verify(&scene.system).expect("there is nothing to satisfy");
    let [x, y, phi, vx, vy, turn] = START.map(|(_, value)| value);
    let w = 2.0_f64.sqrt();
    let newton = |t: f64| vec![x * t.cos() + vx * t.sin(), y * (w * t).cos() + vy / w * (w * t).sin(), phi + turn * t];

    must("planar body, Chetaev without constraint: Newton", error(&mut chetaev(&scene), &newton), 1e-11);
    let mut right = complete(&scene, removed(&scene, frame, &[-vx, -vy]));
    let start = at(&mut right, 0.0);
    let place = right.equations.multipliers.iter().position(|m| m.name == "p_u").expect("p_u");
    must("planar body, P(t₀) = −(ẋ₀, ẏ₀): |p_u|", start.multipliers[place].abs(), 1e-14);
    must("planar body, P(t₀) = −(ẋ₀, ẏ₀): Newton's motion over 3 s", error(&mut right, &newton), 1e-8);

    let mut wrong = complete(&scene, removed(&scene, frame, &[0.0, 0.0]));
    let rotation = at(&mut wrong, 3.0).coordinates[2] - newton(3.0)[2];
    must_exceed("planar body, P(t₀) = 0: rotation off after 3 s, rad", rotation.abs(), 1.0);
}
