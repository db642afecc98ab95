//! Other writings of a scene file: the motions are the same, or are those on one leaf or branch.

use motion::band::INSTANTS;
use motion::{CHETAEV, Choice, Settings, choices_among, solve_choice};
use scene::Scene;
use toml::{Table, Value};

/// A writing.
#[derive(Clone, Copy, Debug)]
pub struct Writing {
    /// Its name.
    pub name: &'static str,
    /// How many integrable constraints it adds.
    pub adds: usize,
    /// Whether gaps are the same: up to the end, and in the same metric.
    pub keeps_gaps: bool,
    /// `None` where the scene cannot be written so.
    pub of: fn(&Table) -> Option<Table>,
}

const fn writing(name: &'static str, adds: usize, keeps_gaps: bool, of: fn(&Table) -> Option<Table>) -> Writing {
    Writing { name, adds, keeps_gaps, of }
}

/// Coordinates that start this far from zero, and do not come to it, are written as roots.
const FROM_ZERO: f64 = 0.25;

/// All of them.
pub const WRITINGS: [Writing; 8] = [
    writing("signs", 0, true, signs),
    writing("roots", 0, false, roots),
    writing("slave", 1, true, slave),
    writing("unit vectors", 1, false, unit_vectors),
    writing("quaternions", 1, false, quaternions),
    writing("invariants", 0, true, invariants),
    writing("formulas", 0, true, formulas),
    writing("time", 0, true, time),
];

/// Without what no sentence is about.
pub fn plain(scene: &Table) -> Table {
    let mut scene = scene.clone();
    ["view", "observables", "removal", "bodies"].into_iter().for_each(|key| _ = scene.remove(key));
    let system = scene.get_mut("system").and_then(Value::as_table_mut);
    system.into_iter().for_each(|system| _ = system.remove("virtual"));
    scene
}

/// As a file, a line for each section.
pub fn written(scene: &Table) -> String {
    fn inline(value: &Value) -> String {
        let joined = |parts: Vec<String>| parts.join(", ");
        match value {
            Value::String(text) => format!("{text:?}"),
            Value::Integer(x) => x.to_string(),
            Value::Float(x) => format!("{x:?}"),
            Value::Boolean(x) => x.to_string(),
            Value::Array(list) => format!("[{}]", joined(list.iter().map(inline).collect())),
            Value::Table(table) => {
                format!(
                    "{{ {} }}",
                    joined(table.iter().map(|(key, value)| format!("{key:?} = {}", inline(value))).collect())
                )
            }
            Value::Datetime(_) => String::new(),
        }
    }
    scene.iter().map(|(key, value)| format!("{key:?} = {}\n", inline(value))).collect()
}

impl Writing {
    /// Whether a sentence about this does not depend on the writing.
    pub fn keeps(&self, about: &str) -> bool {
        self.keeps_gaps || !["gap", "verdict"].contains(&about)
    }
}

/// Names with their primes in `text`, replaced; parts of vectors are none.
fn renamed(text: &str, name_of: &dyn Fn(&str, usize) -> Option<String>) -> String {
    let (mut out, mut rest, mut before) = (String::new(), text, ' ');
    while let Some(first) = rest.chars().next() {
        let length = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        if !(first.is_alphabetic() || first == '_') || before.is_alphanumeric() || before == '.' {
            // a number is read whole: 1e-3 has no name in it
            let length = if first.is_alphanumeric() { length } else { first.len_utf8() };
            out += &rest[..length];
            before = rest[..length].chars().last().unwrap_or(' ');
            rest = &rest[length..];
            continue;
        }
        let (name, behind) = rest.split_at(length);
        let primes = behind.len() - behind.trim_start_matches('\'').len();
        out += &name_of(name, primes).unwrap_or_else(|| format!("{name}{}", &behind[..primes]));
        (rest, before) = (&behind[primes..], ' ');
    }
    out
}

