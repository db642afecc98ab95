//! The car with n trailers: `trailer.toml` for any n.

use std::fmt::Write;

/// Text of the scene with `n` trailers, coordinates `x, y, theta0 … theta{n}`; headings fall evenly from 0.3 to 0 rad, as in `trailer.toml`.
///
/// ```
/// let scene = mechanics::Scene::parse("trailers", &peers::trailer(2, 10.0)).unwrap();
/// assert_eq!((scene.system.dimension(), scene.system.constraints.len()), (5, 3));
/// assert_eq!(scene.start.v[2], 0.5);
/// ```
pub fn trailer(n: usize, duration: f64) -> String {
    let list = |item: &dyn Fn(usize) -> String, between: &str| (0..=n).map(item).collect::<Vec<_>>().join(between);
    let mut text = format!("title = \"Car with {n} trailers\"\n\n[parameters]\nm = 1.0\nJ = 0.1\nd = 0.8\n\n");
    text += "[coordinates]\nx = { unit = \"m\", start = 0 }\ny = { unit = \"m\", start = 0 }\n";
    for i in 0..=n {
        let start = 0.3 * (1.0 - i as f64 / n as f64);
        let _ = writeln!(text, "theta{i} = {{ unit = \"rad\", start = {start} }}");
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
    let _ = writeln!(
        text,
        "]\n\n[start.velocities]\n\"x'\" = \"1.2*cos(theta0)\"\n\"theta0'\" = 0.5\n\n[run]\nduration = {duration}"
    );
    text
}
