//! A car with n trailers: in coordinates whose constraints touch neighbours only, or in as few as possible.
//!
//! n + 1 bodies, headings `θᵢ`, axles `(xᵢ, yᵢ)`, body 0 the car; trailers hitch at the axle `d` before:
//!
//! ```text
//! xᵢ = xᵢ₋₁ − d cos θᵢ ,   yᵢ = yᵢ₋₁ − d sin θᵢ ,   ẏᵢ cos θᵢ − ẋᵢ sin θᵢ = 0   (no axle slips sideways).
//! ```
//!
//! Two degrees of freedom however long the train: the speed of the car along its heading, and its turning.
//! With n = 3 and minimal coordinates it is the scene `trailer`.

use crate::Scene;
use mechanics::{Completion, Parameter, State, System, View};
use symbolic::{Expr, ParseError};

/// Description of the train.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// All `(xᵢ, yᵢ, θᵢ)`, hitches as velocity constraints: 3n + 3 coordinates, 3n + 1 short constraints.
    Maximal,
    /// `(x, y)` of the car and all headings: n + 3 coordinates, n + 1 constraints of up to n + 2 velocities.
    Minimal,
}

/// Longest train that a name can ask for.
pub const LONGEST: usize = 1000;

const PARAMETERS: [(&str, f64); 3] = [("m", 1.0), ("J", 0.1), ("d", 0.8)];
/// m/s along the heading of the car, rad/s of the car.
const SPEED: f64 = 1.2;
const TURN: f64 = 0.5;
/// Headings: of the car, and how much that of the next body is less; rad.
const HEADING: f64 = 0.3;
const BEND: f64 = 0.1;
/// s
const DURATION: f64 = 10.0;

/// The expressions of a train, as text.
struct Train {
    /// Name, unit, start, and velocity at the start.
    coordinates: Vec<(String, &'static str, f64, f64)>,
    lagrangian: String,
    constraints: Vec<String>,
}

/// The train `n-trailer-N` (maximal coordinates) or `n-trailer-minimal-N`, with 1 to [`LONGEST`] trailers.
pub fn named(name: &str) -> Option<(usize, Coordinates)> {
    let rest = name.strip_prefix("n-trailer-")?;
    let (number, coordinates) = match rest.strip_prefix("minimal-") {
        Some(number) => (number, Coordinates::Minimal),
        None => (rest, Coordinates::Maximal),
    };
    let trailers = number.parse().ok().filter(|n| (1..=LONGEST).contains(n))?;
    Some((trailers, coordinates))
}

/// The train as a scene file; the velocities of the trailers are left to the constraints.
pub fn text(trailers: usize, coordinates: Coordinates) -> String {
    let train = Train::new(trailers, coordinates);
    let mut text = format!("title = \"Car with {trailers} trailers\"\n");
    text += "source = \"Laumond 1993; Soerdalen 1993; dynamics after Neimark & Fufaev 1972\"\n\n[parameters]\n";
    text.extend(PARAMETERS.map(|(name, value)| format!("{name} = {value:?}\n")));
    text += "\n[coordinates]\n";
    for (name, unit, start, _) in &train.coordinates {
        text += &format!("{name} = {{ unit = \"{unit}\", start = {start:?} }}\n");
    }
    text += &format!("\n[system]\nlagrangian = \"{}\"\nconstraints = [\n", train.lagrangian);
    text.extend(train.constraints.iter().map(|f| format!("  \"{f}\",\n")));
    let x = &train.coordinates[0].0;
    text + &format!(
        "]\n\n[start.velocities]\n\"{x}'\" = \"{SPEED}*cos(theta0)\"\n\"theta0'\" = {TURN}\n\n[run]\nduration = {DURATION:?}\n"
    )
}

/// The train as a scene, start velocities body by body: no matrix is decomposed, long trains come at once.
///
/// # Errors
/// None for the texts made here, which parse.
///
/// ```
/// use scene::catalogue::trailer::{Coordinates, scene};
/// let scene = scene(2, Coordinates::Maximal)?;
/// assert_eq!((scene.system.dimension(), scene.system.constraints.len()), (9, 7));
/// # Ok::<(), symbolic::ParseError>(())
/// ```
pub fn scene(trailers: usize, coordinates: Coordinates) -> Result<Scene, ParseError> {
    let train = Train::new(trailers, coordinates);
    let names: Vec<(&str, &str)> = train.coordinates.iter().map(|c| (c.0.as_str(), c.1)).collect();
    let mut system = System::new(symbolic::Graph::new(), &names);
    let g = &system.graph;
    system.parameters =
        PARAMETERS.map(|(name, value)| Parameter { symbol: g.symbol(name), value, formula: None }).into();
    system.lagrangian = g.parse(&train.lagrangian, g)?;
    system.constraints = train.constraints.iter().map(|f| g.parse(f, g)).collect::<Result<Vec<Expr>, _>>()?;
    let state = State {
        t: 0.0,
        q: train.coordinates.iter().map(|c| c.2).collect(),
        v: train.coordinates.iter().map(|c| c.3).collect(),
    };
    Ok(Scene {
        name: match coordinates {
            Coordinates::Maximal => format!("n-trailer-{trailers}"),
            Coordinates::Minimal => format!("n-trailer-minimal-{trailers}"),
        },
        title: format!("Car with {trailers} trailers"),
        source: String::new(),
        notes: String::new(),
        multipliers: vec![0.0; system.constraints.len()],
        system,
        start: state,
        completion: Completion::default(),
        removals: Vec::new(),
        duration: DURATION,
        film: Vec::new(),
        view: View::default(),
        meant: None,
    })
}

/// One body at the start.
struct Body {
    place: [f64; 3],
    velocity: [f64; 3],
}

fn bodies(trailers: usize) -> Vec<Body> {
    let d = PARAMETERS[2].1;
    let velocity = [SPEED * HEADING.cos(), SPEED * HEADING.sin(), TURN];
    let mut bodies = vec![Body { place: [0.0, 0.0, HEADING], velocity }];
    for i in 1..=trailers {
        let front = &bodies[i - 1];
        let theta = HEADING - BEND * i as f64;
        let (sine, cosine) = theta.sin_cos();
        let turn = (front.velocity[1] * cosine - front.velocity[0] * sine) / d;
        let place = [front.place[0] - d * cosine, front.place[1] - d * sine, theta];
        let velocity = [front.velocity[0] + d * turn * sine, front.velocity[1] - d * turn * cosine, turn];
        bodies.push(Body { place, velocity });
    }
    bodies
}

impl Train {
    fn new(trailers: usize, coordinates: Coordinates) -> Self {
        match coordinates {
            Coordinates::Maximal => Train::maximal(trailers),
            Coordinates::Minimal => Train::minimal(trailers),
        }
    }

