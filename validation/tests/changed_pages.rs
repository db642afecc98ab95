//! One number changed on a committed page is found.

use std::fs;
use std::path::{Path, PathBuf};

use pages::difference_of_verdicts;
use serde_json::json;
use validation::report::{Compared, without_referees};

/// The pages and pictures of the reports, those of the main job and of times alike.
fn pages() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reports");
    let folders = ["", "scenes", "evidence", "paper"].map(|name| root.join(name));
    let files = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).expect("reports"))
        .map(|file| file.expect("a file").path());
    let mut files: Vec<PathBuf> =
        files.filter(|file| file.extension().is_some_and(|e| e == "md" || e == "svg")).collect();
    files.sort();
    let text = |file: &Path| fs::read_to_string(file).expect("a page").replace('\u{2212}', "-");
    files.into_iter().map(|file| (file.clone(), text(&file))).collect()
}

/// Where numbers stand on a page, and their lengths; of a picture in its texts. Behind a letter or within a
/// number or a name is none.
fn numbers(page: &str) -> Vec<(usize, usize)> {
    let bytes = page.as_bytes();
    let is_picture = page.trim_start().starts_with("<svg");
    let (mut found, mut i, mut text, mut tag) = (Vec::new(), 0, !is_picture, false);
    while i < bytes.len() {
        if is_picture {
            text = (text || bytes[i..].starts_with(b"<text")) && !bytes[i..].starts_with(b"</text>");
            tag = (tag || bytes[i] == b'<') && bytes[i] != b'>';
        }
        let begins = i == 0 || !(bytes[i - 1].is_ascii_alphanumeric() || b".-_/#".contains(&bytes[i - 1]));
        if text && !tag && begins && bytes[i].is_ascii_digit() {
            let length = bytes[i..].iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
            found.push((i, length));
            i += length;
        } else {
            i += 1;
        }
    }
    found
}

/// The number with another first digit that is not zero: one more, or 8 for 9. Round-off may be another power
/// of ten, so it becomes one that is much larger.
fn changed(page: &str, (at, length): (usize, usize)) -> String {
    let number = &page[at..at + length];
    let rest = &page[at + length..];
    let exponent = rest.strip_prefix("e-").and_then(|rest| rest.split(|c: char| !c.is_ascii_digit()).next());
    if exponent.and_then(|digits| digits.parse::<u32>().ok()).is_some_and(|power| power > 8) {
        return format!("{}{number}e-3{}", &page[..at], &rest[2 + exponent.map_or(0, str::len)..]);
    }
    let Some(place) = number.find(|c: char| c.is_ascii_digit() && c != '0') else {
        return format!("{}1{}", &page[..at], &page[at + 1..]);
    };
    let digit = match number.as_bytes()[place] {
        b'9' => '8',
        digit => char::from(digit + 1),
    };
    format!("{}{digit}{}", &page[..at + place], &page[at + place + 1..])
}

#[test]
fn of_twenty_pages_with_one_number_changed_each_twenty_are_found() {
    let pages = pages();
    let (mut found, mut tried) = (0, 0);
    for (path, page) in &pages {
        let same = Compared::default().page(page, page);
        assert_eq!(same, Ok(()), "{}", path.display());
        let numbers = numbers(page);
        // five numbers of each page, one at a time: so every page is among the twenty that are drawn
        for part in [0.0, 0.23, 0.51, 0.77, 0.999] {
            let Some(&number) = numbers.get((part * numbers.len() as f64) as usize) else { continue };
            let other = changed(page, number);
            assert_ne!(other, *page);
            tried += 1;
            let line = page[..number.0].matches('\n').count() + 1;
            match Compared::default().page(page, &other) {
                Err(told) if page.trim_start().starts_with("<svg") || told.starts_with(&format!("line {line}: ")) => {
                    found += 1
                }
                told => panic!("{}, line {line}, {}: {told:?}", path.display(), &page[number.0..number.0 + number.1]),
            }
        }
    }
    println!("{found} of {tried} changed numbers found on {} pages and pictures", pages.len());
    assert!(found == tried && pages.len() > 20 && tried > 5 * 20);
}

fn differs(old: &str, new: &str) -> bool {
    Compared::default().page(old, new).is_err()
}

#[test]
fn counts_are_exact_and_digits_as_sure_as_they_are() {
    for (old, new) in [
        ("419 of 419 hold", "519 of 519 hold"),
        ("0 wrong", "41 wrong"),
        ("no claim fails", "5 claims fail"),
        ("the gap is 1.25", "the gap is 1.52"),
        ("1.3e-12", "1.3e-10"),
        ("after 0.327 s", "after 0.427 s"),
        ("one line", "one line\nanother"),
        ("2.0e-3", "2.0e-4"),
        ("3 of 4", "3 of 5"),
        ("0.3 s", "0.4 s"),
        ("to 1e-8", "to 2e-8"),
        ("| 2.0e\u{2212}3 |", "| 2.0e\u{2212}4 |"),
    ] {
        assert!(differs(old, new), "{old} / {new}");
        assert!(differs(new, old), "{new} / {old}");
    }
    for (old, new) in [("1.3e-12", "1.4e-12"), ("4e-13 apart", "2e-13 apart"), ("0.327 s", "0.328 s")] {
        assert!(!differs(old, new), "{old} / {new}");
    }
    let mut compared = Compared::default();
    compared.page("x1 = 0.51, 3 of 3, 1e-16", "x1 = 0.52, 3 of 3, 2e-16").expect("the same");
    assert_eq!(compared, Compared { pages: 1, same: 3, last_digit: 1, round_off: 1 });
}

#[test]
fn of_a_picture_what_is_written_in_it_counts() {
    let picture = |x: f64, word: &str| format!("<svg><path d=\"M0 {x}\"/><text x=\"{x}\">{word}</text></svg>");
    assert!(!differs(&picture(1.25, "gap 3"), &picture(1.5, "gap 3")));
    assert!(differs(&picture(1.25, "gap 3"), &picture(1.25, "gap 4")));
}

#[test]
fn only_what_referees_say_is_left_out() {
    let page = "- A line. [More](a.md).\n- Referees. [More](evidence/referees.md).\n- B.\n";
    assert_eq!(without_referees(page), "- A line. [More](a.md).\n- B.\n");
}

#[test]
fn a_changed_verdict_is_found() {
    let old = json!({ "scenes": { "disc": { "pairs": [{ "verdict": "same", "passes": [0.5, null] }] } } });
    let mut new = old.clone();
    assert_eq!(difference_of_verdicts(&old, &new), None);
    new["scenes"]["disc"]["pairs"][0]["passes"][0] = json!(0.5001);
    assert_eq!(difference_of_verdicts(&old, &new), None);
    new["scenes"]["disc"]["pairs"][0]["verdict"] = json!("different");
    let found = difference_of_verdicts(&old, &new).unwrap();
    assert!(found.starts_with("/scenes/disc/pairs/0/verdict"), "{found}");
}
