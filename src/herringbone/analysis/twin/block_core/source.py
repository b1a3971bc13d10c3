"""Source of the kernels by which a system as one component is condensed, see `in_block.form`.

core_given(b, x, u, dx, z): rates, behind them outputs, and the laws' arguments, where the laws'
values, the sources' signals, then the inputs, are given in u
core_signals(b, t, to): of the sources
core_prepare(b): before the laws
core_laws(b, t, z, f, k, e): of all parts, one behind the other
core_indicators(b, t, z, f, k, e): arguments, and the laws there, after the rates
core_period(b): shortest of the meshes [s]
core_show(b, u, t, need, bent): outputs that are not affine, see `in_block.form.Equations`
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from herringbone.analysis.twin.block_core.form import signals_of
from herringbone.analysis.twin.block_core.writer import Writer
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.condensed.lean import names_of_states
from herringbone.core.declaring.roles import GEARS, Quantity

_LAWS = """
{name}_gather = COMPONENTS["{name}"].laws.gather
{name}_evaluate = COMPONENTS["{name}"].laws.evaluate
{name}_apply = COMPONENTS["{name}"].laws.apply
"""
_KERNELS = """

@rare
def core_given(b: np.ndarray, x: np.ndarray, u: np.ndarray, dx: np.ndarray, z: np.ndarray) -> None:
    blocks = b[{first}:]
    scatter(blocks, x)
{given}{motions}{rates}{gather}{held}{outputs}    return


@kernel
def core_signals(b: np.ndarray, t: float, to: np.ndarray) -> None:
    blocks = b[{first}:]
{signals}    return


@kernel
def core_prepare(b: np.ndarray) -> None:
    blocks = b[{first}:]
{prepare}    return


@kernel
def core_laws(
    b: np.ndarray, t: float, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    blocks = b[{first}:]
{evaluate}    return


@kernel
def core_indicators(
    b: np.ndarray, t: float, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    blocks = b[{first}:]
{gather}    core_laws(b, t, z, f, k, e)


@kernel
def core_period(b: np.ndarray) -> float:
    blocks = b[{first}:]
    period = np.inf
{periods}    return period


@rare
def core_show(
    b: np.ndarray, u: np.ndarray, t: float, need: np.ndarray, bent: np.ndarray
) -> None:
    blocks = b[{first}:]
{show}    return
"""


class Mesh(NamedTuple):
    """Whose laws repeat themselves every pair of teeth.

    Attributes:
        teeth: place of the number of the pinion's teeth, in the blocks of the parts.
        speed: place of the pinion's speed, in the component's block.
    """

    teeth: int
    speed: int


def meshes_of(parts: Parts, own: int = 0) -> list[Mesh]:
    """The meshes of a component with so many states in front of those of its parts."""
    found = []
    for p, i in enumerate(parts.instances):
        d = i.component.declaration
        teeth = [v.name for v in d.offered(Quantity.NUMBER_OF_TEETH) if v.place == GEARS[0]]
        angles = [v.name for v in d.states if v.steady == "rotating"]
        if teeth and angles:
            first, states = parts.layout.block_first[p], [v.name for v in d.states]
            speed = own + parts.layout.state_first[p] + states.index(f"der({angles[0]})")
            found.append(Mesh(first + d.index[teeth[0]], speed))
    return found


def core_source(
    parts: Parts,
    first: int,
    inputs: Sequence[int],
    own: int = 0,
    held: Sequence[str] = (),
    *,
    shown: bool = False,
) -> str:
    """The kernels.

    Args:
        parts: of the system.
        first: start of their blocks in the component's.
        inputs: places in these blocks of what the inputs feed.
        own: states in front of those of the parts.
        held: names of states that keep their values.
        shown: its outputs are those of the parts, and can be had one by one.
    """
    write = Writer(parts)
    values = sum(len(laws.values) for laws in write.laws.values())
    fed = [write.place(*signal) for signal in signals_of(parts)] + list(inputs)
    states = names_of_states(parts.instances)
    preparing = {
        write.name(p) for p, laws in write.laws.items() if hasattr(laws.prepare, "py_func")
    }
    first_input = values + len(signals_of(parts))
    given = {to: first_input + k for k, to in enumerate(inputs)}
    text = _KERNELS.format(
        first=first,
        outputs=write.outputs() if shown else "",
        show=write.show(given) if shown else "",
        given="".join(f"    blocks[{to}] = u[{values + k}]\n" for k, to in enumerate(fed)),
        motions=write.motions(),
        rates=write.rates(),
        gather="".join(
            f"    {write.name(p)}_gather({write.block(p)}, {write.ranges[p][0]})\n"
            for p in write.laws
        ),
        held="".join(f"    dx[{states.index(name)}] = 0.0\n" for name in held),
        signals=write.signals(),
        prepare="".join(
            f"    {write.name(p)}_prepare({write.block(p)})\n"
            for p in write.laws
            if write.name(p) in preparing
        ),
        evaluate=write.evaluate(),
        periods="".join(
            f"    period = min(period, {2.0 * math.pi!r} / abs(blocks[{m.teeth}] * b[{m.speed}]))\n"
            for m in meshes_of(parts, own)
        ),
    )
    names = sorted({write.name(p) for p in write.laws})
    head = "".join(_LAWS.format(name=name) for name in names)
    if shown:  # arrays: what seldom happens has no checks of their ends
        head += "SHOWN_FROM, SHOWN_TO = np.array(OUTPUT_FROM), np.array(OUTPUT_TO)\n"
    return f"\n\nfrom herringbone.kernels.compiling.jit import rare\n{head}{text}"
