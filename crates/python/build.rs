//! The stubs are the one place of docstrings: each goes to a file of its own, which `doc!` of `src/lib.rs`
//! includes.

use std::path::Path;
use std::{env, fs, io};

/// From this crate, and in a source distribution, where what is Python stands above all crates.
const STUBS: [&str; 2] = ["python/deltaq/_native.pyi", "../../python/deltaq/_native.pyi"];
const QUOTES: &str = "\"\"\"";

fn main() -> io::Result<()> {
    let stubs = STUBS.into_iter().find(|file| Path::new(file).exists());
    let stubs = stubs.ok_or_else(|| io::Error::other(format!("there is none of {}", STUBS.join(", "))))?;
    println!("cargo::rerun-if-changed={stubs}");
    let out = env::var_os("OUT_DIR").ok_or_else(|| io::Error::other("cargo sets OUT_DIR"))?;
    let text = fs::read_to_string(stubs)?;
    let (mut owner, mut item, mut lines) = (String::new(), String::new(), text.lines());
    while let Some(line) = lines.next() {
        let bare = line.trim_start();
        let indent = line.len() - bare.len();
        if let Some(first) = bare.strip_prefix(QUOTES) {
            let mut doc = first.to_owned();
            while !doc.ends_with(QUOTES) {
                let Some(next) = lines.next() else { break };
                doc += "\n";
                doc += next.get(indent..).unwrap_or_default();
            }
            fs::write(Path::new(&out).join(format!("{item}.txt")), doc.trim_end_matches(QUOTES).trim_end())?;
        } else if indent <= 4 {
            // a class, a function or an attribute; lines of a signature begin further in
            let named = bare.strip_prefix("class ").or(bare.strip_prefix("def ")).unwrap_or(bare);
            let name = named.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default();
            match (name, indent) {
                ("", _) => {}
                (_, 0) => (owner, item) = (name.to_owned(), name.to_owned()),
                _ => item = format!("{owner}.{name}"),
            }
        }
    }
    Ok(())
}
