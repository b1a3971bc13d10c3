"""C addresses of components' laws and of sources' signals."""

from functools import cache

from herringbone.components.registry import COMPONENTS
from herringbone.core.caching.generated import load_generated

_LAW = '''"""Address of a component's laws; generated, not to be edited."""

from numba import carray, types

from herringbone.components.registry import COMPONENTS
from herringbone.kernels.compiling.jit import c_function

evaluate = COMPONENTS["{name}"].laws.evaluate
_REALS = types.CPointer(types.float64)


@c_function(types.int32(_REALS, _REALS, _REALS, _REALS, _REALS))
def law(block, z, f, k, e):
    evaluate(
        carray(block, {block}), carray(z, {z}), carray(f, {f}), carray(k, {k}), carray(e, {e})
    )
    return types.int32(0)
'''
_SIGNALS = '''"""Address of a component's outputs; generated, not to be edited."""

from numba import carray, types

from herringbone.components.registry import COMPONENTS
from herringbone.kernels.compiling.jit import c_function

out = COMPONENTS["{name}"].kernels.out


@c_function(types.int32(types.CPointer(types.float64), types.float64))
def signals(block, t):
    out(carray(block, {block}), t)
    return types.int32(0)
'''


@cache
def law_address(component: str) -> int:
    """Address of int32 law(block, z, f, k, e), see `core.Laws.evaluate`, of a component with laws.

    All are addresses of reals; it always returns 0.
    """
    found = COMPONENTS[component]
    assert found.laws is not None
    source = _LAW.format(
        name=component,
        block=found.declaration.size,
        z=len(found.laws.arguments),
        f=len(found.laws.values),
        k=len(found.laws.stiff),
        e=max(found.laws.kinks, 1),
    )
    return load_generated("law", source).law.address


@cache
def signals_address(component: str) -> int:
    """Address of int32 signals(block, t), which writes the outputs at a time; it returns 0."""
    source = _SIGNALS.format(name=component, block=COMPONENTS[component].declaration.size)
    return load_generated("signals", source).signals.address
