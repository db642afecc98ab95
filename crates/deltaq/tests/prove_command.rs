//! `deltaq prove`: certificates, and the reason where there is none.

use std::path::Path;

use serde_json::{Value, json};

use crate::support::{answer, refused};

#[test]
fn a_no_is_proved_in_a_certificate() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("certificate.json").display().to_string();
    let told = answer(&["prove", "sledge", "--set", "x=0.25", "--out", &path], 0).0;
    assert!(told.contains("proved (order 1)") && told.contains(&path), "{told}");
    let certificate = std::fs::read_to_string(&path).expect("a certificate");
    let value: Value = serde_json::from_str(&certificate).expect("JSON");
    let (mut found, known) = (
        value.as_object().expect("an object").keys().map(String::as_str).collect::<Vec<_>>(),
        "schema scene digest almost_every_start prime unity exponents roots order rows minor divided_by set \
         completed motion reactions"
            .split(' ')
            .collect::<Vec<_>>(),
    );
    found.sort_by_key(|key| known.iter().position(|name| name == key));
    assert_eq!(found, known);
    let scene = &value["scene"];
    assert_eq!((&value["set"]["x"], &scene["positions"]["x"]), (&json!("0.25"), &json!("1/4")));
    assert_eq!(scene["constraints"], json!(["y'*cos(phi) - x'*sin(phi)"]));
    assert_eq!(scene["velocities"], json!({ "phi'": "1.1", "x'": "cos(phi)/2" }));
    assert_eq!(answer(&["prove", "sledge", "--set", "x=0.25", "--out", "-"], 0).0, certificate);
    let told = answer(&["prove", "sledge", "--out", &path, "--format", "json"], 0).0;
    assert_eq!(serde_json::from_str::<Value>(&told).expect("JSON")["answer"], "none");
}

#[test]
fn without_a_certificate_there_is_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    let path = file("certificate.json");
    let (told, complaint) = answer(&["prove", "heisenberg", "--out", &path, "--format", "json"], 3);
    assert!(complaint.contains("no certificate for heisenberg") && complaint.contains("an identity"), "{complaint}");
    assert_eq!(serde_json::from_str::<Value>(&told).expect("JSON")["answer"], "some");
    let (told, complaint) = answer(&["prove", "turntable", "--set", "x=0.6", "--set", "psi'=0.7", "--out", "-"], 3);
    assert!(told.is_empty() && complaint.contains("0.048"), "{told}{complaint}");
    let (_, complaint) = answer(&["prove", "planar-body", "--out", "-"], 3);
    assert!(complaint.contains("nothing is constrained"), "{complaint}");
    let scene = include_str!("../../scene/scenes/particle.toml").replace("z'^2)/2\"", "z'^2)/2 - x*log(2 + x)\"");
    std::fs::write(file("logarithm.toml"), scene).expect("written");
    let (_, complaint) = answer(&["prove", &file("logarithm.toml"), "--out", &path], 3);
    assert!(complaint.contains("a logarithm is taken at the start"), "{complaint}");
    assert!(!Path::new(&path).exists());
    std::fs::write(file("mine"), "").expect("written");
    refused(&["prove", "sledge", "--out", &file("mine/c.json")], &["cannot create", "mine"]);
}

#[test]
fn a_projection_that_moves_nothing_leaves_numbers_exact() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sledge.toml").display().to_string();
    let sledge = include_str!("../../scene/scenes/sledge.toml");
    let projected = |velocities: &str| {
        let start = format!("[start]\nproject = true\n[start.velocities]\n{velocities}");
        std::fs::write(&file, sledge.replacen("[start.velocities]\n", &start, 1)).expect("written");
    };
    projected("");
    assert!(answer(&["prove", &file, "--out", "-"], 0).0.contains("\"order\": 1"));
    projected("\"y'\" = 5\n");
    let (_, complaint) = answer(&["prove", &file, "--out", "-"], 3);
    assert!(complaint.contains("but projected ones"), "{complaint}");
}

#[test]
fn a_scene_that_is_proved_is_plain() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("disc.toml").display().to_string();
    std::fs::write(&file, include_str!("../src/template.toml")).expect("written");
    let plain = |arguments: &[&str]| -> Value {
        let told = answer(&[&["prove", &file, "--out", "-"], arguments].concat(), 0).0;
        serde_json::from_str::<Value>(&told).expect("JSON")["scene"].take()
    };
    let scene = plain(&[]);
    let formulas = format!("{} {}", scene["lagrangian"], scene["constraints"]);
    assert!(["centre", "body", "slip", "rotation", "dot"].iter().all(|name| !formulas.contains(name)), "{formulas}");
    assert_eq!(scene["parameters"], json!({ "a": "1/2", "g": "9.81", "m": "1", "slope": "pi/30" }));
    // what the constraints supply is left to them; elsewhere the start has whole numbers
    let anywhere = plain(&["--almost-every"]);
    assert_eq!(anywhere["lagrangian"], scene["lagrangian"]);
    for start in [&scene, &anywhere] {
        let velocities = start["velocities"].as_object().expect("an object");
        assert_eq!(velocities.len(), 3, "{velocities:?}");
    }
    assert!(
        anywhere["positions"]
            .as_object()
            .expect("an object")
            .values()
            .all(|x| x.as_str().is_some_and(|x| x.parse::<i64>().is_ok()))
    );
}

