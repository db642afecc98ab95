//! Published claims: the page and its data.

use validation::report::LiteratureReport;

#[test]
fn every_claim_has_the_word_that_its_data_expect_and_the_headline_counts_the_table() {
    let report = LiteratureReport::new(true).unwrap_or_else(|e| panic!("{e:#}"));
    let page = report.files().remove(0).text;
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| ") && line.ends_with("** |")).collect();
    let count = |word: &str| rows.iter().filter(|row| row.ends_with(&format!("| **{word}** |"))).count();
    let words = ["confirmed", "qualified", "contradicted", "refuted"].map(|word| (word, count(word)));
    let [answered, open] = ["answered", "open"].map(count);
    let claims: usize = words.iter().map(|(_, n)| n).sum();
    assert_eq!(claims + answered + open, rows.len());
    let found: Vec<String> = words.iter().filter(|(_, n)| *n > 0).map(|(word, n)| format!("{n} {word}")).collect();
    let expected = format!(
        "Of {} entries from the literature, {claims} are claims that were computed after their abstract was read: {}. For {answered} \
         entries a question is answered for the systems named, without a verdict on the source. {open} entries were not computed.",
        rows.len(),
        found.join(", ")
    );
    assert_eq!(report.headline(), expected);
}

#[test]
fn the_word_follows_from_what_was_found() {
    let claim = |word: &str, more: &str| {
        let head = "[[claim]]\nsource = ''\nread = ''\nabout = ''\nsays = ''\n";
        let data = format!("{head}word = '{word}'\n{more}");
        LiteratureReport::of(&data, true).map(|_| ()).map_err(|e| e.to_string())
    };
    let case = |scene: &str, claimed: &str, outside: bool| {
        format!("[[claim.case]]\nscene = '{scene}'\nclaimed = '{claimed}'\noutside = {outside}\n")
    };
    let mixed = case("disc", "some", false) + &case("sledge", "some", true);
    assert_eq!(claim("open", ""), Ok(()));
    assert_eq!(claim("confirmed", &case("disc", "one", false)), Ok(()));
    assert_eq!(claim("contradicted", &case("sledge", "some", false)), Ok(()));
    assert_eq!(claim("contradicted", &mixed), Ok(()));
    assert_eq!(claim("refuted", &format!("in_full = true\n{mixed}")), Ok(()));
    assert_eq!(claim("qualified", &format!("condition = ''\n{mixed}")), Ok(()));
    // a question has no verdict, and the same data are held against what was found
    let asked =
        format!("[[claim]]\nsource = 'a'\nread = ''\nabout = 'b'\nquestion = 'Is it?'\nword = 'contradicted'\n{mixed}");
    let asked = LiteratureReport::of(&asked, true).expect("a page");
    let page: String = asked.files().into_iter().map(|file| file.text).collect();
    assert!(page.contains("**answered**") && page.contains("Is it?") && !page.contains("contradicted"), "{page}");
    let told = claim("confirmed", &mixed).expect_err("a word that does not follow");
    assert!(told.contains("it is contradicted"), "{told}");
    let along = "along = { formulation = 'vakonomik', quantity = 'x', during = [0, 1], between = [0, 1] }\n";
    let data = format!(
        "[[claim]]\nsource = ''\nread = ''\nabout = ''\nsays = ''\nword = 'open'\n{}{along}",
        case("disc", "yes", false)
    );
    let told = LiteratureReport::of(&data, true).err().map(|error| format!("{error:#}")).expect("no such formulation");
    assert!(told.contains("`vakonomik`, did you mean `vakonomic`?"), "{told}");
}
