//! The car with n trailers: `trailer.toml` for any n.

use std::fmt::Write;

/// Text of the scene with `n` trailers, coordinates `x, y, theta0 … theta{n}`; headings fall evenly from 0.3 to 0 rad, as in `trailer.toml`.
///
/// ```
/// let scene = scene::Scene::parse("trailers", &peers::trailer(2, 10.0)).unwrap();
/// assert_eq!((scene.system.dimension(), scene.system.constraints.len()), (5, 3));
/// assert_eq!(scene.start.v[2], 0.5);
/// ```
pub fn trailer(n: usize, duration: f64) -> String {
    let list = |item: &dyn Fn(usize) -> String, between: &str| (0..=n).map(item).collect::<Vec<_>>().join(between);
    let mut text = head(n);
    text += "[coordinates]\nx = { unit = \"m\", start = 0 }\ny = { unit = \"m\", start = 0 }\n";
    for i in 0..=n {
        let _ = writeln!(text, "theta{i} = {{ unit = \"rad\", start = {} }}", heading(i, n));
    }
    text += "\n[definitions]\n";
    for i in 1..=n {
        let (x, y) = match i {
            1 => ("x'".into(), "y'".into()),
            _ => (format!("vx{}", i - 1), format!("vy{}", i - 1)),
        };
        let _ =
            writeln!(text, "vx{i} = \"{x} + d*theta{i}'*sin(theta{i})\"\nvy{i} = \"{y} - d*theta{i}'*cos(theta{i})\"");
    }
    let speed = |i: usize| if i == 0 { "x'^2 + y'^2".into() } else { format!("vx{i}^2 + vy{i}^2") };
    let turn = |i: usize| format!("theta{i}'^2");
    let _ = writeln!(
        text,
        "\n[system]\nlagrangian = \"m/2*({}) + J/2*({})\"\nconstraints = [",
        list(&speed, " + "),
        list(&turn, " + ")
    );
    text += "  \"y'*cos(theta0) - x'*sin(theta0)\",\n";
    for i in 1..=n {
        let _ = writeln!(text, "  \"vy{i}*cos(theta{i}) - vx{i}*sin(theta{i})\",");
    }
    text + &tail(duration)
}

/// The same motion with a place for every body, coordinates `x, y, theta0, x1, y1, theta1 …`, and hitches as constraints: each of these touches neighbours
/// only, which is what a long train wants.
///
/// ```
/// let scene = scene::Scene::parse("bodies", &peers::train_of_bodies(2, 10.0)).unwrap();
/// assert_eq!((scene.system.dimension(), scene.system.constraints.len()), (9, 7));
/// let same = scene::Scene::parse("trailers", &peers::trailer(2, 10.0)).unwrap();
/// assert!((scene.start.v[8] - same.start.v[4]).abs() < 1e-14, "the last heading");
/// ```
pub fn train_of_bodies(n: usize, duration: f64) -> String {
    let number = |i: usize| if i == 0 { String::new() } else { i.to_string() };
    let list = |item: &dyn Fn(usize) -> String, between: &str| (0..=n).map(item).collect::<Vec<_>>().join(between);
    let mut text = head(n) + "[coordinates]\n";
    let mut place = (0.0, 0.0);
    for i in 0..=n {
        let theta = heading(i, n);
        if i > 0 {
            place = (place.0 - LENGTH * theta.cos(), place.1 - LENGTH * theta.sin());
        }
        for (name, unit, start) in [("x", "m", place.0), ("y", "m", place.1)] {
            let _ = writeln!(text, "{name}{} = {{ unit = \"{unit}\", start = {start:?} }}", number(i));
        }
        let _ = writeln!(text, "theta{i} = {{ unit = \"rad\", start = {theta} }}");
    }
    let energy = |i: usize| format!("m/2*(x{0}'^2 + y{0}'^2) + J/2*theta{i}'^2", number(i));
    let _ = writeln!(text, "\n[system]\nlagrangian = \"{}\"\nconstraints = [", list(&energy, " + "));
    for i in 0..=n {
        let (own, front) = (number(i), number(i.saturating_sub(1)));
        let _ = writeln!(text, "  \"y{own}'*cos(theta{i}) - x{own}'*sin(theta{i})\",");
        if i > 0 {
            let _ = writeln!(text, "  \"x{own}' - x{front}' - d*theta{i}'*sin(theta{i})\",");
            let _ = writeln!(text, "  \"y{own}' - y{front}' + d*theta{i}'*cos(theta{i})\",");
        }
    }
    text + &tail(duration)
}

/// Where the coordinates of [`trailer`] are among those of [`train_of_bodies`].
pub(crate) fn place_among_bodies(i: usize) -> usize {
    if i < 3 { i } else { 3 * (i - 2) + 2 }
}

/// From axle to hitch.
const LENGTH: f64 = 0.8;

fn heading(i: usize, n: usize) -> f64 {
    0.3 * (1.0 - i as f64 / n as f64)
}

fn head(n: usize) -> String {
    format!("title = \"Car with {n} trailers\"\n\n[parameters]\nm = 1.0\nJ = 0.1\nd = {LENGTH:?}\n\n")
}

fn tail(duration: f64) -> String {
    format!(
        "]\n\n[start.velocities]\n\"x'\" = \"1.2*cos(theta0)\"\n\"theta0'\" = 0.5\n\n[run]\nduration = {duration}\n"
    )
}
