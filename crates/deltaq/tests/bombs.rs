//! Inputs that are huge or deep: each has an answer, stays open, or is refused with its limit, in 2 GB and in
//! 60 s of processor time. `BOMBS=all` tries all of them, `BOMBS=NAME` those whose name has that word.

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::thread;
use std::time::Instant;

use crate::support::text;

/// Names of those in the check begin so: they take hundredths of a second.
const QUICK: [&str; 9] = ["brackets", "minus", "powers", "lists", "sines 1", "keys", "power ", "number ", "digits"];
/// What a bomb may take.
const KILOBYTES: u32 = 2_000_000;
const SECONDS: u32 = 60;

/// A name, a file, and calls in which `@` is its path.
struct Bomb {
    name: String,
    file: String,
    calls: &'static [&'static str],
}

const ALL: &[&str] =
    &["check @", "show @", "solve @ -f chetaev --max-steps 200", "integrals @ --degree 1", "prove @ --out -"];
const SOME: &[&str] = &["check @", "show @", "solve @ -f chetaev --max-steps 200"];

/// A scene in `x`, `y`, `z` with this in it.
fn scene(head: &str, lagrangian: &str, constraint: &str, tail: &str) -> String {
    format!(
        "title = \"bomb\"\n{head}\n[coordinates]\nx = {{ start = 0.3 }}\ny = {{ start = 0.4 }}\nz = {{ start = 0.1 }}\n\
         [system]\nlagrangian = \"(x'^2 + y'^2 + z'^2)/2 + {lagrangian}\"\nconstraints = [\"{constraint}\"]\n{tail}\n\
         [start.velocities]\n\"x'\" = 1\n\"y'\" = 0.5\n[run]\nduration = 1\n"
    )
}

fn repeated(n: usize, term: impl Fn(usize) -> String, between: &str) -> String {
    (0..n).map(term).collect::<Vec<_>>().join(between)
}

/// `n` coordinates, `L` and constraints by their numbers.
fn many(n: usize, energy: impl Fn(usize) -> String, constraints: usize, row: impl Fn(usize) -> String) -> String {
    let coordinates = repeated(n, |i| format!("q{i} = {{ start = {} }}", 0.1 + 0.01 * i as f64), "\n");
    let rows = repeated(constraints, |i| format!("{:?}", row(i)), ", ");
    let velocities = repeated(n - constraints, |i| format!("\"q{}'\" = 0.1", i + constraints), "\n");
    format!(
        "title = \"bomb\"\n[coordinates]\n{coordinates}\n[system]\nlagrangian = \"{}\"\nconstraints = [{rows}]\n\
         [start.velocities]\n{velocities}\n[run]\nduration = 1\n",
        repeated(n, energy, " + ")
    )
}

fn pendulums(n: usize) -> String {
    let sum = |i: usize, function: &str, rate: &str| repeated(i + 1, |j| format!("q{j}{rate}*{function}(q{j})"), " + ");
    let energy = |i: usize| format!("(({})^2 + ({})^2)/2 + cos(q{i})", sum(i, "cos", "'"), sum(i, "sin", "'"));
    many(n, energy, 1, |_| "q0' - q1'*q2".into())
}

fn bodies(n: usize) -> String {
    let mut file = "title = \"bomb\"\ngravity = [0, 0, -9.8]\n[coordinates]\n".to_owned();
    (0..n).for_each(|i| _ = writeln!(file, "q{i} = {{ start = 0.1 }}"));
    for i in 0..n {
        let on = if i == 0 { String::new() } else { format!("on = \"b{}\"\n", i - 1) };
        let _ = writeln!(
            file,
            "[body.b{i}]\n{on}joint = {{ hinge = [{}], angle = \"q{i}\", at = [0, 0, -1] }}\nshape = \"ball\"\nsize = [0.1]\nmass = 1",
            ["1, 0, 0", "0, 1, 0"][i % 2]
        );
    }
    file + "[start.velocities]\n" + &repeated(n, |i| format!("\"q{i}'\" = 0.1"), "\n") + "\n[run]\nduration = 0.1\n"
}

/// Each definition has the one before it twice.
fn doubled(n: usize, next: impl Fn(usize) -> String) -> String {
    let definitions = repeated(n, |i| format!("d{} = {:?}", i + 1, next(i)), "\n");
    scene(&format!("[definitions]\nd0 = \"x + y*z\"\n{definitions}"), &format!("d{n}"), "z' - y*x'", "")
}

fn table(rows: usize, columns: usize) -> String {
    let mut table = "t".to_owned() + &repeated(columns, |i| format!(",c{i}"), "") + "\n";
    for row in 0..rows {
        let _ = writeln!(table, "{}{}", row as f64 * 0.01, ",0.5".repeat(columns));
    }
    table
}

const FILMS: &[&str] = &["fit sledge @ --free g --sigma 0.01 --starts 2", "judge sledge @"];

