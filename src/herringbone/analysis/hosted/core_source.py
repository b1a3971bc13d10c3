"""Source of the kernels by which a gearbox for hosts is condensed, see `kernels.condensed`.

core_given(b, x, u, dx, z): rates and the laws' arguments, where the laws' values, then the
inputs, are given in u
core_prepare(b): before the laws
core_laws(b, z, f, k, e): of all parts, one behind the other
core_period(b): of the meshes [s]
"""

import math

from herringbone.analysis.hosted.start_places import StartPlaces
from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.condensed.equations import laws_of
from herringbone.core import Laws

_LAWS = """
{name}_prepare = COMPONENTS["{name}"].laws.prepare
{name}_gather = COMPONENTS["{name}"].laws.gather
{name}_evaluate = COMPONENTS["{name}"].laws.evaluate
{name}_apply = COMPONENTS["{name}"].laws.apply
"""
_KERNELS = """

@rare
def core_given(b: np.ndarray, x: np.ndarray, u: np.ndarray, dx: np.ndarray, z: np.ndarray) -> None:
    blocks = b[{first}:]
    scatter(blocks, x)
{signals}{motions}{rates}{gather}    return


@kernel
def core_prepare(b: np.ndarray) -> None:
    blocks = b[{first}:]
{prepare}    return


@kernel
def core_laws(
    b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray
) -> None:
    blocks = b[{first}:]
{evaluate}    return


@kernel
def core_period(b: np.ndarray) -> float:
    return {turn!r} / abs(b[{first} + {teeth}] * b[{speed}])
"""


def laws_of_parts(parts: Parts) -> dict[int, Laws]:
    """The laws of the parts that have some, by the parts' number.

    Raises:
        StructureError: a part's equations cannot be taken apart.
    """
    return {p: found for p, i in enumerate(parts.instances) if (found := laws_of(i))}


def core_source(parts: Parts, start: StartPlaces, inputs: tuple[int, ...]) -> str:
    """The kernels.

    Args:
        parts: of the gearbox.
        start: places of what the start needs.
        inputs: places in their blocks of what the inputs feed.
    """
    instances, network, layout = parts.instances, parts.network, parts.layout
    laws = laws_of_parts(parts)
    values = sum(len(own.values) for own in laws.values())

    def block(p: int) -> str:
        return f"blocks[{layout.block_first[p]}:{layout.block_first[p + 1]}]"

    def feed(p: int) -> str:
        def place(q: int, variable: str) -> int:
            return layout.block_first[q] + instances[q].component.declaration.index[variable]

        return "".join(
            f"    blocks[{place(c.target, c.input)}] = blocks[{place(c.source, c.output)}]\n"
            for c in network.inputs(p)
        )

    def evaluation(p: int, kernel: str) -> str:
        own, states = value_of.get(p), f"dx[{layout.state_first[p]}:{layout.state_first[p + 1]}]"
        name = instances[p].component.name
        if own:
            return f"    {name}_apply({block(p)}, 0.0, u[{own[0]}:{own[1]}], {states})\n"
        if kernel == "out":
            return f"    {name}_out({block(p)}, 0.0)\n"
        return f"    {name}_rhs({block(p)}, 0.0, {states})\n"

    value_of, ranges, at = {}, {}, [0, 0, 0, 0]
    for p, own in laws.items():
        sizes = (len(own.arguments), len(own.values), len(own.stiff), own.kinks)
        ends = [a + size for a, size in zip(at, sizes, strict=True)]
        ranges[p] = [f"{n}[{a}:{end}]" for n, a, end in zip("zfke", at, ends, strict=True)]
        value_of[p], at = (at[1], ends[1]), ends
    bodies = [p for p in network.bodies if p not in network.elements]
    motions = [evaluation(p, "out") for p in bodies]
    motions += [feed(p) + evaluation(p, "out") for p in network.elements]
    names = {p: instances[p].component.name for p in laws}
    text = _KERNELS.format(
        first=start.first,
        teeth=start.teeth[0],
        speed=start.speed,
        turn=2.0 * math.pi,
        signals="".join(f"    blocks[{to}] = u[{values + k}]\n" for k, to in enumerate(inputs)),
        motions="".join(motions),
        rates="".join(feed(p) + evaluation(p, "rhs") for p in bodies),
        gather="".join(f"    {names[p]}_gather({block(p)}, {ranges[p][0]})\n" for p in laws),
        prepare="".join(f"    {names[p]}_prepare({block(p)})\n" for p in laws),
        evaluate="".join(
            f"    {names[p]}_evaluate({block(p)}, {', '.join(ranges[p])})\n" for p in laws
        ),
    )
    head = "".join(_LAWS.format(name=name) for name in sorted(set(names.values())))
    return f"\n\nfrom herringbone.kernels.compiling.jit import rare\n{head}{text}"
