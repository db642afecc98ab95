"""What the stubs promise is there, is described, and takes the arguments that they say."""

import ast
import inspect
import re
from operator import attrgetter
from pathlib import Path

import pytest

import deltaq
from deltaq import _native

STUBS = Path(deltaq.__file__).with_name("_native.pyi")
TREE = ast.parse(STUBS.read_text())
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}
PYTHON = {"Design", "Estimate", "FilmFit", "FormulationFit", "Functions", "Integrals", "Profile", "Proof", "Sweep"}
PYTHON |= {"designs", "ensemble", "from_sympy", "from_urdf", "review", "sweep"}
VALUES = {node.target.id for node in TREE.body if isinstance(node, ast.AnnAssign) and not node.target.id.startswith("_")}


def described(node, following):
    """The docstring of a class or a function, or what stands below an attribute."""
    if isinstance(node, ast.AnnAssign):
        text = following.value.value if isinstance(following, ast.Expr) else None
        return text if text is None else inspect.cleandoc(text)
    return (ast.get_docstring(node) or "").strip()


def stubbed(body):
    """Names of classes, functions and attributes that can only be read, each with what is said of it."""
    for node, following in zip(body, [*body[1:], None]):
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            yield node.name, described(node, following)
        elif isinstance(node, ast.AnnAssign) and "Final" in ast.unparse(node.annotation):
            yield node.target.id, described(node, following)


def test_stubs_say_what_the_module_says():
    wrong = {}
    for name, text in stubbed(TREE.body):
        if text != inspect.getdoc(getattr(_native, name)) and not name.startswith("_"):
            wrong[name] = text
    for owner, node in CLASSES.items():
        for name, text in stubbed(node.body):
            if not name.startswith("_") and text != inspect.getdoc(getattr(getattr(deltaq, owner), name)):
                wrong[f"{owner}.{name}"] = text
    assert not wrong


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_it_is_marked_as_typed():
    assert STUBS.with_name("py.typed").exists()


def test_the_same_names_everywhere():
    stubbed = public(CLASSES) | public(FUNCTIONS) | VALUES
    assert stubbed == public(vars(_native)) == public(deltaq.__all__) - PYTHON
    assert all(hasattr(deltaq, name) for name in deltaq.__all__)


@pytest.mark.parametrize("name", sorted(CLASSES))
def test_classes(name):
    cls = getattr(deltaq, name)
    assert cls.__doc__, name
    assert cls.__module__ == "deltaq"
    assert [base.id for base in CLASSES[name].bases] == [base.__name__ for base in cls.__bases__ if base is not object]
    body = {node.name: node for node in CLASSES[name].body if isinstance(node, ast.FunctionDef)}
    # what only can be read; an exception has its attributes as an instance
    values = {node.target.id for node in CLASSES[name].body if isinstance(node, ast.AnnAssign) and "Final" in ast.unparse(node)}
    # what is written in Python stands there with its signature, and here by name
    shared = {node.targets[0].id: ast.unparse(node.value) for node in CLASSES[name].body if isinstance(node, ast.Assign)}
    for member, function in shared.items():
        assert getattr(cls, member) is attrgetter(function)(deltaq), f"{name}.{member}"
    assert public(body) | public(values) | public(shared) == public(vars(cls))
    for member in public(body) | values:
        assert inspect.getdoc(getattr(cls, member)), f"{name}.{member} is not described"
        assert inspect.isdatadescriptor(getattr(cls, member)) == (member in values)
    for member in public(body):
        same_parameters(body[member], getattr(cls, member))
    if "__new__" in body:
        same_parameters(body["__new__"], cls, without=1)


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_functions(name):
    assert inspect.getdoc(getattr(deltaq, name))
    same_parameters(FUNCTIONS[name], getattr(deltaq, name))


def same_parameters(stub, real, without=0):
    arguments = stub.args
    positional = [a.arg for a in arguments.posonlyargs + arguments.args][without:]
    found = inspect.signature(real).parameters.values()
    assert positional == [p.name for p in found if p.kind not in (p.KEYWORD_ONLY, p.VAR_POSITIONAL, p.VAR_KEYWORD)], stub.name
    assert [a.arg for a in [arguments.kwarg] if a] == [p.name for p in found if p.kind is p.VAR_KEYWORD], stub.name
    assert [a.arg for a in [arguments.vararg] if a] == [p.name for p in found if p.kind is p.VAR_POSITIONAL], stub.name
    assert [a.arg for a in arguments.kwonlyargs] == [p.name for p in found if p.kind is p.KEYWORD_ONLY], stub.name
    defaults = [p.default for p in found if p.kind is p.KEYWORD_ONLY]
    for node, default in zip(arguments.kw_defaults, defaults):
        expected = inspect.Parameter.empty if node is None else ast.literal_eval(node)
        assert expected == default, stub.name


def documented():
    """Functions and methods with what they take, of all classes that the package names."""
    for name in deltaq.__all__:
        member = getattr(deltaq, name)
        if inspect.isclass(member) and member.__module__.startswith("deltaq") and not issubclass(member, BaseException):
            for of, method in vars(member).items():
                if not of.startswith("_") and callable(method):
                    yield f"{name}.{of}", inspect.getattr_static(member, of), 1
        elif inspect.isroutine(member):
            yield name, member, 0


@pytest.mark.parametrize(("name", "member", "without"), [pytest.param(*case, id=case[0]) for case in documented()])
def test_sections_of_numpydoc_name_what_is_taken(name, member, without):
    """Parameters in the order of the signature, each described; what is returned."""
    if isinstance(member, (classmethod, staticmethod)):
        member, without = member.__func__, 1
    text = inspect.getdoc(member)
    assert text, name
    stars = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    taken = [stars.get(p.kind, "") + p.name for p in list(inspect.signature(member).parameters.values())[without:]]
    sections = dict(zip(re.findall(r"^(\w+)\n-+$", text, re.M), re.split(r"^\w+\n-+$", text, flags=re.M)[1:]))
    found = [n.strip() for line in re.findall(r"^(\S.*?)(?: : .*)?$", sections.get("Parameters", ""), re.M) for n in line.split(",")]
    assert sorted(found) == sorted(taken), name
    for line in re.findall(r"^\S.*\n(.*)", sections.get("Parameters", ""), re.M):
        assert line.startswith("    "), (name, line)
    signature = inspect.signature(member)
    assert "Returns" in sections or signature.return_annotation in ("None", None), name


def test_everything_has_a_repr_of_its_own():
    for name in deltaq.__all__:
        member = getattr(deltaq, name)
        if inspect.isclass(member) and not issubclass(member, BaseException):
            assert member.__repr__ is not object.__repr__, name
