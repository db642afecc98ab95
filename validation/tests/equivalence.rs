//! Which motions of classic systems are vakonomic: the page and its data.

use validation::report::EquivalenceReport;

#[test]
fn every_start_is_what_the_page_says_and_the_headline_counts_its_tables() {
    let report = EquivalenceReport::new(true).unwrap_or_else(|e| panic!("{e:#}"));
    let page = report.files().remove(0).text;
    let tables: Vec<Vec<&str>> = page
        .split("\n\n")
        .filter(|block| block.starts_with('|'))
        .map(|block| block.lines().skip(2).collect())
        .collect();
    let [systems, starts] = &tables[..] else { panic!("{} tables", tables.len()) };
    let count = |what: &str| {
        let begins = |row: &&&str| row.split('|').nth(5).is_some_and(|cell| cell.trim().starts_with(what));
        systems.iter().filter(begins).count()
    };
    let [none, one, more, every] = ["**none**", "**one**", "**dimension", "**every one**"].map(count);
    let headline = report.headline();
    let begins = format!("Of {} classic systems and variants, {none} have no $\\mu_0$", systems.len());
    assert!(headline.starts_with(&begins), "{begins}: {headline}");
    assert_eq!(none + one + more + every + count("**open**"), systems.len());
    let some = format!("; {one} have one $\\mu_0$, {more} a set of dimension 1 or more, {every} every $\\mu_0$");
    assert!(
        headline.contains(&some) && headline.contains(&format!(" {} further starts, ", starts.len())),
        "{headline}"
    );
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
