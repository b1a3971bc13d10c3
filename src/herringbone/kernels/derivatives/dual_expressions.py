"""Expressions of the kernel language with their tangents (see `forward_mode`)."""

import ast
import math
from types import ModuleType
from typing import Protocol

from numba.core.dispatcher import Dispatcher

from herringbone.kernels import elementary
from herringbone.kernels.derivatives.trees import (
    assignment,
    definition_of,
    dotted,
    expression,
    is_real,
    is_target,
    product,
    returned_values,
    sum_of,
    zero,
)

_DERIVATIVES: dict[object, tuple[str, str]] = {
    elementary.sine: ("sine", "{0}_dot * cosine({0})"),
    elementary.cosine: ("cosine", "-{0}_dot * sine({0})"),
    elementary.exponential: ("exponential", "{0}_dot * exponential({0})"),
    math.sqrt: ("math.sqrt", "0.5 * {0}_dot / math.sqrt({0})"),
    abs: ("abs", "({0}_dot if {0} >= 0.0 else -{0}_dot)"),
    min: ("min", "({1}_dot if {1} < {0} else {0}_dot)"),
    max: ("max", "({1}_dot if {1} > {0} else {0}_dot)"),
}
_LOCALLY_CONSTANT: dict[object, str] = {math.floor: "math.floor", int: "int", range: "range"}

Dual = tuple[ast.expr, ast.expr | None]
"""An expression and its tangent; None: the tangent is zero."""


class NotDifferentiableError(TypeError):
    """A kernel uses what forward mode does not know."""


class Program(Protocol):
    """Where derivatives, kernels and constants are collected."""

    def derivative(self, kernel: Dispatcher) -> str:
        """Name of a kernel's derivative."""
        ...

    def original(self, kernel: Dispatcher) -> str:
        """Name under which a kernel itself can be called."""
        ...

    def constant(self, owner: str, name: str, value: object) -> str:
        """Name of a constant that stands in the module `owner`."""
        ...


