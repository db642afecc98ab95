//! Scenes drawn from the whole language, under every command: no panic, no code but those of the guide.
//!
//! `DELTAQ_SCENES=20000` draws more of them; `DELTAQ_FIRST=N` begins with scene N; `DELTAQ_PATIENCE=5` stops
//! commands after 5 s.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::support::{command, text};

/// Scenes of the check.
const SCENES: u64 = 20;
/// A command is stopped after this many seconds, which is not a fault of it.
const PATIENCE: u64 = 20;
/// Codes that the guide names, but for those that are faults of the program: 4 and 5.
const CODES: [i32; 4] = [0, 1, 2, 3];

/// Draws: every number follows from the one of the scene.
struct Draw(u64);

impl Draw {
    /// SplitMix64.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    fn one<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.below(of.len())]
    }

    fn once_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn number(&mut self) -> &'static str {
        self.one(&["0", "1", "2", "10", "3", "0.5", "1e-3", "(1/3)", "pi", "0.1", "7", "(-2)", "4"])
    }

    /// An expression in these names, as deep as that.
    fn expression(&mut self, names: &[&str], depth: usize) -> String {
        if depth == 0 || self.once_in(6) {
            let leaf = if names.is_empty() || self.once_in(3) { self.number() } else { self.one(names) };
            return leaf.into();
        }
        let mut e = |depth: usize| self.expression(names, depth - 1);
        let (a, b) = (e(depth), e(depth));
        // as a rule with a value
        let positive = if self.once_in(5) { a.clone() } else { format!("1 + ({a})^2") };
        match self.below(14) {
            0 => format!("({a} + {b})"),
            1 => format!("({a} - {b})"),
            2 | 3 => format!("{a}*{b}"),
            4 => format!("{a}/(2 + {b})"),
            5 => {
                format!("({positive})^{}", self.one(&["2", "3", "(-1)", "(1/2)", "(1/3)", "24", "(-5/2)", "2.5", "41"]))
            }
            6 => format!("{}^({b})", self.one(&["2", "10", "(1/2)", "pi", "0.3"])),
            7 => format!("({positive})^({b})"),
            8 => format!("atan2({a}, {b})"),
            9 => format!("pow({positive}, {b})"),
            10 => format!("step({a}, 0.1, 0.4, {})", self.one(&["0.1", "1e-3", "1e-9"])),
            11 => format!("-{a}"),
            12 => format!("exp(-({a})^2)"),
            _ => match self.function() {
                bounded @ ("asin" | "acos" | "atanh") => format!("{bounded}(tanh({a})/2)"),
                root @ ("log" | "ln" | "sqrt" | "acosh") => format!("{root}({positive})"),
                other => format!("{other}({a})"),
            },
        }
    }

    fn function(&mut self) -> &'static str {
        self.one(&[
            "sin", "cos", "tan", "sec", "csc", "cot", "sinh", "cosh", "tanh", "asin", "acos", "atan", "asinh", "acosh",
            "atanh", "exp", "log", "ln", "sqrt",
        ])
    }
}

/// A scene: its text and the names of its coordinates.
struct Drawn {
    text: String,
    names: Vec<&'static str>,
}

