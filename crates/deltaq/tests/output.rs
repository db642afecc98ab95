//! Where answers and files go: nothing is lost in silence, and nothing is written where nobody asked for it.

use std::fs;

use crate::support::{all_may_be_left, answer, command, commands, elsewhere, none_is_lost, refused, text};

/// A scene with faults.
const BAD: &str = concat!(env!("CARGO_TARGET_TMPDIR"), "/bad.toml");

/// One call of every command.
const ANSWERS: [&[&str]; 21] = [
    &["new"],
    &["check", "sledge"],
    &["solve", "sledge", "-f", "chetaev", "--times", "0,1"],
    &["connect", "disc", "-f", "chetaev", "--to", "psi=3,phi=1", "--starts", "2"],
    &["list"],
    &["show", "sledge"],
    &["compare", "bowl", "--set", "duration=1"],
    &["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2"],
    &["linearize", "bicycle"],
    &["explore", "sledge", "--out", concat!(env!("CARGO_TARGET_TMPDIR"), "/explore.html")],
    &["prove", "sledge", "--out", "-"],
    &["integrals", "suslov"],
    &["judge", "sledge", concat!(env!("CARGO_MANIFEST_DIR"), "/tests/sledge.csv")],
    &["review", "sleigh", concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/derivations/right.txt")],
    &[
        "fit",
        "sledge",
        concat!(env!("CARGO_MANIFEST_DIR"), "/tests/film.csv"),
        "--free=x,y,phi,x',phi'",
        "--sigma=1mm",
        "--starts=1",
    ],
    &["design", "heisenberg", "--tell=vakonomic,chetaev", "--film=9Hz,1mm,1s", "--free=x',y'", "--starts=1"],
    &["schema", "solve"],
    &["completions", "bash"],
    &["man"],
    &["help", "solve"],
    &["--help"],
];

#[test]
fn every_command_is_called() {
    let commands = commands();
    assert!(commands.iter().any(|name| name == "solve"), "{commands:?}");
    for command in commands {
        assert!(ANSWERS.iter().any(|call| call[0] == command), "{command}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_answer_that_cannot_be_written_is_an_error() {
    none_is_lost(&ANSWERS);
    for file in [&["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2"][..], &["prove", "sledge"]] {
        let (_, stderr) = answer(&[file, &["--out", "/dev/full"]].concat(), 1);
        for words in ["cannot write", "/dev/full", "No space left"] {
            assert!(stderr.contains(words), "`{words}` is not in {stderr}");
        }
    }
    // complaints that cannot be written change no exit code
    let full = || fs::File::options().write(true).open("/dev/full").expect("the device that is always full");
    for arguments in [&["check", "sledge", "nothing"][..], &["check", BAD], &["solve", "nothing"]] {
        fs::write(BAD, "[coordinates]\nx = {}\n").expect("written");
        let output = command(arguments).stderr(full()).output().expect("the command runs");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    all_may_be_left(&ANSWERS);
}

#[test]
fn built_in_scenes_are_known_everywhere() {
    for scene in ["sledge", "trailer", "n-trailer-3"] {
        let output = elsewhere(&["solve", scene, "-f", "chetaev", "--times", "0"]);
        assert!(output.status.success(), "{scene}: {}", text(&output.stderr));
    }
}

#[test]
fn no_text_of_others_reaches_a_terminal_as_an_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a\u{1b}]0;b\u{7}.toml");
    let named = path.to_str().expect("UTF-8");
    let (scene, _) = answer(&["new", "--from", "bowl"], 0);
    let title = scene.lines().find(|line| line.starts_with("title")).expect("a title");
    fs::write(&path, scene.replace(title, "title = \"bell\\u0007 \\u001b[31mred \\u009b32m\"")).expect("written");
    let missing = folder.path().join("\u{1b}[2J");
    let calls: [(&[&str], i32); 7] = [
        (&["show", named], 0),
        (&["check", named], 0),
        (&["compare", named, "--set", "duration=0.1"], 0),
        (&["compare", named, "--set", "duration=0.1", "--markdown"], 0),
        (&["check", named, "--set", "\u{1b}[31m=1"], 2),
        (&["solve", missing.to_str().expect("UTF-8"), "-f", "chetaev"], 2),
        (&["solve", named, "--method", "\u{1b}[31m"], 2),
    ];
    for (arguments, code) in calls {
        let (stdout, stderr) = answer(arguments, code);
        let obeyed = |c: char| c.is_control() && !"\n\t".contains(c);
        assert!(!(stdout.clone() + &stderr).contains(obeyed), "{arguments:?}: {stdout:?} {stderr:?}");
        // the library that reads arguments leaves some out
        assert!((stdout + &stderr).contains("\\u{1b}") || arguments.contains(&"--method"), "{arguments:?}");
    }
}

#[test]
fn pages_obey_no_text_of_a_scene_and_replace_only_what_is_ours() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, out) = (folder.path().join("own.toml"), folder.path().join("out"));
    let [file, out_name] = [&file, &out].map(|path| path.to_str().expect("UTF-8"));
    let (scene, _) = answer(&["new", "--from", "bowl"], 0);
    let title = scene.lines().find(|line| line.starts_with("title")).expect("a title");
    let bad = "<img src=x onerror=alert(1)> [x](javascript:alert(1))";
    let invariants = format!("\n[observables]\n\"energy, {bad}\" = \"x^2\"\n");
    fs::write(file, scene.replace(title, &format!("title = \"{bad}\"")) + &invariants).expect("written");
    let call = ["compare", file, "--set", "duration=0.1", "--quiet", "--out", out_name];
    answer(&call, 0);
    let page = out.join("scenes/own.md");
    let text = fs::read_to_string(&page).expect("a page");
    assert!(!text.contains("<img") && !text.contains("](javascript"), "{text}");
    assert!(text.contains("# &lt;img src=x"), "{text}");
    // a name with a comma is one cell
    let (table, _) = answer(&["solve", file, "-f", "chetaev", "--times", "0"], 0);
    let names = table.lines().next().expect("names");
    assert!(names.ends_with(&format!(",\"energy, {bad}\"")), "{names}");
    // again, and not over what is not ours
    answer(&call, 0);
    fs::remove_file(out.join(".deltaq")).expect("the list");
    fs::write(&page, "mine").expect("written");
    refused(&call, &["is not of deltaq, as far as it and the list `.deltaq` tell, and not replaced"]);
    assert_eq!(fs::read_to_string(&page).expect("the page"), "mine");
    let table = folder.path().join("m.csv");
    fs::write(&table, "my,own\n").expect("written");
    let members = ["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2", "--out"];
    refused(&[&members[..], &[table.to_str().expect("UTF-8")]].concat(), &["m.csv is not of deltaq"]);
    assert_eq!(fs::read_to_string(&table).expect("the table"), "my,own\n");
}

