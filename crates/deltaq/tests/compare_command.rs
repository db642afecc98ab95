//! `deltaq compare`: what it says first, what it writes, and what there is of it when it is interrupted.

use std::fs;
use std::path::Path;
use std::time::Instant;

use serde_json::Value;

use crate::support::{answer, refused, run, text};

const SNAKE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/snake-14.toml");

#[test]
fn four_lines_two_tables_and_a_plot() {
    let (told, complaint) = answer(&["compare", "sledge", "--set", "duration=2"], 0);
    println!("{told}");
    let lines: Vec<&str> = told.lines().collect();
    let answer = "sledge: Different: Chetaev and vakonomic, for every μ₀ (proved). Wheels, skates and rolling bodies follow Chetaev";
    assert!(lines[0].starts_with(answer), "{told}");
    assert!(lines[1].starts_with("motions: 5 ") && lines[1].contains("differ by 1e-3 after 0.127 s"), "{told}");
    assert!(lines[2].starts_with("why: Constraint: nonholonomic"), "{told}");
    assert!(lines[3].starts_with("how sure: No μ₀ makes the vakonomic motion Chetaev's: proved"), "{told}");
    for words in [
        "a  Chetaev – vakonomic ",
        "different: removed (arc-length) – removed (along-x)",
        "gap in the kinetic metric (m √kg)",
        "·····",
        "t − t₀ (s)",
        "what a gap has to pass",
    ] {
        assert!(told.contains(words), "`{words}` is not in {told}");
    }
    // a curve that has a letter in the table is seen, and one that is hidden has none
    let canvas: String = lines.iter().filter_map(|line| line.split(['│', '┤']).nth(1)).collect();
    for letter in ["a", "b", "c"] {
        assert!(lines.iter().any(|line| line.starts_with(&format!("{letter}  Chetaev – "))), "{told}");
        assert!(canvas.matches(letter).count() >= 4, "{letter} is hidden in {told}");
    }
    assert!(lines[4..].iter().all(|line| line.chars().count() <= 90), "{told}");
    assert!(!told.contains("substitution (wrong on purpose)") && complaint.is_empty(), "{told}{complaint}");
}

#[test]
fn only_the_formulations_asked_for() {
    let (told, _) = answer(&["compare", "sledge", "-f", "chetaev,vakonomic", "--set", "duration=1"], 0);
    assert!(told.contains("2 different motions: Chetaev; vakonomic.") && !told.contains("removed"), "{told}");
    let (told, _) = answer(&["compare", "bowl", "-f", "chetaev,vakonomic", "--set", "duration=1"], 0);
    assert!(told.starts_with("bowl: Same: Chetaev and vakonomic, for every μ₀ (proved)"), "{told}");
    assert!(!told.contains("follow Chetaev"), "nothing has to be chosen: {told}");
    // multipliers at the start may bring the two together: one line says both
    let (told, _) = answer(&["compare", "disc", "-f", "chetaev,vakonomic", "--set", "duration=1"], 0);
    let first = "disc: Different: Chetaev and vakonomic, with the scene's μ₀; the same with μ₀ = (-0.92106, -0.38942) (proved).";
    assert!(told.starts_with(first), "{told}");
    let (value, _) = answer(&["compare", "bowl", "-f", "chetaev", "--set", "duration=1", "--format", "json"], 0);
    let value: Value = serde_json::from_str(&value).expect("JSON");
    let runs = value["scenes"]["bowl"]["runs"].as_object().expect("runs");
    assert_eq!(runs.keys().collect::<Vec<_>>(), ["Chetaev"]);
    refused(&["compare", "sledge", "-f", "newton"], &["newton", "chetaev"]);
    refused(&["compare", "sledge", "-f", "kappa"], &["kappa", "parameter"]);
}

