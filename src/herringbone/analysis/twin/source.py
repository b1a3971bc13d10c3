"""Source of a system's monolithic twin: one right-hand side, generated from the structure.

All blocks lie side by side in one array `b`. The generated module has

    propagate(b, t): outputs of sources, of bodies, then of elements, each handed to the inputs
    move(b, t): the same, but of bodies no more than their motion where that is all others take
    rhs(b, x, t, dx): derivative of all states
    observe(b, times, states, columns, values): recorded outputs at given times and states
"""

from dataclasses import dataclass

from herringbone.core import Instance
from herringbone.cosim.structure.network import Network

_HEADER = '''"""Monolithic twin of a system; generated, not to be edited."""

import numpy as np

from herringbone.components.registry import COMPONENTS
from herringbone.kernels.compiling.jit import kernel, seldom

'''
_OBSERVE = """

@kernel
def observe(b, times, states, columns, values):
    for row in range(times.size):
        scatter(b, states[:, row])
        propagate(b, times[row])
        propagate(b, times[row])
        for k in range(columns.size):
            values[row, k] = b[columns[k]]
"""


@dataclass(frozen=True)
class TwinLayout:
    """Where each part lies in the twin.

    Attributes:
        block_first: start of each part's block.
        state_first: start of each part's states.
    """

    block_first: tuple[int, ...]
    state_first: tuple[int, ...]


def twin_layout(instances: list[Instance]) -> TwinLayout:
    """Blocks and states one behind the other, in the order of the parts; totals at the end."""
    blocks, states = [0], [0]
    for instance in instances:
        declaration = instance.component.declaration
        blocks.append(blocks[-1] + declaration.size)
        states.append(states[-1] + declaration.state_count)
    return TwinLayout(tuple(blocks), tuple(states))


def twin_source(network: Network, instances: list[Instance], layout: TwinLayout) -> str:
    """Generate the twin's module.

    No text enters it but names of components, which are identifiers (see `Declaration`).
    """

    def block(p: int) -> str:
        return f"b[{layout.block_first[p]}:{layout.block_first[p + 1]}]"

    def index(p: int, variable: str) -> int:
        return layout.block_first[p] + instances[p].component.declaration.index[variable]

    def propagation(kernel: str, moving: frozenset[int]) -> list[str]:
        text = [f"\n\n@kernel\ndef {kernel}(b: np.ndarray, t: float) -> None:\n"]
        for p in (*network.sources, *network.bodies, *network.elements):
            if p in network.elements:
                text += [_copy(c, index) for c in network.inputs(p)]
            name = instances[p].component.name
            call = f"{name}_motion({block(p)})" if p in moving else f"{name}_out({block(p)}, t)"
            text.append(f"    {call}\n")
        for p in network.bodies:
            text += [_copy(c, index) for c in network.inputs(p)]
        return [*text, "    return\n"]

    names = sorted({i.component.name for i in instances})
    moving = _moving(network, instances)
    lines = [_HEADER]
    lines += [f'{n}_rhs = COMPONENTS["{n}"].kernels.rhs\n' for n in names]
    lines += [f'{n}_out = COMPONENTS["{n}"].kernels.out\n' for n in names]
    moved = sorted({instances[p].component.name for p in moving})
    lines += [f'{n}_motion = COMPONENTS["{n}"].motion\n' for n in moved]
    lines.append("\n\n@kernel\ndef scatter(b: np.ndarray, x: np.ndarray) -> None:\n")
    for p, instance in enumerate(instances):
        first, count = layout.state_first[p], instance.component.declaration.state_count
        if count:
            lines.append(f"    for i in range({count}):\n")
            lines.append(f"        b[{layout.block_first[p]} + i] = x[{first} + i]\n")
    lines.append("    return\n")
    lines += propagation("propagate", frozenset())
    lines += propagation("move", moving)
    lines.append("\n\n@kernel\n")
    lines.append("def rhs(b: np.ndarray, x: np.ndarray, t: float, dx: np.ndarray) -> None:\n")
    lines.append("    scatter(b, x)\n    move(b, t)\n")
    for p, instance in enumerate(instances):
        first, end = layout.state_first[p], layout.state_first[p + 1]
        if end > first:
            lines.append(f"    {instance.component.name}_rhs({block(p)}, t, dx[{first}:{end}])\n")
    lines.append("    return\n")
    lines.append(_OBSERVE)
    return "".join(lines)


def _moving(network: Network, instances: list[Instance]) -> frozenset[int]:
    """Bodies of which others take what states alone decide, and which can compute that alone."""

    def depends(p: int, output: str) -> bool:
        return bool(instances[p].component.declaration.variable(output).feedthrough)

    more = {c.source for c in network.connections if depends(c.source, c.output)}
    return frozenset(
        p for p in network.bodies if instances[p].component.motion is not None and p not in more
    )


def _copy(connection, index) -> str:  # noqa: ANN001
    target = index(connection.target, connection.input)
    return f"    b[{target}] = b[{index(connection.source, connection.output)}]\n"
