//! Kinds of machines that are drawn.

use super::frame::{Arg, Between, Force, Law, Shape, Step, V};
use super::machine::{Machine, written};

pub(super) const KINDS: [&str; 6] = ["hinge", "hinge", "slider", "plane", "ball", "fixed"];

/// A tree of two to four bodies with forces between them, in space or on a slope.
pub(super) fn tree(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    m.may_be_homogeneous = true;
    let slope = m.likely(0.3).then(|| m.slope());
    let mut joints = Vec::new();
    let roots = m.bodies.len();
    if m.likely(0.4) {
        let word = m.word();
        m.free(slope, word, None, "");
    }
    for _ in 0..2 + m.below(2) {
        let on = if m.bodies.len() > roots { Some(roots + m.below(m.bodies.len() - roots)) } else { slope };
        let kind = KINDS[m.below(KINDS.len())];
        let (i, length) = m.jointed(on, kind, true);
        joints.extend(length.map(|arg| (i, arg)));
    }
    for _ in 0..m.below(4) {
        let joint = if joints.is_empty() || m.likely(0.4) { None } else { Some(joints[m.below(joints.len())].clone()) };
        m.link(joint);
    }
    m
}

/// A body that rolls, slides or cuts, on the ground, a slope or a turning table, perhaps with a body on it.
pub(super) fn rolling(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let (on, stands) = match m.below(4) {
        0 => {
            let slope = m.slope();
            (Some(slope), Some(slope))
        }
        1 => {
            let arg = Arg { text: "0.3*sin(2*t)".into(), wave: 0.3, ..Arg::default() };
            let lines =
                format!("shape = \"table\"\nsize = [1]\njoint = {{ hinge = \"z\", angle = \"{}\" }}\n", arg.text);
            let table = m.body(&lines, None, vec![Step::Turn(V::z(), arg)], false);
            (Some(table), m.likely(0.4).then_some(table))
        }
        _ => (None, None),
    };
    let (a, b, c) = (m.between(0.2, 0.5), m.between(0.2, 0.5), m.between(0.2, 0.5));
    let point = m.vector(0.5);
    let (shape, lines, height) = match m.below(5) {
        0 => (Shape::Ball(a), format!("shape = \"ball\"\nsize = [{a:?}]\n"), a),
        1 => (Shape::Ellipsoid(V::new(a, b, c)), format!("shape = \"ellipsoid\"\nsize = [{a:?}, {b:?}, {c:?}]\n"), b),
        2 => (Shape::Wheel(a, 0.1), format!("shape = \"wheel\"\nsize = [{a:?}, 0.1]\n"), 0.7 * a),
        3 => (Shape::Wheel(a, 0.0), format!("shape = \"disc\"\nsize = [{a:?}]\n"), 0.7 * a),
        _ => (Shape::Point(point), String::new(), 0.3),
    };
    let law = [Law::Rolls, Law::Rolls, Law::Rubber, Law::Slides, Law::Blade][m.below(5)];
    let word = match shape {
        Shape::Point(_) if law == Law::Blade => ["z", "zx"][m.below(2)],
        Shape::Wheel(..) if m.likely(0.5) => "zxy",
        _ => m.word(),
    };
    let law =
        if law == Law::Blade && matches!(shape, Shape::Ball(_) | Shape::Ellipsoid(_)) { Law::Slides } else { law };
    let body = m.free(stands, word, Some(height), &lines);
    m.contact(body, on, shape, law);
    if m.likely(0.5) {
        let kind = ["hinge", "slider", "ball"][m.below(3)];
        let (i, length) = m.jointed(Some(body), kind, true);
        if let Some(arg) = length {
            m.link(Some((i, arg)));
        }
    }
    m
}

/// A ball or a point in a cone, a cylinder or a bowl, which stands somewhere and is turned.
pub(super) fn inside(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let (a, b, at) = (m.number(0.5), m.number(0.5), m.vector(0.5));
    let (rotation, turns) = Machine::turns("yx", vec![Arg::number(a), Arg::number(b)]);
    let (size, curved) = (m.between(0.4, 0.8), m.between(0.3, 0.9));
    let kind = ["cone", "cylinder", "bowl"][m.below(3)];
    let sizes = match kind {
        "cone" => format!("{size:?}, 2"),
        "cylinder" => format!("{size:?}, 3"),
        _ => format!("{size:?}, {curved:?}, 2"),
    };
    let placed =
        if m.likely(0.7) { format!("at = {}\nrotation = \"{rotation}\"\n", written(at)) } else { String::new() };
    let steps = if placed.is_empty() { Vec::new() } else { [vec![Step::Shift(at)], turns].concat() };
    let under = m.body(&format!("shape = \"{kind}\"\nsize = [{sizes}]\n{placed}"), None, steps, false);
    if kind == "bowl" {
        let body = m.free(None, "zx", Some(0.3), "");
        m.contact(body, Some(under), Shape::Bowl(size, curved), Law::Slides);
        return m;
    }
    let (k, v) = (m.coordinate(false, false), m.arg(true));
    let u = Arg { text: format!("0.8 + q{k}"), linear: vec![(k, 1.0)], constant: 0.8, ..Arg::default() };
    let is_ball = m.likely(0.7);
    let radius = if is_ball { m.between(0.05, 0.2) } else { 0.0 };
    let (along, normal) = match kind {
        "cone" => (vec![Step::Turn(V::z(), v.clone()), Step::Turn(V::y(), Arg::number(size))], V::x()),
        _ => (vec![Step::Turn(V::x(), v.clone())], -V::z()),
    };
    let place = match kind {
        "cone" => vec![Step::Slide(V::z(), u.clone()), Step::Shift(-V::x() * radius)],
        _ => vec![Step::Slide(V::x(), u.clone()), Step::Shift(V::z() * (radius - size))],
    };
    let mut steps = [along.clone(), place, vec![Step::Upright]].concat();
    let mut joint = format!("surface = [\"{}\", \"{}\"]", u.text, v.text);
    let mut lines = "shape = \"point\"\nsize = [0.1]\n".to_string();
    if is_ball {
        let word = m.word();
        let angles = word.chars().map(|_| m.arg(true)).collect();
        let (rotation, turns) = Machine::turns(word, angles);
        joint += &format!(", rotation = \"{rotation}\"");
        lines = format!("shape = \"ball\"\nsize = [{radius:?}]\n");
        steps.extend(turns);
    }
    let body = m.body(&format!("{lines}joint = {{ {joint} }}\n"), Some(under), steps, true);
    m.bodies[body].surface = Some((along, normal));
    if is_ball {
        let law = [Law::Rolls, Law::Rubber, Law::Slides][m.below(3)];
        m.contact(body, Some(under), Shape::Inside(radius), law);
    }
    m
}