/// All formulas of the scene; those of starts have no rates on the left.
fn map(scene: &mut Table, of: &dyn Fn(&str) -> String) {
    fn walk(value: &mut Value, of: &dyn Fn(&str) -> String) {
        match value {
            Value::String(text) => *text = of(text),
            Value::Array(list) => list.iter_mut().for_each(|value| walk(value, of)),
            Value::Table(table) => table.iter_mut().for_each(|(_, value)| walk(value, of)),
            _ => {}
        }
    }
    for key in ["definitions", "system", "invariants"] {
        scene.get_mut(key).into_iter().for_each(|value| walk(value, of));
    }
    for key in ["velocities", "guess", "equations"] {
        let start = scene.get_mut("start").and_then(Value::as_table_mut);
        start.and_then(|start| start.get_mut(key)).into_iter().for_each(|value| walk(value, of));
    }
}

fn coordinates(scene: &Table) -> Vec<String> {
    scene["coordinates"].as_table().into_iter().flatten().map(|(name, _)| name.clone()).collect()
}

fn formula(value: &Value) -> String {
    match value {
        Value::String(text) => format!("({text})"),
        Value::Integer(x) => format!("({x})"),
        Value::Float(x) => format!("({x:?})"),
        _ => String::new(),
    }
}

fn start(scene: &Table, name: &str) -> Option<String> {
    scene["coordinates"].get(name)?.get("start").map(formula)
}

fn put(scene: &mut Table, path: [&str; 2], value: String) {
    let section = scene.entry(path[0]).or_insert_with(|| Table::new().into());
    section.as_table_mut().expect("a table").insert(path[1].into(), Value::String(value));
}

fn list<'a>(scene: &'a mut Table, key: &str) -> Option<&'a mut Vec<Value>> {
    scene.get_mut("system")?.get_mut(key)?.as_array_mut()
}

/// `−q` for every coordinate `q`, start included.
fn signs(scene: &Table) -> Option<Table> {
    let (names, mut scene) = (coordinates(scene), scene.clone());
    let own = names.clone();
    let minus = move |name: &str, primes: usize| {
        own.iter().any(|own| own == name).then(|| format!("(-{name}{})", "'".repeat(primes)))
    };
    map(&mut scene, &|text| renamed(text, &minus));
    for name in &names {
        let value = start(&scene, name)?;
        scene["coordinates"][name.as_str()].as_table_mut()?.insert("start".into(), format!("-{value}").into());
    }
    for key in ["velocities", "guess"] {
        let given = scene.get_mut("start").and_then(|start| start.get_mut(key)).and_then(Value::as_table_mut);
        given.into_iter().flatten().for_each(|(_, value)| *value = format!("-({})", formula(value)).into());
    }
    let forces = scene.get_mut("system")?.get_mut("forces").and_then(Value::as_table_mut);
    forces.into_iter().flatten().for_each(|(_, value)| *value = format!("-({})", formula(value)).into());
    Some(scene)
}

/// The motion of the scene by Chetaev.
fn chetaev(scene: &Table) -> Option<(Scene, Choice)> {
    let read = Scene::parse("own", &written(scene)).ok()?;
    let choice = choices_among(&read, |own| own == CHETAEV).into_iter().next()?;
    Some((read, choice))
}

/// `±√(q²)` in the constraints, for coordinates that are not near zero at the start, and do not come to it:
/// where one does, it is another constraint from there on.
fn roots(scene: &Table) -> Option<Table> {
    let mut scene = scene.clone();
    let (read, choice) = chetaev(&scene)?;
    let mut motion = solve_choice(&read, &choice, &Settings { max_steps: 20_000, ..Settings::default() }).ok()?;
    let own = &read.system.coordinates;
    let far = |i: &usize| read.start.q[*i].abs() > FROM_ZERO;
    let mut stays: Vec<usize> = (0..own.len()).filter(far).collect();
    for t in motion.grid(INSTANTS) {
        let now = motion.at(t).ok()?.coordinates;
        stays.retain(|&i| read.start.q[i] * now[i] > 0.0);
    }
    let root = |name: &str, primes: usize| {
        let i = *stays.iter().find(|&&i| primes == 0 && own[i].name == name)?;
        Some(format!("({}sqrt({name}^2))", if read.start.q[i] < 0.0 { "-" } else { "" }))
    };
    let text = scene["system"].get("constraints")?.clone();
    let written: Vec<Value> =
        text.as_array()?.iter().map(|f| renamed(f.as_str().unwrap_or(""), &root).into()).collect();
    let changed = text.as_array()? != &written;
    *list(&mut scene, "constraints")? = written;
    changed.then_some(scene)
}

