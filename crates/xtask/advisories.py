"""The advisories that `cargo xtask deny` checks dependencies against: `advisories.tsv`, one per line.

    advisories.py lay FOLDER    writes them as the database that cargo-deny reads
    advisories.py take CLONE    renews advisories.tsv from a clone of the RustSec advisory database
"""

import json
import os
import subprocess
import sys
import tomllib
from datetime import datetime
from pathlib import Path

LIST = Path(__file__).with_name("advisories.tsv")
# Where cargo-deny looks for a clone of the database under its `db-path`.
NAME = "advisory-db-3157b0e258782691"
HEAD = "# RustSec advisory database, commit {} of {}; CC0-1.0, in parts CC-BY-4.0. Renewed by advisories.py.\n"


def lay(folder):
    """Without a fetch, cargo-deny takes the age of the database from the time of `.git/FETCH_HEAD`."""
    head, *lines = LIST.read_text(encoding="utf-8").splitlines()
    for line in lines:
        identifier, package, date, kind, patched, unaffected = line.split("\t")
        place = folder / NAME / "crates" / package
        place.mkdir(parents=True, exist_ok=True)
        informational = f"informational = {json.dumps(kind)}\n" if kind else ""
        (place / f"{identifier}.md").write_text(
            f'```toml\n[advisory]\nid = "{identifier}"\npackage = "{package}"\ndate = "{date}"\n{informational}'
            f"[versions]\npatched = {patched}\nunaffected = {unaffected}\n```\n\n"
            f"# see https://rustsec.org/advisories/{identifier}\n\n{package}\n",
            encoding="utf-8",
        )
    fetched = folder / NAME / ".git" / "FETCH_HEAD"
    fetched.parent.mkdir(exist_ok=True)
    fetched.write_text(head + "\n", encoding="utf-8")
    date = head.split(" of ")[1].split(";")[0]
    seconds = datetime.fromisoformat(date).timestamp()
    os.utime(fetched, (seconds, seconds))
    print(f", {len(lines)} advisories of {date}")


def take(clone):
    git = ["git", "-C", str(clone)]
    commit, date = subprocess.check_output([*git, "log", "-1", "--format=%h %cs"], text=True).split()
    lines = []
    for name in subprocess.check_output([*git, "ls-tree", "-r", "--name-only", "HEAD", "crates/"], text=True).split():
        text = subprocess.check_output([*git, "show", f"HEAD:{name}"], text=True)
        data = tomllib.loads(text.split("```toml", 1)[1].split("\n```", 1)[0])
        about, versions = data["advisory"], data["versions"]
        if "withdrawn" in about:
            continue
        ranges = (json.dumps(versions.get(key, [])) for key in ("patched", "unaffected"))
        fields = (about["id"], about["package"], about["date"], about.get("informational", ""), *ranges)
        lines.append("\t".join(map(str, fields)) + "\n")
    LIST.write_text(HEAD.format(commit, date) + "".join(sorted(lines)), encoding="utf-8")


if __name__ == "__main__":
    {"lay": lay, "take": take}[sys.argv[1]](Path(sys.argv[2]))
