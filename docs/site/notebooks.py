"""Notebooks as pages: what their cells say, and what came out, pictures as files beside the page."""

import base64
import json


def outputs(cell, name, write):
    """What came out of a cell, in Markdown; `write` takes pictures by their names."""
    page = ""
    for i, output in enumerate(cell.get("outputs", [])):
        data = {kind: "".join(text) for kind, text in output.get("data", {"text/plain": output.get("text", "")}).items()}
        if "image/png" in data:
            picture = f"{name}-{i}.png"
            write(picture, base64.b64decode(data["image/png"]))
            page += f"![{data.get('text/plain', 'picture').strip('<>')}]({picture})\n\n"
        elif "text/html" in data and data["text/html"].startswith("<svg"):
            write(f"{name}-{i}.svg", data["text/html"].encode())
            page += f"![{data['text/plain'].strip('<>')}]({name}-{i}.svg)\n\n"
        elif "text/html" in data:
            rows = "\n".join(line for line in data["text/html"].splitlines() if line.strip())
            # what scrolls is a stop of the tabulator
            page += "<div>\n" + rows.replace("<style scoped>", "<style>").replace("<table", '<table tabindex="0"') + "\n</div>\n\n"
        elif "text/latex" in data:
            page += f"```{{math}}\n{data['text/latex'].strip('$').removeprefix(chr(92) + 'displaystyle ')}\n```\n\n"
        else:
            page += f"```text\n{data['text/plain'].strip()}\n```\n\n"
    return page


def page(path, write):
    """A notebook in Markdown."""
    text = ""
    for i, cell in enumerate(json.loads(path.read_text("utf-8"))["cells"]):
        source = "".join(cell["source"])
        is_code = cell["cell_type"] == "code"
        text += (f"```python\n{source}\n```\n\n" + outputs(cell, f"{path.stem}-{i}", write)) if is_code else f"{source}\n\n"
        text += "" if i else f"*This page is a notebook: [download it]({path.name}).*\n\n"
    return text
