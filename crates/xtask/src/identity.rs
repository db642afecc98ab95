//! Who made it and where it is: known in one place, `[workspace.package]` and `[workspace.metadata.identity]`
//! of the workspace's manifest, and copied from there to all files that say it.

use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};

use crate::sources;
use crate::tools::Outcome;

const MANIFEST: &str = "Cargo.toml";
/// Readmes of packages stand two folders below the root; links of indexes are absolute.
const FROM_PACKAGES: &str = "](../../";
/// What only holds of a project with an address, each in two halves, so that this file passes.
const PRETENDING: [(&str, &str); 6] = [
    ("pip install ", "deltaq"),
    ("pip install \"", "deltaq["),
    ("cargo install ", "deltaq"),
    ("cargo add ", "deltaq"),
    ("github.com/", "deltaq"),
    ("deltaq.", "readthedocs"),
];
/// Text that is prepared for the day of the release.
const PREPARED: &str = "docs/releases/";

/// A person, as `Name (ORCID; affiliation)`, or a placeholder without the brackets.
struct Author {
    name: String,
    orcid: Option<String>,
    affiliation: Option<String>,
}

struct Identity {
    authors: Vec<Author>,
    address: Option<String>,
    version: String,
    date: String,
}

/// Every file says who and where as the manifest does, and none speaks of an address that there is not.
pub(crate) fn check() -> Result<Outcome> {
    let identity = Identity::read()?;
    let stale: Vec<String> = identity.files()?.into_iter().map(|(path, _)| path.display().to_string()).collect();
    ensure!(stale.is_empty(), "not as {MANIFEST} says: {}", stale.join(", "));
    if identity.address.is_none() {
        let found = pretending()?;
        ensure!(found.is_empty(), "there is no address yet: {}", found.join("; "));
    }
    let address = identity.address.as_deref().unwrap_or("no address yet");
    Ok(Outcome::Passed(format!(", {address}, {} authors", identity.authors.len())))
}

/// Sets the address, if one is given (`none` for none), and writes all that follows from the manifest.
pub(crate) fn write(arguments: &[&str]) -> Result<Outcome> {
    if let [address] = arguments {
        let before = Identity::read()?;
        let address = if *address == "none" { "" } else { address.trim_end_matches('/') };
        ensure!(address.is_empty() || address.starts_with("https://"), "`{address}` is no address: https://…");
        let text = read(MANIFEST)?;
        let line = |address: &str| format!("\naddress = \"{address}\"\n");
        let now = line(before.address.as_deref().unwrap_or_default());
        ensure!(text.matches(&now).count() == 1, "{MANIFEST} has no line{now}");
        std::fs::write(MANIFEST, text.replace(&now, &line(address)))?;
        let (old, new) = (links(before.address.as_deref()), links(Some(address).filter(|address| !address.is_empty())));
        for readme in readmes()? {
            let text = read(&readme)?;
            std::fs::write(&readme, text.replace(&old, &new))?;
        }
    }
    let files = Identity::read()?.files()?;
    for (path, text) in &files {
        std::fs::write(path, text).with_context(|| path.display().to_string())?;
    }
    Ok(Outcome::Passed(format!(", {} files changed", files.len())))
}

/// How links of a package's readme begin.
fn links(address: Option<&str>) -> String {
    address.map_or_else(|| FROM_PACKAGES.to_owned(), |address| format!("]({address}/blob/main/"))
}

fn readmes() -> Result<Vec<String>> {
    let is_readme = |name: &String| name.starts_with("crates/") && name.ends_with("/README.md");
    Ok(sources::names()?.into_iter().filter(is_readme).collect())
}

fn read(path: &str) -> Result<String> {
    std::fs::read_to_string(path).with_context(|| path.to_owned())
}

/// Lines that tell a reader to fetch what is nowhere yet.
fn pretending() -> Result<Vec<String>> {
    let mut found = Vec::new();
    for name in sources::names()?.into_iter().filter(|name| !name.starts_with(PREPARED)) {
        let Ok(text) = std::fs::read_to_string(&name) else { continue };
        for (number, line) in (1..).zip(text.lines()) {
            let words = PRETENDING.iter().map(|(head, tail)| format!("{head}{tail}"));
            found.extend(
                words.filter(|words| line.contains(words)).map(|words| format!("{name}:{number} says `{words}`")),
            );
        }
    }
    Ok(found)
}

