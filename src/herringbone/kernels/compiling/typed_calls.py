"""What numba found out about the types of a call, remembered.

For each use of an operator or a function of NumPy, numba asks all templates that anybody ever
registered for it, most of which refuse, each with a message that nobody reads: a third of the time
that a kernel takes before LLVM. The answer depends on the types of the arguments alone.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from weakref import WeakKeyDictionary

from numba import types
from numba.core.typing import Signature
from numba.core.typing.context import BaseContext

_ask = types.BaseFunction.get_call_type
_found: WeakKeyDictionary[types.BaseFunction, dict[tuple, Signature]] = WeakKeyDictionary()
"""Signatures by function and types of arguments; numba makes another function of more templates."""


def _remembered(
    function: types.BaseFunction, context: BaseContext, args: tuple, kws: dict[str, Any]
) -> Signature | None:
    if kws:
        return _ask(function, context, args, kws)
    known = _found.setdefault(function, {})
    if args not in known:
        signature = _ask(function, context, args, kws)
        if signature is None:
            return None
        known[args] = signature
    return known[args]


@contextmanager
def remembered_calls() -> Iterator[None]:
    """While kernels are compiled; what others compile outside of it is left to numba."""
    if types.BaseFunction.get_call_type is _remembered:
        yield
        return
    types.BaseFunction.get_call_type = _remembered
    try:
        yield
    finally:
        types.BaseFunction.get_call_type = _ask
