//! Bodies rolling on each other, from positions and rotations alone: what constraints 1 to 3 must say.

use anyhow::{Result, bail};
use symbolic::{Expr, Function, Graph};

use super::context::Context;

type Vector = [Expr; 3];

/// Definitions of the geometry `name`: slips (contact point velocities, zero for rolling), energies.
pub(super) fn definitions(name: &str, context: &Context) -> Result<Vec<(String, Expr)>> {
    match name {
        "incline" => incline(context),
        "cone" => ball_in_cone(context, ContactAt::Distance),
        "cone-of-centres" => ball_in_cone(context, ContactAt::ConeOfCentres),
        "cylinders" => cylinders(context),
        _ => bail!("no geometry `{name}`"),
    }
}

/// What `r` is in the cone.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ContactAt {
    /// The distance of the apex from the point of contact.
    Distance,
    /// The distance along the cone on which the centre moves.
    ConeOfCentres,
}

/// A plane that falls along `x`, a blade along `(cos φ, sin φ)`.
fn incline(context: &Context) -> Result<Vec<(String, Expr)>> {
    let g = &context.graph;
    let e = |text: &str| context.expression(text);
    let position = [e("x*cos(alpha)")?, e("y")?, e("-x*sin(alpha)")?];
    let velocity = rate(context, position)?;
    let kinetic = g.add(g.mul(g.ratio(1, 2), dot(g, velocity, velocity)), e("k^2*phi'^2/2")?);
    let across = [e("-sin(phi)*cos(alpha)")?, e("cos(phi)")?, e("sin(phi)*sin(alpha)")?];
    let potential = g.mul(e("g")?, position[2]);
    Ok(vec![("energy_difference".into(), g.sub(kinetic, potential)), ("slip".into(), dot(g, velocity, across))])
}

/// Wall direction `s`, inward normal `n`, both at azimuth `γ`; the ball's rotation is
/// `R = R_z(χ+γ) R_x(θ) R_z(φ)`, and `ω` comes from `Ṙ Rᵀ`. Centre `r s + a n`, contact at `−a n` from it.
fn ball_in_cone(context: &Context, contact: ContactAt) -> Result<Vec<(String, Expr)>> {
    let g = &context.graph;
    let e = |text: &str| context.expression(text);
    let along = [e("sin(alpha)*cos(gamma)")?, e("sin(alpha)*sin(gamma)")?, e("cos(alpha)")?];
    let inward = [e("-cos(alpha)*cos(gamma)")?, e("-cos(alpha)*sin(gamma)")?, e("sin(alpha)")?];
    let around = [e("-sin(gamma)")?, e("cos(gamma)")?, g.zero()];
    let (r, a) = (e("r")?, e("a")?);
    let centre = match contact {
        ContactAt::Distance => add(g, scale(g, r, along), scale(g, a, inward)),
        ContactAt::ConeOfCentres => scale(g, r, along),
    };
    let velocity = rate(context, centre)?;
    let rotation = product(
        g,
        &product(g, &turn(g, e("chi + gamma")?, [0, 1, 2]), &turn(g, e("theta")?, [1, 2, 0])),
        &turn(g, e("phi")?, [0, 1, 2]),
    );
    let mut spin = [[g.zero(); 3]; 3];
    for (row, rates) in spin.iter_mut().enumerate() {
        let moving = rate(context, rotation[row])?;
        for (column, entry) in rates.iter_mut().enumerate() {
            *entry = dot(g, moving, rotation[column]);
        }
    }
    let omega = [spin[2][1], spin[0][2], spin[1][0]];
    let slip = add(g, velocity, cross(g, omega, scale(g, g.neg(a), inward)));
    let kinetic = e("m/2")?;
    let kinetic =
        g.add(g.mul(kinetic, dot(g, velocity, velocity)), g.product(&[kinetic, e("k^2")?, dot(g, omega, omega)]));
    let height = g.product(&[e("m*g")?, centre[2]]);
    Ok(vec![
        ("slip_s".into(), dot(g, slip, along)),
        ("slip_t".into(), dot(g, slip, around)),
        ("slip_n".into(), dot(g, slip, inward)),
        ("energy_difference".into(), g.sub(kinetic, height)),
    ])
}