#[test]
fn every_command_refuses_a_name_that_is_no_formulation() {
    refused(&["compare", "sledge", "-f", "chetaev,vakonomik"], &["vakonomik", "a similar value exists: 'vakonomic'"]);
    let others: [&[&str]; 4] = [
        &["solve", "sledge"],
        &["ensemble", "sledge", "--vary", "phi=0..1:2"],
        &["linearize", "sledge"],
        &["show", "sledge"],
    ];
    for command in others {
        let asked = [command, &["-f", "vakonomik"]].concat();
        refused(&asked, &["unknown formulation `vakonomik`, did you mean `vakonomic`?; known: chetaev, "]);
        // the control has no name that leads to it
        refused(&[command, &["-f", "substitution"]].concat(), &["unknown formulation `substitution`"]);
    }
}

#[test]
fn fits_are_made_where_nothing_is_decided_or_on_request() {
    let fits = |option: &[&str]| {
        let call = [&["compare", "sledge", "--set", "duration=1", "--format", "json"], option].concat();
        let value: Value = serde_json::from_str(&answer(&call, 0).0).expect("JSON");
        value["scenes"]["sledge"]["fits"].as_array().expect("fits").len()
    };
    assert_eq!((fits(&[]), fits(&["--without", "fits"])), (0, 0));
    assert!(fits(&["--with", "fits"]) > 2);
    refused(&["compare", "sledge", "--with", "fits", "--without", "fits"], &["--without"]);
}

/// A folder with the scene in files of these names.
fn folder_with(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let disc = include_str!("../../deltaq/examples/disc-on-slope.toml");
    for name in names {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, disc).expect("written");
    }
    folder
}

#[test]
fn all_scenes_are_read_before_anything_is_computed() {
    let folder = folder_with(&["a.toml"]);
    let at = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    refused(&["compare", &at("a.toml"), &at("nope.toml")], &["nope.toml", "neither a file"]);
}

#[test]
fn pages_of_scenes_with_one_name_are_two() {
    let folder = folder_with(&["d1/s [1].toml", "d2/s [1].toml"]);
    let at = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let (one, two, out) = (at("d1/s [1].toml"), at("d2/s [1].toml"), at("out"));
    let short = ["--set", "duration=0.2", "-f", "chetaev,vakonomic"];
    answer(&[&["compare", &one, &two, "--out", &out], &short[..]].concat(), 0);
    for name in ["s [1]", "s [1]-2"] {
        let page = fs::read_to_string(Path::new(&out).join("scenes").join(format!("{name}.md"))).expect("a page");
        let link = format!("({}-gap.svg)", name.replace(' ', "%20").replace('[', "%5B").replace(']', "%5D"));
        assert!(page.contains(&link), "{link} is not in {page}");
        assert!(Path::new(&out).join("scenes").join(format!("{name}-gap.svg")).exists());
    }
    let (value, _) = answer(&[&["compare", &one, &two, "--format", "json"], &short[..]].concat(), 0);
    let value: Value = serde_json::from_str(&value).expect("JSON");
    assert_eq!(value["scenes"].as_object().map(|scenes| scenes.len()), Some(2));
}

#[test]
fn the_page_is_printed_on_request() {
    let (page, _) = answer(&["compare", "bowl", "--markdown", "--set", "duration=1"], 0);
    assert!(page.starts_with("# ") && page.contains("## Equations"), "{page}");
}

#[test]
fn a_snake_of_fourteen_links_is_compared_soon() {
    let clock = Instant::now();
    // what grew with the links stands before the motion: a sixth of its time says the same
    let (told, _) = answer(&["compare", SNAKE, "--set", "duration=0.5"], 0);
    println!("{told}{:.1} s", clock.elapsed().as_secs_f64());
    assert!(told.contains("Chetaev") && told.contains("how sure: "), "{told}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_prints_what_there_is() {
    use crate::support::command;
    use std::process::{Command, Stdio};
    for (format, words) in [("text", "sledge: "), ("json", "\"schema\": \"deltaq/compare/2\"")] {
        // far longer than anybody waits
        let call = ["compare", "sledge", "--set", "duration=3000", "--tolerance", "1e-14", "--format", format];
        let child = command(&call).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it runs");
        std::thread::sleep(std::time::Duration::from_millis(1500));
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("a signal");
        assert!(kill.success());
        let output = child.wait_with_output().expect("it ends");
        let (told, complaint) = (text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.code(), Some(130), "{told}{complaint}");
        assert!(told.contains(words) && told.contains("Chetaev"), "{told}");
        assert!(complaint.contains("interrupted: sledge: "), "{complaint}");
    }
}

/// All files under a folder, with their sizes.
fn files(folder: &Path) -> Vec<(String, u64)> {
    let mut found = Vec::new();
    let mut pending = vec![folder.to_path_buf()];
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let entry = entry.expect("an entry");
            let kind = entry.metadata().expect("metadata");
            if kind.is_dir() {
                pending.push(entry.path());
            } else {
                found.push((entry.path().display().to_string(), kind.len()));
            }
        }
    }
    found
}

