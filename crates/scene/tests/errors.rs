//! Every fault of a scene file is reported with its kind, its place and what was expected.

use mechanics::RemovalError;
use scene::{NameFault, Scene, SceneError, SceneErrorKind as Kind, Unavailable};
use symbolic::ParseErrorKind;

pub const SLEDGE: &str = r#"title = "Ice sledge on an incline"
source = "Gao 2017, example 1"

[parameters]
g = 9.81
alpha = 0.4
k = 0.7

[coordinates]
x   = { unit = "m", start = 0 }
y   = { unit = "m", start = "2*x" }
phi = { unit = "rad", start = 0.3 }

[definitions]
weight = "g*sin(alpha)"

[system]
lagrangian  = "(x'^2 + y'^2)/2 + k^2*phi'^2/2 + weight*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
forces = { x = "-0.1*x'" }

[start]
time = 0
project = false

[start.velocities]
"phi'" = 1.1
"x'" = "0.5*cos(phi)"

[removal.arc-length]
parameters = ["u", "phi"]
rates = { x = "u'*cos(phi)", y = "u'*sin(phi)" }
start = { u = 0 }
constants = { horizon = 10 }

[vakonomic]
multipliers = [0.0]

[run]
duration = 10
"#;

/// The error of the sledge after a replacement.
pub fn error(old: &str, new: &str) -> SceneError {
    assert_eq!(SLEDGE.matches(old).count(), 1, "{old:?} must be there once");
    error_of(&SLEDGE.replace(old, new))
}

pub fn error_of(text: &str) -> SceneError {
    let error = Scene::parse("sledge", text).unwrap_err();
    let shown = error.to_string();
    if error.line > 0 {
        assert!(shown.starts_with(&format!("sledge:{}:{}: ", error.line, error.column)), "{shown}");
        assert!(shown.ends_with('^'), "{shown}");
    }
    error
}

/// What the carets point at.
pub fn pointed(error: &SceneError) -> String {
    error.source_line.chars().skip(error.column - 1).take(error.length).collect()
}

macro_rules! fault {
    ($old:expr, $new:expr, $kind:pat $(if $guard:expr)?, $at:expr) => {{
        let error = error($old, $new);
        assert!(matches!(&*error.kind, $kind $(if $guard)?), "{error}\n{:?}", error.kind);
        assert_eq!(pointed(&error), $at, "{error}");
    }};
}

#[test]
fn the_sledge_is_fine() {
    let scene = Scene::parse("sledge", SLEDGE).unwrap();
    assert_eq!((scene.name.as_str(), scene.duration), ("sledge", 10.0));
    assert_eq!(scene.completion.given, ["x'", "phi'"]);
}

#[test]
fn message_line_and_carets() {
    let shown = error("lagrangian ", "lagrangain ").to_string();
    let expected = "\
sledge:18:1: unknown key `lagrangain` in [system], did you mean `lagrangian`?; known here: lagrangian, constraints, forces, virtual
18 | lagrangain  = \"(x'^2 + y'^2)/2 + k^2*phi'^2/2 + weight*x\"
   | ^^^^^^^^^^";
    assert_eq!(shown, expected);
}

#[test]
fn misspelt_keys() {
    fault!("title", "tilte", Kind::UnknownKey { suggestion: Some(s), .. } if s == "title", "tilte");
    fault!("[run]", "[rum]", Kind::UnknownKey { suggestion: Some(s), .. } if s == "run", "rum");
    let error = error("duration", "length");
    assert!(matches!(&*error.kind, Kind::MissingKey { key: "duration", .. }), "{error}");
    assert!(matches!(&*error.also[0].kind, Kind::UnknownKey { suggestion: None, .. }), "{error}");
    fault!("x   = { unit", "x   = { units", Kind::UnknownKey { suggestion: Some(s), .. } if s == "unit", "units");
    fault!("project", "projekt", Kind::UnknownKey { suggestion: Some(s), .. } if s == "project", "projekt");
    fault!("rates = ", "rate = ", Kind::UnknownKey { suggestion: Some(s), .. } if s == "rates", "rate");
    fault!("horizon", "horizont", Kind::UnknownKey { suggestion: Some(s), .. } if s == "horizon", "horizont");
    fault!("multipliers", "multiplier", Kind::UnknownKey { suggestion: Some(_), .. }, "multiplier");
    fault!("forces = { x", "forces = { z", Kind::UnknownName { .. }, "z");
    fault!("\"phi'\" = 1.1", "\"phj'\" = 1.1", Kind::UnknownName { suggestion: Some(s), .. } if s == "phi'", "\"phj'\"");
    fault!("rates = { x", "rates = { z", Kind::UnknownName { .. }, "z");
    fault!("start = { u = 0 }", "start = { w = 0 }", Kind::UnknownName { .. }, "w");
    fault!("{ horizon = 10 }", "{ start = { u = 1 } }", Kind::UnknownName { .. }, "u");
}