/// A robot on wheels: a body in the plane, forks on it, wheels, upright or with camber, and blades.
pub(super) fn robot(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    let height = m.between(0.1, 0.5);
    let [x, y, phi] = [m.arg(false), m.arg(false), m.arg(true)];
    let joint =
        format!("joint = {{ plane = [\"{}\", \"{}\", \"{}\"], at = [0, 0, {height:?}] }}\n", x.text, y.text, phi.text);
    let steps =
        vec![Step::Shift(V::z() * height), Step::Slide(V::x(), x), Step::Slide(V::y(), y), Step::Turn(V::z(), phi)];
    let mut carriers = vec![m.body(&joint, None, steps, true)];
    for _ in 0..m.below(3) {
        let on = carriers[m.below(carriers.len())];
        let (at, arg) = (V::new(m.number(0.8), m.number(0.8), 0.0), m.arg(true));
        let lines = format!("joint = {{ hinge = \"z\", angle = \"{}\", at = {} }}\n", arg.text, written(at));
        let is_heavy = m.likely(0.7);
        let i = m.body(&lines, Some(on), vec![Step::Shift(at), Step::Turn(V::z(), arg.clone())], is_heavy);
        carriers.push(i);
        m.link(Some((i, arg)));
    }
    for &on in &carriers.clone() {
        let (a, camber) = (m.between(0.1, 0.4), if m.likely(0.3) { m.number(0.4) } else { 0.0 });
        let at = V::new(m.number(0.5), m.number(0.5), a * camber.cos() - height);
        if m.likely(0.25) {
            m.contact(on, None, Shape::Point(V::new(at.x, at.y, -height)), Law::Blade);
            continue;
        }
        for side in if m.likely(0.4) { &[1.0, -1.0][..] } else { &[1.0] } {
            let at = V::new(at.x, at.y * side, at.z);
            let arg = m.arg(true);
            let law = if m.likely(0.8) { Law::Rolls } else { Law::Blade };
            let lines = format!("at = {}\nrotation = \"rotation(x, {camber:?})\"\n", written(at));
            let knuckle = vec![Step::Shift(at), Step::Turn(V::x(), Arg::number(camber))];
            let knuckle = m.body(&lines, Some(on), knuckle, false);
            let hinge = format!("joint = {{ hinge = \"y\", angle = \"{}\" }}\n", arg.text);
            let lines = format!("shape = \"wheel\"\nsize = [{a:?}]\n{hinge}");
            let i = m.body(&lines, Some(knuckle), vec![Step::Turn(V::y(), arg.clone())], true);
            m.contact(i, None, Shape::Wheel(a, 0.0), law);
            m.link(Some((i, arg)));
        }
    }
    m
}

/// A chain whose end is held where it is at the start, by a point that closes the loop.
pub(super) fn closed(seed: u64) -> Machine {
    let mut m = Machine::new(seed);
    m.may_be_homogeneous = true;
    let slope = m.likely(0.3).then(|| m.slope());
    let is_flat = m.likely(0.5);
    let mut on = slope;
    for _ in 0..if is_flat { 3 } else { 4 } {
        let (i, _) = if is_flat {
            let (at, arg) = (V::new(0.6, m.number(0.3), 0.0), m.arg(true));
            let lines = format!("joint = {{ hinge = \"z\", angle = \"{}\", at = {} }}\n", arg.text, written(at));
            (m.body(&lines, on, vec![Step::Shift(at), Step::Turn(V::z(), arg)], true), None)
        } else {
            let kind = if m.likely(0.8) { "hinge" } else { "ball" };
            m.jointed(on, kind, true)
        };
        on = Some(i);
    }
    let last = m.bodies.len() - 1;
    let end = V::new(0.7, m.number(0.3), if is_flat { 0.0 } else { 0.2 });
    let still = vec![0.0; m.start.len()];
    let frames = m.frames((0.4, &m.start, &still));
    let (to, name) = if m.likely(0.3) && slope.is_some() { (slope, "b0") } else { (None, "space") };
    let there = frames[last].point(end).p;
    let own = to.map_or(there, |i| frames[i].r.transpose() * (there - frames[i].p));
    m.text += &format!("[loop.pin]\nbetween = {{ b{last} = {}, {name} = {} }}\n", written(end), written(own));
    m.forces.push((Between::Points([(Some(last), end), (to, own)]), Force::Loop));
    m
}