#[test]
fn compare_writes_whole_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("new");
    let output = run(&["compare", "bowl", "--out", out.to_str().expect("UTF-8"), "--set", "duration=1"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut found = files(&out);
    println!("{found:?}");
    assert!(found.iter().any(|(name, _)| name.ends_with("scenes/bowl.md")), "{found:?}");
    assert!(found.iter().filter(|(name, _)| name.ends_with(".svg")).count() >= 1, "{found:?}");
    // and a list of them
    found.retain(|(name, _)| !name.ends_with(".deltaq"));
    let known = [".md", ".svg", ".csv", ".tex", ".json"];
    let whole = |(name, size): &(String, u64)| *size > 20 && known.iter().any(|ending| name.ends_with(ending));
    assert!(found.iter().all(whole), "{found:?}");
    for (name, _) in found.iter().filter(|(name, _)| name.ends_with(".svg")) {
        let text = fs::read_to_string(name).expect("readable");
        roxmltree::Document::parse(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
    }
}

#[test]
fn a_compare_that_fails_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("new");
    let to = out.to_str().expect("UTF-8");
    // the second scene is the bad one: the first is already computed
    for bad in [&["bowl", "no-such-scene"][..], &["bowl", "disc", "--set", "kx=1"]] {
        let output = run(&[&["compare"], bad, &["--out", to]].concat());
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
        assert!(!out.exists() || files(&out).is_empty(), "{:?}", files(&out));
    }
    // what was there stays as it was
    fs::create_dir_all(out.join("scenes")).expect("a folder");
    fs::write(out.join("scenes/bowl.md"), "mine").expect("written");
    let output = run(&["compare", "bowl", "no-such-scene", "--out", to]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert_eq!(fs::read_to_string(out.join("scenes/bowl.md")).expect("readable"), "mine");
    assert_eq!(files(&out).len(), 1);
    // a folder that cannot be one
    let file = folder.path().join("file");
    fs::write(&file, "").expect("written");
    let output = run(&["compare", "bowl", "--set", "duration=1", "--out", file.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
}

/// A motion whose estimate is doubted from the start has no bound for its gap, and no infinite one is
/// printed.
#[test]
fn what_has_no_bound_is_not_known() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("far.toml");
    let scene = "title = 'far'\n[coordinates]\nx = { start = 1e3 }\ny = { start = 0 }\nz = { start = 1 }\nw = { start = \"pi/2\" }\n\
                 s = { start = -1 }\n[system]\nlagrangian = \"x'^2/2 + y'^2/2 + z'^2/2 + w'^2/2 + s'^2\"\nconstraints = [\n\
                 \"w' - 2*cos(y)*x' - cos(z)^2*cos(y)^2/2*y' - (2*cos(y)*y + 2*tanh(20*(z-1)))*z'\",\n\
                 \"s' + x^2*y' - 2*tanh(20*(x-1))*z'\"]\n[start.velocities]\n\"x'\" = 1\n\"y'\" = 1\n\"z'\" = -0.7\n[run]\n\
                 duration = 1\n";
    fs::write(&path, scene).expect("written");
    let file = path.to_str().expect("UTF-8");
    let (told, _) = answer(&["compare", file, "-f", "chetaev,vakonomic", "--without", "fits"], 0);
    assert!(told.contains("different (proved)") && told.contains("not known") && !told.contains("inf"), "{told}");
}