/// A multiplier more, where the scene has values of them.
fn multiplier(scene: &mut Table, add: impl Fn(&mut Vec<Value>)) {
    let all = scene.get_mut("vakonomic").and_then(|own| own.get_mut("multipliers"));
    all.and_then(Value::as_array_mut).into_iter().for_each(add);
}

/// A coordinate without inertia that follows the others, `w = q₁ q₂ + q₁²`.
fn slave(scene: &Table) -> Option<Table> {
    let (names, mut scene) = (coordinates(scene), scene.clone());
    let [one, two] = [names.first()?, names.get(1)?];
    let follows = |one: &str, two: &str| format!("{one}*{two} + {one}^2");
    let at = follows(&start(&scene, one)?, &start(&scene, two)?);
    let slave = Table::from_iter([("start".to_owned(), Value::String(at))]);
    list(&mut scene, "constraints")?.push(format!("slave - ({})", follows(one, two)).into());
    scene["coordinates"].as_table_mut()?.insert("slave".into(), slave.into());
    multiplier(&mut scene, |all| all.push(Value::Integer(0)));
    Some(scene)
}

/// `(c, s)` for an angle of which there are only `cos`, `sin` and the rate.
fn unit_vectors(scene: &Table) -> Option<Table> {
    coordinates(scene).iter().find_map(|angle| unit_vector(scene, angle))
}

fn unit_vector(scene: &Table, angle: &str) -> Option<Table> {
    let mut other = scene.clone();
    let [c, s] = ["uc", "us"];
    let rate = |name: &str, primes: usize| (name == angle && primes == 1).then(|| format!("({c}*{s}' - {s}*{c}')"));
    map(&mut other, &|text| {
        let text = text.replace(&format!("cos({angle})"), c).replace(&format!("sin({angle})"), s);
        renamed(&text, &rate)
    });
    let left = std::cell::Cell::new(false);
    let look = |name: &str, _: usize| {
        left.set(left.get() || name == angle);
        None
    };
    map(&mut other.clone(), &|text| renamed(text, &look));
    let at = start(scene, angle)?;
    if other["system"].get("forces").is_some_and(|forces| forces.get(angle).is_some()) {
        return None;
    }
    let text = written(&other);
    if left.get() || !text.contains(&format!("{c}*{s}'")) || !written(scene).contains(&format!("({angle})")) {
        return None;
    }
    let velocities = other.get_mut("start")?.get_mut("velocities")?.as_table_mut()?;
    if let Some(given) = velocities.remove(&format!("{angle}'")).map(|value| formula(&value)) {
        velocities.insert(format!("{c}'"), format!("-sin({at})*{given}").into());
        velocities.insert(format!("{s}'"), format!("cos({at})*{given}").into());
    }
    let lagrangian = format!("{} + ({c}*{c}' + {s}*{s}')^2/2", other["system"]["lagrangian"].as_str()?);
    put(&mut other, ["system", "lagrangian"], lagrangian);
    list(&mut other, "constraints")?.insert(0, format!("{c}^2 + {s}^2 - 1").into());
    multiplier(&mut other, |all| all.insert(0, Value::Integer(0)));
    in_place_of(&mut other, &[angle], &[(c, format!("cos({at})")), (s, format!("sin({at})"))]);
    Some(other)
}