    fn maximal(trailers: usize) -> Self {
        let mut train = Train { coordinates: Vec::new(), lagrangian: String::new(), constraints: Vec::new() };
        let mut energies = Vec::new();
        for (i, body) in bodies(trailers).into_iter().enumerate() {
            for (k, (name, unit)) in [("x", "m"), ("y", "m"), ("theta", "rad")].into_iter().enumerate() {
                train.coordinates.push((format!("{name}{i}"), unit, body.place[k], body.velocity[k]));
            }
            energies.push(format!("m/2*(x{i}'^2 + y{i}'^2) + J/2*theta{i}'^2"));
            train.constraints.push(format!("y{i}'*cos(theta{i}) - x{i}'*sin(theta{i})"));
            if let Some(front) = i.checked_sub(1) {
                train.constraints.push(format!("x{i}' - x{front}' - d*theta{i}'*sin(theta{i})"));
                train.constraints.push(format!("y{i}' - y{front}' + d*theta{i}'*cos(theta{i})"));
            }
        }
        train.lagrangian = energies.join(" + ");
        train
    }

    fn minimal(trailers: usize) -> Self {
        let bodies = bodies(trailers);
        let mut coordinates: Vec<(String, &'static str, f64, f64)> = [("x", 0), ("y", 1)]
            .map(|(name, k)| (name.to_string(), "m", bodies[0].place[k], bodies[0].velocity[k]))
            .into();
        let headings = bodies.iter().enumerate();
        coordinates.extend(headings.map(|(i, b)| (format!("theta{i}"), "rad", b.place[2], b.velocity[2])));
        let (mut x, mut y) = ("x'".to_string(), "y'".to_string());
        let mut energies = Vec::new();
        let mut constraints = Vec::new();
        for i in 0..=trailers {
            if i > 0 {
                x += &format!(" + d*theta{i}'*sin(theta{i})");
                y += &format!(" - d*theta{i}'*cos(theta{i})");
            }
            energies.push(format!("m/2*(({x})^2 + ({y})^2) + J/2*theta{i}'^2"));
            let levers = (1..i).map(|j| format!(" - d*theta{j}'*cos(theta{i} - theta{j})"));
            let own = if i > 0 { format!(" - d*theta{i}'") } else { String::new() };
            constraints.push(format!("y'*cos(theta{i}) - x'*sin(theta{i}){}{own}", levers.collect::<String>()));
        }
        Train { coordinates, lagrangian: energies.join(" + "), constraints }
    }
}