fn drawn(number: u64) -> Drawn {
    let draw = &mut Draw(number);
    let names: Vec<&str> = ["x", "y", "z", "phi"][..2 + draw.below(3)].to_vec();
    let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
    let rates: Vec<&str> = rates.iter().map(|rate| &rate[..]).collect();
    let places = [&names[..], &["a", "b", "c"]].concat();
    let clock = [&places[..], &["t"]].concat();
    let all = [&clock[..], &rates].concat();
    let mut text = format!("title = \"drawn {number}\"\n[parameters]\n");
    for name in ["a", "b"] {
        let _ = writeln!(text, "{name} = \"{}\"", draw.number());
    }
    let _ = writeln!(text, "c = \"{}\"\n[coordinates]", draw.expression(&["a", "b"], 1));
    let mut starts = Vec::new();
    for name in &names {
        let start = if draw.once_in(8) { draw.number() } else { draw.one(&["0.4", "0.3", "1.1", "0.7"]) };
        let _ = writeln!(text, "{name} = {{ unit = \"m\", start = \"{start}\" }}");
        starts.push(format!("({name} - ({start}))"));
    }
    let _ = writeln!(text, "[definitions]\ne = \"{}\"", draw.expression(&places, 2));
    let turned = draw.once_in(3);
    if turned {
        let axes = draw.one(&["zxz", "zyx", "xy", "z"]);
        let angles: Vec<String> = axes.chars().map(|_| draw.expression(&names, 1)).collect();
        let _ = writeln!(text, "R = \"rotation({axes}, {})\"\nW = \"angular_velocity(R)\"", angles.join(", "));
    }
    let squares: Vec<String> = rates.iter().map(|rate| format!("{rate}^2/2")).collect();
    let _ = write!(text, "[system]\nlagrangian = \"{} - ({})", squares.join(" + "), draw.expression(&clock, 3));
    for further in 0..draw.below(3) {
        let _ = match further {
            0 => write!(text, " + e*{}*{}", draw.one(&rates), draw.one(&rates)),
            _ => write!(text, " + {}", draw.expression(&all, 2)),
        };
    }
    text += if turned { " + dot(W, W)/5\"\n" } else { "\"\n" };
    let constraints = draw.below(names.len());
    let rows: Vec<String> = (0..constraints)
        .map(|i| constraint(draw, [&starts[i], &starts[i + 1]], [rates[i], rates[i + 1]], [&places, &clock, &all]))
        .collect();
    let _ = writeln!(text, "constraints = [{}]", rows.join(", "));
    if constraints > 0 && draw.once_in(5) {
        let virtuals: Vec<String> = (0..constraints).map(|i| format!("\"{}\"", rates[rates.len() - 1 - i])).collect();
        let _ = writeln!(text, "virtual = [{}]", virtuals.join(", "));
    }
    for name in names.iter().filter(|_| draw.once_in(3)).copied().collect::<Vec<_>>() {
        let _ = writeln!(text, "forces.{name} = \"{}\"", draw.expression(&all, 3));
    }
    let _ = writeln!(text, "[observables]\nseen = \"{}\"", draw.expression(&all, 2));
    if draw.once_in(2) {
        let _ = writeln!(text, "[film.mark]\nis = \"{}\"\nsigma = 0.05", draw.expression(&names, 2));
    }
    if draw.once_in(3) {
        let _ = writeln!(text, "[invariants]\nheld = \"{}\"", draw.expression(&all, 2));
    }
    text += "[start]\nproject = true\n[start.velocities]\n";
    for rate in &rates[constraints..] {
        let _ = writeln!(text, "\"{rate}\" = {}", draw.one(&["0.2", "1", "0.5", "0.3", "0"]));
    }
    let _ = writeln!(text, "[run]\nduration = {}", draw.one(&["1", "0.5", "2"]));
    if draw.once_in(2) {
        let (shape, size) =
            draw.one(&[&("ball", "[a]"), &("blade", "[a, 0.1]"), &("box", "[1, b, c]"), &("disc", "[1]")]);
        let at = [(); 3].map(|()| draw.expression(&[&names[..], &["a", "t"]].concat(), 1));
        let size = size.replace('a', "\"a\"").replace('b', "\"b\"").replace('c', "\"c\"");
        let _ = writeln!(text, "[view.body]\nshape = \"{shape}\"\nsize = {size}\nat = \"[{}]\"", at.join(", "));
    }
    Drawn { text, names }
}

