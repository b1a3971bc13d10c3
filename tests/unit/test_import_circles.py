"""Each module can be the first that a process imports: no circle, packages' `__init__` included."""

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter

from herringbone.core.places.paths import PACKAGE


def module_of(file) -> str:
    parts = file.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_of(file): file for file in PACKAGE.rglob("*.py")}


def at_import(body) -> Iterator[ast.Import | ast.ImportFrom]:
    """Imports that are done while a module is imported."""
    for node in body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield node
        elif isinstance(node, ast.If):
            if ast.unparse(node.test) != "TYPE_CHECKING":
                yield from at_import(node.body)
            if ast.unparse(node.test) != "not TYPE_CHECKING":
                yield from at_import(node.orelse)
        elif isinstance(node, ast.Try | ast.With):
            yield from at_import(node.body)


def with_parents(module: str) -> list[str]:
    parts = module.split(".")
    return [".".join(parts[: k + 1]) for k in range(len(parts))]


def needed(module: str) -> set[str]:
    """What is imported before a module is there; not the packages that it lies in."""
    found: set[str] = set()
    for node in at_import(ast.parse(FILES[module].read_text(encoding="utf-8")).body):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        found.update(parent for name in names for parent in with_parents(name))
    return (found & FILES.keys()) - set(with_parents(module))


def test_modules_are_imported_in_some_order():
    """`graphlib.CycleError` names the circle."""
    order = list(TopologicalSorter({module: needed(module) for module in FILES}).static_order())
    assert len(order) == len(FILES)
