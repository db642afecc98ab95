//! Which motions of classic systems are vakonomic: the page and its data.

use validation::report::EquivalenceReport;

#[test]
fn every_start_is_what_the_page_says_and_the_headline_counts_its_tables() {
    let report = EquivalenceReport::new(true).unwrap_or_else(|e| panic!("{e:#}"));
    let files = report.files();
    let systems: Vec<&str> = files[0].text.lines().filter(|line| line.starts_with('|')).skip(2).collect();
    let table = files.iter().find(|file| file.path.ends_with("data/equivalence/starts.csv")).expect("a table");
    let starts = table.text.lines().count() - 1;
    let count = |what: &str| {
        let begins = |row: &&&str| row.split('|').nth(4).is_some_and(|cell| cell.trim().starts_with(what));
        systems.iter().filter(begins).count()
    };
    let [none, one, more, every] = ["none", "one", "dimension", "every one"].map(count);
    let headline = report.headline();
    let begins = format!("For {none} of {} classic systems and variants no initial multipliers", systems.len());
    assert!(headline.starts_with(&begins), "{begins}: {headline}");
    assert_eq!(none + one + more + every + count("open"), systems.len());
    let some = format!(
        "For {one} systems one $\\mu_0$ does, for {more} a set of dimension 1 or more, for {every} every $\\mu_0$"
    );
    assert!(headline.contains(&some) && headline.contains(&format!(" {starts} starts on ")), "{headline}");
}

#[test]
fn a_start_that_is_not_what_the_page_says_is_refused() {
    let data = |is: &str| {
        format!(
            "[[system]]\nscene = 'sledge'\nexceptions = ''\nstart = [{{ at = '', set = {{ phi = 0, \"phi'\" = 0 }}, is = '{is}' }}]"
        )
    };
    assert!(EquivalenceReport::of(&data("one"), true).is_ok());
    let told = EquivalenceReport::of(&data("none"), true).err().expect("a wrong expectation").to_string();
    assert!(told.contains("none was expected"), "{told}");
}
