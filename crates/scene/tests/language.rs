//! What a scene can say, and all that is wrong with it at once.

use super::errors::{SLEDGE, error, error_of, pointed};
use scene::{NameFault, Scene, SceneError, SceneErrorKind as Kind};

#[test]
fn parameters_and_definitions_come_in_any_order() {
    let text = SLEDGE
        .replace("g = 9.81", "g = \"k2 + 9.81\"\nk2 = \"k^2*r\"\nr = \"pi/3\"")
        .replace("weight = \"g", "weight = \"force*g")
        .replace("[system]", "force = \"sin(later)/sin(later)\"\nlater = \"x + 2\"\n[system]");
    let scene = Scene::parse("sledge", &text).unwrap();
    let names: Vec<String> = scene.system.parameters.iter().map(|p| scene.system.graph.name(p.symbol)).collect();
    assert_eq!(names, ["r", "alpha", "k"], "the others follow these");
    assert_eq!(scene.system.parameters[0].value, std::f64::consts::PI / 3.0);
    let set = Scene::parse_with("sledge", &text, &[("k2".into(), 2.0)]).unwrap();
    assert!(set.system.parameters.iter().any(|p| p.value == 2.0), "one that is set follows nothing");
}

#[test]
fn circles_are_shown() {
    let shown = |error: &SceneError| match &*error.kind {
        Kind::Circle { names } => names.join(" → "),
        _ => panic!("{error}"),
    };
    let error = error("weight = \"g*sin(alpha)\"", "weight = \"a*g\"\na = \"b + 1\"\nb = \"weight\"");
    assert_eq!((shown(&error).as_str(), error.also.len()), ("weight → a → b → weight", 0), "{error}");
    let own = super::errors::error("g = 9.81", "g = \"2*g\"");
    assert_eq!(shown(&own), "g → g");
}

#[test]
fn every_fault_is_found_at_once() {
    let text = SLEDGE
        .replace("title = ", "tilte = ")
        .replace("g = 9.81", "g = true")
        .replace("unit = \"rad\"", "unit = \"deg\"")
        .replace("\"2*x\"", "\"2*z\"")
        .replace("weight = \"g*sin(alpha)\"", "weight = \"g*sni(alpha)\"\nlight = \"g*cos(beta)\"")
        .replace("+ weight*x", "+ q + weight*x")
        .replace("forces = { x", "forces = { u")
        .replace("duration = 10", "duration = 0");
    let error = error_of(&text);
    let found: Vec<(usize, String)> = error.each().map(|e| (e.line, pointed(e))).collect();
    let expected = [
        (1, "tilte"),
        (5, "true"),
        (11, "z"),
        (12, "\"deg\""),
        (15, "sni"),
        (16, "beta"),
        (19, "q"),
        (21, "u"),
        (41, "0"),
    ];
    println!("{error}");
    let expected: Vec<(usize, String)> = expected.iter().map(|(line, at)| (*line, at.to_string())).collect();
    assert_eq!(found, expected);
}

#[test]
fn names_of_overrides_are_reserved() {
    for name in ["time", "duration", "mu0_1", "P0_x"] {
        for (old, new) in [("k = 0.7", format!("{name} = 0.7")), ("phi = {", format!("{name} = {{"))] {
            let error = error(old, &new);
            assert!(
                error.each().any(|e| matches!(&*e.kind, Kind::InvalidName { fault: NameFault::Overriding(_), .. }))
            );
        }
    }
    let error = error("phi = {", "kappa = {");
    assert!(error.to_string().contains("the parameter of the formulation `kappa`"), "{error}");
    let error = Scene::parse_with("sledge", SLEDGE, &[("t".into(), 3.0)]).unwrap_err();
    assert!(error.to_string().contains("did you mean `time`?"), "{error}");
}

/// A pendulum by a constraint on its position: its rate is the constraint, and its value is watched.
#[test]
fn constraints_on_positions_and_vectors_of_constraints() {
    let text = "title = \"pendulum\"\n[coordinates]\nx = { start = 0.6 }\ny = { start = -0.8 }\nz = { start = 0 }\n\
        [definitions]\nr = \"[x, y, z]\"\n[system]\nlagrangian = \"dot(r', r')/2 - 9.81*y\"\n\
        constraints = [\"dot(r, r) - 1\", \"z'\"]\n[start.velocities]\n\"x'\" = 1\n[run]\nduration = 1\n";
    let scene = Scene::parse("pendulum", text).unwrap();
    let system = &scene.system;
    assert_eq!(system.graph.plain(system.constraints[0]), "2*x*x' + 2*y*y' + 2*z*z'");
    assert!((scene.start.v[1] - 0.75).abs() < 1e-15);
    assert_eq!(system.watched[0].name, "constraint 1 on positions");
    let vector = text.replace("[\"dot(r, r) - 1\", \"z'\"]", "[\"[x*x' + y*y', z']\"]");
    let scene = Scene::parse("pendulum", &vector).unwrap();
    assert_eq!((scene.system.constraints.len(), scene.start.v[2]), (2, 0.0));
    // each component has a number of its own, and so a name
    let both =
        Scene::parse("pendulum", &text.replace("[\"dot(r, r) - 1\", \"z'\"]", "[\"[dot(r, r) - 1, z]\"]")).unwrap();
    let names: Vec<&str> = both.system.watched.iter().map(|watched| &watched.name[..]).collect();
    assert_eq!(names, ["constraint 1 on positions", "constraint 2 on positions"]);
    assert_eq!(Scene::parse("again", &both.to_toml()).unwrap().start.q, both.start.q);
}
