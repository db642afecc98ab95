//! Texts that are not ours on pages, and names of files in links.

use pages::markdown::{image, inert, link};
use program::File;

#[test]
fn a_page_obeys_no_text_of_a_scene() {
    let told = "x < y and a<b, [a](https://a.org/?b=1), [b](../c.md#d): [1], *no*";
    assert_eq!(inert(told), told.replace("a<b", "a&lt;b"));
    assert_eq!(inert("<script>x</script><!-- -->"), "&lt;script>x&lt;/script>&lt;!-- -->");
    assert_eq!(inert(r"$\href{javascript:x}{y}$, \phi"), r"$\\href{javascript:x}{y}$, \phi");
    for address in ["javascript:x", "JavaScript&#58;x", " <javascript:x>", "\njava\tscript:x", "data:x", "//\\x:y"] {
        assert_eq!(inert(&format!("[a]({address})")), format!("[a\\]\\({})", inert(address)));
        assert_eq!(inert(&format!("[a]: {address}")), format!("[a\\]\\: {}", inert(address)));
    }
}

#[test]
fn names_of_files_do_not_end_links() {
    assert_eq!(link("my [1].svg", "a/my [1](ü).svg"), "[my \\[1\\].svg](a/my%20%5B1%5D%28%C3%BC%29.svg)");
    assert_eq!(link("x", "ball-in-cone_2.svg"), "[x](ball-in-cone_2.svg)");
    let picture = |text: &str| File { path: "scenes/own.svg".into(), text: text.into() };
    assert_eq!(image(&picture("<svg><title>gap &lt; 1 &amp; more</title></svg>")), "![gap < 1 & more](own.svg)");
    assert_eq!(image(&picture("<svg/>")), "![own.svg](own.svg)");
    let title = "<svg><title>a [x](javascript:y) &lt;b&gt; c</title></svg>";
    assert_eq!(image(&picture(title)), r"![a \[x\]\(javascript:y) &lt;b> c](own.svg)");
}
