//! `deltaq explore`: the page, and the scene in it.

use serde_json::{Value, json};

use crate::support::{answer, refused};

/// The scene that a page opens with.
fn chosen(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"chosen\">").expect("a place for the scene");
    serde_json::from_str(rest.split("</script>").next().unwrap_or_default()).expect("JSON")
}

#[test]
fn a_page_opens_with_the_scene_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (out, own) = (path("page.html"), path("own.toml"));
    let page = |arguments: &[&str]| {
        let told = answer(&[&["explore", "--out", &out], arguments].concat(), 0).0;
        assert!(told.starts_with(&out), "{told}");
        std::fs::read_to_string(&out).expect("the page")
    };
    let plain = page(&[]);
    assert_eq!(chosen(&plain), Value::Null);
    assert!(plain.len() < 4_000_000, "{} bytes", plain.len());
    assert_eq!(chosen(&page(&["disc"])), json!({ "name": "disc", "text": null, "set": {} }));
    let set = ["disc", "--set", "m=2", "--set", "phi=pi/2"];
    assert_eq!(chosen(&page(&set))["set"], json!({ "m": 2.0, "phi": std::f64::consts::FRAC_PI_2 }));
    refused(&["explore", "disc", "--set", "mm=2", "--out", &out], &["`mm`"]);
    refused(&["explore", "--set", "m=2", "--out", &out], &["--set needs a scene"]);
    // whatever the text, it stays in its place
    let text = include_str!("../../scene/scenes/bowl.toml");
    let title = text.lines().find(|line| line.starts_with("title")).expect("a title");
    let text = text.replace(title, "title = \"</script><b>\"");
    std::fs::write(&own, &text).expect("a file");
    assert_eq!(chosen(&page(&[&own])), json!({ "name": own, "text": text, "set": {} }));
    assert_eq!(chosen(&answer(&["explore", &own, "--out", "-"], 0).0)["name"], own);
    // of no scene and of a faulty one there is no page
    for (text, said) in [("", "title"), ("title = \"</script><b>\"\n", "coordinates"), ("title = ", "expected")] {
        std::fs::write(&own, text).expect("a file");
        refused(&["explore", &own, "--out", &path("none.html")], &["own.toml", said]);
        assert!(!folder.path().join("none.html").exists());
    }
    refused(&["explore", "no-such-scene", "--out", &out], &["neither a file nor one of the built-in scenes"]);
}
