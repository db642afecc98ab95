//! `deltaq compare --sweep`: a table, the same however often it was cut off, with its exceptional line.

use std::fs;

use crate::support::{answer, refused};

const CALL: [&str; 6] = ["compare", "turntable", "--set", "x=0.6", "--sweep", "Omega=0.3:0.9:3"];

fn sweep(folder: &str, more: &[&str]) -> String {
    answer(&[&CALL[..], &["--sweep", "psi'=0.3:0.9:5", "--quiet", "--out", folder], more].concat(), 0).0
}

#[test]
fn the_line_on_which_the_ball_turns_with_the_table_is_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("UTF-8");
    assert!(sweep(path, &[]).starts_with("15 points in "));
    let table = fs::read_to_string(folder.path().join("turntable-sweep.csv")).expect("the table");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0][..7], ["Omega", "psi'", "verdict", "apart", "largest", "limit", "answer"]);
    assert_eq!(rows.len(), 16);
    for row in &rows[1..] {
        // contained if and only if ω_z = ψ' is Ω; then μ₀ is (2m/5) v₀, a point
        let expected = if row[0] == row[1] { ("some", "0") } else { ("none proved", "") };
        assert_eq!((row[6], row[8]), expected, "{row:?}");
        assert_eq!(row[2], "different", "{row:?}");
    }
    let page = fs::read_to_string(folder.path().join("turntable-sweep.md")).expect("the page");
    assert!(page.contains("at 3 points some do.") && page.contains("- Omega = 0.6, psi' = 0.6: some"), "{page}");
    for kind in ["apart", "decision"] {
        let svg = fs::read_to_string(folder.path().join(format!("turntable-{kind}.svg"))).expect("a picture");
        roxmltree::Document::parse(&svg).expect("XML");
        assert!(
            svg.matches("<rect").count() > 15 && svg.matches("<circle").count() == 4,
            "three dots and the legend's"
        );
    }
}

#[test]
fn a_sweep_that_was_cut_off_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_str().expect("UTF-8");
    sweep(path, &["--threads", "2"]);
    let table = folder.path().join("turntable-sweep.csv");
    let whole = fs::read(&table).expect("the table");
    let part = folder.path().join("turntable-sweep.csv.part");
    // within a row, right behind one, right behind the names, within them, nothing at all
    let names = whole.iter().position(|&b| b == b'\n').expect("names") + 1;
    for length in [whole.len() / 2, whole.iter().rposition(|&b| b == b'\n').expect("rows"), names, 20, 0] {
        fs::write(&part, &whole[..length]).expect("written");
        fs::remove_file(&table).expect("there");
        sweep(path, &["--threads", "1"]);
        assert!(fs::read(&table).expect("the table") == whole, "cut at {length}");
        assert!(!part.exists());
    }
    fs::write(&part, "k,verdict\n1,same\n").expect("written");
    refused(&[&CALL[..], &["--out", path]].concat(), &["turntable-sweep.csv.part is of another sweep"]);
}

#[test]
fn a_start_that_there_is_not_is_a_row_and_a_name_that_means_nothing_is_none() {
    let (table, _) = answer(&["compare", "ball-in-cone", "--sweep", "theta=-0.4:0.4:3"], 0);
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 4, "{table}");
    assert!(rows[1..].iter().any(|row| row.contains(",,,,") && row.ends_with('"')), "{table}");
    refused(&["compare", "sledge", "--sweep", "kk=0:1:3"], &["`kk` is no", "did you mean `k`"]);
    refused(&["compare", "sledge", "disc", "--sweep", "k=0:1:3"], &["one scene"]);
    refused(&["compare", "sledge", "--set", "k=1", "--sweep", "k=0:1:3"], &["--set fixes it"]);
    refused(&["compare", "sledge", "--sweep", "k=0:1:3", "--sweep", "k=0:1:3"], &["varies twice"]);
    refused(&["compare", "sledge", "--sweep", "k=0:1"], &["NAME=FROM:TO:COUNT"]);
}

#[test]
fn costates_vary_like_multipliers_and_two_formulations_are_chosen() {
    let call = ["compare", "sledge", "--quiet", "--sweep"];
    let table = answer(&[&call[..], &["P0_x=-2.7:2.7:3"]].concat(), 0).0;
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), ["P0_x", "-2.7", "0.0", "2.7"]);
    assert!(rows[1..].iter().all(|row| row[1] == "different" && row[5] == "none proved"), "{table}");
    assert!(rows[1][2] != rows[2][2] && rows[2][2] != rows[3][2], "{table}");

    let two = ["g=9:10:1", "--formulation", "removed-constraint,vakonomic"];
    let table = answer(&[&call[..], &two].concat(), 0).0;
    let row: Vec<&str> = table.lines().nth(1).expect("a row").split(',').collect();
    // a removal by coordinates with other costates is vakonomic
    assert_eq!((row[0], row[5], row[7]), ("9.0", "some", "0"), "{table}");

    refused(&[&call[..], &["P0_z=0:1:2"]].concat(), &["`P0_z`", "P0_x, P0_y"]);
    refused(&[&call[..], &["P0_x=0:1:2", "--formulation", "chetaev,vakonomic"]].concat(), &["P0_x", "no removal"]);
    refused(&[&call[..], &["g=9:10:2", "--formulation", "chetaev"]].concat(), &["two formulations, not 1"]);
}

#[test]
fn the_values_of_a_sweep_are_the_decimals_that_are_meant() {
    let values = |range: &str, call: &[&str]| {
        let text = answer(&[call, &["--quiet", "--sweep", &format!("phi'={range}")]].concat(), 0).0;
        let lines = text.lines().filter(|line| line.starts_with(['-', '0', '6'])).map(str::to_owned);
        lines.map(|line| line.split(',').next().unwrap_or_default().to_owned()).collect::<Vec<_>>()
    };
    let tenths: Vec<String> = (-6..=6).map(|k| format!("{:?}", f64::from(k) / 10.0)).collect();
    assert_eq!(values("-0.6:0.6:13", &["compare", "disc"]), tenths);
    assert_eq!(values("-6e-10:6e-10:3", &["compare", "disc"]), ["-6e-10", "0.0", "6e-10"]);
}
