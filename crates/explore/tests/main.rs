//! The answers, against the library.

mod arrows;
mod further;
mod texts;

use comparison::compare_unfitted;
use comparison::words::Headline;
use explore::{Answer, Explorer};
use motion::{Settings, choices, solve_choice};
use scene::Scene;
use serde_json::{Value, json};

const SLEDGE: &str = include_str!("../../scene/scenes/sledge.toml");

fn ask(question: Value) -> (Value, Vec<f64>) {
    ask_again(&mut Explorer::default(), question)
}

fn ask_again(explorer: &mut Explorer, question: Value) -> (Value, Vec<f64>) {
    let Answer { text, numbers } = explorer.answer(&question.to_string());
    (serde_json::from_str(&text).expect("an answer is JSON"), numbers)
}

fn place(object: &Value, name: &str) -> usize {
    object[name].as_u64().unwrap_or_else(|| panic!("{name} in {object}")) as usize
}

/// The coordinates in a row of a motion.
fn coordinates<'a>(motion: &Value, numbers: &'a [f64], row: usize, count: usize) -> &'a [f64] {
    let at = place(motion, "from") + row * place(motion, "width");
    &numbers[at + 1..at + 1 + count]
}

#[test]
fn motions_are_those_of_the_library() {
    let labels = ["Chetaev", "vakonomic", "removed constraint (arc-length)"];
    let question = |glance: bool| {
        json!({ "ask": "motions", "name": "sledge", "text": SLEDGE, "set": { "phi": 0.5, "mu0_1": 0.25, "P0_y": 1.0 },
                "motions": labels, "steps": 50, "glance": glance })
    };
    let (all, numbers) = ask(question(false));
    let (glance, coarse) = ask(question(true));
    let set = [("phi".to_string(), 0.5), ("mu0_1".to_string(), 0.25)];
    let scene = Scene::parse_with("sledge", SLEDGE, &set).unwrap();
    for (i, label) in labels.iter().enumerate() {
        let mut choice = choices(&scene).into_iter().find(|choice| choice.label == *label).unwrap();
        if choice.removal.is_some() {
            choice.constants = mechanics::ConstantsRule::Given(vec![0.0, 1.0]);
        }
        let mut motion = solve_choice(&scene, &choice, &Settings::default()).unwrap();
        assert_eq!(place(&all["motions"][i], "rows"), 51, "{label}");
        let estimate = motion::error_estimate(&mut motion, motion::setting(&scene)).unwrap();
        assert_eq!(all["motions"][i]["error"], estimate.absolute, "{label}");
        assert!(glance["motions"][i]["error"].is_null());
        for row in 0..=50 {
            let q = motion.at(row as f64 / 5.0).unwrap().coordinates;
            assert_eq!(coordinates(&all["motions"][i], &numbers, row, 3), q, "{label}");
            let near = coordinates(&glance["motions"][i], &coarse, row, 3);
            assert!(near.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-5), "{label}: {near:?} {q:?}");
        }
    }
    for (name, gaps, numbers) in [("two runs", &all["gaps"], &numbers), ("one run", &glance["gaps"], &coarse)] {
        let gap = &gaps[0];
        assert_eq!((place(gap, "first"), place(gap, "second")), (0, 1), "{name}");
        let rows = numbers[place(gap, "from")..].chunks_exact(3).take(place(gap, "rows"));
        let largest = rows.map(|row| row[1]).fold(0.0, f64::max);
        assert!(largest > 1.0, "{name}: {largest}");
    }
    assert_eq!(all["gaps"][0]["verdict"], "different");
    // a gap at a glance is that of the rows of its two motions
    let gap = &glance["gaps"][0];
    let mut metric = motion::Metric::new(&scene.system).unwrap();
    for (row, numbers) in coarse[place(gap, "from")..].chunks_exact(3).take(place(gap, "rows")).enumerate() {
        let motion = |i: usize, count: usize| coordinates(&glance["motions"][i], &coarse, row, count);
        let (q, v) = motion(0, 6).split_at(3);
        assert_eq!(numbers[..2], [row as f64 / 5.0, metric.distance(row as f64 / 5.0, q, v, motion(1, 3))]);
    }
}

