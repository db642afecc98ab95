//! Files are written whole or not at all.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// A file of a report.
#[derive(Clone, Debug)]
pub struct File {
    /// Path inside the folder of reports.
    pub path: PathBuf,
    /// Text.
    pub text: String,
}

/// A link in Markdown: of its path all but letters, digits and `-._/` is percent-encoded.
pub(crate) fn link(text: &str, path: &str) -> String {
    let text = text.replace('\\', "\\\\").replace('[', "\\[").replace(']', "\\]");
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._/".contains(&byte);
    let encoded = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    format!("[{text}]({})", path.bytes().map(encoded).collect::<String>())
}

/// What stands for a character in the text of a picture, which is XML.
const ENTITIES: [(&str, &str); 4] = [("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")];

/// A picture in a page beside it; those who cannot see it are told its title.
pub(crate) fn image(picture: &File) -> String {
    let name = picture.path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let title = picture.text.split_once("<title>").and_then(|(_, rest)| Some(rest.split_once("</title>")?.0));
    let plain = |title: &str| ENTITIES.iter().fold(title.to_owned(), |text, (entity, c)| text.replace(entity, c));
    format!("!{}", link(&title.map_or(name.clone(), plain), &name))
}

/// Writes every file beside its place first; only when all are written are they moved into place.
///
/// # Errors
/// Whatever the file system says, with the path.
pub fn write_all(folder: &Path, files: &[File]) -> Result<()> {
    let mut waiting = Vec::new();
    for file in files {
        let path = folder.join(&file.path);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).with_context(|| format!("cannot create {}", parent.display()))?;
        // a device is written to, not replaced
        if fs::metadata(&path).is_ok_and(|there| !there.is_file()) {
            fs::write(&path, &file.text).with_context(|| format!("cannot write {}", path.display()))?;
            continue;
        }
        let mut temporary =
            tempfile::NamedTempFile::new_in(parent).with_context(|| format!("cannot write in {}", parent.display()))?;
        temporary.write_all(file.text.as_bytes()).with_context(|| format!("cannot write {}", path.display()))?;
        waiting.push((temporary, path));
    }
    for (temporary, path) in waiting {
        make_readable(temporary.as_file())?;
        temporary.persist(&path).with_context(|| format!("cannot replace {}", path.display()))?;
    }
    Ok(())
}

/// Temporary files are private; reports are for everybody.
#[cfg(unix)]
fn make_readable(file: &fs::File) -> Result<()> {
    use std::os::unix::fs::PermissionsExt;
    Ok(file.set_permissions(fs::Permissions::from_mode(0o644))?)
}

#[cfg(not(unix))]
fn make_readable(_: &fs::File) -> Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{File, image, link};

    #[test]
    fn names_of_files_do_not_end_links() {
        assert_eq!(link("my [1].svg", "a/my [1](ü).svg"), "[my \\[1\\].svg](a/my%20%5B1%5D%28%C3%BC%29.svg)");
        assert_eq!(link("x", "ball-in-cone_2.svg"), "[x](ball-in-cone_2.svg)");
        let picture = |text: &str| File { path: "scenes/own.svg".into(), text: text.into() };
        assert_eq!(image(&picture("<svg><title>gap &lt; 1 &amp; more</title></svg>")), "![gap < 1 & more](own.svg)");
        assert_eq!(image(&picture("<svg/>")), "![own.svg](own.svg)");
    }
}
