"""Trees of the kernel language: what is read of a kernel, and pieces that tangents are made of."""

import ast
import inspect
import textwrap
from collections.abc import Callable

from numba.core.dispatcher import Dispatcher

SUFFIX = "_dot"


def definition_of(kernel: Dispatcher) -> ast.FunctionDef:
    """The source of a kernel as a tree."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(kernel.py_func)))
    return next(s for s in tree.body if isinstance(s, ast.FunctionDef))


def unique_name(module: str, name: str) -> str:
    """A name of a module, for generated ones that take names of many.

    The whole path counts: components have files of the same name.
    """
    return f"{module.removeprefix('herringbone.').replace('.', '__')}__{name}"


def mangled(function: Callable) -> str:
    """A function's name that is unique in a generated module."""
    return unique_name(function.__module__, function.__name__)


def is_target(node: ast.AST) -> bool:
    """True for a name that is assigned."""
    return isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)


def is_real(annotation: ast.expr | None) -> bool:
    """True for what has a tangent: reals and arrays of reals."""
    return annotation is not None and ast.unparse(annotation) in ("float", "np.ndarray")


def returned_values(definition: ast.FunctionDef) -> list[ast.expr]:
    """Annotations of the values that a kernel returns."""
    annotation = definition.returns
    if isinstance(annotation, ast.Subscript) and isinstance(annotation.slice, ast.Tuple):
        return annotation.slice.elts
    return [annotation] if annotation is not None else []


def dotted(e: ast.expr) -> ast.expr:
    """The tangent of a name, or of an entry of an array."""
    if isinstance(e, ast.Subscript):
        return ast.Subscript(dotted(e.value), e.slice)
    return ast.Name(e.id + SUFFIX)  # type: ignore[attr-defined]  # a name, in this language


def expression(source: str) -> ast.expr:
    """The tree of a text."""
    return ast.parse(source, mode="eval").body


def zero() -> ast.expr:
    """A tangent that vanishes."""
    return ast.Constant(0.0)


def product(p: ast.expr, q: ast.expr) -> ast.expr:
    """Of two factors that do not vanish."""
    return ast.BinOp(p, ast.Mult(), q)


def sum_of(p: ast.expr | None, q: ast.expr | None) -> ast.expr:
    """Sum of two tangents, one of which may be zero."""
    if p is None or q is None:
        return p or q or zero()
    return ast.BinOp(p, ast.Add(), q)


def assignment(targets: list[ast.expr], value: ast.expr) -> ast.Assign:
    """One assignment to all targets: every right side is computed before any target changes."""
    return ast.Assign([ast.Tuple(targets) if len(targets) > 1 else targets[0]], value)
