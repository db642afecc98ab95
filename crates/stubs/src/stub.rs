//! The stubs as a list of what they describe.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// From the crate of the module, and in a source distribution, where what is Python stands above all crates.
const PLACES: [&str; 2] = ["python/deltaq/_native.pyi", "../../python/deltaq/_native.pyi"];
const QUOTES: &str = "\"\"\"";

/// A class, function, method or attribute.
pub(crate) struct Entry {
    /// `load`, or `Motion.at`.
    pub(crate) name: String,
    /// Its docstring, or what stands below an attribute; empty where there is none.
    pub(crate) doc: String,
    /// Parameters of a function with types and defaults; the type of an attribute; `(BASE):` of a class.
    pub(crate) said: String,
}

/// The stubs of the crate that is being compiled.
pub(crate) struct Stub {
    pub(crate) file: PathBuf,
    entries: Vec<Entry>,
}

impl Stub {
    pub(crate) fn read() -> io::Result<Stub> {
        let folder =
            env::var_os("CARGO_MANIFEST_DIR").ok_or_else(|| io::Error::other("cargo sets CARGO_MANIFEST_DIR"))?;
        let file = PLACES.into_iter().map(|place| Path::new(&folder).join(place)).find(|file| file.exists());
        let file = file.ok_or_else(|| io::Error::other(format!("there is none of {}", PLACES.join(", "))))?;
        Ok(Stub { entries: entries(&fs::read_to_string(&file)?), file })
    }

    pub(crate) fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name == name)
    }

    /// Exceptions that have one base: name, base and docstring.
    pub(crate) fn exceptions(&self) -> impl Iterator<Item = (&str, &str, &str)> {
        self.entries.iter().filter_map(|Entry { name, doc, said }| {
            let base = said.strip_prefix('(')?.strip_suffix("):")?;
            (!base.contains(',')).then_some((name.as_str(), base, doc.as_str()))
        })
    }

    /// Attributes of a class that can only be read, and their types.
    pub(crate) fn fields(&self, class: &str) -> impl Iterator<Item = (&str, &str)> {
        self.entries.iter().filter_map(move |entry| {
            let name = entry.name.strip_prefix(class)?.strip_prefix('.')?;
            Some((name, entry.said.strip_prefix("Final[")?.strip_suffix(']')?))
        })
    }
}

fn entries(text: &str) -> Vec<Entry> {
    let (mut owner, mut entries, mut lines) = (String::new(), Vec::<Entry>::new(), text.lines());
    while let Some(line) = lines.next() {
        let mut bare = line.trim_start().to_owned();
        let indent = line.len() - bare.len();
        if let Some(first) = bare.strip_prefix(QUOTES) {
            let mut doc = first.to_owned();
            while !doc.ends_with(QUOTES) {
                let Some(next) = lines.next() else { break };
                doc += "\n";
                doc += next.get(indent..).unwrap_or_default();
            }
            if let Some(entry) = entries.last_mut() {
                doc.trim_end_matches(QUOTES).trim_end().clone_into(&mut entry.doc);
            }
            continue;
        }
        // a signature goes on until its brackets are closed
        while depth(&bare) > 0 {
            let Some(next) = lines.next() else { break };
            bare += next.trim();
        }
        let function = bare.strip_prefix("def ");
        let named = function.or(bare.strip_prefix("class ")).unwrap_or(&bare);
        let end = named.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(named.len());
        let (name, rest) = named.split_at(end);
        let said = match function {
            Some(_) => rest.rsplit_once(" -> ").map_or(rest, |(arguments, _)| arguments),
            None => rest.strip_prefix(": ").unwrap_or(rest),
        };
        let name = match (name, indent) {
            ("", _) => continue,
            (_, 0) => {
                name.clone_into(&mut owner);
                name.to_owned()
            }
            _ => format!("{owner}.{name}"),
        };
        entries.push(Entry { name, doc: String::new(), said: said.to_owned() });
    }
    entries
}

/// Brackets that are not closed.
fn depth(text: &str) -> i32 {
    text.chars().map(|c| i32::from("([".contains(c)) - i32::from(")]".contains(c))).sum()
}

/// The parts of a text between separators outside of brackets.
fn split(text: &str, separator: char) -> Vec<&str> {
    let places = text.match_indices(separator).map(|(i, _)| i).filter(|&i| depth(&text[..i]) == 0);
    let ends: Vec<usize> = places.chain([text.len()]).collect();
    let starts = [0].into_iter().chain(ends.iter().map(|end| end + 1));
    starts.zip(&ends).map(|(start, &end)| text[start..end].trim()).filter(|part| !part.is_empty()).collect()
}

/// Parameters without their types, with defaults as Rust writes them.
pub(crate) fn signature(said: &str, is_method: bool) -> String {
    let inside = said.strip_prefix('(').and_then(|said| said.strip_suffix(')')).unwrap_or(said);
    let one = |part: &str| {
        let (part, default) = part.rsplit_once(" = ").map_or((part, None), |(part, default)| (part, Some(default)));
        let name = part.split(':').next().unwrap_or_default();
        let raw = if name == "virtual" { "r#" } else { "" };
        match default {
            None => format!("{raw}{name}"),
            Some("True") => format!("{raw}{name}=true"),
            Some("False") => format!("{raw}{name}=false"),
            Some(other) => format!("{raw}{name}={other}"),
        }
    };
    let parts: Vec<String> = split(inside, ',').into_iter().skip(usize::from(is_method)).map(one).collect();
    format!("({})", parts.join(", "))
}

/// What Rust holds for a type of Python.
pub(crate) fn rust(kind: &str) -> String {
    let either = split(kind, '|');
    if either.len() > 1 {
        let some: Vec<&str> = either.into_iter().filter(|own| *own != "None").collect();
        return format!("Option<{}>", rust(&some.join(" | ")));
    }
    let (of, inner) = kind.strip_suffix(']').and_then(|kind| kind.split_once('[')).unwrap_or((kind, ""));
    match of {
        "float" => "f64".into(),
        "int" => "usize".into(),
        "bool" => "bool".into(),
        "str" | "Literal" | "_Verdict" => "String".into(),
        "_Array" => "pyo3::Py<numpy::PyArrayDyn<f64>>".into(),
        "npt.NDArray" => "pyo3::Py<numpy::PyArrayDyn<numpy::Complex64>>".into(),
        "dict" => "pyo3::Py<pyo3::types::PyDict>".into(),
        "list" => format!("Vec<{}>", rust(inner)),
        "tuple" => format!("({})", split(inner, ',').into_iter().map(rust).collect::<Vec<_>>().join(", ")),
        class => format!("pyo3::Py<{class}>"),
    }
}
