//! Which files are replaced, and how tables are written.

use program::{File, is_own, may_replace, write_all, write_one};

#[test]
fn exponents_in_tables_do_not_break() {
    let folder = tempfile::tempdir().unwrap();
    let page = "about 1e-6\n| 1e-6 at 5.2e-11; e-6, three-2, 2e-x |\n";
    write_all(folder.path(), &[File { path: "x.md".into(), text: page.into() }]).unwrap();
    let written = std::fs::read_to_string(folder.path().join("x.md")).unwrap();
    assert_eq!(written, "about 1e-6\n| 1e\u{2212}6 at 5.2e\u{2212}11; e-6, three-2, 2e-x |\n");
}

#[test]
fn only_files_of_deltaq_are_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let files = |text: &str| {
        [File { path: "a/x.md".into(), text: text.into() }, File { path: "y.svg".into(), text: text.into() }]
    };
    write_all(folder.path(), &files("1")).unwrap();
    write_all(folder.path(), &files("2")).unwrap();
    std::fs::write(at("z.md"), "mine").unwrap();
    let more = [&files("3")[..], &[File { path: "z.md".into(), text: "3".into() }]].concat();
    assert!(
        write_all(folder.path(), &more)
            .unwrap_err()
            .to_string()
            .contains("z.md is not of deltaq, as far as it and the list `.deltaq` tell")
    );
    let texts = ["a/x.md", "y.svg", "z.md"].map(|name| std::fs::read_to_string(at(name)).unwrap());
    assert_eq!(texts, ["2", "2", "mine"]);
    // what the main job wrote is its own
    std::fs::write(at("verdicts.json"), "{\n  \"schema\": \"deltaq/verdicts/1\",").unwrap();
    assert!(is_own(folder.path()));
    write_all(folder.path(), &more).unwrap();
    assert_eq!(std::fs::read_to_string(at("z.md")).unwrap(), "3");
    // one file
    std::fs::write(at("mine.json"), "{}").unwrap();
    assert!(write_one(&at("mine.json"), "{}").is_err());
    write_one(&at("ours.json"), "{\n  \"schema\": \"deltaq/certificate/2\",").unwrap();
    write_one(&at("ours.json"), "member,x").unwrap();
    write_one(&at("ours.json"), "").unwrap();
}

#[cfg(unix)]
#[test]
fn links_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("mine"), "member,").unwrap();
    for (name, to) in [("x.md", at("mine")), ("y.md", at("nothing"))] {
        std::os::unix::fs::symlink(to, at(name)).unwrap();
        let file = File { path: name.into(), text: "1".into() };
        for written in [write_all(folder.path(), &[file]), write_one(&at(name), "1"), may_replace(&at(name))] {
            assert!(written.unwrap_err().to_string().contains("is a link"));
        }
    }
    assert_eq!(std::fs::read_to_string(at("mine")).unwrap(), "member,");
    std::os::unix::fs::symlink("/dev/null", at("null")).unwrap();
    write_one(&at("null"), "1").unwrap();
}
