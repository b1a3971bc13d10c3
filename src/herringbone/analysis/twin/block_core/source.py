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
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from herringbone.analysis.twin.block_core.form import (
    laws_of_parts,
    makers,
    outputs_of,
    pure_sources,
    shown_of,
    signals_of,
)
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.condensed.lean import names_of_states
from herringbone.core.declaring.roles import GEARS, Quantity
from herringbone.kernels.condensed.in_block.places import output_places

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

    def outputs(self) -> str:
        """All outputs, when the rates and what elements give are known."""
        network = self.parts.network
        others = {*pure_sources(self.parts), *self.laws}
        lines = [
            self.feed(p) + self.evaluation(p, rates=False)
            for p in (*network.sources, *network.bodies)
            if p not in others
        ]
        count, first = len(outputs_of(self.parts)), self.parts.layout.state_first[-1]
        lines.append(f"    for i in range({count}):\n")
        lines.append(f"        dx[{first} + i] = blocks[SHOWN_FROM[i]]\n")
        return "".join(lines)

    def show(self, inputs: Mapping[int, int]) -> str:
        """Outputs of each part that makes some alone, from states and other outputs.

        Args:
            inputs: places in `u`, by place in the blocks of the parts of what they feed.
        """
        layout, shown = self.parts.layout, shown_of(self.parts)
        rows, places = outputs_of(self.parts), output_places(shown)
        index = {row: k for k, row in enumerate(rows)}
        lines = []
        for number, p in enumerate(makers(self.parts)):
            first, end = layout.block_first[p], layout.block_first[p + 1]
            lines += [
                f"    if need[{number}] != 0.0:\n",
                f"        for i in range({layout.state_first[p + 1] - layout.state_first[p]}):\n",
                f"            blocks[{first} + i] = b[{layout.state_first[p]} + i]\n",
            ]
            for c in self.parts.network.inputs(p):
                place = places[index[c.source, c.output]]
                lines.append(f"        blocks[{self.place(p, c.input)}] = b[{place}]\n")
            lines += [
                f"        blocks[{to}] = u[{k}]\n" for to, k in inputs.items() if first <= to < end
            ]
            lines.append(f"        {self.name(p)}_out({self.block(p)}, t)\n")
            own = [k for k, row in enumerate(rows) if row[0] == p]
            for nodes in (True, False):
                chosen = [k for k in own if (k < shown.with_nodes) == nodes]
                if not chosen:
                    continue
                lines += [
                    f"        for i in range({chosen[0]}, {chosen[-1] + 1}):\n",
                    "            if bent[i] != 0.0:\n",
                    "                b[SHOWN_TO[i]] = blocks[SHOWN_FROM[i]]\n",
                ]
                if nodes:
                    lines.append("                b[SHOWN_TO[i] + 1] = blocks[SHOWN_FROM[i]]\n")
        return "".join(lines)

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
    write = _Writer(parts)
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
