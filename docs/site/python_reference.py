"""The reference of the Python module as a page, from its stubs and sources: nothing has to be built or imported."""

import ast
from pathlib import Path


def signature(node):
    """A function as one writes its call."""
    arguments = ast.unparse(node.args)
    for first in ("self", "cls"):
        arguments = arguments.removeprefix(first).removeprefix(", ")
    returned = f" -> {ast.unparse(node.returns)}" if node.returns else ""
    return f"{node.name}({arguments}){returned}"


def block(language, text):
    return f"```{language}\n{text}\n```\n\n" if text else ""


def members(node):
    """Attributes and methods of a class that are for its users, each with what is said of it."""
    page, body = "", node.body
    for i, member in enumerate(body):
        if isinstance(member, ast.AnnAssign) and not member.target.id.startswith("_"):
            after = body[i + 1] if i + 1 < len(body) else None
            said = after.value.value if isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant) else ""
            kind = ast.unparse(member.annotation).removeprefix("Final[").removesuffix("]")
            page += f"- `{member.target.id}` (`{kind}`) {' '.join(str(said).split())}\n"
    page += "\n"
    for member in body:
        if isinstance(member, ast.FunctionDef) and not member.name.startswith("_") or getattr(member, "name", "") == "__new__":
            name = node.name if member.name == "__new__" else f"{node.name}.{member.name}"
            text = signature(member).replace("__new__(", f"{node.name}(", 1)
            said = ast.get_docstring(member)
            page += (f"### {name}\n\n" if member.name != "__new__" else "") + block("python", text) + block("text", said)
    return page


def page(package):
    """The page of the package in this folder: what its `__all__` names, `System` and functions first, errors last."""
    trees = {path: ast.parse(path.read_text("utf-8")) for path in sorted(Path(package).glob("*.py*"))}
    front = trees[Path(package) / "__init__.py"]
    places = {n.name: n for tree in trees.values() for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef)}
    listed = next(n.value for n in front.body if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
    text = "# Python reference\n\n" + block("text", ast.get_docstring(front))
    def rank(name):
        is_class = isinstance(places.get(name), ast.ClassDef)
        return name.endswith("Error"), is_class and name != "System"

    for name in sorted(ast.literal_eval(listed), key=rank):
        node = places.get(name)
        if isinstance(node, ast.ClassDef):
            text += f"## {name}\n\n" + block("text", ast.get_docstring(node)) + members(node)
        elif node:
            text += f"## {name}\n\n" + block("python", signature(node)) + block("text", ast.get_docstring(node))
    return text