/// Two cylinders of radius `r` roll on the ground, axes along `(1, 0)` and `(cos α, sin α)`; one of radius
/// `R`, heading `θ` and unit mass lies on both. `m_i`, `I_i`: the lower masses and moments about their axes.
fn cylinders(context: &Context) -> Result<Vec<(String, Expr)>> {
    let g = &context.graph;
    let e = |text: &str| context.expression(text);
    let up = [g.zero(), g.zero(), g.one()];
    let heading = [e("cos(theta)")?, e("sin(theta)")?, g.zero()];
    let centre = [e("x")?, e("y")?, e("2*r + R")?];
    let velocity = rate(context, centre)?;
    let omega = add(g, scale(g, e("theta'")?, up), scale(g, e("phi'")?, heading));
    let (half, about_up, about_axis) = (g.ratio(1, 2), dot(g, omega, up), dot(g, omega, heading));
    let mut doubled =
        vec![dot(g, velocity, velocity), g.mul(e("A")?, g.powi(about_up, 2)), g.mul(e("C")?, g.powi(about_axis, 2))];
    let mut all = Vec::new();
    for (number, angle) in [("1", g.zero()), ("2", e("alpha")?)] {
        let roll = format!("phi{number}");
        let axis = [g.call(Function::Cos, angle), g.call(Function::Sin, angle), g.zero()];
        let sideways = cross(g, up, axis);
        let below = add(g, scale(g, e(&format!("r*{roll}"))?, sideways), scale(g, e("r")?, up));
        // rolls on the ground: the velocity at its foot is zero
        let turning = scale(g, e(&format!("-{roll}'"))?, axis);
        let moving = rate(context, below)?;
        let foot = add(g, moving, cross(g, turning, scale(g, e("-r")?, up)));
        let top = add(g, moving, cross(g, turning, scale(g, e("r")?, up)));
        let across = g.sub(dot(g, below, sideways), dot(g, centre, sideways));
        let contact = g.div(across, dot(g, heading, sideways));
        let arm = add(g, scale(g, contact, heading), scale(g, e("-R")?, up));
        let touching = add(g, velocity, cross(g, omega, arm));
        for (index, direction) in ["x", "y"].into_iter().enumerate() {
            all.push((format!("slip{number}_{direction}"), g.sub(touching[index], top[index])));
        }
        all.push((format!("ground{number}"), dot(g, foot, sideways)));
        doubled.push(g.mul(e(&format!("m{number}"))?, dot(g, moving, moving)));
        doubled.push(g.mul(e(&format!("I{number}"))?, dot(g, turning, turning)));
    }
    all.push(("kinetic".into(), g.mul(half, g.sum(&doubled))));
    Ok(all)
}

fn rate(context: &Context, v: Vector) -> Result<Vector> {
    Ok([context.rate(v[0])?, context.rate(v[1])?, context.rate(v[2])?])
}

fn add(g: &Graph, a: Vector, b: Vector) -> Vector {
    [g.add(a[0], b[0]), g.add(a[1], b[1]), g.add(a[2], b[2])]
}

fn scale(g: &Graph, s: Expr, v: Vector) -> Vector {
    v.map(|x| g.mul(s, x))
}

fn dot(g: &Graph, a: Vector, b: Vector) -> Expr {
    g.dot(&a, &b)
}

fn cross(g: &Graph, a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| g.sub(g.mul(a[i], b[j]), g.mul(a[j], b[i])))
}

/// The rotation by `angle` from the first of `axes` to the second, about the third.
fn turn(g: &Graph, angle: Expr, [i, j, k]: [usize; 3]) -> [Vector; 3] {
    let (cos, sin) = (g.call(Function::Cos, angle), g.call(Function::Sin, angle));
    let mut m = [[g.zero(); 3]; 3];
    (m[i][i], m[j][j], m[k][k]) = (cos, cos, g.one());
    (m[i][j], m[j][i]) = (g.neg(sin), sin);
    m
}

fn product(g: &Graph, a: &[Vector; 3], b: &[Vector; 3]) -> [Vector; 3] {
    let entry = |i: usize, j: usize| dot(g, a[i], [b[0][j], b[1][j], b[2][j]]);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}
