//! Which files are replaced, and how tables are written.

use std::path::Path;

use program::{AtomicWriter, File, is_own, keep, may_replace, write_all};

fn write_one(path: &Path, text: &str) -> anyhow::Result<()> {
    let told = keep(Some(path), text.into(), |file| format!("in {file}"))?;
    assert_eq!(told, format!("in {}", path.display()));
    Ok(())
}

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
    write_one(&at("ours.json"), "member,x,error_estimate,status,cause\n").unwrap();
    write_one(&at("ours.json"), "").unwrap();
    // its folder is made, and a line stands for standard output
    write_one(&at("new/folder/page"), "1").unwrap();
    assert_eq!(keep(Some(Path::new("-")), "1".into(), |_| String::new()).unwrap(), "1");
    assert_eq!(keep(None, "1".into(), |_| String::new()).unwrap(), "1");
    let said = write_one(&at("mine.json/page"), "1").unwrap_err();
    assert!(format!("{said:#}").contains("mine.json"), "{said:#}");
    assert!(write_one(Path::new(".."), "1").unwrap_err().to_string().contains("names no file"));
}

/// A file is whole or not there.
#[test]
fn what_is_not_closed_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("page");
    for closed in [false, true] {
        let mut sink = AtomicWriter::whole(&path).unwrap();
        assert!(sink.write("1").unwrap() && sink.write("2").unwrap() && !path.exists());
        if closed {
            assert_eq!(sink.close().unwrap().as_deref(), Some(&*path));
        }
    }
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path()).collect();
    assert_eq!((left, std::fs::read_to_string(&path).unwrap()), (vec![path], "12".to_string()));
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
