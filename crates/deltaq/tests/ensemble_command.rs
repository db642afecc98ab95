//! `deltaq ensemble` as a user runs it: members are single motions, none is dropped, faults have a place.

use std::path::Path;

use serde_json::Value;

use crate::support::{self, refused, run};

#[track_caller]
fn answer(arguments: &[&str], code: i32) -> (String, String) {
    support::answer(&[&["ensemble"], arguments].concat(), code)
}

/// Names of the columns and the cells of every row; causes, which are quoted, stand last.
fn table(text: &str) -> (Vec<&str>, Vec<Vec<&str>>) {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().expect("names").split(',').collect();
    let rows = lines.map(|line| line.splitn(names.len(), ',').collect::<Vec<_>>());
    let rows: Vec<Vec<&str>> = rows.collect();
    assert!(rows.iter().all(|row| row.len() == names.len()), "{text}");
    (names, rows)
}

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path.display().to_string()
}

#[test]
fn members_are_the_motions_of_solve() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(folder.path(), "m.csv", "g, phi'\n9.81, 1.1\n3.7, -0.4\n1.6, 2\n");
    let automatic = ["removed-constraint", "--removal", "quasi-velocities", "--constants", "start=0.5"];
    for formulation in [&["chetaev"][..], &["chetaev-reduced"], &["vakonomic"], &automatic] {
        let arguments = [&["sledge", "--times", "0,2.5,10", "-f"], formulation].concat();
        let (text, _) = answer(&[&arguments[..], &["--members", &file, "--vary", "phi=0..0.6:2"]].concat(), 0);
        let (names, rows) = table(&text);
        assert_eq!(&names[..5], ["member", "set g", "set phi'", "set phi", "t"]);
        assert_eq!(rows.len(), 3 * 2 * 3);
        for member in rows.chunks(3) {
            let set: Vec<String> = (1..4).map(|i| format!("{}={}", &names[i][4..], member[0][i])).collect();
            let set = set.iter().flat_map(|x| ["--set", x]).collect::<Vec<_>>();
            let single = run(&[&["solve"], &arguments[..], &["--method", "taylor"], &set].concat());
            let single = String::from_utf8(single.stdout).expect("UTF-8");
            let (mut known, expected) = table(&single);
            known.retain(|name| !name.starts_with("error "));
            assert_eq!(&names[4..4 + known.len()], known);
            for (row, expected) in member.iter().zip(&expected) {
                for (here, there) in row[4..4 + known.len()].iter().zip(expected) {
                    let [here, there] = [here, there].map(|x| x.parse::<f64>().expect("a number"));
                    assert!((here - there).abs() < 1e-8 * there.abs().max(1.0), "{formulation:?} {set:?}: {row:?}");
                }
            }
        }
    }
}

#[test]
fn members_that_fail_are_listed_with_their_cause() {
    // the first two blades turn across the slope, where x is no parameter; the third comes back before
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(folder.path(), "m.csv", "phi,phi'\n0.3,1.1\n0.3,-0.2\n0.1,-1.5\n");
    let removed = ["sledge", "-f", "removed-constraint", "--removal", "along-x", "--constants", "zero"];
    let arguments = [&removed[..], &["--members", &file, "--times", "0:0.8:3"]].concat();
    let (text, complaint) = answer(&arguments, 3);
    let (names, rows) = table(&text);
    let of = |member: &str| rows.iter().filter(|row| row[0] == member).collect::<Vec<_>>();
    let (status, cause) = (names.len() - 2, names.len() - 1);
    assert_eq!(of("1").len(), 2, "{text}");
    assert!(of("1").iter().all(|row| row[status] == "stopped" && row[cause].contains("cos(phi) vanishes")), "{text}");
    assert_eq!(of("2").len(), 3, "{text}");
    assert!(of("2").iter().all(|row| row[status] == "stopped"), "the run goes on to 10 s: {text}");
    assert!(complaint.contains("member 1 (phi = 0.3, phi' = 1.1): stopped at t = 0.69"), "{complaint}");

    let (text, complaint) = answer(&["ball-in-cone", "-f", "chetaev", "--vary", "theta=-0.4..0.4:3"], 3);
    let (_, rows) = table(&text);
    assert_eq!(rows.iter().map(|row| row[status_of(&text)]).collect::<Vec<_>>(), ["completed", "refused", "completed"]);
    assert!(rows[1].iter().filter(|cell| cell.is_empty()).count() > 10, "{text}");
    assert!(text.contains("not determined") && complaint.starts_with("deltaq: 1 of 3 members"), "{complaint}");

    let json = ["ball-in-cone", "-f", "chetaev", "--vary", "theta=-0.4..0.4:3", "--format", "json"];
    let value: Value = serde_json::from_str(&answer(&json, 3).0).expect("JSON");
    assert_eq!(value["count"], serde_json::json!({ "completed": 2, "untrusted": 0, "stopped": 0, "refused": 1 }));
    assert_eq!(value["members"][1]["set"]["theta"], 0.0);
    assert!(value["members"][1]["cause"].as_str().is_some_and(|cause| cause.contains("not determined")));
    assert_eq!(value["members"][0]["coordinates"]["theta"].as_array().map(Vec::len), Some(1));
}

