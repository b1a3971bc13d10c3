"""How signals reach parts without nodes: FMI derivatives as far as a part takes them, else hold."""

import numpy as np

from herringbone.core import FmuError
from herringbone.core.part import Part
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.layouts.derivatives import Derivatives, input_fit
from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.cosim.loops.derivatives import get_rates, set_derivatives
from herringbone.cosim.structure.network import Network

_FATAL = 4


def settle_derivatives(network: Network, prepared: PreparedRun) -> list[str]:
    """Try the derivatives that parts in step mode declare, and use what they do not refuse.

    FMI 2.0 has no flag for the order of input derivatives: orders are tried from that of the
    signals downward.

    Returns:
        One line per part: how its signals travel, and what that costs.

    Raises:
        FmuError: a part fails for good when it is asked.
    """
    layout, notes = prepared.layout, []
    signals = layout.derivatives
    if signals is None:
        return []
    for p, part in enumerate(network.parts):
        asked, rated = int(signals.order[p]), bool(signals.rated[p])
        if not asked and not rated:
            continue
        refused = _settle_inputs(signals, layout, part, p)
        taken = int(signals.order[p])
        signals.fit[p] = input_fit(signals.samples.size - 1, taken, at_end=bool(layout.at_end[p]))
        if asked and not taken:
            signals.rated[p] = 0
        elif rated:
            refused += _settle_outputs(signals, layout, part, p)
        notes.append(
            _note(prepared, signals, p, asked, [f"{part.name} has no signal nodes", *refused])
        )
    return notes


def _settle_inputs(signals: Derivatives, layout: Layout, part: Part, p: int) -> list[str]:
    """Lower the order of a part's input derivatives until it takes them; what it refused."""
    refused: list[str] = []
    for order in range(int(signals.order[p]), 0, -1):
        status = set_derivatives(signals, layout, p)
        if status <= LAST_GOOD:
            break
        said = _refusal(part, status, f"input derivatives of order {order}")
        refused = refused or [said]
        signals.order[p] = order - 1
    return refused


def _settle_outputs(signals: Derivatives, layout: Layout, part: Part, p: int) -> list[str]:
    """Use a part's rates unless it refuses them; what it refused."""
    status = get_rates(signals, layout, p, np.zeros(layout.output_reference.size))
    if status <= LAST_GOOD:
        return []
    signals.rated[p] = 0
    return [_refusal(part, status, "output derivatives")]


def _refusal(part: Part, status: int, what: str) -> str:
    said = "; ".join(part.messages())
    if status == _FATAL:
        raise FmuError(f"{part.name} fails for good at {what}, which it declares: {said}")
    return f"it declares {what} but refuses them ({said or f'FMI status {status}'})"


def _note(prepared: PreparedRun, signals: Derivatives, p: int, asked: int, said: list[str]) -> str:
    taken, rated = int(signals.order[p]), bool(signals.rated[p])
    ways = []
    if asked:
        ways.append(
            f"its inputs go as FMI derivatives up to order {taken}"
            if taken
            else "its inputs are held over a step"
        )
    if rated:
        ways.append("its outputs are cubics through values and FMI derivatives")
    elif prepared.inner_outputs:
        ways.append("its outputs are interpolated through past values")
    kept = prepared.kept_order(p)
    cost = (
        f"the coupling keeps order {kept} in the step"
        if kept == prepared.full_order
        else f"the coupling falls from order {prepared.full_order} to {kept} in the step"
    )
    return "; ".join([*said, *ways, cost])