fn bombs() -> Vec<Bomb> {
    let mut all = Vec::new();
    let mut add = |name: String, calls: &'static [&'static str], file: String| all.push(Bomb { name, file, calls });
    let plain = |lagrangian: &str| scene("", lagrangian, "z' - y*x'", "");
    for n in [10, 25, 50, 100] {
        add(format!("pendulums {n}"), ALL, pendulums(n));
    }
    for n in [100, 300, 1000] {
        let energy = |i: usize| format!("q{i}'^2/2 + cos(q{i} - q{})", (i + 1) % n);
        add(format!("row {n}"), ALL, many(n, energy, 1, |_| "q0' - q1'*q2".into()));
    }
    for n in [30, 100, 300] {
        add(
            format!("rows {n}"),
            ALL,
            many(n, |i| format!("q{i}'^2/2"), n - 2, |i| format!("q{i}' - q{}*q{}'", i + 1, n - 1)),
        );
    }
    for n in [10, 30, 100, 300] {
        add(format!("bodies {n}"), SOME, bodies(n));
    }
    for (n, name) in [(50, "50"), (1000, "1000"), (1_000_000, "1000000")] {
        add(format!("brackets {name}"), SOME, plain(&("(".repeat(n) + "x" + &")".repeat(n))));
        add(format!("minus {name}"), SOME, plain(&("-".repeat(n) + "x")));
        add(format!("powers {name}"), SOME, plain(&repeated(n, |_| "x".into(), "^")));
        add(format!("lists {name}"), SOME, plain(&("[".repeat(n) + "x" + &"]".repeat(n))));
        add(format!("sines {name}"), SOME, plain(&("sin(".repeat(n) + "x" + &")".repeat(n))));
        add(format!("keys {name}"), &["check @"], "a = ".to_owned() + &"[".repeat(n));
    }
    for n in [1_000, 30_000] {
        add(format!("sum {n}"), ALL, plain(&repeated(n, |i| format!("sin({i}*x)"), " + ")));
        add(format!("product {n}"), ALL, plain(&repeated(n, |i| format!("({} + x)", i + 2), "*")));
        add(format!("quotient {n}"), SOME, plain(&repeated(n, |i| format!("({} + x^2)", i + 2), "/")));
        add(
            format!("parameters {n}"),
            SOME,
            scene(&format!("[parameters]\n{}", repeated(n, |i| format!("p{i} = {i}"), "\n")), "p7*x", "z' - y*x'", ""),
        );
        add(
            format!("observables {n}"),
            SOME,
            scene(
                "",
                "x",
                "z' - y*x'",
                &format!("[observables]\n{}", repeated(n, |i| format!("o{i} = \"x^{i}\""), "\n")),
            ),
        );
        add(
            format!("invariants {n}"),
            SOME,
            scene(
                "",
                "x",
                "z' - y*x'",
                &format!("[invariants]\n{}", repeated(n, |i| format!("i{i} = \"x'*{i}\""), "\n")),
            ),
        );
        add(
            format!("views {n}"),
            SOME,
            scene(
                "",
                "x",
                "z' - y*x'",
                &repeated(n, |i| format!("[view.b{i}]\nshape = \"ball\"\nsize = [1]\nat = \"[x, y, {i}]\""), "\n"),
            ),
        );
    }
    for power in ["1000", "1000000", "1000000000000", "2^(2^(2^(2^2)))", "(1/1000001)", "1e300"] {
        add(format!("power {power}"), ALL, plain(&format!("(1 + x*y + z^2)^({power})")));
    }
    for number in [
        "2^(2^30)",
        "10^10^10",
        "1e-99999",
        "pi^(10^9)",
        "exp(exp(exp(exp(9))))",
        "(1 + sqrt(2))^100000",
        "cos(1)^(10^7)",
    ] {
        add(format!("number {number}"), SOME, plain(&format!("x*({number})")));
    }
    add("digits".into(), SOME, plain(&("1".repeat(100_000) + "*x")));
    add("name".into(), SOME, plain(&"x".repeat(1_000_000)));
    for n in [12, 40, 2000] {
        add(format!("squares {n}"), ALL, doubled(n, |i| format!("d{i}^2 + d{i}/7")));
        add(format!("sines of sums {n}"), ALL, doubled(n, |i| format!("sin(d{i}) + d{i}*x")));
        add(format!("quotients {n}"), ALL, doubled(n, |i| format!("d{i}/(2 + d{i}*y)")));
        add(format!("towers {n}"), SOME, doubled(n, |i| format!("(1 + d{i}^2)^d{i}")));
    }
    for (rows, columns) in [(100_000, 3), (1_000_000, 3), (2, 10_000), (10, 1_000_000)] {
        add(
            format!("film {rows} x {columns}"),
            FILMS,
            table(rows, columns).replace("c0", "x").replace("c1", "y").replace("c2", "phi"),
        );
    }
    add("film of one cell".into(), FILMS, "t,x\n0,".to_owned() + &"9".repeat(50_000_000));
    add("film of one quote".into(), FILMS, "t,\"x".to_owned() + &"\"\"".repeat(20_000_000));
    const TRAINS: &[&str] =
        &["check n-trailer-@", "show n-trailer-@ -f chetaev", "prove n-trailer-@ --out -", "integrals n-trailer-@"];
    for n in ["10", "30", "100", "100000"] {
        add(format!("train {n}"), TRAINS, n.into());
    }
    const NUMBERS: &[&str] = &[
        "solve sledge -f chetaev --times 0:1:100000000",
        "solve sledge -f chetaev --set duration=1e300 --max-steps 20000",
        "solve disc -f vakonomic --tolerance 1e-300",
        "solve sledge -f chetaev --method leapfrog --step 1e-9",
        "compare sledge --sweep g=1:2:100000000",
        "ensemble sledge -f chetaev --vary g=1..2:100000000",
        "ensemble sledge -f chetaev --times 0:1:1000000 --vary g=1..2:4096",
        "integrals disc --degree 4",
        "integrals rattleback --degree 1000000",
        "linearize bicycle --sweep v=1:2:100000000",
        "connect heisenberg --to x=1,y=1,z=1 --at 1 --starts 1000000000",
        "design sledge --tell chetaev,vakonomic --free g --film 1e9Hz,1mm,1e9s",
        "design sledge --tell chetaev,vakonomic --free g --film 10Hz,1mm,1s --points 1000000000",
        "bench sledge --ensemble 1e-10 --members 65535 --seconds 0",
    ];
    add("numbers".into(), NUMBERS, String::new());
    const THEIRS: &[&str] = &["review sledge @"];
    add("their lines".into(), THEIRS, "x'' = x + y\n".repeat(100_000));
    add("their sum".into(), THEIRS, "x'' = ".to_owned() + &repeated(100_000, |i| format!("sin({i}*phi)"), " + "));
    add("their brackets".into(), THEIRS, "x'' = ".to_owned() + &"(".repeat(100_000));
    all
}

