//! A bicycle with a leaning rider.

use nalgebra::Matrix3;

use super::frame::{Arg, Between, Body, Force, Law, Shape, Step, V};
use super::machine::{Machine, written};

/// The benchmark bicycle whose rider leans: a torso on a hinge along the frame, with a spring and a damper.
pub(super) fn rider(seed: u64) -> Machine {
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
    type Part = (String, Option<usize>, Vec<Step>, f64, V, [f64; 4]);
    let parts: [Part; 5] = [
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
