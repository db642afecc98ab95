//! `deltaq prove`: certificates, and the reason where there is none.

use std::path::Path;

use serde_json::Value;

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
        "schema prime i zeta N tau order rows minor divided_by set completed motion reactions"
            .split(' ')
            .collect::<Vec<_>>(),
    );
    found.sort_by_key(|key| known.iter().position(|name| name == key));
    assert_eq!(found, known);
    assert_eq!(value["set"]["x"], 0.25);
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
    let scene =
        include_str!("../../../validation/scenes/particle.toml").replace("z'^2)/2\"", "z'^2)/2 - x*log(2 + x)\"");
    std::fs::write(file("logarithm.toml"), scene).expect("written");
    let (_, complaint) = answer(&["prove", &file("logarithm.toml"), "--out", &path], 3);
    assert!(complaint.contains("a logarithm is taken at the start"), "{complaint}");
    assert!(!Path::new(&path).exists());
    refused(&["prove", "sledge", "--out", &file("no/such/folder")], &["cannot write", "no/such/folder"]);
}

#[test]
fn the_words_say_what_is_proved_and_what_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("particle.toml").display().to_string();
    let out = folder.path().join("certificate.json").display().to_string();
    let particle = |constraint: &str, x: &str| {
        let scene = include_str!("../../../validation/scenes/particle.toml");
        let scene = scene.replace("z' - y*x'", constraint).replace("x = { unit = \"m\", start = 0", x);
        assert!(scene.contains(constraint) && scene.contains(x), "{scene}");
        std::fs::write(&path, scene).expect("written");
    };
    particle("z' - t^6*y*x'", "x = { unit = \"m\", start = 0");
    assert!(answer(&["prove", &path, "--out", &out], 0).0.contains("proved (order 11)"));
    particle("z' - (x - sqrt(x^2))*y'", "x = { unit = \"m\", start = 20");
    let complaint = answer(&["prove", &path, "--out", &out], 3).1;
    assert!(complaint.contains("modulo two primes, near this start, which is no proof"), "{complaint}");
    let complaint = answer(&["prove", "disc", "--out", &out], 3).1;
    assert!(complaint.contains("an identity, (-m*x', -m*y'), for all starts: proved"), "{complaint}");
    let complaint = answer(&["prove", "disc", "--set", "phi=1.0471975511965976", "--out", &out], 3).1;
    assert!(complaint.contains("write it as a formula"), "{complaint}");
    let certificate = answer(&["prove", "sledge", "--set", "phi=pi/3", "--out", "-"], 0).0;
    assert_eq!(serde_json::from_str::<Value>(&certificate).expect("JSON")["set"]["phi"], "pi/3");
}