/// Linear in the velocities, affine, or not linear; of places alone now and then.
fn constraint(draw: &mut Draw, ways: [&str; 2], [own, other]: [&str; 2], [places, clock, all]: [&[&str]; 3]) -> String {
    let row = match draw.below(8) {
        0 => format!("{own} - {}", draw.expression(clock, 2)),
        1 => format!("{own} - ({})*{other} - {}", draw.expression(places, 1), draw.expression(clock, 1)),
        2 => format!("{own} - sqrt(1 + {other}^2*({})^2)", draw.expression(places, 1)),
        3 => format!("{own} - ({})", draw.expression(all, 1)),
        4 => format!("{} + {}*{}", ways[0], ways[1], draw.expression(clock, 1)),
        _ => format!("{own} - ({})*{other}", draw.expression(places, 2)),
    };
    format!("\"{row}\"")
}

/// Calls of every command on a scene in a folder.
fn calls(draw: &mut Draw, scene: &str, folder: &Path, names: &[&str]) -> Vec<Vec<String>> {
    let out = |name: &str| folder.join(name).display().to_string();
    let (first, last) = (names[0], names[names.len() - 1]);
    let method = draw.one(&["auto", "taylor", "dop853", "radau5"]);
    let formulation = draw.one(&[
        "chetaev",
        "vakonomic",
        "removed-constraint",
        "kappa",
        "first-order",
        "prescribed",
        "chetaev-reduced",
        "vakonomic-reduced",
        "vakonomic-costate",
    ]);
    let film = out("film.csv");
    let ends = names.iter().map(|name| format!("{name}=0.5")).collect::<Vec<_>>().join(",");
    let always = [
        format!("check {scene}"),
        format!("show {scene} --latex"),
        format!("show {scene} -f {formulation} --format json"),
        format!("solve {scene} -f chetaev --times 0:0.2:3"),
        format!("solve {scene} -f {formulation} --method {method} --max-steps 3000 --format json"),
        format!("compare {scene} --without fits"),
    ];
    let seldom = [
        format!("compare {scene} --with fits --out {}", out("page")),
        format!("compare {scene} --sweep a=0.1:1:3"),
        format!("prove {scene} --out {}", out("proof.json")),
        format!("integrals {scene}"),
        format!("integrals {scene} -f vakonomic --degree 1"),
        format!("linearize {scene} --free {last}"),
        format!("linearize {scene} --find"),
        format!("review {scene} {}", out("equations.txt")),
        format!("ensemble {scene} -f {formulation} --vary {first}=0..1:5 --max-steps 3000"),
        format!("fit {scene} {film} --free a --sigma 0.01 --starts 1 --max-steps 300"),
        format!("fit {scene} {film} --free {first}',b --sigma 0.01,0.02 --starts 1 --robust --max-steps 300"),
        format!("judge {scene} {film}"),
        format!("connect {scene} --to {ends} --at 0.3 --starts 2 --max-steps 300"),
        format!(
            "design {scene} --tell chetaev,vakonomic --free a --film 20Hz,1mm,0.2s --starts 1 --points 2 --max-steps 300"
        ),
        format!("explore {scene} --out {}", out("page.html")),
        format!("show {scene} --code c"),
        format!("solve {scene} -f chetaev --method leapfrog --step 0.01"),
    ];
    let mut words: Vec<String> = always.to_vec();
    let every = std::env::var_os("DELTAQ_SCENES").is_some();
    words.extend(if every { seldom.to_vec() } else { vec![seldom[draw.below(seldom.len())].clone()] });
    words.iter().map(|call| call.split(' ').map(String::from).collect()).collect()
}

