//! When pages were measured, and with which code.

use std::fs;

use validation::report::stamp::{Age, PAGES, ages, date, write};

#[test]
fn days_are_those_of_the_calendar() {
    let known =
        [(0, "1970-01-01"), (951_782_399, "2000-02-28"), (951_782_400, "2000-02-29"), (951_868_800, "2000-03-01")];
    for (seconds, day) in known.into_iter().chain([(1_767_225_599, "2025-12-31"), (1_795_478_400, "2026-11-24")]) {
        assert_eq!(date(seconds), day);
    }
}

#[test]
fn a_page_is_older_as_soon_as_its_code_changes() {
    let folder = tempfile::tempdir().expect("a folder");
    let (root, reports) = (folder.path(), folder.path().join("reports"));
    for (page, folders) in PAGES {
        for source in folders {
            fs::create_dir_all(root.join(source).join("deeper")).expect("a folder");
            fs::write(root.join(source).join("deeper/a.rs"), source).expect("a file");
        }
        let page = reports.join(page);
        fs::create_dir_all(page.parent().expect("a folder")).expect("a folder");
        fs::write(page, "# A page\n\n1 of 3\n").expect("a page");
    }
    let those = |wanted: fn(&Age) -> bool| -> Vec<&str> {
        let all = ages(root, &reports).expect("read").into_iter();
        all.filter(|(_, age)| wanted(age)).map(|(page, _)| page).collect()
    };
    let older = || those(|age| matches!(age, Age::Older(date) if date.starts_with("20")));
    assert_eq!(those(|age| *age == Age::Unknown).len(), PAGES.len());
    for (page, _) in PAGES {
        write(root, &reports, page).expect("written");
    }
    assert_eq!(those(|age| *age == Age::Current).len(), PAGES.len());
    // once more: the line is one
    let page = reports.join("evidence/engine.md");
    let before = fs::read_to_string(&page).expect("a page");
    write(root, &reports, "evidence/engine.md").expect("written");
    assert_eq!(fs::read_to_string(&page).expect("a page"), before);
    assert!(before.starts_with("# A page\n\n1 of 3\n\nMeasured on 20"), "{before}");
    // another text, a file more, a file of another name; what is no source does not count
    let source = root.join("crates/symbolic/src");
    let speaking = [
        "evidence/peers.md",
        "measured/error-vs-time.md",
        "measured/scaling.md",
        "measured/ivp.md",
        "measured/machine-code.md",
    ];
    fs::write(source.join("notes.txt"), "").expect("a file");
    assert_eq!(older(), Vec::<&str>::new());
    fs::write(source.join("deeper/a.rs"), "crates/symbolic/srd").expect("a file");
    assert_eq!(older(), speaking);
    fs::write(source.join("deeper/a.rs"), "crates/symbolic/src").expect("a file");
    assert_eq!(older(), Vec::<&str>::new());
    fs::rename(source.join("deeper/a.rs"), source.join("a.rs")).expect("moved");
    assert_eq!(older(), speaking);
    fs::write(root.join("crates/decision/src/b.rs"), "").expect("a file");
    assert_eq!(older().len(), speaking.len() + 2);
    assert!(
        write(root, &reports, "evidence/random.md")
            .is_err_and(|error| error.to_string().contains("evidence/engine.md"))
    );
}
