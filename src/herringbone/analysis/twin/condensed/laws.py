"""Laws and sources of a condensed system, called by their addresses, compiled."""

import numpy as np

from herringbone.analysis.twin.condensed.march_arrays import Calls, Fixed, State
from herringbone.cosim.loops.calls import c_call
from herringbone.kernels.compiling.jit import inlined, kernel

_REAL = 8

_call_law = c_call("address", "address", "address", "address", "address")
_call_signals = c_call("address", "real")


@inlined
def call_laws(
    calls: Calls, t: float, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    """Values, tangents and indicators of all laws at their arguments and a time [s]."""
    blocks = calls.blocks.ctypes.data
    for p in range(calls.law.size):
        if calls.clock[p] >= 0:
            calls.blocks[calls.clock[p]] = t
        _call_law(
            calls.law[p],
            (
                blocks + _REAL * calls.block[p],
                z.ctypes.data + _REAL * calls.argument[p],
                f.ctypes.data + _REAL * calls.value[p],
                k.ctypes.data + _REAL * calls.tangent[p],
                e.ctypes.data + _REAL * calls.indicator[p],
            ),
        )


@kernel
def _call_sources(calls: Calls, t: float) -> None:
    """Let the sources write their signals at a time [s] into their blocks."""
    for k in range(calls.source.size):
        _call_signals(
            calls.source[k], (calls.blocks.ctypes.data + _REAL * calls.source_block[k], t)
        )


@inlined
def call_signals(
    calls: Calls, fixed: Fixed, state: State, t: float, h: float, u: np.ndarray
) -> None:
    """Write the signals at the nodes of a step from t [s] on, and the last channel.

    Args:
        calls, fixed, state: of the march.
        t, h: start and length of the step [s].
        u: (channels, nodes).
    """
    count, channels = fixed.nodes.size, len(u)
    own = u[channels - 1 - calls.signal.size :]
    if calls.source.size > 0:
        for i in range(count):
            _call_sources(calls, t + h * fixed.nodes[i])
            for k in range(calls.signal.size):
                if calls.signal[k] >= 0:
                    own[k, i] = calls.blocks[calls.signal[k]]
    for k in range(calls.signal.size):
        if calls.source.size > 0 and calls.signal[k] >= 0:
            continue
        curve = state.curve[k]
        since, last = t - curve[0], curve.size - 1
        while last > 1 and curve[last] == 0.0:
            last -= 1
        for i in range(count):
            now, value = since + h * fixed.nodes[i], curve[last]
            for j in range(last - 1, 0, -1):
                value = curve[j] + now * value
            own[k, i] = value
    for i in range(count):
        own[calls.signal.size, i] = fixed.one


@kernel
def laws_along(
    calls: Calls, t: float, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    """Write values, tangents and indicators of all laws at many places.

    Args:
        calls: the laws.
        t: time [s] at which they are, if they depend on it.
        z: (places, arguments).
        f: (places, values).
        k: (places, tangents).
        e: (places, indicators).
    """
    for i in range(len(z)):
        call_laws(calls, t, z[i], f[i], k[i], e[i])