impl Identity {
    fn read() -> Result<Identity> {
        let text = read(MANIFEST)?;
        let value = |key: &str| {
            let line = text.lines().find_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix("= "));
            line.with_context(|| format!("{MANIFEST} has no `{key} = …`"))
        };
        let plain = |key: &str| Ok::<_, anyhow::Error>(value(key)?.trim_matches('"').to_owned());
        let authors = value("authors")?.trim_matches(['[', ']']).split("\", \"");
        let address = plain("address")?;
        Ok(Identity {
            authors: authors.map(|author| Author::new(author.trim_matches('"'))).collect(),
            address: (!address.is_empty()).then_some(address),
            version: plain("version")?,
            date: plain("date")?,
        })
    }

    /// Files that are not as they should be, with their texts.
    fn files(&self) -> Result<Vec<(PathBuf, String)>> {
        let mut files = vec![
            ("CITATION.cff".to_owned(), self.citation(&read("CITATION.cff")?)?),
            ("codemeta.json".to_owned(), self.codemeta()),
            (".zenodo.json".to_owned(), self.zenodo()),
            ("docs/paper/paper.md".to_owned(), self.paper(&read("docs/paper/paper.md")?)?),
            ("README.md".to_owned(), self.badges(&read("README.md")?)),
            ("crates/python/pyproject.toml".to_owned(), self.urls(&read("crates/python/pyproject.toml")?)),
            (MANIFEST.to_owned(), self.manifest(&read(MANIFEST)?)),
        ];
        for name in sources::names()?.into_iter().filter(|name| name.ends_with("/Cargo.toml")) {
            let text = self.package(&read(&name)?);
            files.push((name, text));
        }
        for name in readmes()? {
            let text = read(&name)?;
            let relative = self.address.is_some() && text.contains(FROM_PACKAGES);
            ensure!(
                !relative,
                "{name} has links that indexes cannot follow; `cargo xtask address none`, then the address"
            );
        }
        let stale = |(name, text): &(String, String)| std::fs::read_to_string(name).ok().as_ref() != Some(text);
        Ok(files.into_iter().filter(stale).map(|(name, text)| (name.into(), text)).collect())
    }

    /// The page of the documents.
    fn documents(address: &str) -> String {
        format!("{address}/blob/main/docs/guide.md")
    }

    fn manifest(&self, text: &str) -> String {
        let lines = self.address.as_ref().map(|address| {
            let documents = Self::documents(address);
            format!("repository = \"{address}\"\nhomepage = \"{address}\"\ndocumentation = \"{documents}\"\n")
        });
        with_lines(text, "license = ", |line| is_key(line, " = "), &lines.unwrap_or_default())
    }

    /// Of a package that is published: cargo refuses to inherit what is not set.
    fn package(&self, text: &str) -> String {
        let lines = self.address.as_ref().filter(|_| !text.contains("publish = false"));
        let lines = lines.map(|_| KEYS.map(|key| format!("{key}.workspace = true\n")).concat());
        with_lines(text, "license.workspace", |line| is_key(line, ".workspace"), &lines.unwrap_or_default())
    }

    fn urls(&self, text: &str) -> String {
        let head = "[project.urls]";
        let before = text.split(&format!("{head}\n")).next().unwrap_or(text).trim_end();
        let after = text.split(&format!("{head}\n")).nth(1).and_then(|rest| rest.split_once("\n\n"));
        let whole = after.map_or_else(|| text.to_owned(), |(_, rest)| format!("{before}\n\n{rest}"));
        let Some(address) = &self.address else { return whole };
        let documents = Self::documents(address);
        let urls = format!(
            "{head}\nRepository = \"{address}\"\nDocumentation = \"{documents}\"\nIssues = \"{address}/issues\"\n\
             Changelog = \"{address}/blob/main/CHANGELOG.md\"\n\n[tool.maturin]"
        );
        whole.replacen("[tool.maturin]", &urls, 1)
    }

    fn badges(&self, text: &str) -> String {
        let badge = |address: &String| {
            let page = format!("{address}/actions/workflows/test.yml");
            format!("\n[![test]({page}/badge.svg)]({page})\n")
        };
        let lines = self.address.as_ref().map(badge).unwrap_or_default();
        let (title, rest) = text.split_once('\n').unwrap_or((text, ""));
        let rest = if rest.starts_with("\n[![") { rest.splitn(3, '\n').nth(2).unwrap_or_default() } else { rest };
        format!("{title}\n{lines}{rest}")
    }

    fn citation(&self, text: &str) -> Result<String> {
        let person = |author: &Author| {
            let orcid = author.orcid.iter().map(|orcid| format!("    orcid: \"https://orcid.org/{orcid}\"\n"));
            let at = author.affiliation.iter().map(|place| format!("    affiliation: \"{place}\"\n"));
            format!("  - name: \"{}\"\n{}", author.name, orcid.chain(at).collect::<String>())
        };
        let authors = self.authors.iter().map(person).collect::<String>();
        let address =
            self.address.iter().map(|address| format!("repository-code: \"{address}\"\n")).collect::<String>();
        let (version, date) = (&self.version, &self.date);
        let own = format!("authors:\n{authors}version: {version}\ndate-released: {date}\n{address}license:\n");
        between(text, "authors:\n", "license:\n", &own).context("CITATION.cff")
    }

    fn paper(&self, text: &str) -> Result<String> {
        let mut places: Vec<&str> = self.authors.iter().filter_map(|author| author.affiliation.as_deref()).collect();
        places.dedup();
        let person = |author: &Author| {
            let at = author.affiliation.as_deref().and_then(|at| places.iter().position(|place| *place == at));
            let orcid = author.orcid.iter().map(|orcid| format!("    orcid: {orcid}\n"));
            let at = at.map(|at| format!("    affiliation: {}\n", at + 1));
            format!("  - name: {}\n{}", author.name, orcid.chain(at).collect::<String>())
        };
        let authors = self.authors.iter().map(person).collect::<String>();
        let places = (1..).zip(&places).map(|(i, place)| format!("  - name: {place}\n    index: {i}\n"));
        let places = places.collect::<String>();
        let places = if places.is_empty() { String::new() } else { format!("affiliations:\n{places}") };
        let own = format!("authors:\n{authors}{places}date: {}\n", self.date);
        let rest = text.split_once("date: ").and_then(|(_, rest)| rest.split_once('\n')).context("paper.md: date")?.0;
        between(text, "authors:\n", &format!("date: {rest}\n"), &own).context("paper.md")
    }

    fn codemeta(&self) -> String {
        let person = |author: &Author| {
            let orcid = author.orcid.iter().map(|orcid| format!(", \"@id\": \"https://orcid.org/{orcid}\""));
            let kind = if author.orcid.is_some() { "Person" } else { "Organization" };
            format!("{{\"@type\": \"{kind}\", \"name\": \"{}\"{}}}", author.name, orcid.collect::<String>())
        };
        let authors = self.authors.iter().map(person).collect::<Vec<_>>().join(", ");
        let address = self.address.iter().map(|address| format!("  \"codeRepository\": \"{address}\",\n"));
        let (version, date, address) = (&self.version, &self.date, address.collect::<String>());
        format!(
            "{{\n  \"@context\": \"https://doi.org/10.5063/schema/codemeta-2.0\",\n  \"@type\": \"SoftwareSourceCode\",\n  \
             \"name\": \"deltaq\",\n  \"description\": \"{DESCRIPTION}\",\n  \"version\": \"{version}\",\n  \
             \"dateModified\": \"{date}\",\n  \"license\": [\"https://spdx.org/licenses/MIT\", \
             \"https://spdx.org/licenses/Apache-2.0\"],\n{address}  \"author\": [{authors}],\n  \
             \"programmingLanguage\": [\"Rust\", \"Python\"],\n  \"keywords\": [\"nonholonomic mechanics\", \
             \"vakonomic mechanics\", \"Lagrangian mechanics\", \"equations of motion\"],\n  \
             \"developmentStatus\": \"active\"\n}}\n"
        )
    }

    fn zenodo(&self) -> String {
        let person = |author: &Author| {
            let orcid = author.orcid.iter().map(|orcid| format!(", \"orcid\": \"{orcid}\""));
            let at = author.affiliation.iter().map(|place| format!(", \"affiliation\": \"{place}\""));
            format!("{{\"name\": \"{}\"{}}}", author.name, orcid.chain(at).collect::<String>())
        };
        let authors = self.authors.iter().map(person).collect::<Vec<_>>().join(", ");
        format!(
            "{{\n  \"title\": \"deltaq: equations of motion of nonholonomic systems, derived, integrated and compared\",\n  \
             \"description\": \"{DESCRIPTION}\",\n  \"upload_type\": \"software\",\n  \"version\": \"{}\",\n  \
             \"license\": \"MIT\",\n  \"notes\": \"MIT OR Apache-2.0, as you choose.\",\n  \"creators\": [{authors}],\n  \
             \"keywords\": [\"nonholonomic mechanics\", \"vakonomic mechanics\", \"Lagrangian mechanics\"]\n}}\n",
            self.version
        )
    }
}