class DualExpressions:
    """The expressions of one kernel.

    Args:
        program: collects what the expressions need.
        kernel: a compiled kernel.
    """

    def __init__(self, program: Program, kernel: Dispatcher) -> None:
        self._program = program
        self._function = kernel.py_func
        self._tree = definition_of(kernel)
        arguments = self._tree.args.args
        self._local = {
            node.id
            for node in ast.walk(self._tree)
            if isinstance(node, ast.Name) and is_target(node)
        }
        self._local |= {a.arg for a in arguments}
        self._active = {a.arg for a in arguments if is_real(a.annotation)}
        self._before: list[ast.stmt] = []
        self._temporaries = 0

    def _value(self, e: ast.expr) -> ast.expr:
        return self._dual(e)[0]

    def _dual(self, e: ast.expr) -> Dual:  # noqa: PLR0911 (one case per kind of expression)
        match e:
            case ast.Constant():
                return e, None
            case ast.Name(name):
                if name not in self._local:
                    return self._constant(name, self._function.__globals__[name]), None
                return e, dotted(e) if name in self._active else None
            case ast.Attribute():
                return self._constant(ast.unparse(e).replace(".", "_"), self._resolve(e)), None
            case ast.Subscript(array, index):
                return self._subscript(array, index)
            case ast.Slice(lower, upper, None):
                return ast.Slice(*(b and self._value(b) for b in (lower, upper))), None
            case ast.Compare(left, operators, others):
                others = [self._value(o) for o in others]
                return ast.Compare(self._value(left), operators, others), None
            case ast.BoolOp(operator, values):
                return ast.BoolOp(operator, [self._value(v) for v in values]), None
            case ast.IfExp(test, body, other):
                (p, tp), (q, tq) = self._dual(body), self._dual(other)
                test = self._value(test)
                tangent = ast.IfExp(test, tp or zero(), tq or zero()) if tp or tq else None
                return ast.IfExp(test, p, q), tangent
            case ast.UnaryOp(operator, operand):
                p, t = self._dual(operand)
                return ast.UnaryOp(operator, p), t and ast.UnaryOp(operator, t)
            case ast.BinOp(left, operator, right):
                return self._binary(operator, self._dual(left), self._dual(right))
            case ast.Call(function, arguments):
                return self._call(self._resolve(function), e, arguments)
        raise self._unknown(e)

    def _constant(self, name: str, value: object) -> ast.expr:
        return ast.Name(self._program.constant(self._function.__module__, name, value))

    def _subscript(self, array: ast.expr, index: ast.expr) -> Dual:
        base, tangent = self._dual(array)
        at = self._value(index)
        return ast.Subscript(base, at), tangent and ast.Subscript(tangent, at)

    def _binary(self, operator: ast.operator, left: Dual, right: Dual) -> Dual:
        (p, tp), (q, tq) = left, right
        value = ast.BinOp(p, operator, q)
        if tp is None and tq is None:
            return value, None
        match operator:
            case ast.Add():
                return value, sum_of(tp, tq)
            case ast.Sub():
                return value, sum_of(tp, tq and ast.UnaryOp(ast.USub(), tq))
            case ast.Mult():
                return value, sum_of(tp and product(tp, q), tq and product(p, tq))
            case ast.Div():
                change = tq and ast.UnaryOp(ast.USub(), product(value, tq))
                return value, ast.BinOp(sum_of(tp, change), ast.Div(), q)
            case ast.Pow() if tq is None and tp is not None:
                lower = ast.BinOp(p, operator, ast.BinOp(q, ast.Sub(), ast.Constant(1)))
                return value, product(product(q, lower), tp)
        raise self._unknown(value)

    def _call(self, function: object, call: ast.Call, arguments: list[ast.expr]) -> Dual:
        if function in _LOCALLY_CONSTANT:
            values = [self._value(a) for a in arguments]
            return ast.Call(expression(_LOCALLY_CONSTANT[function]), values, []), None
        if function in _DERIVATIVES:
            return self._elementary(function, arguments)
        if not isinstance(function, Dispatcher):
            raise self._unknown(call)
        returned = returned_values(definition_of(function))
        if not any(is_real(a) for a in returned):
            values = [self._value(a) for a in arguments]
            return ast.Call(ast.Name(self._program.original(function)), values, []), None
        result, tangent = self._temporary(), self._temporary()
        self._before.append(assignment([result, tangent], self._call_of_kernel(call)))
        return result, tangent

    def _elementary(self, function: object, arguments: list[ast.expr]) -> Dual:
        name, rule = _DERIVATIVES[function]
        duals = [self._dual(a) for a in arguments]
        if all(t is None for _, t in duals):
            return ast.Call(expression(name), [p for p, _ in duals], []), None
        names: list[ast.Name] = []
        for p, t in duals:
            names.append(self._temporary())
            self._before.append(assignment([names[-1]], p))
            self._before.append(assignment([dotted(names[-1])], t or zero()))
        value = ast.Call(expression(name), [*names], [])
        return value, expression(rule.format(*(n.id for n in names)))

    def _call_of_kernel(self, call: ast.Call) -> ast.Call:
        """The call of a kernel's derivative."""
        kernel = self._resolve(call.func)
        if not isinstance(kernel, Dispatcher):
            raise self._unknown(call)
        arguments: list[ast.expr] = []
        for argument, declared in zip(call.args, definition_of(kernel).args.args, strict=True):
            p, t = self._dual(argument)
            arguments += [p, t or zero()] if is_real(declared.annotation) else [p]
        return ast.Call(ast.Name(self._program.derivative(kernel)), arguments, [])

    def _is_kernel_call(self, call: ast.Call) -> bool:
        function = self._resolve(call.func)
        known = function in _LOCALLY_CONSTANT or function in _DERIVATIVES
        return not known and isinstance(function, Dispatcher)

    def _resolve(self, e: ast.expr) -> object:
        """What a global name, or an attribute of a module, stands for."""
        if isinstance(e, ast.Attribute) and isinstance(e.value, ast.Name):
            owner = self._function.__globals__.get(e.value.id)
            if isinstance(owner, ModuleType):
                return getattr(owner, e.attr)
        if isinstance(e, ast.Name):
            builtins = {f.__name__: f for f in (abs, min, max, int, range)}
            known = self._function.__globals__ | builtins
            if e.id in known:
                return known[e.id]
        raise self._unknown(e)

    def _temporary(self) -> ast.Name:
        self._temporaries += 1
        return ast.Name(f"_{self._temporaries}")

    def _unknown(self, node: ast.AST) -> NotDifferentiableError:
        function = self._function
        return NotDifferentiableError(
            f"{function.__module__}.{function.__name__}: forward mode does not know "
            f"'{ast.unparse(node)}'; write it in the kernel language"
        )
