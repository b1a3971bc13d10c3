"""Forward-mode derivatives of kernels, by transformation of their source.

Every real `x` of a kernel gets its tangent `x_dot`, every array its array of tangents, and every
statement first computes the tangents of what it assigns (A. Griewank and A. Walther, Evaluating
Derivatives, 2008, section 3.1). A kernel `f(b, i, x) -> float` becomes
`f_dot(b, b_dot, i, x, x_dot) -> (value, tangent)`: integers have no tangent. At a kink (min, max,
abs, a branch) the derivative is that of the side on which the value is computed.

The kernel language is small, so that this is: assignments, loops, branches, views, calls of other
kernels, + - * / **, min, max, abs, sqrt and the elementary functions.
"""

import ast
import textwrap
from collections.abc import Callable

from herringbone.kernels.derivatives.derivative_modules import Derivatives
from herringbone.kernels.derivatives.dual_expressions import DualExpressions
from herringbone.kernels.derivatives.trees import (
    SUFFIX,
    assignment,
    definition_of,
    dotted,
    is_real,
    returned_values,
    zero,
)


def differentiate(*kernels: Callable) -> list[Callable]:
    """Forward-mode derivatives of kernels.

    Returns:
        For each kernel its derivative: every real or array argument is followed by its tangents;
        after the values the tangents of the real ones are returned.

    Raises:
        NotDifferentiableError: a kernel uses what forward mode does not know.
    """
    program = Derivatives(lambda module, kernel, name: _Function(module, kernel).source(name))
    modules = [program.module_of(k) for k in kernels]
    names = [module.make(k) for module, k in zip(modules, kernels, strict=True)]
    return [getattr(m.loaded, name) for m, name in zip(modules, names, strict=True)]


class _Function(DualExpressions):
    """Transformation of one kernel."""

    def source(self, name: str) -> str:
        """Source of the derivative."""
        known: set[str] = set()
        while known != self._active:
            known = set(self._active)
            self._temporaries = 0
            body = self._block(self._tree.body)
        arguments = []
        for a in self._tree.args.args:
            arguments.append(a.arg)
            if is_real(a.annotation):
                arguments.append(a.arg + SUFFIX)
        module = ast.fix_missing_locations(ast.Module(body, []))
        text = textwrap.indent(ast.unparse(module) or "pass", "    ")
        return f"\n\n@kernel\ndef {name}({', '.join(arguments)}):\n{text}\n"

    # Statements.

    def _block(self, statements: list[ast.stmt]) -> list[ast.stmt]:
        result: list[ast.stmt] = []
        for statement in statements:
            outer, self._before = self._before, []
            made = self._statement(statement)
            result += [*self._before, *made]
            self._before = outer
        return result

    def _statement(self, s: ast.stmt) -> list[ast.stmt]:  # noqa: PLR0911 (one case per kind)
        match s:
            case ast.Expr(ast.Constant()) | ast.Pass():
                return [ast.Pass()]
            case ast.Expr(ast.Call() as call):
                return [ast.Expr(self._call_of_kernel(call))]
            case ast.Assign(targets, value):
                return self._assign(targets, value)
            case ast.AugAssign(target, operator, value):
                load = ast.parse(ast.unparse(target), mode="eval").body
                return self._assign([target], ast.BinOp(load, operator, value))
            case ast.For(target, iterator, body, []):
                return [ast.For(target, self._value(iterator), self._block(body), [])]
            case ast.While(test, body, []):
                test = self._value(test)
                if self._before:  # it would be computed once only
                    raise self._unknown(s)
                return [ast.While(test, self._block(body), [])]
            case ast.If(test, body, other):
                return [ast.If(self._value(test), self._block(body), self._block(other))]
            case ast.Return(None):
                return [s]
            case ast.Return(ast.expr() as value):
                return [ast.Return(self._returned(value))]
        raise self._unknown(s)

    def _returned(self, value: ast.expr) -> ast.expr:
        """All values, then the tangents of the real ones; the annotation says which are real."""
        if isinstance(value, ast.Call) and self._is_kernel_call(value):
            return self._call_of_kernel(value)
        parts = value.elts if isinstance(value, ast.Tuple) else [value]
        duals = [self._dual(p) for p in parts]
        real = [is_real(a) for a in returned_values(self._tree)]
        tangents = [t or zero() for (_, t), r in zip(duals, real, strict=True) if r]
        values = [p for p, _ in duals]
        return ast.Tuple([*values, *tangents]) if tangents or len(values) > 1 else values[0]

    def _assign(self, targets: list[ast.expr], value: ast.expr) -> list[ast.stmt]:
        match targets:
            case [ast.Tuple(elements)] if isinstance(value, ast.Call):
                real = returned_values(definition_of(self._resolve(value.func)))
                tangents = [self._tangent_target(e) for e, r in zip(elements, real, strict=True)
                            if is_real(r)]  # fmt: skip
                return [assignment([*elements, *tangents], self._call_of_kernel(value))]
            case [ast.Tuple(elements)] if isinstance(value, ast.Tuple):
                pairs = list(zip(elements, value.elts, strict=True))
            case _:
                pairs = [(target, value) for target in targets]
        left: list[ast.expr] = []
        right: list[ast.expr] = []
        for target, expression in pairs:
            p, t = self._dual(expression)
            if t is not None or self._is_active(target):
                left.append(self._tangent_target(target))
                right.append(t or zero())
            left.append(self._indexed(target))
            right.append(p)
        return [assignment(left, ast.Tuple(right) if len(right) > 1 else right[0])]

    def _is_active(self, target: ast.expr) -> bool:
        name = target.value if isinstance(target, ast.Subscript) else target
        return isinstance(name, ast.Name) and name.id in self._active

    def _tangent_target(self, target: ast.expr) -> ast.expr:
        if isinstance(target, ast.Name):
            self._active.add(target.id)
        return dotted(self._indexed(target))

    def _indexed(self, target: ast.expr) -> ast.expr:
        """A target with the constants of its index resolved."""
        return self._dual(target)[0] if isinstance(target, ast.Subscript) else target
