//! What the program writes is read back by every reader of tables.

use std::fs;

use scene::Table;
use serde_json::Value;

use crate::support::{answer, refused};

/// Names with commas, quotation marks, parentheses and blanks.
const NAMES: [&str; 6] = ["atan2(y,x)", "say \\\"it\\\", (now)", " y ", "#x", "a;b", "path [1]"];

/// A sledge on a slope with these observables.
fn scene() -> String {
    let scene = include_str!("../../scene/scenes/sledge.toml");
    let watched: String = NAMES.iter().map(|name| format!("\"{name}\" = \"x - 2*y\"\n")).collect();
    format!("{scene}\n[observables]\n{watched}")
}

#[test]
fn a_motion_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let (own, motion) = (at("own.toml"), at("motion.csv"));
    fs::write(&own, scene()).expect("written");
    for law in ["chetaev", "vakonomic", "removed-constraint"] {
        let call = ["solve", &own, "-f", law, "--times", "0:1:41", "--sensitivities", "g", "--format"];
        let csv = answer(&[&call[..], &["csv"]].concat(), 0).0;
        let json: Value = serde_json::from_str(&answer(&[&call[..], &["json"]].concat(), 0).0).expect("JSON");
        let table = Table::read("motion.csv", &csv).expect("a table");
        for name in NAMES.map(|name| name.replace("\\\"", "\"")) {
            let column = table.column(&name).unwrap_or_else(|error| panic!("{error}"));
            let values = json["observables"][&name].as_array().expect("values");
            assert_eq!(values.len(), table.rows().len());
            for (row, value) in table.rows().zip(values) {
                assert_eq!(table.number(row, column).ok(), value.as_f64(), "{name}, {row}");
            }
        }
        fs::write(&motion, &csv).expect("written");
        let told =
            answer(&["judge", &own, &motion, "--format", "json"], if law == "removed-constraint" { 3 } else { 0 });
        let judged: Value = serde_json::from_str(&told.0).expect("JSON");
        assert_eq!(judged["motions"][0]["samples"], 35);
        // multipliers, errors and derivatives are no film; the rest is
        let fit =
            ["fit", &own, &motion, "--free", "g", "--sigma", "1e-3", "--starts", "1", "--formulations", "chetaev"];
        let (told, _) = answer(&fit, if law == "chetaev" { 0 } else { 3 });
        let numbers = 41 * (6 + NAMES.len());
        assert!(told.contains(&format!("41 samples, {numbers} numbers; not looked at: ")), "{told}");
    }
}

/// Values that one ensemble was set to are members of another; and its own table is no table of members.
#[test]
fn members_are_read_as_they_were_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("members.csv").display().to_string();
    let ensemble = ["ensemble", "sledge", "-f", "chetaev", "--set", "duration=0.1"];
    let first = answer(&[&ensemble[..], &["--vary", "phi=0..0.3:3", "--vary", "x'=0.1..0.7:2"]].concat(), 0).0;
    let table = Table::read("first", &first).expect("a table");
    let [phi, rate] = ["set phi", "set x'"].map(|name| table.column(name).expect("a column"));
    let row = |row: usize| format!("{},\"{}\"\n", table.text(row, phi), table.text(row, rate));
    fs::write(&file, format!("phi,\"x'\"\n{}", table.rows().map(row).collect::<String>())).expect("written");
    assert_eq!(answer(&[&ensemble[..], &["--members", &file]].concat(), 0).0, first);
    fs::write(&file, &first).expect("written");
    refused(
        &[&ensemble[..], &["--members", &file]].concat(),
        &["members.csv:2:", "column `status`: `completed` is not a finite number"],
    );
}

/// No table is written that cannot be read.
#[test]
fn no_two_columns_have_one_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = folder.path().join("own.toml").display().to_string();
    fs::write(&own, scene().replace("\"#x\"", "x")).expect("written");
    refused(&["solve", &own, "-f", "chetaev", "--times", "0,1"], &["two columns of the table are called `x`"]);
    answer(&["solve", &own, "-f", "chetaev", "--times", "0,1", "--format", "json"], 0);
}
