"""Source of the kernels by which a system as one component is condensed, see `in_block.form`.

core_given(b, x, u, dx, z): rates and the laws' arguments, where the laws' values, the sources'
signals, then the inputs, are given in u
core_signals(b, t, to): of the sources
core_prepare(b): before the laws
core_laws(b, t, z, f, k, e): of all parts, one behind the other
core_period(b): shortest of the meshes [s]
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from herringbone.analysis.twin.block_core.form import laws_of_parts, pure_sources, signals_of
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
{given}{motions}{rates}{gather}{held}    return


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
def core_period(b: np.ndarray) -> float:
    blocks = b[{first}:]
    period = np.inf
{periods}    return period
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


class _Writer:
    """Lines of kernels; `b` is the component's block, `blocks` those of the parts."""

    def __init__(self, parts: Parts) -> None:
        self.parts, self.laws = parts, laws_of_parts(parts)
        self.ranges: dict[int, list[str]] = {}
        self.values: dict[int, str] = {}
        at = [0, 0, 0, 0]
        for p, own in self.laws.items():
            sizes = (len(own.arguments), len(own.values), len(own.stiff), own.kinks)
            ends = [a + size for a, size in zip(at, sizes, strict=True)]
            self.ranges[p] = [f"{n}[{a}:{end}]" for n, a, end in zip("zfke", at, ends, strict=True)]
            self.values[p], at = f"u[{at[1]}:{ends[1]}]", ends

    def block(self, p: int) -> str:
        first = self.parts.layout.block_first
        return f"blocks[{first[p]}:{first[p + 1]}]"

    def name(self, p: int) -> str:
        return self.parts.instances[p].component.name

    def place(self, p: int, variable: str) -> int:
        index = self.parts.instances[p].component.declaration.index
        return self.parts.layout.block_first[p] + index[variable]

    def feed(self, p: int) -> str:
        pairs = (
            (self.place(c.target, c.input), self.place(c.source, c.output))
            for c in self.parts.network.inputs(p)
        )
        return "".join(f"    blocks[{to}] = blocks[{of}]\n" for to, of in pairs)

    def evaluation(self, p: int, *, rates: bool) -> str:
        first = self.parts.layout.state_first
        states, name, block = f"dx[{first[p]}:{first[p + 1]}]", self.name(p), self.block(p)
        if p in self.laws:
            return f"    {name}_apply({block}, 0.0, {self.values[p]}, {states})\n"
        if rates:
            return f"    {name}_rhs({block}, 0.0, {states})\n"
        return f"    {name}_out({block}, 0.0)\n"

    def motions(self) -> str:
        """Outputs of all that moves, each handed to the elements behind it."""
        network, sources = self.parts.network, set(pure_sources(self.parts))
        bodies = (*(p for p in network.sources if p not in sources), *network.bodies)
        found = [self.evaluation(p, rates=False) for p in bodies if p not in network.elements]
        found += [self.feed(p) + self.evaluation(p, rates=False) for p in network.elements]
        return "".join(found)

    def rates(self) -> str:
        """Rates of all that moves, with what elements give."""
        network, sources = self.parts.network, set(pure_sources(self.parts))
        moving = (*network.sources, *network.bodies, *network.elements)
        return "".join(
            ("" if p in network.elements else self.feed(p)) + self.evaluation(p, rates=True)
            for p in moving
            if p not in sources and self.parts.instances[p].component.declaration.state_count
        )

    def signals(self) -> str:
        """Outputs of the sources at a time."""
        calls = [f"    {self.name(p)}_out({self.block(p)}, t)\n" for p in pure_sources(self.parts)]
        places = [self.place(*signal) for signal in signals_of(self.parts)]
        return "".join([*calls, *(f"    to[{k}] = blocks[{at}]\n" for k, at in enumerate(places))])

    def evaluate(self) -> str:
        """The laws; those with a clock are told the time."""
        lines = []
        for p, own in self.laws.items():
            if own.clock is not None:
                place = self.parts.layout.block_first[p] + own.clock
                lines.append(f"    blocks[{place}] = t\n")
            lines.append(
                f"    {self.name(p)}_evaluate({self.block(p)}, {', '.join(self.ranges[p])})\n"
            )
        return "".join(lines)


def core_source(
    parts: Parts, first: int, inputs: Sequence[int], own: int = 0, held: Sequence[str] = ()
) -> str:
    """The kernels.

    Args:
        parts: of the system.
        first: start of their blocks in the component's.
        inputs: places in these blocks of what the inputs feed.
        own: states in front of those of the parts.
        held: names of states that keep their values.
    """
    write = _Writer(parts)
    values = sum(len(laws.values) for laws in write.laws.values())
    fed = [write.place(*signal) for signal in signals_of(parts)] + list(inputs)
    states = names_of_states(parts.instances)
    preparing = {
        write.name(p) for p, laws in write.laws.items() if hasattr(laws.prepare, "py_func")
    }
    text = _KERNELS.format(
        first=first,
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
    return f"\n\nfrom herringbone.kernels.compiling.jit import rare\n{head}{text}"
