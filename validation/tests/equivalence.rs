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
    let everywhere = |row: &&&str| row.split('|').nth(5).is_some_and(|cell| cell.trim().starts_with("**none**"));
    let none = systems.iter().filter(everywhere).count();
    let open = systems.iter().filter(|row| row.split('|').nth(5).is_some_and(|cell| cell.contains("**open**"))).count();
    let headline = report.headline();
    let begins = format!("Of {} classic systems and variants, {none} have no $\\mu_0$", systems.len());
    assert!(headline.starts_with(&begins), "{begins}: {headline}");
    let some = format!("at almost every start; {} have one", systems.len() - none - open);
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
