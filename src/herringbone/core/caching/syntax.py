"""What a source file says to the compiler: its syntax tree without comments and docstrings."""

import ast
import hashlib
from collections.abc import Iterator
from typing import NamedTuple

_BODIES = "body", "orelse", "finalbody"
_BRANCHES = "handlers", "cases"


class Syntax(NamedTuple):
    """A source file, as far as what it computes depends on it.

    Attributes:
        digest: hash of the syntax tree, without comments, docstrings, positions and layout.
        imports: the modules, and names of modules, that it imports anywhere.
    """

    digest: str
    imports: tuple[str, ...]


def syntax_of(source: str) -> Syntax:
    """The syntax of a Python source; raises SyntaxError."""
    tree = ast.parse(source)
    nodes = list(_statements(tree))
    imports = {name for node in nodes for name in _imported(node)}
    for node in nodes:
        for field in _BODIES:
            if isinstance(statements := getattr(node, field, None), list):
                setattr(node, field, [s for s in statements if not _is_text(s)])
    digest = hashlib.sha256(ast.dump(tree).encode()).hexdigest()
    return Syntax(digest, tuple(sorted(imports)))


def _statements(tree: ast.Module) -> Iterator[ast.AST]:
    """What holds statements and imports, expressions left out: most nodes."""
    todo: list[ast.AST] = [tree]
    while todo:
        node = todo.pop()
        yield node
        for field in _BODIES + _BRANCHES:
            if isinstance(inside := getattr(node, field, None), list):
                todo += inside


def _is_text(statement: ast.stmt) -> bool:
    """True for docstrings, and the strings that describe constants."""
    return (
        isinstance(statement, ast.Expr)
        and isinstance(statement.value, ast.Constant)
        and isinstance(statement.value.value, str)
    )


def _imported(node: ast.AST) -> list[str]:
    if isinstance(node, ast.Import):
        return [alias.name for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.module:
        return [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return []