#[test]
fn formulas() {
    fault!("+ weight*x", "+ wieght*x",
        Kind::Expression(ParseErrorKind::Undefined { suggestion: Some(s), .. }) if s == "weight", "wieght");
    fault!("cos(phi) - x'", "cos(psi) - x'", Kind::Expression(ParseErrorKind::Undefined { .. }), "psi");
    fault!("\"-0.1*x'\"", "\"-c*x'\"", Kind::Expression(ParseErrorKind::Undefined { .. }), "c");
    fault!("\"2*x\"", "\"2*z\"", Kind::Expression(ParseErrorKind::Undefined { .. }), "z");
    fault!("0.5*cos(phi)", "0.5*cas(phi)", Kind::Expression(ParseErrorKind::UnknownFunction { .. }), "cas");
    fault!("u'*cos(phi)", "u'*cos(phi", Kind::Expression(ParseErrorKind::UnclosedParenthesis), "(");
    fault!("g*sin(alpha)", "h*sin(alpha)", Kind::Expression(ParseErrorKind::Undefined { .. }), "h");
    fault!("u = 0", "u = \"y'*q\"", Kind::Expression(ParseErrorKind::Undefined { .. }), "q");
    fault!("+ weight*x", "+ x''", Kind::Unavailable { reason: Unavailable::Acceleration, .. }, "x''");
    fault!("+ weight*x", "+ g'", Kind::Unavailable { reason: Unavailable::NoDerivative("a parameter"), .. }, "g'");
    fault!("\"2*x\"", "\"2*phi\"", Kind::Unavailable { reason: Unavailable::NotYetKnown { .. }, .. }, "phi");
    fault!("0.5*cos(phi)", "0.5*phi'", Kind::Unavailable { reason: Unavailable::NotYetKnown { .. }, .. }, "phi'");
    fault!("+ weight*x", "+ (x*y')'", Kind::Expression(ParseErrorKind::NoRate), "'");
    fault!("+ weight*x", "+ weight''*x", Kind::Unavailable { reason: Unavailable::Acceleration, .. }, "weight''");
    fault!("+ weight*x", "+ [x, y]", Kind::Expression(ParseErrorKind::Shapes { .. }), "+");
    // in a string of several lines the place is exact, behind escapes it is the start of the value
    fault!("\"g*sin(alpha)\"", "\"\"\"\ng*\n  sin(alhpa)\"\"\"", Kind::Expression(_), "alhpa");
    fault!("\"g*sin(alpha)\"", "\"g\\u002Asin(alhpa)\"", Kind::Expression(_), "\"g\\u002Asin(alhpa)\"");
}

#[test]
fn names() {
    fn fault_is(error: &SceneError, expected: &NameFault) {
        assert!(matches!(&*error.kind, Kind::InvalidName { fault, .. } if fault == expected), "{error}");
    }
    let taken = |by: &str| NameFault::Taken { by: by.into() };
    fault_is(&error("weight = \"g", "x = \"g"), &taken("a coordinate"));
    fault_is(&error("weight = \"g", "k = \"g"), &taken("a parameter"));
    fault_is(&error("phi = {", "g = {"), &taken("a parameter"));
    fault_is(&error("[\"u\", \"phi\"]", "[\"k\", \"phi\"]"), &taken("a parameter"));
    fault_is(&error("[\"u\", \"phi\"]", "[\"u\", \"u\"]"), &taken("a parameter of the removal"));
    fault_is(&error("[\"u\", \"phi\"]", "[\"phi\", \"phi\"]"), &taken("a parameter of the removal"));
    fault_is(&error("start = { u = 0 }", "memory = { u = \"u'\" }"), &taken("a parameter of the removal"));
    fault_is(&error("k = 0.7", "t = 0.7"), &NameFault::Reserved("time"));
    fault_is(&error("k = 0.7", "pi = 3"), &NameFault::Reserved("a constant"));
    for function in ["sin", "sqrt", "atan2", "log", "pow", "abs", "min"] {
        fault_is(&error("k = 0.7", &format!("{function} = 3")), &NameFault::Reserved("a function"));
    }
    fault_is(&error("k = 0.7", "\"k'\" = 3"), &NameFault::Primed);
    for name in ["=1+1", "@x", "-x", "+x", "two\\nlines", "bell\\u0007"] {
        let observables = format!("[observables]\n\"{name}\" = \"x\"\n\n[start.velocities]");
        fault_is(&error("[start.velocities]", &observables), &NameFault::Formula);
    }
    fault_is(&error("phi = {", "\"phi'\" = {"), &NameFault::Primed);
    for bad in ["", "1", "k k", " y", "y ", "α", "a-b", "a+b", "(y)", "-y"] {
        fault_is(&error("k = 0.7", &format!("\"{bad}\" = 3")), &NameFault::NotIdentifier);
    }
    for good in ["theta_1", "I", "E", "e", "x1"] {
        Scene::parse("sledge", &SLEDGE.replace("g = 9.81", &format!("g = 9.81\n{good} = 3"))).unwrap();
    }
    fault!("k = 0.7", "g = 0.7", Kind::Syntax { .. }, "g");
}

