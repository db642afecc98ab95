//! Pages about many systems and many points: every count against records and rows with known counts.

use pages::sweep_files;
use random::{Batch, DIVERGES, Kind, NEAREST, Record};
use serde_json::json;
use validation::report::{random_files, random_headline};

use crate::pages::table;

/// Systems of a batch that is known: `open` failed, the rest held.
fn records() -> Vec<Record> {
    let record = |index: u64, flagged: bool, exponent: f64, differs: bool| {
        let open = if flagged {
            Vec::new()
        } else {
            vec![json!({ "theorem": 12, "claim": "c", "word": "undecided", "figure": null, "note": "n" })]
        };
        json!({
            "index": index, "kind": Kind::Linear, "coordinates": 3, "constraints": 1, "features": ["a switch"], "shortened": null,
            "held": [[1, "a", 2], [12, "b", 1]], "open": open,
            "observed": [
                [12, "the wrong formulation is wrong, and flagged", f64::from(u8::from(flagged))],
                [5, "growth exponent, mu0 = 0", exponent],
                [1, DIVERGES[0].differs, f64::from(u8::from(differs))],
                [1, DIVERGES[0].passes, 1.0 + index as f64],
                [6, "something else is so", f64::from(u8::from(index < 2))],
                [1, NEAREST, 0.125 * index as f64],
            ],
            "seconds": [0.1, []],
        })
    };
    let all = [
        record(0, true, 3.02, true),
        record(1, true, 2.9, true),
        record(2, false, 3.0, true),
        record(3, true, 3.01, true),
        record(4, true, 3.0, false),
    ];
    all.into_iter().map(|value| serde_json::from_value(value).expect("a record")).collect()
}

#[test]
fn it_is_told_how_near_gaps_come_to_what_they_must_not_pass() {
    let kinds: Vec<Kind> = Kind::ALL.into_iter().filter(|kind| kind.is_integrable()).collect();
    let batch = Batch { seed: 5, kinds };
    let mut parts = Vec::new();
    for index in 0..4 {
        let record = batch.record(index);
        let near = record.observed.iter().filter(|(theorem, what, _)| *theorem == 1 && what == NEAREST);
        parts.extend(near.map(|(_, _, part)| *part));
        let held: u32 = record.held.iter().filter(|(theorem, ..)| *theorem == 1).map(|(_, _, times)| times).sum();
        assert!(parts.len() as u32 >= held && held > 0, "{record:?}");
    }
    // under their limits, and not by many powers of ten: limits a hundred times as large would be seen
    assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)) && parts.iter().any(|part| *part > 1e-4), "{parts:?}");
}

#[test]
fn the_page_of_random_systems_counts_its_records() {
    let batch = Batch { seed: 1, kinds: vec![Kind::Linear] };
    let records = records();
    let files = random_files(&batch, &records).expect("a page");
    let page = &files.iter().find(|file| file.path.ends_with("random.md")).expect("a page").text;
    // T1 on all five, T12 on four, and on one undecided
    let headline = "On 5 random systems no claim fails (T1 to T18); 1 of 10 verdicts (10 %) are undecided.";
    assert!(page.contains(headline) && random_headline(&records) == headline, "{page}");
    let claims = table(page, headline);
    let row = |name: &str| claims.iter().find(|row| row[""] == name).unwrap_or_else(|| panic!("{name}"));
    // something is at stake on the four on which formulations differ
    for (name, counts) in [("T1", ["5", "0", "0", "4"]), ("T12", ["4", "0", "1", "4"])] {
        assert_eq!(["holds", "fails", "undecided", "at stake"].map(|column| &row(name)[column][..]), counts, "{name}");
    }
    assert!(page.contains("8 of the 10 verdicts (80 %) concern systems on which at least two"), "{page}");
    // four of five are flagged
    assert!(page.contains("80 %") && !page.contains(" 0 %"), "{page}");
    let csv = |name: &str| files.iter().find(|file| file.path.ends_with(name)).expect(name).text.clone();
    assert!(csv("pairs.csv").contains(",4,5,3,5\n"), "differ, of, the median of 1 to 5, passed: {}", csv("pairs.csv"));
    assert!(page.contains("5 systems, off by at most 0.1"), "{page}");
    assert!(csv("counts.csv").contains("T6,something else is so,2,5\n"), "{}", csv("counts.csv"));
    let nearest = csv("measured.csv").lines().any(|line| line.starts_with("T1,") && line.ends_with(",0,0.25,0.5,5"));
    assert!(nearest && csv("measured.csv").contains(NEAREST), "{}", csv("measured.csv"));
}

#[test]
fn the_page_of_a_sweep_counts_its_rows_and_draws_its_columns() {
    let head = "k,verdict,apart,largest,limit,answer,order,dimension,mismatch,cause\n";
    let rows = [
        "0.0,different,0.5,3.0,1e-9,none proved,2,,0.25,",
        "1.0,different,0.75,4.0,2e-9,none,,,0.5,",
        "2.0,same,,5.0,3e-9,some,,1,0.125,",
        "3.0,undecided,,6.0,4e-9,some proved,,0,0.0625,\"why\"",
        "4.0,,,,,,,,,\"no motion\"",
        "5.0,different,1.5,8.0,5e-9,none proved,3,,2.0,",
    ];
    let sledge = scene::catalogue::find("sledge", &[]).expect("a scene");
    let scene = scene::Scene { name: "s".into(), title: "A sweep".into(), ..sledge };
    let files = |rows: &[&str]| {
        let ranges = [("k".to_string(), 0.0, 5.0, rows.len())];
        let table = head.to_owned() + &rows.iter().map(|row| format!("{row}\n")).collect::<String>();
        sweep_files(&scene, ["one", "two"], &ranges, &table).expect("files")
    };
    let text = |files: &[program::File], name: &str| {
        files.iter().find(|file| file.path.ends_with(name)).map(|file| file.text.clone()).expect("a file")
    };
    let all = files(&rows);
    let page = text(&all, "s-sweep.md");
    let headline = "The motions differ at 3 of 6 points and agree at 1; 1 points are undecided, 1 have no motion. It is proved \
                    at 2 points that no constants make the two motion the one one; at 2 points some do.";
    assert!(page.contains(headline), "{page}");
    assert!(page.contains("- k = 2: some\n- k = 3: some proved\n"), "{page}");
    // each picture is of one column, and of no other
    let columns = ["apart", "largest", "limit", "mismatch"];
    for (i, column) in columns.into_iter().zip([2, 3, 4, 8]).map(|(name, i)| (i, name)) {
        let mut cells: Vec<String> = rows[1].split(',').map(String::from).collect();
        cells[i] = "0.9".into();
        let mut changed = rows;
        let row = cells.join(",");
        changed[1] = &row;
        let changed = files(&changed);
        for (picture, drawn) in [("s-apart.svg", "apart"), ("s-decision.svg", "mismatch")] {
            assert_eq!(text(&changed, picture) != text(&all, picture), drawn == column, "{picture}, {column}");
        }
    }
}