/// What is wrong with how a call ended; and the seconds that it took.
fn failure(call: &str, folder: &Path, path: &str) -> (Option<String>, f64) {
    let (clock, program) = (Instant::now(), env!("CARGO_BIN_EXE_deltaq"));
    let call = call.replace('@', path);
    let line =
        format!("ulimit -v {KILOBYTES}; ulimit -t {SECONDS}; exec '{program}' {call} --quiet --threads 2 --patience 5");
    let output =
        Command::new("sh").args(["-c", &line]).current_dir(folder).stdin(Stdio::null()).output().expect("a shell");
    let said = text(&output.stderr);
    let short = || said.chars().take(300).collect::<String>();
    let fault = match output.status.code() {
        Some(0..=3) if said.len() > 100_000 => Some(format!("a message of {} bytes: {}", said.len(), short())),
        Some(2 | 3) if said.trim().is_empty() => Some("nothing is said".into()),
        Some(0..=3) if !said.contains("panicked") => None,
        _ => Some(format!("{}: {}", output.status, short())),
    };
    (fault.map(|fault| format!("{call}: {fault}")), clock.elapsed().as_secs_f64())
}

#[test]
fn what_is_huge_or_deep_is_answered_or_refused() {
    let asked = std::env::var("BOMBS").ok();
    let bombs = bombs();
    let calls = bombs.iter().flat_map(|bomb| bomb.calls.iter().map(move |call| (bomb, *call))).enumerate();
    let is_wanted = |name: &str| match asked.as_deref() {
        None => QUICK.iter().any(|word| name.starts_with(word)),
        Some("all") => true,
        Some(word) => name.contains(word),
    };
    let wanted = Mutex::new(calls.filter(|(_, (bomb, _))| is_wanted(&bomb.name)).collect::<Vec<_>>().into_iter());
    let (folder, found) = (tempfile::tempdir().expect("a folder"), Mutex::new((0, Vec::new())));
    let work = || {
        while let Some((at, (bomb, call))) = { wanted.lock().expect("a list").next() } {
            let file = folder.path().join(format!("{at}.toml"));
            std::fs::write(&file, &bomb.file).expect("written");
            let path = if bomb.file.len() < 10 { bomb.file.clone() } else { file.display().to_string() };
            let (fault, seconds) = failure(call, folder.path(), &path);
            let _ = std::fs::remove_file(&file);
            let word = if fault.is_some() { "FAILS" } else { "holds" };
            println!("{} {call}: {word}, {seconds:.1} s", bomb.name);
            let mut found = found.lock().expect("a list");
            found.0 += 1;
            found.1.extend(fault.map(|fault| format!("{}: {fault}", bomb.name)));
        }
    };
    thread::scope(|scope| (0..2).for_each(|_| _ = scope.spawn(work)));
    let (count, faults) = found.into_inner().expect("a list");
    println!("{count} of {} calls", bombs.iter().map(|bomb| bomb.calls.len()).sum::<usize>());
    assert!(count > 0 && faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n"));
}
