//! Markdown of texts that are not ours.

use program::File;

/// A link in Markdown: of its path all but letters, digits and `-._/` is percent-encoded.
pub fn link(text: &str, path: &str) -> String {
    // all brackets are escaped: the text has no links of its own
    let text = tagless(text).replace('\\', "\\\\").replace('[', "\\[").replace(']', "\\]");
    let text = text.replace("](", "]\\(");
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._/".contains(&byte);
    let encoded = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    format!("[{text}]({})", path.bytes().map(encoded).collect::<String>())
}

/// Text of a scene in a page: Markdown without HTML, with links to the web and to files beside only, and with
/// none in formulas.
pub fn inert(text: &str) -> String {
    let text = tagless(text).replace("\\href", "\\\\href");
    let address = |behind: &str| behind.strip_prefix(['(', ':']).is_some_and(|address| !is_harmless(address));
    replaced(&text, ']', |behind| if address(behind) { "\\]\\" } else { "]" })
}

/// A cell without marks of Markdown, for CSV: links by their text, no emphasis, plain minus signs, nothing
/// where a dash stands for nothing. Formulas keep their dollars.
pub(crate) fn plain(cell: &str) -> String {
    let cell = cell.trim().replace('\u{2212}', "-");
    if ["–", "-", ""].contains(&&cell[..]) {
        return String::new();
    }
    let mut text = String::new();
    for (i, part) in cell.split('$').enumerate() {
        let dollars = if i > 0 { "$" } else { "" };
        text += dollars;
        text += &if i % 2 == 0 { unlinked(&part.replace("**", "").replace('`', "")) } else { part.to_owned() };
    }
    // emphasis of the whole cell: a star elsewhere is a product
    let emphasis = text.strip_prefix('*').and_then(|rest| rest.strip_suffix('*')).filter(|inner| !inner.contains('*'));
    emphasis.map_or(text.clone(), str::to_owned)
}

/// Text with links by their texts.
fn unlinked(text: &str) -> String {
    let Some((before, rest)) = text.split_once("](") else { return text.to_owned() };
    let (Some((ahead, label)), Some((_, behind))) = (before.rsplit_once('['), rest.split_once(')')) else {
        return text.to_owned();
    };
    format!("{ahead}{label}{}", unlinked(behind))
}

/// Text in which nothing begins a tag of HTML.
fn tagless(text: &str) -> String {
    let begins_a_tag = |c: char| c.is_ascii_alphabetic() || "/!?".contains(c);
    replaced(text, '<', |behind| if behind.starts_with(begins_a_tag) { "&lt;" } else { "<" })
}

/// A text with something in the place of a character, by what stands behind it.
fn replaced(text: &str, character: char, by: impl Fn(&str) -> &'static str) -> String {
    let ends = text.match_indices(character).map(|(at, found)| by(&text[at + found.len()..]));
    let mut parts = text.split(character);
    let first = parts.next().unwrap_or_default().to_owned();
    ends.zip(parts).fold(first, |text, (by, part)| text + by + part)
}

/// Whether an address, which stands first in a text, is of the web or a plain path.
fn is_harmless(text: &str) -> bool {
    let address = text.trim_start().split([')', ' ', '\n']).next().unwrap_or_default();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-._/#%=".contains(c);
    ["https://", "http://", "mailto:"].iter().any(|scheme| address.starts_with(scheme)) || address.chars().all(plain)
}

/// What stands for a character in the text of a picture, which is XML.
const ENTITIES: [(&str, &str); 4] = [("&quot;", "\""), ("&lt;", "<"), ("&gt;", ">"), ("&amp;", "&")];

/// A picture in a page beside it; its title is the alternative text.
pub fn image(picture: &File) -> String {
    let name = picture.path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned());
    let title = picture.text.split_once("<title>").and_then(|(_, rest)| Some(rest.split_once("</title>")?.0));
    let plain = |title: &str| ENTITIES.iter().fold(title.to_owned(), |text, (entity, c)| text.replace(entity, c));
    format!("!{}", link(&title.map_or(name.clone(), plain), &name))
}