#[test]
fn missing_things() {
    fault!("title = \"Ice sledge on an incline\"\n", "", Kind::MissingKey { key: "title", .. }, "s");
    fault!("duration = 10", "", Kind::MissingKey { key: "duration", .. }, "run");
    fault!("[run]\nduration = 10", "", Kind::MissingKey { key: "run", .. }, "t");
    fault!("unit = \"m\", start = 0 ", "unit = \"m\"", Kind::MissingKey { key: "start", .. }, "x");
    fault!(
        "lagrangian  = \"(x'^2 + y'^2)/2 + k^2*phi'^2/2 + weight*x\"",
        "",
        Kind::MissingKey { key: "lagrangian", .. },
        "system"
    );
    fault!("parameters = [\"u\", \"phi\"]", "", Kind::MissingKey { key: "parameters", .. }, "arc-length");
    fault!("{ horizon = 10 }", "{}", Kind::EmptySection { .. }, "{}");
    let text = "title = \"a\"\n[coordinates]\n[system]\nlagrangian = \"0\"\n[run]\nduration = 1\n";
    assert!(matches!(*error_of(text).kind, Kind::EmptySection { .. }));
    let error = error_of(&text.replace("[coordinates]\n", ""));
    assert!(matches!(*error.kind, Kind::MissingKey { key: "coordinates", .. }));
    for empty in ["", "  \n", "# only a remark\n"] {
        assert!(matches!(*error_of(empty).kind, Kind::Empty));
    }
}

#[test]
fn wrong_types() {
    fault!("g = 9.81", "g = true", Kind::WrongType { found: "true or false", .. }, "true");
    fault!("project = false", "project = 0", Kind::WrongType { .. }, "0");
    fault!("[\"y'*cos(phi) - x'*sin(phi)\"]", "\"y'\"", Kind::WrongType { .. }, "\"y'\"");
    fault!("[\"y'*cos(phi) - x'*sin(phi)\"]", "[1]", Kind::WrongType { .. }, "1");
    fault!("x   = { unit = \"m\", start = 0 }", "x   = 0", Kind::WrongType { expected: "a table", .. }, "0");
    fault!("duration = 10", "duration = []", Kind::WrongType { .. }, "[]");
    fault!("duration = 10", "duration = \"long\"", Kind::Expression(ParseErrorKind::Undefined { .. }), "long");
    fault!("duration = 10", "duration = \"x\"", Kind::Unavailable { .. }, "x");
    fault!("duration = 10", "duration = 10\nbreakpoints = 5", Kind::WrongType { .. }, "5");
    fault!("\"phi'\" = 1.1", "\"phi'\" = true", Kind::WrongType { .. }, "true");
    fault!("[0.0]", "[true]", Kind::WrongType { .. }, "true");
    fault!("[0.0]", "[0, 0]", Kind::WrongLength { found: 2, expected: 1, .. }, "[0, 0]");
    fault!("{ horizon = 10 }", "\"nil\"", Kind::WrongWord { .. }, "\"nil\"");
    fault!("{ horizon = 10 }", "{ horizon = 10, start = {} }", Kind::WrongWord { .. }, "start");
    fault!("{ horizon = 10 }", "10", Kind::WrongType { .. }, "10");
    fault!(
        "title = \"Ice sledge on an incline\"",
        "title = 2020-01-01",
        Kind::WrongType { found: "a date or time", .. },
        "2020-01-01"
    );
    fault!("[\"u\", \"phi\"]", "[\"u\", 1]", Kind::WrongType { .. }, "1");
}

