"""Types of what is native in the Python package, which only its stubs have."""

from __future__ import annotations

import ast
import copy
from pathlib import Path

import sprag
from sphinx.application import Sphinx

STUBS = ast.parse(Path(sprag.__file__).with_name("_core.pyi").read_text(encoding="utf-8"))
PROPERTIES = ("attribute", "property")
ALIASES = {node.targets[0].id: ast.unparse(node.value) for node in STUBS.body if isinstance(node, ast.Assign)}


def text(node: ast.AST | None) -> str:
    """The source of a node, with names that only the stubs have written out."""
    source = "" if node is None else ast.unparse(node)
    for alias, type_ in ALIASES.items():
        source = source.replace(alias, type_)
    return source


def stub(name: str) -> ast.FunctionDef | None:
    """The function that the stubs have for a public name, such as sprag.Record.read; of a class, its constructor."""
    path = name.split(".")[1:]
    if not path or getattr(sprag, path[0], None) is not getattr(sprag._core, path[0], path[0]):
        return None
    body: list[ast.stmt] = STUBS.body
    found: ast.stmt | None = None
    for part in path:
        found = next((node for node in body if getattr(node, "name", None) == part), None)
        body = getattr(found, "body", [])
    if isinstance(found, ast.ClassDef):
        found = next((node for node in body if getattr(node, "name", None) == "__new__"), None)
    return found if isinstance(found, ast.FunctionDef) else None


def sign(app: Sphinx, what: str, name: str, of: object, options: object, signature: str, returns: str) -> tuple[str, str] | None:
    """Gives a function the signature of its stub."""
    function = stub(name)
    if function is None or what in PROPERTIES:
        return None
    arguments = copy.deepcopy(function.args)
    if what != "function" and not any(text(decorator) == "staticmethod" for decorator in function.decorator_list):
        del arguments.args[0]
    return f"({text(arguments)})", "" if what == "class" else text(function.returns)


def type_first(app: Sphinx, what: str, name: str, of: object, options: object, lines: list[str]) -> None:
    """Begins the docstring of a property with its type."""
    if what in PROPERTIES and (function := stub(name)):
        first = next(number for number, line in enumerate(lines) if line)
        lines[first] = f"``{text(function.returns)}``: {lines[first]}"


def setup(app: Sphinx) -> None:
    """Adds types to what autodoc finds."""
    # Before numpydoc, which takes the signature without types, and after it, since it begins with an empty line.
    app.connect("autodoc-process-signature", sign, priority=400)
    app.connect("autodoc-process-docstring", type_first, priority=900)