/// Other coordinates in the place of these, at the end.
fn in_place_of(scene: &mut Table, old: &[&str], new: &[(&str, String)]) {
    let table = scene["coordinates"].as_table_mut().expect("coordinates");
    old.iter().for_each(|name| _ = table.remove(*name));
    for (name, start) in new {
        table.insert((*name).into(), Table::from_iter([("start".to_owned(), Value::String(start.clone()))]).into());
    }
}

/// A unit quaternion for the Euler angles z-x-z of the built-in scenes, whose rates are those of a body.
fn quaternions(scene: &Table) -> Option<Table> {
    const ANGLES: [&str; 3] = ["psi", "theta", "phi"];
    /// Angular velocity in the body and in the room, and its square.
    const KNOWN: [(&str, &str); 9] = [
        ("theta'*cos(phi) + psi'*sin(theta)*sin(phi)", "qW.x"),
        ("psi'*sin(theta)*cos(phi) - theta'*sin(phi)", "qW.y"),
        ("theta'*cos(psi) + phi'*sin(theta)*sin(psi)", "qO.x"),
        ("theta'*sin(psi) - phi'*sin(theta)*cos(psi)", "qO.y"),
        ("(psi'^2 + theta'^2 + phi'^2 + 2*psi'*phi'*cos(theta))", "dot(qW, qW)"),
        ("psi'*cos(theta) + phi'", "qW.z"),
        ("(phi' + psi'*cos(theta))", "qW.z"),
        ("psi' + phi'*cos(theta)", "qO.z"),
        ("(theta'^2 + psi'^2*sin(theta)^2)", "(qW.x^2 + qW.y^2)"),
    ];
    let names = coordinates(scene);
    if !ANGLES.iter().all(|angle| names.iter().any(|own| own == angle)) {
        return None;
    }
    let mut other = scene.clone();
    map(&mut other, &|text| KNOWN.iter().fold(text.to_owned(), |text, (old, new)| text.replace(old, new)));
    let left = std::cell::Cell::new(false);
    let look = |name: &str, _: usize| {
        left.set(left.get() || ANGLES.contains(&name));
        None
    };
    let velocities = other.get_mut("start")?.get_mut("velocities")?.as_table_mut()?;
    let rates: Vec<Option<String>> =
        ANGLES.iter().map(|angle| velocities.remove(&format!("{angle}'")).map(|value| formula(&value))).collect();
    map(&mut other.clone(), &|text| renamed(text, &look));
    if left.get() {
        return None;
    }
    // all three rates, or as many as the constraints leave free, by the equations of the start
    let [psi, theta, phi] = ANGLES.map(|angle| start(scene, angle));
    let (psi, theta, phi) = (psi?, theta?, phi?);
    let half = |f: &str, sign: &str| format!("{f}(({phi} {sign} {psi})/2)");
    let [c, s] = ["cos", "sin"].map(|f| format!("{f}({theta}/2)"));
    let q = [
        ("qa", format!("{c}*{}", half("cos", "+"))),
        ("qb", format!("{s}*{}", half("cos", "-"))),
        ("qc", format!("-{s}*{}", half("sin", "-"))),
        ("qd", format!("{c}*{}", half("sin", "+"))),
    ];
    let w =
        "2*[qa*qb' - qb*qa' - qc*qd' + qd*qc', qa*qc' - qc*qa' - qd*qb' + qb*qd', qa*qd' - qd*qa' - qb*qc' + qc*qb']";
    let r = "[[1-2*(qc^2+qd^2), 2*(qb*qc-qa*qd), 2*(qb*qd+qa*qc)], [2*(qb*qc+qa*qd), 1-2*(qb^2+qd^2), 2*(qc*qd-qa*qb)], \
             [2*(qb*qd-qa*qc), 2*(qc*qd+qa*qb), 1-2*(qb^2+qc^2)]]";
    put(&mut other, ["definitions", "qW"], w.into());
    put(&mut other, ["definitions", "qR"], r.into());
    put(&mut other, ["definitions", "qO"], "qR*qW".into());
    let lagrangian = format!("{} + (qa*qa' + qb*qb' + qc*qc' + qd*qd')^2/2", other["system"]["lagrangian"].as_str()?);
    put(&mut other, ["system", "lagrangian"], lagrangian);
    list(&mut other, "constraints")?.insert(0, "qa^2 + qb^2 + qc^2 + qd^2 - 1".into());
    multiplier(&mut other, |all| all.insert(0, Value::Integer(0)));
    in_place_of(&mut other, &ANGLES, &q);
    let equations: Vec<Value> = [
        // psi', theta', phi' by the angular velocity in the body
        (&rates[0], format!("(qW.x*sin({phi}) + qW.y*cos({phi}))/sin({theta})")),
        (&rates[1], format!("qW.x*cos({phi}) - qW.y*sin({phi})")),
        (&rates[2], format!("qW.z - cos({theta})*(qW.x*sin({phi}) + qW.y*cos({phi}))/sin({theta})")),
    ]
    .into_iter()
    .filter_map(|(rate, expression)| Some(format!("{expression} - {}", rate.as_ref()?).into()))
    .collect();
    let start = other.get_mut("start")?.as_table_mut()?;
    start.insert("equations".into(), Value::Array(equations));
    Some(other)
}