fn status_of(text: &str) -> usize {
    table(text).0.iter().position(|name| *name == "status").expect("a status")
}

#[test]
fn the_answer_does_not_depend_on_threads_and_is_written_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let arguments = ["sledge", "-f", "vakonomic", "--vary", "mu0_1=-0.3..0.3:7", "--vary", "k=0.5..1:3"];
    let (text, _) = answer(&arguments, 0);
    for threads in ["1", "3"] {
        let out = folder.path().join(threads).join("members.csv");
        let given = ["--threads", threads, "--out", out.to_str().expect("UTF-8")];
        let (told, _) = answer(&[&arguments[..], &given].concat(), 0);
        assert!(told.starts_with("21 members in "), "{told}");
        assert_eq!(std::fs::read_to_string(&out).expect("the file"), text);
        let beside = std::fs::read_dir(out.parent().expect("a folder")).expect("files").count();
        assert_eq!(beside, 1, "something was left beside the answer");
    }
}

#[test]
fn what_was_cut_off_goes_on_and_nothing_is_lost_or_doubled() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("m.csv");
    let (part, file) = (folder.path().join("m.csv.part"), out.to_str().expect("UTF-8"));
    // the second of three blades cannot be started where y' contradicts x'
    let options = ["-f", "chetaev", "--vary", "phi=0..0.6:3", "--vary", "phi'=0.5..1:2", "--times", "0,1"];
    let arguments =
        [&["ball-in-cone", "-f", "chetaev", "--vary", "theta=-0.4..0.4:3", "--times", "0,1"], &["sledge"][..0]];
    let sledge = [&["sledge"][..], &options].concat();
    for (arguments, code) in [(sledge, 0), (arguments.concat(), 3)] {
        let (whole, complaint) = answer(&arguments, code);
        let to_file = [&arguments[..], &["--out", file]].concat();
        for cut in [0, 1, whole.len() / 3, whole.len() / 2, whole.len() - 1, whole.len()] {
            std::fs::write(&part, &whole.as_bytes()[..cut]).expect("written");
            let (_, told) = answer(&to_file, code);
            assert_eq!(
                (std::fs::read_to_string(&out).expect("the file"), told),
                (whole.clone(), complaint.clone()),
                "{cut}"
            );
            assert!(!part.exists());
        }
        // of other times, of other members, of another tolerance
        for (from, to) in [("t,", "s,"), ("\n2,", "\n3,"), (".0,", ".5,")] {
            std::fs::write(&part, whole.replacen(from, to, 3)).expect("written");
            refused(&[&["ensemble"], &to_file[..]].concat(), &["m.csv.part", "another ensemble"]);
            assert!(part.exists());
        }
    }
}

#[test]
fn faults_have_their_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |text: &str, words: &[&str]| {
        let path = write(folder.path(), "m.csv", text);
        refused(&["ensemble", "sledge", "-f", "chetaev", "--members", &path], words);
    };
    file("g,phi\n9,1\n9,one\n", &["m.csv:3:3", "`one`", "phi"]);
    file("g,phi\n9,1,2\n", &["m.csv:2:5", "3 cells, and the header has 2"]);
    file("g,gg\n9,1\n", &["m.csv:1:3", "`gg`", "alpha"]);
    file("duration\n9\n", &["m.csv:1:1", "--set"]);
    file("mu0_1\n9\n", &["m.csv:1:1", "vakonomic"]);
}

#[test]
fn members_that_are_not_trusted_are_complained_about_and_counted() {
    let arguments = ["sledge", "-f", "chetaev", "--tolerance", "0.5", "--times", "10", "--vary", "phi=0..0.6:4"];
    let (text, complaint) = answer(&arguments, 3);
    let (_, rows) = table(&text);
    let status = |row: &&Vec<&str>| row[row.len() - 2] == "untrusted";
    let untrusted = rows.iter().filter(status).count();
    assert!(untrusted > 0, "{text}");
    assert!(complaint.contains(&format!("{untrusted} of 4 members are not to be trusted to the end")), "{complaint}");
}