/// `--out` has one meaning: a file is made anew, takes the place of an answer and of nothing else, and `-` is
/// standard output, which holds no folder.
#[test]
fn there_is_one_rule_for_every_out() {
    let members = ["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2", "--out"];
    let files: [&[&str]; 7] = [
        &members,
        &["prove", "sledge", "--out"],
        &["integrals", "suslov", "--degree", "1", "--out"],
        &["integrals", "suslov", "--degree", "1", "--format", "json", "--out"],
        &["integrals", "suslov", "--degree", "0", "--sweep", "K=0:1:2", "--out"],
        &["explore", "disc", "--out"],
        &["explore", "--out"],
    ];
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    for (i, call) in files.iter().enumerate() {
        let to = |file: &str, code: i32| answer(&[call, &[file][..]].concat(), code);
        let (own, mine) = (at(&format!("new/{i}")), at("mine"));
        let on_terminal = to("-", 0).0;
        for _ in 0..2 {
            assert!(to(&own, 0).0.contains(&own), "{call:?}");
            assert_eq!(fs::read_to_string(&own).expect("an answer"), on_terminal, "{call:?}");
        }
        fs::write(&mine, "mine").expect("written");
        assert!(to(&mine, 2).1.contains("mine is not of deltaq"), "{call:?}");
        assert!(to(&at("mine/in/it"), 2).1.contains("mine/in"), "{call:?}");
        assert!(to("..", 2).1.contains("--out .. names no file"), "{call:?}");
        assert_eq!(fs::read_to_string(&mine).expect("the file"), "mine");
    }
    let left = |folder: &str| fs::read_dir(at(folder)).expect("a folder").count();
    assert_eq!((left("new"), left("")), (files.len(), 2));
    for folder in [
        &["compare", "bowl", "--set", "duration=0.1", "--out"][..],
        &["compare", "sledge", "--sweep", "g=1:2:2", "--out"],
        &["linearize", "bicycle", "--sweep", "v=4:6:3", "--out"],
        &["integrals", "suslov", "--certificates"],
        &["fit", "sledge", "film.csv", "--free=x", "--pictures"],
    ] {
        refused(&[folder, &["-"]].concat(), &["this is standard output, and a folder is needed"]);
    }
    // a scene to begin with is a text of one's own from then on
    let scene = at("scene.toml");
    answer(&["new", &scene], 0);
    refused(&["new", &scene], &["scene.toml is not of deltaq"]);
    assert_eq!(answer(&["new", "-"], 0), answer(&["new"], 0));
    (0..2).for_each(|_| drop(answer(&["new", "--schema", &at("schema.json")], 0)));
}