#[test]
fn what_has_no_text_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sledge.toml").display().to_string();
    let sledge = include_str!("../../scene/scenes/sledge.toml");
    let told = answer(&["prove", "sledge", "--set", "phi=pi/3 + 0.1", "--out", "-"], 0).0;
    let certificate: Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!(certificate["set"], json!({ "phi": "pi/3 + 0.1" }));
    assert_eq!(certificate["scene"]["positions"]["phi"], "1/10 + 1*pi/3");
    let turned =
        sledge.replace("rotation(y, alpha)\"\n\n[body.sledge", "rotation(y, alpha + pi/3 + 0.1)\"\n\n[body.sledge");
    assert_ne!(turned, sledge);
    std::fs::write(&file, turned).expect("written");
    let (_, complaint) = answer(&["prove", &file, "--out", "-"], 3);
    assert!(complaint.contains("a sum of a fraction and a multiple of pi"), "{complaint}");
}

#[test]
fn forces_act_in_what_is_compared_and_proved() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pushed.toml").display().to_string();
    let particle = include_str!("../../scene/scenes/particle.toml");
    let pushed = particle.replace("\n[start", "\nforces = { x = \"-x'*z\" }\n[start");
    let friction = include_str!("../../scene/classics/sledge-with-friction.toml");
    for text in [pushed.as_str(), friction] {
        assert!(text.contains("forces ="), "{text}");
        std::fs::write(&file, text).expect("written");
        let compared = answer(&["compare", &file], 0).0;
        assert!(!compared.contains("no motion"), "{compared}");
        for formulation in ["chetaev", "vakonomic", "removed-constraint"] {
            answer(&["solve", &file, "--formulation", formulation], 0);
        }
    }
    let (_, complaint) = answer(&["prove", &file, "--out", "-"], 3);
    assert!(complaint.contains("nothing is constrained"), "{complaint}");
    std::fs::write(&file, &pushed).expect("written");
    let value: Value = serde_json::from_str(&answer(&["prove", &file, "--out", "-"], 0).0).expect("JSON");
    assert_eq!(value["scene"]["forces"], json!({ "x": "-x'*z" }));
}

#[test]
fn orders_are_written_as_far_as_they_are_proved() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("flat.toml").display().to_string();
    let particle = include_str!("../../scene/scenes/particle.toml");
    let flat = particle
        .replace("z' - y*x'", "z' - (y + 1)^4*x'")
        .replace("[removal", "[old")
        .split("[old")
        .next()
        .map(|head| format!("{head}[run]\nduration = 1\n"));
    std::fs::write(&file, flat.expect("a scene")).expect("written");
    let told = answer(&["prove", &file, "--out", "-"], 0).0;
    let certificate: Value = serde_json::from_str(&told).expect("JSON");
    assert_eq!(certificate["order"], 7);
    let motion = certificate["motion"].as_object().expect("an object");
    assert!(motion.values().all(|series| series.as_array().is_some_and(|series| series.len() == 10)));
}

#[test]
fn the_words_say_what_is_proved_and_what_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("particle.toml").display().to_string();
    let out = folder.path().join("certificate.json").display().to_string();
    let particle = |constraint: &str, x: &str| {
        let scene = include_str!("../../scene/scenes/particle.toml");
        let scene = scene.replace("z' - y*x'", constraint).replace("x = { unit = \"m\", start = 0", x);
        // its removal is for another constraint
        let scene = scene.split("[removal").next().map(|head| format!("{head}[run]\nduration = 1\n")).expect("a head");
        assert!(scene.contains(constraint) && scene.contains(x), "{scene}");
        std::fs::write(&path, scene).expect("written");
    };
    particle("z' - t^6*y*x'", "x = { unit = \"m\", start = 0");
    assert!(answer(&["prove", &path, "--out", &out], 0).0.contains("proved (order 11)"));
    particle("z' - (x - sqrt(x^2))*y'", "x = { unit = \"m\", start = 1");
    let complaint = answer(&["prove", &path, "--out", &out], 3).1;
    assert!(complaint.contains("at random starts of the branch of this start"), "{complaint}");
    particle("z' - (x - sqrt(x^2))*y'", "x = { unit = \"m\", start = -1");
    let told = answer(&["prove", &path, "--almost-every", "--out", &out], 0).0;
    assert!(told.contains("from almost every start of the branch of this start: proved"), "{told}");
    let told = answer(&["prove", &path, "--out", &out, "--format", "json"], 0).0;
    assert_eq!(serde_json::from_str::<Value>(&told).expect("JSON")["domain"], "this start");
    let complaint = answer(&["prove", "disc", "--out", &out], 3).1;
    assert!(complaint.contains("an identity, (-m*x', -m*y'), for all starts: proved"), "{complaint}");
    let complaint = answer(&["prove", "disc", "--set", "phi=1.0471975511965976", "--out", &out], 3).1;
    assert!(complaint.contains("write it as a formula"), "{complaint}");
    let certificate = answer(&["prove", "sledge", "--set", "phi=pi/3", "--out", "-"], 0).0;
    assert_eq!(serde_json::from_str::<Value>(&certificate).expect("JSON")["set"]["phi"], "pi/3");
}