#[test]
fn numbers_out_of_range() {
    fault!("g = 9.81", "g = nan", Kind::NotFinite { .. }, "nan");
    fault!("g = 9.81", "g = -inf", Kind::NotFinite { .. }, "-inf");
    fault!("g = 9.81", "g = 1e999", Kind::NotFinite { .. }, "1e999");
    fault!("\"2*x\"", "\"1/x\"", Kind::NotFinite { .. }, "\"1/x\"");
    fault!("0.5*cos(phi)", "log(x)", Kind::NotFinite { .. }, "\"log(x)\"");
    fault!("duration = 10", "duration = 0", Kind::OutOfRange { limit: 0.0, .. }, "0");
    fault!("duration = 10", "duration = -1", Kind::OutOfRange { value: -1.0, .. }, "-1");
    fault!("duration = 10", "duration = inf", Kind::NotFinite { .. }, "inf");
    fault!("duration = 10", "duration = 10\nbreakpoints = [5, nan]", Kind::NotFinite { .. }, "nan");
    fault!("horizon = 10", "horizon = 0", Kind::OutOfRange { limit: 0.0, .. }, "0");
    fault!("time = 0", "time = 10", Kind::OutOfRange { limit: 10.0, .. }, "10");
    let large = Scene::parse("a", &SLEDGE.replace("g = 9.81", "g = 0xffffffffffffffffffff")).unwrap();
    assert_eq!(large.system.parameters[0].value, 2.0_f64.powi(80) - 1.0);
}

#[test]
fn wrong_constraints() {
    fault!(
        "[\"y'*cos(phi) - x'*sin(phi)\"]",
        "[\"y'\", \"x'\", \"phi'\"]",
        Kind::TooManyConstraints { found: 3, dimension: 3 },
        "constraints"
    );
    fault!("[\"y'*cos(phi) - x'*sin(phi)\"]", "[\"g\"]", Kind::NoVelocity { number: 1 }, "\"g\"");
    fault!(
        "[\"y'*cos(phi) - x'*sin(phi)\"]",
        "[\"x^2 + y - 1\"]",
        Kind::OffPosition { number: 1, residual: 1.0, .. },
        "\"x^2 + y - 1\""
    );
}

#[test]
fn wrong_conditions_on_virtual_displacements() {
    let constraints = "constraints = [\"y'*cos(phi) - x'*sin(phi)\"]";
    let with = |conditions: &str| format!("{constraints}\nvirtual = {conditions}");
    fault!(constraints, &with("[\"x'\", \"y'\"]"), Kind::VirtualConditions { found: 2, expected: 1 }, "virtual");
    fault!(constraints, &with("[]"), Kind::VirtualConditions { found: 0, expected: 1 }, "virtual");
    fault!(constraints, &with("[\"x\"]"), Kind::NoRate { number: 1 }, "\"x\"");
    fault!(constraints, &with("[\"z'\"]"), Kind::Expression(_), "z'");
}

#[test]
fn wrong_removals() {
    fault!("u'*sin(phi)", "u'*cos(phi)", Kind::Removal(RemovalError::ConstraintRemains { .. }), "arc-length");
    fault!("rates = { x = \"u'*cos(phi)\", y = \"u'*sin(phi)\" }", "rates = { x = \"u'*cos(phi)\" }",
        Kind::CoordinateRole { roles, .. } if roles.is_empty(), "arc-length");
    fault!("rates = { x", "rates = { phi = \"u'\", x",
        Kind::CoordinateRole { roles, .. } if roles.len() == 2, "phi");
    fault!("start = { u = 0 }", "direct = { y = \"u\" }", Kind::CoordinateRole { .. }, "y");
    fault!(
        "[\"u\", \"phi\"]",
        "[\"u\", \"s\", \"phi\"]",
        Kind::Removal(RemovalError::WrongCount { found: 3, expected: 2, .. }),
        "[\"u\", \"s\", \"phi\"]"
    );
    fault!("u'*cos(phi)", "y'*cos(phi)", Kind::Unavailable { reason: Unavailable::RemovedVelocity, .. }, "y'");
    fault!("u'*cos(phi)", "y''*cos(phi)", Kind::Unavailable { .. }, "y''");
    let direct = "rates = { x = \"u'*cos(phi)\" }\ndirect = { y = \"u''\" }";
    fault!(
        "rates = { x = \"u'*cos(phi)\", y = \"u'*sin(phi)\" }",
        direct,
        Kind::Unavailable { reason: Unavailable::SecondRate, .. },
        "u''"
    );
    let direct = "rates = { x = \"u'*cos(y)\" }\ndirect = { y = \"u\" }";
    fault!(
        "rates = { x = \"u'*cos(phi)\", y = \"u'*sin(phi)\" }",
        direct,
        Kind::Unavailable { reason: Unavailable::DirectCoordinate, .. },
        "y"
    );
}

