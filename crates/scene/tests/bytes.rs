//! Nothing panics, whatever the text of a scene.

use proptest::prelude::*;
use scene::Scene;

const SCENES: [&str; 5] = [
    include_str!("../../../tests/tests/scenes/rattleback-by-vectors.toml"),
    include_str!("../../scene/scenes/sledge.toml"),
    include_str!("../../scene/scenes/appell-hamel.toml"),
    include_str!("../../scene/scenes/three-cylinders.toml"),
    include_str!("../../scene/scenes/velocity-pendulum.toml"),
];

/// What is put in, between blanks.
const PIECES: &str = "' \" \\ [ ] { } = nan -inf 1e400 0 -1 sin x' phi'' ^ ( ) / \n # é \0 t pi [removal]\n u , \"\"\" rotation( zxz \
                     .x .yz dot( cross( diag( c' R [x,y] ]' angular_velocity( step(";

fn piece(index: &prop::sample::Index) -> &'static str {
    let pieces: Vec<&str> = PIECES.split(' ').collect();
    pieces[index.index(pieces.len())]
}

/// A change of a text: at a place (fraction of its length), remove some characters and insert a piece.
fn change() -> impl Strategy<Value = (f64, usize, prop::sample::Index, bool)> {
    (0.0..1.0_f64, 0..12_usize, any::<prop::sample::Index>(), any::<bool>())
}

fn changed(text: &str, changes: &[(f64, usize, prop::sample::Index, bool)]) -> String {
    let mut characters: Vec<char> = text.chars().collect();
    for (place, removed, piece, insert) in changes {
        let start = (place * characters.len() as f64) as usize;
        let end = (start + removed).min(characters.len());
        let piece = if *insert { self::piece(piece) } else { "" };
        characters.splice(start..end, piece.chars());
    }
    characters.into_iter().collect()
}

/// Loads, and displays what comes out.
fn survive(text: &str) {
    match Scene::parse("scene", text) {
        Ok(scene) => {
            let written = scene.to_toml();
            assert!(Scene::parse("written", &written).is_ok(), "{written}");
        }
        Err(error) => {
            let shown = error.to_string();
            assert!(shown.starts_with("scene:"), "{shown}");
            assert!(error.line <= text.lines().count() + 1, "{shown}");
        }
    }
}

proptest! {
    // `PROPTEST_CASES=N` for more
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.max(400)))]

    #[test]
    fn changed_scenes(which in 0..SCENES.len(), changes in prop::collection::vec(change(), 1..4)) {
        survive(&changed(SCENES[which], &changes));
    }

    #[test]
    fn random_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        survive(&String::from_utf8_lossy(&bytes));
    }

    #[test]
    fn random_pieces(pieces in prop::collection::vec(any::<prop::sample::Index>(), 0..60)) {
        survive(&pieces.iter().map(piece).collect::<Vec<_>>().join(" "));
    }

    #[test]
    fn random_lines_of_scenes(lines in prop::collection::vec((0..SCENES.len(), any::<prop::sample::Index>()), 0..40)) {
        let line = |(scene, index): &(usize, prop::sample::Index)| {
            let all: Vec<&str> = SCENES[*scene].lines().collect();
            all[index.index(all.len())]
        };
        survive(&lines.iter().map(line).collect::<Vec<_>>().join("\n"));
    }
}

#[test]
fn bytes_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.toml");
    for byte in 0..=255_u8 {
        let mut bytes = SCENES[0].as_bytes().to_vec();
        bytes[usize::from(byte) * 4] = byte;
        std::fs::write(&path, &bytes).unwrap();
        if let Err(error) = Scene::load(&path) {
            assert!(!error.to_string().is_empty());
        }
    }
}

#[test]
fn deep_and_long_texts() {
    let base = |expression: &str| {
        format!(
            "title = \"a\"\n[coordinates]\nx = {{ start = 1 }}\n[system]\nlagrangian = \"{expression}\"\n\
             [start.velocities]\n\"x'\" = 1\n[run]\nduration = 1\n"
        )
    };
    survive(&base(&format!("{}x{}", "(".repeat(50_000), ")".repeat(50_000))));
    survive(&base(&"-".repeat(50_000)));
    survive(&base(&format!("{}x'", "x'^2 + ".repeat(20_000))));
    survive(&base(&"x'^".repeat(10_000)));
    survive(&"[".repeat(100_000));
    survive(&"a = {".repeat(20_000));
    survive(&"a.".repeat(20_000));
}
