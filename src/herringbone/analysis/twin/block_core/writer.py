"""Lines of the kernels by which a system as one component is condensed, see `block_core.source`."""

from collections.abc import Mapping

from herringbone.analysis.twin.block_core.form import (
    laws_of_parts,
    makers,
    outputs_of,
    pure_sources,
    shown_of,
    signals_of,
)
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.kernels.condensed.in_block.places import output_places


class Writer:
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
        """The block of a part."""
        first = self.parts.layout.block_first
        return f"blocks[{first[p]}:{first[p + 1]}]"

    def name(self, p: int) -> str:
        """The component of a part, as its kernels are named after it."""
        return self.parts.instances[p].component.name

    def place(self, p: int, variable: str) -> int:
        """Place of a variable of a part in `blocks`."""
        index = self.parts.instances[p].component.declaration.index
        return self.parts.layout.block_first[p] + index[variable]

    def feed(self, p: int) -> str:
        """Hands a part what is joined to its inputs."""
        pairs = (
            (self.place(c.target, c.input), self.place(c.source, c.output))
            for c in self.parts.network.inputs(p)
        )
        return "".join(f"    blocks[{to}] = blocks[{of}]\n" for to, of in pairs)

    def evaluation(self, p: int, *, rates: bool) -> str:
        """The rates or the outputs of a part; of one with laws, by the values that are given."""
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
