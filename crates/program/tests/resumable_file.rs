//! Files of lines that are gone on with.

use std::io::Write;

use anyhow::Error;
use program::ResumableFile;

/// A head of two lines, and two lines behind it; `ü` is two bytes.
const HEAD: &str = "\"na\nme\",x\n";
const WHOLE: &str = "\"na\nme\",x\n1,ü\n2,b\n";

#[test]
fn a_file_cut_off_anywhere_goes_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines");
    for cut in 0..=WHOLE.len() {
        std::fs::write(&path, &WHOLE.as_bytes()[..cut]).unwrap();
        let mut lines = ResumableFile::open(&path, HEAD, |_| Error::msg("foreign")).unwrap();
        let mut kept = 0;
        while let Some(line) = lines.next_line().unwrap() {
            assert_eq!(line, ["1,ü\n", "2,b\n"][kept], "{cut}");
            lines.keep(lines.at());
            kept += 1;
        }
        let mut file = lines.go_on().unwrap();
        ["1,ü\n", "2,b\n"][kept..].iter().for_each(|line| file.write_all(line.as_bytes()).unwrap());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), WHOLE, "{cut}");
    }
}

#[test]
fn what_begins_otherwise_is_foreign_and_stays() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines");
    for there in ["x", "\"na\nmy\",x\n1\n", "\"na\nme\",y"] {
        std::fs::write(&path, there).unwrap();
        let error = ResumableFile::open(&path, HEAD, |first| Error::msg(first.to_owned())).map(drop).unwrap_err();
        assert_eq!(error.to_string(), there.lines().next().unwrap());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), there);
    }
}
