//! What is said of broken scenes, to the letter: the sledge with one change each.
//!
//! `broken.txt` has the changes, `old => new`, each followed by the message, which begins with a bar.
//! `UPDATE=1` writes the messages anew; read them before they are committed.

use std::fmt::Write;
use std::path::Path;

use super::errors::SLEDGE;
use scene::Scene;

#[test]
fn messages_are_as_committed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken.txt");
    let committed = std::fs::read_to_string(&path).expect("broken.txt");
    let mut fresh = String::new();
    let mut count = 0;
    for change in committed.lines().filter(|line| !line.is_empty() && !line.starts_with('|')) {
        let (old, new) = change.split_once(" => ").expect(change);
        assert!(SLEDGE.contains(old), "{change}");
        let text = SLEDGE.replacen(old, &new.replace("\\n", "\n"), 1);
        let error = Scene::parse("sledge", &text).expect_err(change).to_string();
        count += 1;
        let _ = writeln!(fresh, "{change}");
        error.lines().for_each(|line| fresh += &format!("| {line}\n"));
        fresh.push('\n');
    }
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &fresh).expect("written");
        return;
    }
    assert!(count >= 100, "{count} broken scenes");
    for (fresh, committed) in fresh.lines().zip(committed.lines()) {
        assert_eq!(fresh, committed);
    }
    assert_eq!(fresh.trim_end(), committed.trim_end());
}