/// One sentence for indexes of software.
const DESCRIPTION: &str = "Derives and integrates the competing equations of motion of nonholonomic systems \
                           (d'Alembert-Lagrange, vakonomic, removed-constraint) and decides whether they can agree.";

const KEYS: [&str; 3] = ["repository", "homepage", "documentation"];

fn is_key(line: &str, after: &str) -> bool {
    KEYS.iter().any(|key| line.strip_prefix(key).is_some_and(|rest| rest.starts_with(after)))
}

/// The text with these lines behind the first that begins with `anchor`, and without those that they replace.
fn with_lines(text: &str, anchor: &str, old: impl Fn(&str) -> bool, lines: &str) -> String {
    let mut done = false;
    let mut out = String::new();
    for line in text.split_inclusive('\n').filter(|line| !old(line)) {
        out += line;
        if !done && line.starts_with(anchor) {
            out += lines;
            done = true;
        }
    }
    out
}

/// The text with `own` in the place of what stands from `first` to `last`, both included.
fn between(text: &str, first: &str, last: &str, own: &str) -> Result<String> {
    let Some((before, rest)) = text.split_once(first) else { bail!("no `{}`", first.trim_end()) };
    let Some((_, after)) = rest.split_once(last) else { bail!("no `{}`", last.trim_end()) };
    Ok(format!("{before}{own}{after}"))
}

