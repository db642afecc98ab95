//! The smallest and the largest questions to each command: one unknown, one sample, a body at rest, a
//! parameter at 0, a heading near 90°, twenty films, few samples a turn, times that begin late. Each is
//! answered, or not decided with a reason; nothing ends otherwise.

use std::fs;
use std::process::Command;

/// A sledge at rest whose blade is 0.1 mrad from across, on level ice.
const REST: &str = r#"
title = "At rest"
[parameters]
g = 0
[coordinates]
x = { unit = "m", start = 0 }
y = { unit = "m", start = 0 }
phi = { unit = "rad", start = 1.5707 }
[system]
lagrangian = "(x'^2 + y'^2 + phi'^2)/2 + g*x"
constraints = ["y'*cos(phi) - x'*sin(phi)"]
[start]
velocities = { "x'" = 0, "phi'" = 0 }
[run]
duration = 1
"#;

/// A straight line of unit speed at these times, as `heisenberg` has it for both formulations.
fn line(times: &[f64], angle: f64) -> String {
    let (sin, cos) = angle.sin_cos();
    let row = |(k, t): (usize, &f64)| {
        // deviations of a millimetre that follow no curve
        let [a, b] = [7, 11].map(|p| 1e-3 * ((k * p) as f64 * 2.399).sin());
        format!("{t},{},{}\n", 0.5 + cos * t + a, sin * t + b)
    };
    "t,x,y\n".to_string() + &times.iter().enumerate().map(row).collect::<String>()
}

#[test]
fn the_smallest_questions_are_answered() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("text").to_string();
    let write = |name: &str, text: String| fs::write(path(name), text).expect("a file");
    let every = |step: f64, from: f64, count: usize| (0..count).map(|k| from + step * k as f64).collect::<Vec<_>>();
    write("rest.toml", REST.into());
    write("rest.csv", "t,x,y\n".to_string() + &(1..=12).map(|k| format!("0.{k:02},0,0\n")).collect::<String>());
    write("one.csv", line(&[0.5], 0.0));
    write("coarse.csv", line(&every(1.0, 1.0, 3), 0.2));
    write("late.csv", line(&every(0.1, 3.0, 10), 0.2));
    let many: Vec<String> = (0..20).map(|k| format!("f{k}.csv")).collect();
    many.iter().enumerate().for_each(|(k, name)| write(name, line(&every(0.1, 0.1, 6), 0.3 * k as f64)));
    let films = many.join(" ");
    // a disc of 2 cm, as the program itself writes its motion: multipliers and errors are not looked at
    let own = ["solve", "disc", "-f", "chetaev", "--set", "R=0.02", "--times", "0:1:11"];
    let own = Command::new(env!("CARGO_BIN_EXE_deltaq")).args(own).output().expect("it runs");
    write("own.csv", String::from_utf8(own.stdout).expect("text"));
    write("gaps.csv", "t,x,y\n0.5,0.5,\n1,,1\n1.5,,\n2,0.5,2\n".into());
    let mut asked = [
        "fit disc own.csv --set R=0.02 --free start --sigma 1e-3",
        "fit disc own.csv --set R=0.02 --free phi' --sigma 1e-3",
        "fit disc own.csv --set R=0.02 --free R~0.03 --sigma free",
        "fit heisenberg gaps.csv --free x' --sigma 1mm",
        "fit rest.toml rest.csv --free g~0 --law eps --sigma 1mm",
        "fit rest.toml rest.csv --free g~0 --law slip --sigma 1mm",
        "fit heisenberg one.csv --free x' --sigma 1mm",
        "fit heisenberg one.csv --free x',y' --sigma 1mm",
        "fit heisenberg rest.csv --free x' --sigma 1mm",
        "fit heisenberg rest.csv --free x',y' --sigma free",
        "fit heisenberg coarse.csv --free x',y' --sigma 1mm",
        "fit heisenberg coarse.csv --free x',z --sigma 1mm",
        "fit heisenberg late.csv --free x',y' --sigma 1mm",
        "fit rest.toml rest.csv --free g --sigma 1mm",
        "fit rest.toml rest.csv --free phi,x',phi' --sigma 1mm",
        "design rest.toml --free phi --film 10Hz,1mm,1s --tell chetaev,vakonomic --starts 2",
        "design rest.toml --free g --film 1Hz,1mm,1s --estimate g",
        "connect rest.toml --to x=0,y=0,phi=1.5707 --starts 4",
        "connect rest.toml --to x=0,y=1,phi=1.5707 --starts 4",
        "solve rest.toml -f chetaev",
        "solve rest.toml -f vakonomic",
        "compare rest.toml",
        "show rest.toml",
        "check rest.toml",
        "linearize rest.toml",
        "integrals rest.toml --patience 2",
    ]
    .map(str::to_string)
    .to_vec();
    asked.push(format!("fit heisenberg {films} --free x,y,x',y' --sigma 1mm --formulations chetaev"));
    for line in asked {
        let words = line
            .split(' ')
            .map(|word| if word.contains(".csv") || word == "rest.toml" { path(word) } else { word.into() });
        let found = Command::new(env!("CARGO_BIN_EXE_deltaq")).args(words).output().expect("it runs");
        let (text, said) = [&found.stdout, &found.stderr].map(|all| String::from_utf8_lossy(all).into_owned()).into();
        assert!(matches!(found.status.code(), Some(0 | 3)), "{line}: {:?} {said}", found.status);
        assert!(!text.is_empty() && !text.contains("NaN"), "{line}: {text}");
    }
}

/// Numbers of which an exact factor comes out of a sum, and of its powers another one.
#[test]
fn high_powers_of_sums_of_long_numbers_end() {
    let scene = "title = \"Powers\"\ncoordinates = { x = { start = 0.7 }, y = { start = 0.3 } }\n[system]\n\
                 lagrangian = \"(x'^2 + y'^2)/2 + (1 + step(y', 0.1, 0.4, 1e-3)^2)^41\"\n\
                 constraints = [\"x' - y'\"]\n[start]\nvelocities = { \"y'\" = 1 }\n[run]\nduration = 1\n";
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("powers.toml");
    fs::write(&path, scene).expect("written");
    let shown = Command::new(env!("CARGO_BIN_EXE_deltaq")).arg("show").arg(path).output().expect("it runs");
    assert_eq!(shown.status.code(), Some(0), "{}", String::from_utf8_lossy(&shown.stderr));
}
