//! Textbook systems derived by hand in several coordinates, right and wrong: a right one is never called
//! wrong, nor a wrong one right. Scenes and derivations are in `textbook/`.

use std::fs::read_to_string;

use review::{Asked, Verdict, review};
use scene::Scene;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/textbook/");

#[test]
fn derivations_of_textbooks_are_judged() {
    let text = read_to_string(format!("{FOLDER}derivations.txt")).expect("derivations");
    let (mut right, mut wrong, mut named) = (0, 0, 0);
    for case in text.split("\n== ").skip(1) {
        let (head, theirs) = case.split_once('\n').expect("a derivation");
        let [scene, verdict, what] = head.splitn(3, ", ").collect::<Vec<_>>()[..] else { panic!("{head}") };
        let own = read_to_string(format!("{FOLDER}{scene}.toml"));
        let own = own.map(|text| Scene::parse(scene, &text).unwrap_or_else(|e| panic!("{e}")));
        let own = own.unwrap_or_else(|_| scene::catalogue::find(scene, &[]).expect("built in"));
        let (wheres, theirs): (Vec<&str>, Vec<&str>) = theirs.lines().partition(|line| line.starts_with("where "));
        let wheres = wheres.iter().map(|line| line["where ".len()..].to_owned()).collect();
        let found = review(&own, "theirs", &theirs.join("\n"), &Asked { wheres, ..Asked::default() });
        let found = found.unwrap_or_else(|e| panic!("{scene}, {what}: {e}"));
        let expected = match verdict {
            "right" => Verdict::Right,
            "wrong" => Verdict::Wrong,
            _ => Verdict::Undecided,
        };
        assert_eq!(found.verdict, expected, "{scene}, {what}: {found:?}");
        right += usize::from(verdict == "right");
        wrong += usize::from(verdict == "wrong");
        named += usize::from(!found.explanations.is_empty());
        if verdict == "wrong" {
            println!("{scene}, {what}: {:?}", found.explanations.first());
        }
        // an L that is zero explains everything, and is no reading
        let all = |words: &String| words.ends_with("is missing in L, wherever it stands in T");
        assert!(!found.explanations.iter().any(|words| words.iter().any(all)), "{scene}, {what}: {found:?}");
    }
    assert_eq!((right, wrong, named), (63, 52, 46), "right, wrong, and wrong with a name");
}