#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let calls = [&["ensemble", "sledge", "-f", "chetaev", "--vary", "phi=0..0.3:2"][..], &["prove", "sledge"]];
    for (name, link) in [("m.csv", "m.csv"), ("p.csv", "p.csv.part")] {
        std::os::unix::fs::symlink(at("elsewhere"), at(link)).expect("a link");
        for call in calls.iter().filter(|call| name == link || call[0] == "ensemble") {
            refused(&[call, &["--out", at(name).to_str().expect("UTF-8")][..]].concat(), &["is a link, which is not"]);
        }
    }
    assert!(!at("elsewhere").exists());
}

#[test]
fn coordinates_are_in_the_order_of_the_scene() {
    let (text, _) = answer(&["solve", "sledge", "-f", "chetaev", "--times", "0", "--format", "json"], 0);
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let names: Vec<&String> = value["velocities"].as_object().expect("an object").keys().collect();
    assert_eq!(names, ["x", "y", "phi"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_without_memory_stops_with_a_cause() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("many.toml");
    let each = |of: fn(usize) -> String, by: &str| (1..=60).map(of).collect::<Vec<_>>().join(by);
    let coordinates = each(|i| format!("x{i} = {{ start = 0 }}"), "\n");
    let lagrangian = each(|i| format!("x{i}'^2/2 - {i}*x{i}^2/2"), " + ");
    let velocities = each(|i| format!("\"x{i}'\" = 1"), "\n");
    let scene = format!(
        "title = \"many\"\n[coordinates]\n{coordinates}\n[system]\nlagrangian = \"{lagrangian}\"\n\
         [start.velocities]\n{velocities}\n[run]\nduration = 1e5\n"
    );
    fs::write(&file, scene).expect("written");
    let call = format!(
        "ulimit -v 700000; exec '{}' solve '{}' -f chetaev --quiet --times ",
        env!("CARGO_BIN_EXE_deltaq"),
        file.display()
    );
    let solve = |times: &str| {
        let output = std::process::Command::new("sh").args(["-c", &(call.clone() + times)]).output();
        let output = output.expect("a shell");
        (output.status.code(), text(&output.stderr))
    };
    // what few times need is little
    let (code, stderr) = solve("0,1e5");
    assert_eq!(code, Some(0), "{stderr}");
    let (code, stderr) = solve("0:1e5:60001");
    assert_eq!(code, Some(3), "{stderr}");
    assert!(stderr.contains("no memory for more"), "{stderr}");
}
