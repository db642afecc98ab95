//! `deltaq integrals`: tables over numbers, and certificates.

use crate::support::{answer, refused};

#[test]
fn a_table_says_of_each_value_what_is_said_of_it_alone() {
    let (table, _) = answer(&["integrals", "suslov", "--degree", "1", "--sweep", "K=-0.03:0.03:3"], 0);
    assert_eq!(
        table,
        "K,measure,multiplier,linear,why\n-0.03,none,none,none,\n0.0,some,some,5,\n0.03,none,none,none,\n"
    );
    let (alone, _) = answer(&["integrals", "suslov", "--degree", "1", "--set", "K=0"], 0);
    assert!(alone.contains("linear        5 local ones\n"), "{alone}");
    let (open, _) = answer(&["integrals", "pursuit", "--degree", "0", "--sweep", "time=0:1:1"], 0);
    assert_eq!(open, "time,measure,multiplier,why\n0.0,open,open,\"time stands in L or in the constraints\"\n");
}

#[test]
fn a_table_goes_to_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("table.csv");
    let words = ["integrals", "suslov", "--degree", "1", "--sweep", "K=0:0.03:2", "--out"];
    let (told, _) = answer(&[&words[..], &[file.to_str().expect("UTF-8")]].concat(), 0);
    let table = std::fs::read_to_string(&file).expect("a table");
    assert!(told.contains("2 points") && table.lines().count() == 3, "{told}{table}");
    // every answer takes the place of another one, and of nothing else
    let [file, mine] = ["table.csv", "mine.csv"].map(|name| folder.path().join(name).display().to_string());
    std::fs::write(&mine, "K,mine\n").expect("written");
    for words in [&words[..6], &words[..4], &[&words[..4], &["--format", "json"]].concat(), &words[..6]] {
        answer(&[words, &["--out", &file]].concat(), 0);
        assert_eq!(std::fs::read_to_string(&file).expect("an answer"), answer(words, 0).0);
        refused(&[words, &["--out", &mine]].concat(), &["mine.csv is not of deltaq"]);
        assert_eq!(answer(&[words, &["--out", "-"]].concat(), 0), answer(words, 0));
    }
}

#[test]
fn certificates_are_written_for_what_is_proved_or_written_down() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("proofs");
    let words = ["integrals", "veselova", "--degree", "1", "--certificates", out.to_str().expect("UTF-8")];
    assert!(answer(&words, 0).0.contains("2 local ones"));
    let text = |name: &str| std::fs::read_to_string(out.join(format!("veselova-{name}.json"))).expect("a certificate");
    let kind = |name: &str| {
        let value: serde_json::Value = serde_json::from_str(&text(name)).expect("JSON");
        value["kind"].as_str().expect("a kind").to_owned()
    };
    assert_eq!((kind("measure"), kind("linear")), ("measure".into(), "bound".into()));
}

#[test]
fn what_does_not_go_together_is_refused() {
    refused(&["integrals", "suslov", "--sweep", "K=0:1:2", "--set", "K=1"], &["`K` varies"]);
    refused(&["integrals", "suslov", "--sweep", "Q=0:1:2"], &["`Q` is no parameter"]);
    refused(&["integrals", "suslov", "--sweep", "K=0:1:2", "-f", "vakonomic"], &["cannot be used with"]);
}