#[test]
fn a_costate_is_that_of_one_removal() {
    let labels = ["removed constraint (arc-length)", "removed constraint (along-x)"];
    let constants = |set: Value| {
        let question =
            json!({ "ask": "motions", "name": "sledge", "text": SLEDGE, "set": set, "motions": labels, "steps": 4 });
        let (answer, _) = ask(question);
        labels.map(|label| {
            let motions = answer["motions"].as_array().unwrap();
            motions.iter().find(|motion| motion["label"] == label).unwrap()["constants"].clone()
        })
    };
    let free = constants(json!({}));
    let set = constants(json!({ "P0_y@removed constraint (along-x)": 1.5 }));
    assert_eq!(set[0], free[0]);
    assert_eq!(set[1], json!([{ "name": "P0_y", "value": 1.5 }]));
    let both = constants(json!({ "P0_y": 1.5 }));
    assert_eq!((&both[0][1]["value"], &both[1]), (&json!(1.5), &set[1]));
}

#[test]
fn kappa_and_what_can_be_varied() {
    let (free, _) = ask(json!({ "ask": "scene", "name": "sledge", "text": SLEDGE }));
    let names = |answer: &Value| -> Vec<String> {
        answer["controls"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap().to_owned()).collect()
    };
    let expected = "g alpha k x y phi x' phi' mu0_1 \
                    P0_x@removed constraint (arc-length) P0_y@removed constraint (arc-length) \
                    P0_y@removed constraint (along-x) \
                    P0_x@removed constraint (quasi-velocities) P0_y@removed constraint (quasi-velocities) kappa duration";
    assert_eq!(names(&free).join(" "), expected);
    let labels = |answer: &Value| -> Vec<String> {
        answer["motions"].as_array().unwrap().iter().map(|m| m["label"].as_str().unwrap().to_owned()).collect()
    };
    assert!(!labels(&free).contains(&"between, κ".to_string()));
    for control in free["controls"].as_array().unwrap() {
        // removals of the scene start from costates that a search finds, the automatic one from zero
        let is_found = control["kind"] == "costate" && control["motion"] != "removed constraint (quasi-velocities)";
        assert_eq!(control["value"].is_null(), is_found, "{control}");
        let [low, high] = ["low", "high"].map(|name| control[name].as_f64().unwrap());
        let value = control["value"].as_f64().unwrap_or(low);
        assert!(low <= value && value <= high && low < high, "{control}");
    }
    let bounds = |name: &str| -> [f64; 2] {
        let control = free["controls"].as_array().unwrap().iter().find(|c| c["name"] == name).unwrap();
        ["low", "high"].map(|bound| control[bound].as_f64().unwrap())
    };
    let pi = std::f64::consts::PI;
    assert_eq!((bounds("phi"), bounds("x")), ([0.3 - pi, 0.3 + pi], [-1.0, 1.0]));
    assert_eq!((bounds("phi'"), bounds("mu0_1")), ([1.1 - 2.2, 1.1 + 2.2], [-2.0, 2.0]));
    assert_eq!((bounds("kappa"), bounds("duration")), ([0.0, 20.0], [1.0, 30.0]));
    let set = json!({ "kappa": 2.0 });
    let (with, _) = ask(json!({ "ask": "scene", "name": "sledge", "text": SLEDGE, "set": set }));
    assert_eq!(names(&with).join(" "), expected);
    assert!(labels(&with).contains(&"between, κ".to_string()));
    // the given velocity is that of the text, 0.5 cos(phi)
    let speed = free["controls"].as_array().unwrap().iter().find(|c| c["name"] == "x'").unwrap();
    assert_eq!((speed["value"].as_f64(), &speed["unit"]), (Some(0.5 * 0.3_f64.cos()), &json!("m/s")));
}

#[test]
fn a_faulty_text_is_answered_as_the_reader_does() {
    let text = SLEDGE.replace("alpha = 0.4", "").replace("k^2", "k^");
    let (answer, numbers) = ask(json!({ "ask": "motions", "name": "own", "text": text, "steps": 10 }));
    let error = Scene::parse("own", &text).err().unwrap();
    assert_eq!(answer["message"], error.to_string());
    let faults = answer["faults"].as_array().unwrap();
    assert!(faults.len() == 1 + error.also.len() && faults.len() > 1 && numbers.is_empty(), "{answer}");
    assert_eq!((place(&faults[0], "line"), place(&faults[0], "column")), (error.line, error.column));
    let (answer, _) = ask(json!({ "ask": "everything" }));
    assert!(answer["refused"].as_str().unwrap().starts_with("the question cannot be read"), "{answer}");
}

