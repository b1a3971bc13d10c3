"""Entry points of native libraries: kernels of a component behind their C signatures."""

from collections.abc import Callable

from numba import carray, types

from herringbone.components.resources.loader import REPORT, ResourceLoader
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Component
from herringbone.core.declaring.component import unbounded, unchanged
from herringbone.kernels.compiling.dispatching import CFunction
from herringbone.kernels.compiling.jit import UNKNOWN_SIZE, c_code

FAST = {"hb_step", "hb_rhs", "hb_out", "hb_indicators", "hb_answer"}
"""Those that a simulation calls all the time; what they call is made for speed."""
_REALS = types.CPointer(types.float64)
_COUNTS = types.CPointer(types.int64)
_REFERENCES = types.CPointer(types.uint32)
_TIME = types.float64
_Found = dict[str, tuple[object, Callable]]
"""Signature and function by symbol."""


def entry_points(of: Component) -> dict[str, CFunction]:
    """The kernels of a component behind their C signatures, by symbol.

    The optional ones, such as `start`, `load` and `indicators`, only if the component has them.
    """
    found = (
        _of_steps(of)
        | _of_parameters(of)
        | _of_resources(of)
        | _of_hosts(of)
        | _of_tolerances(of)
        | _of_what_is_asked(of)
        | _of_events(of)
    )
    return {symbol: c_code(signature, function) for symbol, (signature, function) in found.items()}


def _of_steps(of: Component) -> _Found:
    """Steps, rates, outputs, and derivatives of both."""
    block, work, states = of.declaration.size, _work(of), max(of.declaration.state_count, 1)
    kernels_step, kernels_rhs, kernels_out = of.kernels
    if of.asked is not None:
        kernels_step = of.asked.advance
    kernels_tangent = tangent_kernel(of)

    def step(b, w, t, h):  # noqa: ANN001, ANN202 (typed by the signature)
        return types.int32(kernels_step(carray(b, (block,)), carray(w, (work,)), t, h))

    def rhs(b, t, dx):  # noqa: ANN001, ANN202
        kernels_rhs(carray(b, (block,)), t, carray(dx, (states,)))

    def out(b, t):  # noqa: ANN001, ANN202
        kernels_out(carray(b, (block,)), t)

    def tangent(b, t, d, dx):  # noqa: ANN001, ANN202
        kernels_tangent(carray(b, (block,)), t, carray(d, (block,)), carray(dx, (2 * states,)))

    return {
        "hb_step": (types.int32(_REALS, _REALS, _TIME, _TIME), step),
        "hb_rhs": (types.void(_REALS, _TIME, _REALS), rhs),
        "hb_out": (types.void(_REALS, _TIME), out),
        "hb_tangent": (types.void(_REALS, _TIME, _REALS, _REALS), tangent),
    }


def _of_parameters(of: Component) -> _Found:
    """What follows from parameters: the longest step, and start values."""
    block, kernels_longest_step, kernels_start = of.declaration.size, of.longest_step, of.start

    def longest_step(b):  # noqa: ANN001, ANN202
        return kernels_longest_step(carray(b, (block,)))

    def start(b):  # noqa: ANN001, ANN202
        kernels_start(carray(b, (block,)))

    found: _Found = {}
    if of.longest_step is not unbounded:
        found["hb_longest_step"] = (_TIME(_REALS), longest_step)
    if of.start is not unchanged:
        found["hb_start"] = (types.void(_REALS), start)
    return found


def _of_resources(of: Component) -> _Found:
    """Tables that are loaded into the block, and the check of what was set besides."""
    if not isinstance(of.load, ResourceLoader):
        return {}
    block, kernels_load, scratch = of.declaration.size, of.load.kernel, of.load.scratch
    kernels_check = of.load.check

    def load(values, shape, b, s, report):  # noqa: ANN001, ANN202
        return types.int32(
            kernels_load(
                carray(values, (UNKNOWN_SIZE,)),
                carray(shape, (UNKNOWN_SIZE,)),
                carray(b, (block,)),
                carray(s, (scratch,)),
                carray(report, (REPORT,)),
            )
        )

    signature = types.int32(_REALS, _COUNTS, _REALS, _REALS, _REALS)
    found: _Found = {"hb_load": (signature, load)}
    if kernels_check is None:
        return found

    def verify(b, report):  # noqa: ANN001, ANN202
        return types.int32(kernels_check(carray(b, (block,)), carray(report, (REPORT,))))

    return found | {"hb_verify": (types.int32(_REALS, _REALS), verify)}


def _of_hosts(of: Component) -> _Found:
    """The start that is looked for."""
    if of.hosting is None:
        return {}
    block, kernels_settle = of.declaration.size, of.hosting.settle

    def settle(b, t):  # noqa: ANN001, ANN202
        return types.int32(kernels_settle(carray(b, (block,)), t))

    return {"hb_settle": (types.int32(_REALS, _TIME), settle)}


def _of_tolerances(of: Component) -> _Found:
    """Remarks on steps that follow a tolerance."""
    if of.by_tolerance is None:
        return {}
    block, work, kernels_remark = of.declaration.size, _work(of), of.by_tolerance.remark

    def remark(b, w, which, report):  # noqa: ANN001, ANN202
        return types.int32(
            kernels_remark(
                carray(b, (block,)), carray(w, (work,)), which, carray(report, (REPORT,))
            )
        )

    return {"hb_remark": (types.int32(_REALS, _REALS, types.int32, _REALS), remark)}


def _of_what_is_asked(of: Component) -> _Found:
    """Outputs that are made when they are asked for."""
    if of.asked is None:
        return {}
    block, work, kernels_answer = of.declaration.size, _work(of), of.asked.answer

    def answer(b, w, t, references, count):  # noqa: ANN001, ANN202
        places = carray(references, (UNKNOWN_SIZE,))
        kernels_answer(carray(b, (block,)), carray(w, (work,)), t, places, count)

    return {"hb_answer": (types.void(_REALS, _REALS, _TIME, _REFERENCES, types.int64), answer)}


def _of_events(of: Component) -> _Found:
    """Event indicators."""
    if of.indicators is None:
        return {}
    block, count, kernels_indicators = of.declaration.size, of.indicator_count, of.indicators

    def indicators(b, t, z):  # noqa: ANN001, ANN202
        kernels_indicators(carray(b, (block,)), t, carray(z, (count,)))

    return {"hb_indicators": (types.void(_REALS, _TIME, _REALS), indicators)}


def _work(of: Component) -> int:
    """Length of the work space."""
    return max(of.declaration.work, 1)
