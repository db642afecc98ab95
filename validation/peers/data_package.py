"""Tables as CSV with a data package (Frictionless), as the report code in Rust writes them."""

import csv
import io
import json
import re


def plain(cell):
    """A cell without marks of Markdown; nothing where a dash stands for nothing."""
    cell = cell.replace("**", "").replace("`", "").replace("\n", " ").strip()
    return "" if cell in ("–", "-") else re.sub(r"(?<=\d)e\u2212(?=\d)", "e-", cell)


def is_number(cell):
    try:
        float(cell)
    except ValueError:
        return cell == ""
    return True


class DataPackage:
    """A folder of tables: one CSV each, and `datapackage.json`."""

    def __init__(self, folder, title):
        self.folder, self.title, self.resources, self.texts = folder, title, [], {}

    def table(self, name, about, columns, rows):
        if not rows:
            return
        rows = [[plain(cell) for cell in row] for row in rows]
        out = io.StringIO()
        csv.writer(out, lineterminator="\n").writerows([columns, *rows])
        number = [all(map(is_number, cells)) and any(cells) for cells in zip(*rows)]
        fields = [{"name": column, "type": "number" if is_one else "string"} for column, is_one in zip(columns, number)]
        self.resources.append({"name": name, "title": about, "path": f"{name}.csv", "profile": "tabular-data-resource",
                               "format": "csv", "encoding": "utf-8", "schema": {"fields": fields}})
        self.texts[f"{self.folder}/{name}.csv"] = out.getvalue()

    def list(self, depth):
        up = "../" * depth
        return "".join(f"- {of['title']}: [{of['path']}]({up}{self.folder}/{of['path']})\n" for of in self.resources)

    def files(self):
        about = {"licenses": [{"name": "MIT"}, {"name": "Apache-2.0"}], "name": self.folder.removeprefix("data/").replace("/", "-"),
                 "profile": "tabular-data-package", "resources": self.resources, "title": self.title}
        return self.texts | {f"{self.folder}/datapackage.json": json.dumps(about, indent=2, ensure_ascii=False) + "\n"}