/// A film of the scene: of a motion where there is one, with noise or without; else of bodies at rest.
fn film(draw: &mut Draw, scene: &str, names: &[&str]) -> String {
    let law = draw.one(&["chetaev", "vakonomic"]);
    let motion = command(&["solve", scene, "-f", law, "--times", "0:0.3:21", "--max-steps", "3000", "--quiet"])
        .output()
        .expect("it runs");
    let rows = text(&motion.stdout);
    let mut film = format!("t,{}\n", names.join(","));
    if motion.status.success() && rows.lines().nth(1).is_some_and(|row| row.split(',').count() > names.len()) {
        let noise = if draw.once_in(3) { 0.0 } else { 0.01 };
        for row in rows.lines().skip(1) {
            let cells: Vec<f64> = row.split(',').take(names.len() + 1).filter_map(|cell| cell.parse().ok()).collect();
            let shaken = cells.iter().enumerate().map(|(i, cell)| {
                let off = noise * (draw.below(2001) as f64 / 1000.0 - 1.0);
                if i == 0 { cell.to_string() } else { (cell + off).to_string() }
            });
            film += &(shaken.collect::<Vec<_>>().join(",") + "\n");
        }
    } else {
        for i in 0..5 {
            film += &format!("0.{i},{}\n", vec!["0.1"; names.len()].join(","));
        }
    }
    film
}

/// Equations that somebody might have written, right only by chance.
fn equations(draw: &mut Draw, names: &[&str]) -> String {
    let rates: Vec<String> = names.iter().map(|name| format!("{name}'")).collect();
    let all: Vec<&str> = names.iter().copied().chain(rates.iter().map(|rate| &rate[..])).chain(["a", "t"]).collect();
    names.iter().map(|name| format!("{name}'' = {}\n", draw.expression(&all, 2))).collect()
}

/// The code with which a call ended; or what is wrong with how it did.
fn ended(scene: u64, call: &[String]) -> Result<Option<i32>, String> {
    let (clock, patience) = (Instant::now(), number("DELTAQ_PATIENCE").unwrap_or(PATIENCE));
    let words: Vec<&str> = call.iter().map(|word| &word[..]).collect();
    let mut child = command(&words)
        .args(["--quiet"])
        .stdin(std::process::Stdio::null())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it runs");
    while child.try_wait().expect("it ends").is_none() {
        if clock.elapsed() > Duration::from_secs(patience) {
            child.kill().expect("it can be stopped");
            let _ = child.wait();
            println!("stopped after {patience} s: scene {scene}, {}", call.join(" "));
            return Ok(None);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().expect("it has ended");
    let said = text(&output.stderr);
    let known = output.status.code().is_some_and(|code| CODES.contains(&code));
    let silent = output.status.code() == Some(2) && said.is_empty();
    if !known || silent || said.contains("panicked") {
        return Err(format!("{}: {}", output.status, said.trim()));
    }
    if std::env::var_os("DELTAQ_SAID").is_some() {
        println!("{:?} {}: {}", output.status.code(), call.join(" "), said.trim());
    }
    Ok(output.status.code())
}

fn number(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

#[test]
fn no_scene_of_the_language_makes_a_command_fail() {
    let (first, count) = (number("DELTAQ_FIRST").unwrap_or(0), number("DELTAQ_SCENES").unwrap_or(SCENES));
    let (mut faults, mut codes) = (Vec::new(), BTreeMap::new());
    for n in first..first + count {
        let folder = tempfile::tempdir().expect("a folder");
        let Drawn { text, names } = drawn(n);
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, &text).expect("written");
        let mut draw = Draw(!n);
        std::fs::write(folder.path().join("film.csv"), film(&mut draw, &path.display().to_string(), &names))
            .expect("written");
        std::fs::write(folder.path().join("equations.txt"), equations(&mut draw, &names)).expect("written");
        for call in calls(&mut draw, &path.display().to_string(), folder.path(), &names) {
            match ended(n, &call) {
                Ok(code) => *codes.entry((call[0].clone(), code)).or_insert(0) += 1,
                Err(fault) => {
                    println!("scene {n}, {}: {fault}\n{text}", call.join(" "));
                    faults.push((n, call[0].clone()));
                }
            }
        }
    }
    codes.iter().for_each(|((call, code), count)| println!("{call}: {count} ended with {code:?}"));
    assert!(faults.is_empty(), "{} faults: {faults:?}", faults.len());
}