#[test]
fn words_are_those_of_a_comparison() {
    let scene = Scene::parse("sledge", SLEDGE).unwrap();
    // removals are in the graph of the scene
    let choices = choices(&scene);
    let comparison = compare_unfitted(scene, choices, Vec::new(), &Settings::default()).unwrap();
    let (answer, _) = ask(json!({ "ask": "decision", "name": "sledge", "text": SLEDGE }));
    let Headline { verdict, why, sure, which } = Headline::of(&comparison);
    assert_eq!([&answer["verdict"], &answer["why"], &answer["sure"]], [&verdict, &why, &sure]);
    assert_eq!(answer["whose"], which);
    let pairs = answer["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), comparison.pairs.len());
    for (told, pair) in pairs.iter().zip(&comparison.pairs) {
        let label = |run: usize| comparison.runs[run].choice.label.as_str();
        assert_eq!((&told["first"], &told["second"]), (&json!(label(pair.first)), &json!(label(pair.second))));
        assert_eq!(told["verdict"], pair.gap.verdict.word());
        assert_eq!((&told["largest"], &told["certain"]), (&json!(pair.gap.largest), &json!(pair.gap.certain_from)));
        assert_eq!(told["unit"], "m", "unit mass: as in the kinetic metric");
        if let Some(passes) = pair.gap.passes[1] {
            assert!((told["visible"].as_f64().unwrap() / passes - 1.0).abs() < 2e-3, "{told}, not {passes}");
        }
        let by: Vec<_> = told["coordinates"].as_array().unwrap().iter().map(|c| c["by"].clone()).collect();
        assert_eq!(json!(by), json!(pair.gap.largest_by_coordinate));
    }
    assert!(
        answer["sentence"].as_str().unwrap().contains("diverge because the constraint is nonholonomic"),
        "{answer}"
    );
    assert_eq!(answer["decisions"][0]["answer"], "none, proved");
    assert!(sure.contains("No μ₀ makes the vakonomic motion Chetaev's: proved"), "{sure}");
    let (answer, _) = ask(json!({ "ask": "equations", "name": "sledge", "text": SLEDGE, "motions": ["Chetaev"] }));
    assert!(answer["motions"][0]["equations"].as_str().unwrap().contains("```math"), "{answer}");
}

/// The text with numbers set is that of a scene with these numbers.
#[test]
fn a_text_has_the_numbers_that_are_set() {
    let (answer, _) =
        ask(json!({ "ask": "text", "name": "s", "text": SLEDGE, "set": { "phi": 0.5, "g": 3, "kappa": 2 } }));
    let scene = Scene::parse("s", answer["text"].as_str().unwrap()).unwrap();
    let values: Vec<f64> = scene.system.parameters.iter().map(|p| p.value).collect();
    assert_eq!((scene.start.q[2], &values[..]), (0.5, &[3.0, 0.4, 0.7, 2.0][..]));
}

#[test]
fn bodies_and_a_point_where_a_scene_has_none() {
    let question =
        |text: &str| json!({ "ask": "motions", "name": "s", "text": text, "motions": ["Chetaev"], "steps": 4 });
    let without = SLEDGE.split("[view").next().unwrap().replace("shape = \"blade\"\nsize = [\"2*k\", 0.5]\n", "");
    let (answer, numbers) = ask(question(&without));
    let bodies = answer["bodies"].as_array().unwrap();
    assert_eq!((bodies.len(), &bodies[0]["kind"]), (1, &json!("point")));
    let motion = &answer["motions"][0];
    let q = coordinates(motion, &numbers, 4, 3).to_vec();
    let end = place(motion, "from") + 5 * place(motion, "width");
    assert_eq!(numbers[end - 12..end - 9], [q[0], q[1], 0.0]);
    assert_eq!(numbers[end - 9..end], [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);

    let (answer, numbers) = ask(question(SLEDGE));
    let (motion, ground) = (&answer["motions"][0], &answer["ground"]);
    assert_eq!((place(ground, "rows"), place(ground, "width")), (1, 12));
    assert_eq!([&answer["bodies"][0]["moved"], &answer["bodies"][1]["moved"]], [false, true]);
    let q = coordinates(motion, &numbers, 4, 3).to_vec();
    let end = place(motion, "from") + 5 * place(motion, "width");
    // the blade's y axis is level, the slope 0.4 about y
    assert_eq!(numbers[end - 6..end - 4], [q[2].sin(), q[2].cos()]);
    assert!((numbers[end - 12] - 0.4_f64.cos() * q[0]).abs() < 1e-14);
}

/// The sledge in closed form: its place is R (x, y, 0), R the turn of the slope by 0.4 about y.
#[test]
fn a_hand_holds_the_start() {
    let question = |set: Value| json!({ "ask": "motions", "name": "s", "text": SLEDGE, "motions": ["Chetaev"], "steps": 4, "grips": true, "set": set });
    let (c, s) = (0.4_f64.cos(), 0.4_f64.sin());
    let place = |x: f64, y: f64| [c * x, y, -s * x];
    let near = |found: &Value, expected: [[f64; 3]; 3]| {
        let found: Vec<f64> = found.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        let off = found.iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(found.len() == 9 && off < 1e-5, "{found:?}, not {expected:?}");
    };
    let (answer, _) = ask(question(json!({ "x": 2.0, "phi": 0.5 })));
    let grips = &answer["grips"];
    // x' = 0.5 cos(phi), and the constraint supplies y'
    let (cos, sin) = (0.5_f64.cos(), 0.5_f64.sin());
    near(&grips["here"], [place(2.0, 0.0), place(cos, sin), place(0.5 * cos, 0.5 * sin)]);
    let numbers = grips["numbers"].as_array().unwrap();
    let names: Vec<&str> = numbers.iter().map(|number| number["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["x", "y", "phi", "x'", "phi'"]);
    let zero = [0.0; 3];
    near(&numbers[0]["by"], [place(1.0, 0.0), zero, zero]);
    near(&numbers[1]["by"], [place(0.0, 1.0), zero, zero]);
    near(&numbers[2]["by"], [zero, place(-sin, cos), place(-0.5 * sin, 0.5 * cos)]);
    near(&numbers[3]["by"], [zero, zero, place(1.0, sin / cos)]);
    near(&numbers[4]["by"], [zero, zero, zero]);
    // unasked there are none
    assert_eq!(ask(json!({ "ask": "motions", "name": "s", "text": SLEDGE, "steps": 4 })).0["grips"], Value::Null);
}

/// What is kept while sliders move, against motions in full: every scene, all its numbers moved at once.
#[test]
fn motions_at_a_glance_follow_sliders() {
    // of the largest coordinate
    const NEAR: f64 = 1e-3;
    // where two runs differ by more, a motion makes much of the tolerance at a glance, too
    const CALM: f64 = 1e-9;
    let mut compared = 0;
    for (name, text) in scenes() {
        let (scene, _) = ask(json!({ "ask": "scene", "name": name, "text": text }));
        let count = scene["coordinates"].as_array().unwrap().len();
        let of_removals = |motion: &&Value| motion["formulation"] == "removed-constraint";
        let removed = &scene["motions"].as_array().unwrap().iter().find(of_removals).unwrap()["label"];
        let question = |part: f64, glance: bool| {
            json!({ "ask": "motions", "name": name, "text": text, "set": moved(&scene, part),
                    "motions": ["Chetaev", "vakonomic", removed], "steps": 20, "glance": glance })
        };
        let mut explorer = Explorer::default();
        ask_again(&mut explorer, question(0.02, true));
        let (near, coarse) = ask_again(&mut explorer, question(0.04, true));
        let (full, numbers) = ask(question(0.04, false));
        assert_eq!(near["message"], full["message"], "{name}");
        let Some(motions) = near["motions"].as_array() else { continue };
        for (i, near) in motions.iter().enumerate() {
            let full = &full["motions"][i];
            assert_eq!(near["refused"], full["refused"], "{name}, {}", near["label"]);
            if full["status"] != "completed" || full["error"].as_f64().unwrap() > CALM {
                continue;
            }
            assert_eq!(place(near, "rows"), 21, "{name}, {}", near["label"]);
            for row in 0..=20 {
                let [a, b] = [(near, &coarse), (full, &numbers)].map(|(m, n)| coordinates(m, n, row, count));
                let limit = NEAR * b.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
                assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < limit), "{name}, {}: {a:?} {b:?}", near["label"]);
            }
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
}

/// Equations that are kept while a slider moves have the terms that are zero to the last digit where it was.
#[test]
fn sliders_keep_what_begins_elsewhere() {
    let text = "title = \"Switched\"\n[parameters]\nX = 40\nk = 0\n[coordinates]\nx = { start = 0 }\ny = { start = 0 }\n\
                z = { start = 0 }\nw = { start = 0 }\n[system]\n\
                lagrangian = \"(x'^2 + y'^2 + z'^2 + w'^2)/2 + 0.3*z*x - 0.2*w\"\n\
                constraints = [\"z' - y'\", \"(2 + cos(x))*w' - z' + y' - y'*(1 + tanh(50*(x - X)))/2 - k*x'\"]\n\
                [start.velocities]\n\"x'\" = 4\n\"y'\" = 1\n[run]\nduration = 3\n";
    let (scene, _) = ask(json!({ "ask": "scene", "name": "switched", "text": text }));
    let labels: Vec<&Value> = scene["motions"].as_array().unwrap().iter().map(|motion| &motion["label"]).collect();
    let question = |[place, k, start]: [f64; 3], glance: bool| {
        let set = json!({ "X": place, "k": k, "x": start });
        json!({ "ask": "motions", "name": "switched", "text": text, "set": set, "motions": labels, "steps": 20,
                "glance": glance })
    };
    let mut explorer = Explorer::default();
    ask_again(&mut explorer, question([40.0, 0.0, 0.0], true));
    let mut compared = 0;
    // the switch on the way, from a start beyond it, and with a term whose factor was zero
    for at in [[5.0, 0.0, 0.0], [5.0, 0.0, 9.0], [5.0, 0.5, 0.0], [40.0, 0.5, 0.0]] {
        let ((near, coarse), (full, numbers)) =
            (ask_again(&mut explorer, question(at, true)), ask(question(at, false)));
        for (i, near) in near["motions"].as_array().unwrap().iter().enumerate() {
            let full = &full["motions"][i];
            assert_eq!((&near["status"], &near["refused"]), (&full["status"], &full["refused"]), "{at:?}, {near}");
            if full["status"] == "completed" {
                let [a, b] = [(near, &coarse), (full, &numbers)].map(|(m, n)| coordinates(m, n, 20, 4).to_vec());
                assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-3), "{at:?}, {}: {a:?} {b:?}", near["label"]);
                compared += 1;
            }
        }
    }
    assert!(compared >= 16, "{compared}");
}

/// All numbers of a scene that can be set, moved by so large a part of their sliders, and a tenth as long.
fn moved(scene: &Value, part: f64) -> serde_json::Map<String, Value> {
    let controls = scene["controls"].as_array().unwrap().iter().filter(|control| control["kind"] != "kappa");
    let set = |control: &Value| {
        // a costate that a search finds stands nowhere before
        let [value, low, high] = ["value", "low", "high"].map(|name| control[name].as_f64().unwrap_or_default());
        let shortened = if control["name"] == "duration" { 0.1 } else { 1.0 };
        (control["name"].as_str().unwrap().to_owned(), json!(shortened * value + part * (high - low)))
    };
    controls.map(set).collect()
}

/// Names and texts of all scenes.
fn scenes() -> Vec<(String, String)> {
    let folders = ["scenes", "classics"].map(|name| format!("{}/../scene/{name}", env!("CARGO_MANIFEST_DIR")));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()).map(|file| file.unwrap().path());
    let scenes = files.filter(|file| file.extension().is_some_and(|ending| ending == "toml"));
    let text = |file: &std::path::PathBuf| std::fs::read_to_string(file).unwrap();
    scenes.map(|file| (file.file_stem().unwrap().to_string_lossy().into_owned(), text(&file))).collect()
}

/// An explorer that was asked about other texts and other parameters answers as one that is new.
#[test]
fn what_is_kept_belongs_to_its_text_and_its_parameters() {
    let other = format!("{SLEDGE}\n[system]\nlagrangian = \"y'^2\"\n");
    assert_ne!(other, SLEDGE);
    let question = |text: &str, set: Value| {
        json!({ "ask": "motions", "name": "sledge", "text": text, "set": set, "motions": ["Chetaev", "vakonomic"],
                "steps": 20, "glance": true })
    };
    let mut explorer = Explorer::default();
    let turns = [
        question(SLEDGE, json!({ "duration": 3, "g": 9.0 })),
        question(&other, json!({ "duration": 3, "g": 9.0 })),
        question(&other, json!({ "duration": 3, "g": 9.0, "k": 0.4 })),
        question(&other, json!({ "duration": 3, "k": 0.4 })),
        question(&other, json!({ "duration": 3, "alpha": 0.9 })),
        question(SLEDGE, json!({ "duration": 3, "alpha": 0.9 })),
        question(SLEDGE, json!({ "duration": 3, "alpha": 0.9, "phi": 1.0 })),
    ];
    let mut ends: Vec<Vec<f64>> = Vec::new();
    for turn in turns {
        let (kept, numbers) = ask_again(&mut explorer, turn.clone());
        let (new, anew) = ask(turn.clone());
        let [end, expected] =
            [(kept, numbers), (new, anew)].map(|(all, n)| coordinates(&all["motions"][1], &n, 20, 3).to_vec());
        assert!(end.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-3), "{end:?}, {expected:?}: {turn}");
        // and each is another motion
        assert!(ends.iter().all(|before| before.iter().zip(&end).any(|(a, b)| (a - b).abs() > 1e-2)), "{turn}");
        ends.push(end);
    }
}
