//! A table: every cell of what is read is written so that the same text is read back.
#![no_main]

use libfuzzer_sys::fuzz_target;
use scene::{Table, table_cell};

fuzz_target!(|text: &str| {
    let Ok(table) = Table::read("fuzz", text) else { return };
    let columns = 0..table.columns.len();
    let row = |row: usize| columns.clone().map(|column| table_cell(&table.text(row, column)).into_owned()).collect::<Vec<_>>();
    let rows: Vec<Vec<String>> = (0..table.rows().end).map(row).collect();
    let _ = columns.clone().map(|column| table.times(column).is_ok()).count();
    let _ = table.rows().map(|row| columns.clone().map(|column| table.number_or_gap(row, column).is_ok()).count()).count();
    let written: String = rows.iter().map(|row| row.join(",") + "\n").collect();
    // a row of one empty cell is an empty line, which is none
    if written.lines().any(|line| line.trim().is_empty()) {
        return;
    }
    let again = Table::read("fuzz", &written).unwrap_or_else(|fault| panic!("{fault}\n{written}"));
    assert_eq!(table.rows().end, again.rows().end, "{written}");
    for (at, cells) in rows.iter().enumerate() {
        let same = cells.iter().enumerate().all(|(column, _)| table.text(at, column) == again.text(at, column));
        assert!(same, "{written}");
    }
});
