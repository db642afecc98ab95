"""Builds the site: `python build.py OUT DOC OLDER`, in an environment with requirements.txt; DOC is what `cargo doc` wrote, OLDER
what `evidence reports --ages` prints. No page asks for anything from elsewhere. A measured page that is older than its code is not
built: a note that says so stands at its place.

Pages are those of the project, at their own places; what they link to is copied beside them. Then every link of every page
built is followed: one that leads nowhere is an error.
"""

import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import notebooks
import python_reference

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGES = ["README.md", "NOTATION.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "docs/*.md", "docs/tutorials/*.md", "reports/**/*.md", "validation/benchmark/README.md"]
NOTEBOOKS = "docs/*.ipynb"
MODULE = "crates/python/python/deltaq"
EXPLORER = "reports/explore.html"
LINK = re.compile(r'(\]\(|src="|href=")([^)\s"]+)')


def listing(folder):
    """A page that lists the files of a folder of the project."""
    files = subprocess.run(["git", "ls-files", "."], cwd=ROOT / folder, check=True, capture_output=True, text=True).stdout.split()
    return files, f"# {folder}\n\n" + "".join(f"- [{file}]({file})\n" for file in files)


def older(listed):
    """Notes by the pages of reports that are older than their code: a page and what is wrong with it on each line."""
    notes = {}
    for line in listed.splitlines():
        page, _, why = line.partition("\t")
        name = Path(page).stem
        notes[Path("reports") / page] = f"# {name}\n\nThis page is not part of the site: {why}. It is in the repository, under `reports/{page}`.\n"
    return notes


def stage(source, notes):
    """Copies pages and what they link to, folders as lists of their files; the files that are no pages."""
    pages = sorted(path.relative_to(ROOT) for pattern in PAGES for path in ROOT.glob(pattern))
    files, folders = {Path(EXPLORER)}, set()
    for page in pages:
        def link(match, page=page):
            target = urlsplit(match[2])
            place = (ROOT / page.parent / unquote(target.path)).resolve()
            if target.scheme or not target.path or not place.is_relative_to(ROOT):
                return match[0]
            inside = place.relative_to(ROOT)
            if place.is_dir():
                folders.add(inside)
                return match[0].rstrip("/") + "/index.md"
            if inside not in pages and place.is_file():
                files.add(inside)
            return match[0].replace(".ipynb", ".md")

        text = LINK.sub(link, notes.get(page) or (ROOT / page).read_text("utf-8"))
        write(source / page, text)
    for notebook in ROOT.glob(NOTEBOOKS):
        place = source / notebook.relative_to(ROOT)
        write(place.with_suffix(".md"), notebooks.page(notebook, lambda name, bytes, place=place: write(place.with_name(name), bytes)))
        files.add(notebook.relative_to(ROOT))
    for folder in folders:
        listed, page = listing(folder)
        files |= {folder / file for file in listed}
        write(source / folder / "index.md", "---\norphan: true\n---\n" + page)
    for file in files:
        write(source / file, (ROOT / file).read_bytes())
    return files


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))


class Links(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        named = dict(attributes)
        self.anchors |= {named[key] for key in ("id", "name") if named.get(key)}
        self.links += [named[key] for key in ("href", "src", "data") if named.get(key)]


def dead(out):
    """Links that lead nowhere, with their pages; and how many were followed."""
    pages = {path: Links(path.read_text("utf-8")) for path in out.rglob("*.html") if path != out / EXPLORER and "rust" not in path.relative_to(out).parts[:1]}
    found, count = [], 0
    for page, parsed in pages.items():
        for link in parsed.links:
            target = urlsplit(link)
            if target.scheme or target.netloc:
                continue
            count += 1
            place = (page.parent / unquote(target.path)).resolve() if target.path else page
            place = place / "index.html" if place.is_dir() else place
            known = pages.get(place)
            if not place.is_file() or known and target.fragment and unquote(target.fragment) not in known.anchors:
                found.append(f"{page.relative_to(out)}: {link}")
    return found, count


# What the theme leaves out and readers of the screen, or hands without a mouse, need: levels of headings, and a stop of the
# tabulator at what scrolls.
NEEDED = [
    ('<p class="caption" role="heading">', '<p class="caption" role="heading" aria-level="2">'),
    ("<pre>", '<pre tabindex="0">'),
    ('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper'),
]


def complete(page):
    text = page.read_text("utf-8")
    for before, after in NEEDED:
        text = text.replace(before, after)
    page.write_text(text, "utf-8")


def main(out, rust, listed):
    source = out.with_name(out.name + "-source")
    for folder in (source, out):
        shutil.rmtree(folder, ignore_errors=True)
    files = stage(source, older(listed))
    for name, text in python_reference.pages(ROOT / MODULE).items():
        write(source / f"{name}.md", text)
    shutil.copy(HERE / "index.md", source)
    subprocess.run([sys.executable, "-m", "sphinx", "--quiet", "--jobs", "auto", "--conf-dir", HERE, source, out], check=True)
    for page in out.rglob("*.html"):
        complete(page)
    for file in files:
        write(out / file, (source / file).read_bytes())
    write(out / "explore/index.html", (source / EXPLORER).read_bytes())
    shutil.copytree(rust, out / "rust")
    found, count = dead(out.resolve())
    size = sum(path.stat().st_size for path in out.rglob("*") if path.is_file())
    print(f"{len(list(out.rglob('*.html')))} pages, {size / 1e6:.1f} MB, {count} links followed, {len(found)} dead")
    if found:
        sys.exit("\n".join(sorted(set(found))[:40]))


if __name__ == "__main__":
    main(Path(sys.argv[1]).absolute(), Path(sys.argv[2]).absolute(), sys.argv[3])
