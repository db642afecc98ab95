"""Settings of Sphinx for the site."""

import re

from docutils.nodes import SkipNode
from latex2mathml.converter import convert

project = "deltaq"
html_title = "deltaq"
extensions = ["myst_parser"]
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 6
# links to folders and to headings of reports are held by the check of all links of the built site
suppress_warnings = ["myst.header", "myst.xref_missing", "toc.not_included"]
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_favicon = "static/icon.svg"
html_copy_source = False
html_show_sphinx = False
html_show_copyright = False


# letters that MathML has as characters of their own
SCRIPT = {"E": "ℰ", "H": "ℋ", "L": "ℒ", "S": "𝒮"}


def mathml(text, display):
    """A formula as MathML, which browsers set without a script, a font or a network."""
    text = re.sub(r"\\mathcal\s*\{?([A-Z])\}?", lambda letter: SCRIPT[letter[1]], text)
    return convert(text.replace("{aligned}", "{split}"), display=display)


def formula(self, node):
    self.body.append(mathml(node.astext(), "inline"))
    raise SkipNode


def block(self, node):
    self.body.append(f'<div class="formula" tabindex="0">{mathml(node.astext(), "block")}</div>')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (formula, None), (block, None))
    app.config.html_math_renderer = "mathml"
