//! What the pictures of a scene show, and what they leave out.

use comparison::compare;
use motion::{Settings, choices};
use pages::pictures;

/// The picture of a kind of a built-in scene, if it is drawn.
fn picture(scene: &str, kind: &str) -> Option<String> {
    let scene = scene::catalogue::find(scene, &[]).expect("a scene");
    let (name, choices) = (scene.name.clone(), choices(&scene));
    let mut comparison = compare(scene, choices, Vec::new(), &Settings::default()).expect("compared");
    let files = pictures(&mut comparison).expect("pictures");
    files.into_iter().find(|file| file.path.ends_with(format!("{name}-{kind}.svg"))).map(|file| file.text)
}

#[test]
fn the_decided_member_of_the_family_lies_on_chetaevs_path() {
    let svg = picture("heisenberg", "path").expect("a path");
    for words in ["a dot every 1 s", "vakonomic, μ₀ from 0.8 to -0.4", "vakonomic, equal to Chetaev's: μ₀ = 0"] {
        assert!(svg.contains(words), "{words}");
    }
    // the second of its width is the curve, the first one its entry in the legend
    let drawn = |width: &str| {
        let line = svg.lines().filter(|line| line.contains(&format!("stroke-width=\"{width}\""))).nth(1);
        line.and_then(|line| line.split('"').nth(1)).map(str::to_owned)
    };
    assert!(drawn("5.4").is_some());
    assert_eq!(drawn("5.4"), drawn("2.2"));
}

#[test]
fn what_is_the_same_has_neither_gap_nor_path_of_its_own() {
    assert_eq!(picture("bowl", "gap"), None);
    assert_eq!(picture("bowl", "path"), None);
    assert!(picture("bowl", "coordinates").is_some());
}

#[test]
fn a_gap_is_drawn_from_where_it_is_certain() {
    let svg = picture("planar-body", "gap").expect("a gap");
    assert!(svg.contains("turning-frame), ∝ t") && !svg.contains("no points") && !svg.contains(">vakonomic<"));
    // the control alone is not drawn
    assert_eq!(picture("appell-hamel", "gap"), None);
}
