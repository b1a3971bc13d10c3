"""One part alone, driven by a record of its inputs, in compiled code."""

from collections.abc import Sequence

import numpy as np

from herringbone.core import FmuError
from herringbone.core.part import Part
from herringbone.cosim.loops.calls import do_step, exchange_reals
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.compiling.jit import kernel


@kernel
def _drive(
    addresses: np.ndarray,
    inputs: np.ndarray,
    records: np.ndarray,
    outputs: np.ndarray,
    found: np.ndarray,
    h: float,
) -> int:
    """Set, step, get along the records; the number of steps that were done."""
    component, set_real, get_real, step = addresses
    status = exchange_reals(
        get_real, component, outputs.ctypes.data, outputs.size, found[0].ctypes.data
    )
    if status > LAST_GOOD:
        return -1
    for n in range(records.shape[0]):
        status = exchange_reals(
            set_real, component, inputs.ctypes.data, inputs.size, records[n].ctypes.data
        )
        if status <= LAST_GOOD:
            status = do_step(step, component, n * h, h)
        if status <= LAST_GOOD:
            status = exchange_reals(
                get_real, component, outputs.ctypes.data, outputs.size, found[n + 1].ctypes.data
            )
        if status > LAST_GOOD:
            return n
    return records.shape[0]


def drive(
    part: Part, inputs: Sequence[str], records: np.ndarray, outputs: Sequence[str], step: float
) -> np.ndarray:
    """Step an initialised part from time 0, its inputs held over each step.

    Args:
        part: in step mode.
        inputs: names, as the columns of the records.
        records: (n, len(inputs)).
        outputs: names.
        step: communication step size [s].

    Returns:
        (n + 1, len(outputs)), the values before the first step in row 0.

    Raises:
        FmuError: a call was refused, or a value is not finite; the message holds what was logged.
    """

    def references(names: Sequence[str]) -> np.ndarray:
        return np.array([part.variables[name].reference for name in names], dtype=np.uint32)

    addresses = np.array(part.addresses[:4], dtype=np.int64)
    found = np.full((len(records) + 1, len(outputs)), np.nan)
    values = np.ascontiguousarray(records, dtype=float)
    done = _drive(addresses, references(inputs), values, references(outputs), found, step)
    if done < len(records):
        part.failed()
        said = "; ".join(part.messages()) or "no message"
        raise FmuError(f"{part.name} fails at {max(done, 0) * step:g} s: {said}")
    if not np.isfinite(found).all():
        row, column = np.argwhere(~np.isfinite(found))[0]
        raise FmuError(
            f"{part.name}: {outputs[column]} = {found[row, column]} at {row * step:g} s; "
            "is the step too large for it?"
        )
    return found