#[test]
fn the_unnamed_removal_is_called_given() {
    let scene = Scene::parse("a", &SLEDGE.replace("[removal.arc-length]", "[removal]")).unwrap();
    assert_eq!(scene.removals[0].name, "given");
}

#[test]
fn overrides() {
    let set = |list: &[(&str, f64)]| {
        let list: Vec<(String, f64)> = list.iter().map(|(n, x)| (n.to_string(), *x)).collect();
        Scene::parse_with("sledge", SLEDGE, &list)
    };
    let scene =
        set(&[("g", 1.0), ("x", 2.0), ("phi'", -1.0), ("duration", 3.0), ("mu0_1", 4.0), ("time", 1.0)]).unwrap();
    assert_eq!(scene.system.parameters[0].value, 1.0);
    assert_eq!((scene.start.t, &scene.start.q[..2], scene.start.v[2]), (1.0, &[2.0, 4.0][..], -1.0));
    assert_eq!((scene.duration, &scene.multipliers[..]), (3.0, &[4.0][..]));
    let error = set(&[("gg", 1.0)]).unwrap_err();
    assert!(matches!(&*error.kind, Kind::UnknownName { suggestion: Some(s), .. } if s == "g"), "{error}");
    assert_eq!((error.line, error.to_string().contains('\n')), (0, false));
    assert!(matches!(*set(&[("g", f64::NAN)]).unwrap_err().kind, Kind::NotFinite { .. }));
    assert!(matches!(*set(&[("duration", -1.0)]).unwrap_err().kind, Kind::OutOfRange { value: -1.0, .. }));
}

#[test]
fn files() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let scene = Scene::load(&write("my-sledge.toml", SLEDGE.as_bytes())).unwrap();
    assert_eq!(scene.name, "my-sledge");
    let error = |path: &std::path::Path| Scene::load(path).unwrap_err();
    let size = scene::SIZE_LIMIT + 1;
    let large = error(&write("large.toml", &vec![b'#'; size as usize]));
    assert!(matches!(*large.kind, Kind::TooLarge { size: s, limit } if s == size && limit == size - 1), "{large}");
    assert!(matches!(*error_of(&"#".repeat(size as usize)).kind, Kind::TooLarge { .. }));
    let text = SLEDGE.replace("[parameters]", "# \u{1}[parameters]");
    let mut bytes = text.into_bytes();
    let place = bytes.iter().position(|&b| b == 1).unwrap();
    bytes[place] = 0xff;
    let invalid = error(&write("bytes.toml", &bytes));
    assert!(matches!(*invalid.kind, Kind::NotUtf8 { byte: 0xff, offset } if offset == place), "{invalid}");
    assert_eq!((invalid.line, invalid.column), (4, 3));
    for path in [folder.path().join("missing.toml"), folder.path().to_path_buf()] {
        assert!(matches!(*error(&path).kind, Kind::Unreadable { .. }));
    }
    assert!(error(&folder.path().join("missing.toml")).to_string().contains("not found"));
}

#[test]
fn every_fault_of_a_formula_is_told() {
    let text = "title = \"t\"\n[coordinates]\ntheta = { start = 1 }\nx = { start = 0 }\n[system]\n\
                lagrangian = \"theta_dot^2/2 + xdot^2/2 - gg*cos(thea) + abs(x) + foo(x)*sin(1, 2) + dx\"\n\
                [start.velocities]\n\"x'\" = 0\n[run]\nduration = 1\n";
    let error = scene::Scene::parse("t", text).unwrap_err();
    let told: Vec<String> = error.each().map(|fault| fault.kind.to_string()).collect();
    let expected = [
        "`theta_dot` cannot be used here: a time derivative is theta'",
        "`xdot` cannot be used here: a time derivative is x'",
        "undefined name `gg`",
        "undefined name `thea`; did you mean `theta`?",
        "`abs` is not differentiable",
        "unknown function `foo`",
        "`sin` takes 1 argument, found 2",
        "`dx` cannot be used here: a time derivative is x'",
    ];
    assert_eq!(told.len(), expected.len(), "{told:#?}");
    assert!(told.iter().zip(expected).all(|(told, words)| told.starts_with(words)), "{told:#?}");
}

#[test]
fn velocities_that_are_missing_come_with_the_line_to_write() {
    let text =
        "title = \"t\"\n[coordinates]\nx = { start = 0 }\n[system]\nlagrangian = \"x'^2/2\"\n[run]\nduration = 1\n";
    let told = scene::Scene::parse("t", text).unwrap_err().to_string();
    assert!(told.contains("give more under [start.velocities], as in `\"x'\" = 0`"), "{told}");
}
