"""The reference of the Python module as pages, from its stubs and sources: nothing has to be built or imported."""

import ast
import re
from copy import copy
from pathlib import Path


def signature(node, name):
    """A function as one writes its call."""
    arguments = re.sub(r"^(self|cls)(: \w+)?(, |$)", "", ast.unparse(node.args))
    returned = f" -> {ast.unparse(node.returns)}" if node.returns and node.name != "__new__" else ""
    return f"{name}({arguments}){returned}"


def escaped(text):
    """Prose as Markdown: only what stands in backticks has a meaning."""
    parts = text.split("`")
    return "`".join(part if i % 2 else re.sub(r"([*_<$\[\]])", r"\\\1", part) for i, part in enumerate(parts))


def section(lines):
    """The entries of a section of numpydoc as a list: a name with its type, and what is said of it."""
    entries = []
    for line in filter(str.strip, lines):
        if line.startswith(" ") and entries:
            entries[-1] += " " + escaped(line.strip())
        else:
            name, _, kind = line.partition(" : ")
            entries.append(f"- `{name}`" + (f" (`{kind}`)" if kind else "") + ":")
    return "\n".join(entries) + "\n\n"


def prose(text):
    """A docstring as Markdown: paragraphs, examples as code, sections of numpydoc as lists."""
    page, lines = "", (text or "").splitlines()
    heads = [i for i, line in enumerate(lines[1:], 1) if re.fullmatch(r"-{3,}", line.strip()) and lines[i - 1].strip()]
    first = heads[0] - 1 if heads else len(lines)
    for part in re.split(r"\n\s*\n", "\n".join(lines[:first])):
        is_code = part.lstrip().startswith(">>>") or all(line.startswith("    ") for line in part.splitlines())
        page += (f"```python\n{part}\n```" if is_code and part.strip() else escaped(part)) + "\n\n"
    for head, after in zip(heads, [*(i - 1 for i in heads[1:]), len(lines)]):
        title, body = lines[head - 1].strip(), lines[head + 1 : after]
        is_list = title not in ("Examples", "Notes")
        page += f"**{title}**\n\n" + (section(body) if is_list else prose("\n".join(body)))
    return page


def described(kind, head, text):
    """An object of the Python domain, which Sphinx sets, indexes and links."""
    return f"`````{{py:{kind}}} {head}\n:module: deltaq\n\n{prose(text)}`````\n\n"


def members(node):
    """Attributes and methods of a class that are for its users, each with what is said of it."""
    page, body = "", node.body
    for i, member in enumerate(body):
        if isinstance(member, ast.AnnAssign) and not member.target.id.startswith("_"):
            after = body[i + 1] if i + 1 < len(body) else None
            said = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
            kind = ast.unparse(member.annotation).removeprefix("Final[").removesuffix("]")
            page += f"- `{member.target.id}` (`{kind}`) {escaped(' '.join(str(said).split()))}\n"
    page += "\n"
    for member in body:
        if isinstance(member, ast.FunctionDef) and not member.name.startswith("_"):
            page += described("method", signature(member, f"{node.name}.{member.name}"), ast.get_docstring(member))
    return page


def called(member, shared):
    """A member of a class; where it is a function of another file by name, that function under its name here."""
    if not isinstance(member, ast.Assign):
        return member
    function = copy(shared[ast.unparse(member.value)])
    function.name = member.targets[0].id
    return function


def class_page(node):
    made = next((m for m in node.body if isinstance(m, ast.FunctionDef) and m.name == "__new__"), None)
    head = signature(made, node.name) if made else node.name
    text = "\n\n".join(filter(None, (ast.get_docstring(node), made and ast.get_docstring(made))))
    return f"# {node.name}\n\n" + described("class", head, text) + members(node)


def pages(package):
    """Pages of the package in this folder by their names: what it is; a class each; all functions; all errors."""
    trees = {path: ast.parse(path.read_text("utf-8")) for path in sorted(Path(package).glob("*.py*"))}
    front = trees[Path(package) / "__init__.py"]
    shared = {f"{path.stem}.{n.name}": n for path, tree in trees.items() for n in tree.body if isinstance(n, ast.FunctionDef)}
    for owner in trees[Path(package) / "_native.pyi"].body:
        if isinstance(owner, ast.ClassDef):
            owner.body = [called(member, shared) for member in owner.body]
    places = {n.name: n for tree in trees.values() for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef)}
    listed = next(n.value for n in front.body if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
    nodes = [places[name] for name in sorted(ast.literal_eval(listed)) if name in places]
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef)]
    errors = [node for node in nodes if node.name.endswith("Error")]
    classes = [node for node in nodes if node not in functions and node not in errors]
    classes.sort(key=lambda node: node.name != "System")

    def row(node, link):
        said = (ast.get_docstring(node) or "").split("\n\n")[0]
        return f"| [{node.name}]({link}) | {escaped(' '.join(said.split())).replace('|', chr(92) + '|')} |\n"

    table = "| | |\n|---|---|\n"
    found = {f"python/{node.name}": class_page(node) for node in classes}
    found["python/functions"] = "# Functions\n\n" + "".join(described("function", signature(n, n.name), ast.get_docstring(n)) for n in functions)
    found["python/errors"] = "# Errors\n\n" + "".join(class_page(node).replace("# ", "## ", 1) for node in errors)
    found["python"] = (
        "# Python reference\n\n" + prose(ast.get_docstring(front))
        + "## Functions\n\n" + table + "".join(row(node, "python/functions.md") for node in functions)
        + "\n## Classes\n\n" + table + "".join(row(node, f"python/{node.name}.md") for node in classes)
        + "\n[All errors](python/errors.md) are subclasses of `DeltaqError`.\n\n"
        + "```{toctree}\n:hidden:\n\npython/functions\n" + "".join(f"python/{node.name}\n" for node in classes) + "python/errors\n```\n"
    )
    return found