impl Author {
    fn new(text: &str) -> Author {
        let (name, rest) = text.split_once(" (").unwrap_or((text, ""));
        let mut parts = rest.trim_end_matches(')').split("; ").filter(|part| !part.is_empty()).map(str::to_owned);
        Author { name: name.to_owned(), orcid: parts.next(), affiliation: parts.next() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity(author: &str, address: Option<&str>) -> Identity {
        let address = address.map(str::to_owned);
        Identity { authors: vec![Author::new(author)], address, version: "1.2.3".into(), date: "2030-01-02".into() }
    }

    #[test]
    fn an_address_comes_and_goes() {
        let (none, some) = (identity("A", None), identity("A", Some("https://host.example/deltaq")));
        let package = "[package]\nname = \"a\"\nlicense.workspace = true\nauthors.workspace = true\n";
        let with = some.package(package);
        assert!(with.contains("license.workspace = true\nrepository.workspace = true\nhomepage.workspace"), "{with}");
        assert_eq!(none.package(&with), package);
        let own = format!("{package}publish = false\n");
        assert_eq!(some.package(&own), own);
        let readme = "# deltaq\n\n**It** is.\n";
        let with = some.badges(readme);
        assert!(with.starts_with("# deltaq\n\n[![test](https://host.example/deltaq/actions"), "{with}");
        assert_eq!((some.badges(&with), none.badges(&with)), (with.clone(), readme.to_owned()));
        let project = "[project]\nname = \"a\"\n\n[tool.maturin]\nstrip = true\n";
        let with = some.urls(project);
        assert!(with.contains("[project.urls]\nRepository = \"https://host.example/deltaq\"\n"), "{with}");
        assert_eq!((some.urls(&with), none.urls(&with)), (with.clone(), project.to_owned()));
    }

    #[test]
    fn authors_are_copied() {
        let citation = "title: \"a\"\nauthors:\n  - name: \"B\"\nversion: 0.0.0\nlicense:\n  - MIT\n";
        let one = identity("A B (0000-0001-2345-6789; Institute of C)", None);
        let text = one.citation(citation).unwrap();
        let expected = "authors:\n  - name: \"A B\"\n    orcid: \"https://orcid.org/0000-0001-2345-6789\"\n    affiliation: \"Institute of C\"\nversion: 1.2.3\ndate-released: 2030-01-02\nlicense:\n";
        assert!(text.contains(expected), "{text}");
        let paper = "---\ntitle: a\nauthors:\n  - name: B\ndate: 2000-01-01\n---\n";
        let text = one.paper(paper).unwrap();
        assert!(
            text.contains(
                "    affiliation: 1\naffiliations:\n  - name: Institute of C\n    index: 1\ndate: 2030-01-02\n"
            ),
            "{text}"
        );
        assert!(
            one.codemeta().contains("\"@type\": \"Person\"") && identity("A", None).codemeta().contains("Organization")
        );
    }
}
