//! Tables as they are read: RFC 4180, and what is refused with its place.

use proptest::prelude::*;
use scene::{Table, TableError, TableFault, table_cell, table_text};

fn rows(text: &str) -> Vec<Vec<String>> {
    let table = Table::read("m.csv", text).unwrap_or_else(|error| panic!("{error}"));
    let row = |row: usize| (0..table.columns.len()).map(|column| table.text(row, column).into_owned()).collect();
    std::iter::once(table.columns.clone()).chain(table.rows().map(row)).collect()
}

#[test]
fn cells_are_those_of_rfc_4180() {
    let found =
        rows("\u{feff}# a note, \"of\n\n t ,\"atan2(y,x)\" ,\"say \"\"it\"\"\"\r\n1, 2 ,\"3\n\"\"4\"\r\n,\"\", \"5\" ");
    assert_eq!(found, [["t", "atan2(y,x)", "say \"it\""], ["1", "2", "3\n\"4"], ["", "", "5"]]);
    let table = Table::read("m.csv", "a,b\n\"1\n\",2\n\n3,4").unwrap();
    assert_eq!((&table.lines, table.place(2, 1), table.rows()), (&vec![1, 2, 5], "m.csv:5:3".into(), 1..3));
    assert_eq!(table.number(1, 0), Ok(1.0));
    assert_eq!(Table::read("m.csv", "").map(|table| (table.rows(), table.columns)), Ok((1..1, Vec::new())));
}

#[test]
fn gaps_are_no_numbers() {
    let table = Table::read("m.csv", "a\nNaN\n\"\"\n1e999\nna\n-2e3\n").unwrap();
    let found: Vec<_> = (1..6).map(|row| table.number_or_gap(row, 0).map_err(|error| error.to_string())).collect();
    let wrong = Err("m.csv:4:1: column `a`: `1e999` is not a finite number".to_string());
    assert_eq!(found, [Ok(None), Ok(None), wrong, Ok(None), Ok(Some(-2e3))]);
    assert_eq!(table.number(2, 0).unwrap_err().fault, TableFault::Gap("a".into()));
}

#[test]
fn what_is_no_table_has_its_place() {
    let long = "x".repeat(50_000_000);
    let names = (0..10_000).map(|i| i.to_string()).collect::<Vec<_>>().join(",") + "\n";
    let wide = names + &("1,".repeat(9_999) + "1\n").repeat(5_001);
    for (text, said) in [
        ("t;x\n0;1\n", "m.csv:1:1: cells are separated by semicolons; they must be separated by commas"),
        ("\n\u{e4}\tx\n", "m.csv:2:1: cells are separated by tabs; they must be separated by commas"),
        ("t,x, \"t\"\n", "m.csv:1:6: the column `t` is there already, at m.csv:1:1"),
        ("\u{e4},x\n\u{e4},\"1\n2,3\n", "m.csv:2:3: the quotation mark is not closed"),
        ("t,x\n1,2\"\n", "m.csv:2:4: a quotation mark within a cell"),
        ("t,x\n\"1\"2,3\n", "m.csv:2:4: a quotation mark within a cell"),
        ("t,x\n1\n", "m.csv:2:1: 1 cells, and the header has 2"),
        ("t,x\n1,2,3\n", "m.csv:2:5: 3 cells, and the header has 2"),
        (&",".repeat(10_000), "m.csv:1:10001: the table has more than 10000 columns"),
        (&("t\n".to_owned() + &"1\n".repeat(1_000_001)), "m.csv:1000002:1: the table has more than 1000000 rows"),
        (&format!("t,x\n1,{long}\n"), "m.csv:2:3: column `x`: `xxx"),
        (&format!("t,{long}\n1,2\n"), "m.csv:1:3: the table has more than 1000 bytes in a name"),
        (&wide, "m.csv:5001:19999: the table has more than 50000000 cells"),
    ] {
        let read = Table::read("m.csv", text).and_then(|table| table.number(1, 1));
        let told = read.unwrap_err().to_string();
        assert!(told.starts_with(said) && told.len() < 400, "{told}");
    }
}

#[test]
fn files_that_are_no_tables_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.csv");
    let told = |text: Option<&[u8]>| {
        if let Some(text) = text {
            std::fs::write(&path, text).unwrap();
        }
        table_text(&path).map_err(|TableError { place, fault }| (place.ends_with("m.csv:2:2"), fault))
    };
    assert!(matches!(told(None), Err((false, TableFault::Unreadable(_)))));
    assert_eq!(told(Some("t,\u{e4}\n".as_bytes())), Ok("t,\u{e4}\n".into()));
    assert_eq!(told(Some(b"t\n1\xff")), Err((true, TableFault::NoText)));
    // of what has no end no more is read than is needed to refuse it
    #[cfg(target_os = "linux")]
    {
        let text = table_text("/dev/zero".as_ref()).unwrap();
        let told = Table::read("zero", &text).map(|_| ()).unwrap_err().to_string();
        assert_eq!(told, "zero:1:1: the table has more than 400000000 bytes, the most that is read");
    }
}

proptest! {
    /// Whatever is written as cells is read as it was.
    #[test]
    fn cells_are_read_as_they_were_written(
        names in proptest::collection::hash_set("[ -~\u{e4}\r\n\t]{0,8}", 2..6),
        text in "[ -~\u{e4}\n\",#]{0,8}",
    ) {
        let names: Vec<String> = names.into_iter().collect();
        let line = |cells: &[String]| cells.iter().map(|cell| table_cell(cell)).collect::<Vec<_>>().join(",") + "\n";
        let row: Vec<String> = names.iter().map(|name| format!("{name}{text}")).collect();
        prop_assert_eq!(rows(&(line(&names) + &line(&row))), [names, row]);
    }
}