/// Integrals of Chetaev's motion, which other formulations change.
fn invariants(scene: &Table) -> Option<Table> {
    let mut other = scene.clone();
    let (read, choice) = chetaev(scene)?;
    let found = integrals::watched(&read, &choice).ok()?;
    for (i, integral) in found.iter().enumerate() {
        put(&mut other, ["invariants", &format!("own {i}")], integral.name.clone());
    }
    (!found.is_empty()).then_some(other)
}

/// Numbers of parameters as formulas of the same value; without parameters, a factor 1 of `L` and of the
/// first velocity in the constraints.
fn formulas(scene: &Table) -> Option<Table> {
    const ONE: [&str; 4] = ["2*cos(pi/3)", "sqrt(2)*sqrt(8)/4", "3/3", "(sin(1)^2 + cos(1)^2)"];
    let (names, mut scene) = (coordinates(scene), scene.clone());
    let numbers = scene.get_mut("parameters").and_then(Value::as_table_mut).into_iter().flatten();
    let numbers = numbers.filter(|(_, value)| !value.is_str());
    let count =
        numbers.zip(ONE.iter().cycle()).map(|((_, x), one)| *x = format!("{}*{one}", formula(x)).into()).count();
    if count == 0 {
        let first = |name: &str, primes: usize| (name == names[0] && primes == 1).then(|| format!("(one*{name}')"));
        let written: Vec<Value> = scene["system"]
            .get("constraints")?
            .as_array()?
            .iter()
            .map(|f| renamed(f.as_str().unwrap_or(""), &first).into())
            .collect();
        *list(&mut scene, "constraints")? = written;
        let lagrangian = format!("one*({})", scene["system"]["lagrangian"].as_str()?);
        put(&mut scene, ["system", "lagrangian"], lagrangian);
        put(&mut scene, ["parameters", "one"], ONE[0].into());
    }
    Some(scene)
}

/// 100 s later.
fn time(scene: &Table) -> Option<Table> {
    let mut scene = scene.clone();
    if scene.get("run").and_then(|run| run.get("breakpoints")).is_some() {
        return None;
    }
    let later = |name: &str, primes: usize| (name == "t" && primes == 0).then(|| "(t - 100)".to_owned());
    map(&mut scene, &|text| renamed(text, &later));
    let start = scene.entry("start").or_insert_with(|| Table::new().into()).as_table_mut()?;
    if start.contains_key("time") {
        return None;
    }
    start.insert("time".into(), Value::Integer(100));
    Some(scene)
}
