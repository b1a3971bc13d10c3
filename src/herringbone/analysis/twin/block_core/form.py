"""The form in which a system as one component is condensed, and when it can be."""

from collections.abc import Sequence
from types import ModuleType

import numpy as np

from herringbone.analysis.twin.composite_parts import Parts
from herringbone.analysis.twin.condensed.equations import laws_of
from herringbone.analysis.twin.condensed.rungs import LOBATTO, coefficients, midway
from herringbone.core import Declaration, Instance, Laws, StructureError
from herringbone.kernels.condensed.in_block.form import Equations, Form, Shown
from herringbone.kernels.signals import STRIDE

DEGREE = 4
_MOVED = 1e-2
"""Change of a parameter by which is seen what follows from it; any does."""
_NOTHING = Shown()


def laws_of_parts(parts: Parts) -> dict[int, Laws]:
    """The laws of the parts that have some, by the parts' number.

    Raises:
        StructureError: a part's equations cannot be taken apart.
    """
    return {p: found for p, i in enumerate(parts.instances) if (found := laws_of(i))}


def why_not(parts: Parts) -> str:
    """Why a system has no condensed form, as far as its structure tells; empty if it may have."""
    try:
        laws = laws_of_parts(parts)
    except StructureError as error:
        return str(error)
    return "" if laws else "no part has laws beside its linear equations"


def core_form(
    parts: Parts, inputs: int, lengths: Sequence[float], rough: float, shown: Shown = _NOTHING
) -> Form:
    """The form; mean tangents are those of the parameters as they are exported.

    Other ones are as good for the solution, but take more iterations.

    Args:
        parts: of the system.
        inputs: how many the host gives.
        lengths: of steps, falling [s].
        rough: see `Form`.
        shown: see `Form`.
    """
    laws = laws_of_parts(parts)
    stiff: list[int] = []
    of_tangent: list[int] = []
    arguments = sum(len(own.arguments) for own in laws.values())
    directions, sharp = [np.zeros((0, arguments))], [np.zeros((0, arguments))]
    mean = []
    value = at = 0
    for p, own in laws.items():
        block = parts.instances[p].block
        unknown = sorted(set(own.stiff))
        of_tangent += [len(stiff) + unknown.index(v) for v in own.stiff]
        stiff += [value + v for v in unknown]
        directions.append(_among(own.directions(block), at, arguments))
        sharp += [_among(rows, at, arguments) for rows in _sharp(own, block)]
        mean.append(own.mean(block))
        value, at = value + len(own.values), at + len(own.arguments)
    nodes = np.array(LOBATTO[DEGREE])
    return Form(
        states=parts.layout.state_first[-1],
        turning=_turning(parts),
        arguments=arguments,
        values=value,
        kinks=sum(own.kinks for own in laws.values()),
        stiff=tuple(stiff),
        of_tangent=tuple(of_tangent),
        directions=np.concatenate(directions),
        mean=np.concatenate(mean),
        sharp=np.concatenate(sharp),
        signals=len(signals_of(parts)),
        inputs=inputs,
        nodes=nodes,
        between=midway(DEGREE),
        fit=coefficients(DEGREE),
        ahead=parabola_since_end(nodes),
        lengths=tuple(lengths),
        rough=rough,
        shown=shown,
    )


def _sharp(own: Laws, block: np.ndarray) -> list[np.ndarray]:
    """Directions of a part's laws along which arguments are taken at all nodes."""
    return [rows(block) for rows in (own.sharp or own.directions, own.fine) if rows is not None]


def directed_by(parts: Parts) -> list[tuple[Instance, str]]:
    """Parameters that the sharp directions of a form follow from, and whose they are."""
    found = []
    for p, own in laws_of_parts(parts).items():
        instance = parts.instances[p]
        declaration, here = instance.component.declaration, _sharp(own, instance.block)
        for v in declaration.parameters:
            block = instance.block.copy()
            block[declaration.index[v.name]] += _MOVED * (1.0 + block[declaration.index[v.name]])
            if not all(map(np.array_equal, here, _sharp(own, block))):
                found.append((instance, v.name))
    return found


def parabola_since_end(nodes: np.ndarray) -> np.ndarray:
    """First and second power (2, nodes), see `Form.ahead`; a higher one goes farther off."""
    found = np.zeros((2, nodes.size))
    found[:, :-1] = np.linalg.pinv(np.vander(nodes - 1.0, 3, increasing=True)[:-1, 1:])
    return found


def _among(rows: np.ndarray, at: int, arguments: int) -> np.ndarray:
    """Rows over the arguments of all laws, from those over a part's own."""
    whole = np.zeros((len(rows), arguments))
    whole[:, at : at + rows.shape[1]] = rows
    return whole


def _turning(parts: Parts) -> tuple[int, ...]:
    """States that are angles which grow."""
    return tuple(
        first + k
        for first, i in zip(parts.layout.state_first, parts.instances, strict=False)
        for k, v in enumerate(i.component.declaration.states)
        if v.steady == "rotating"
    )


def equations_of(
    declaration: Declaration, module: ModuleType, sizes: tuple[float, ...], kept: int
) -> Equations:
    """The kernels of a form, see `source`.

    Args:
        declaration: of the component.
        module: its kernels.
        sizes: usual ones of the states.
        kept: see `Equations`.
    """
    d = declaration
    return Equations(
        d.name,
        np.array(d.indices(*(v.name for v in d.inputs)), dtype=np.int64),
        sizes,
        kept,
        module.system_rhs,
        module.system_out,
        module.core_given,
        module.core_signals,
        module.core_prepare,
        module.core_laws,
        module.core_indicators,
        module.core_period,
        module.core_show,
    )


def outputs_of(parts: Parts) -> list[tuple[int, str]]:
    """All outputs, part and name, in the order of the block: those with nodes first."""
    found = [(p, v) for p, i in enumerate(parts.instances) for v in i.component.declaration.outputs]
    return [(p, v.name) for nodes in (True, False) for p, v in found if v.nodes == nodes]


def makers(parts: Parts) -> list[int]:
    """Parts that make outputs alone which are not affine, in the order in which they can."""
    network = parts.network
    own = {*laws_of_parts(parts), *pure_sources(parts)}
    own |= {p for p, i in enumerate(parts.instances) if not _is_affine(i)}
    return [p for p in (*network.sources, *network.bodies, *network.elements) if p in own]


def _is_affine(instance: Instance) -> bool:
    """False if a part has outputs that are not affine in its states and inputs, as a power."""
    d = instance.component.declaration
    given = [*range(d.state_count), *(d.index[v.name] for v in d.inputs)]
    outputs = [d.index[v.name] for v in d.outputs]
    chance = np.random.default_rng(_SEED)
    a, b = chance.normal(size=(2, len(given)))
    found = []
    for share in (0.0, 1.0, 0.3):
        block = instance.block.copy()
        block[given] += share * a + (1.0 - share) * b
        instance.component.kernels.out(block, 0.0)
        found.append(block[outputs])
    mean = 0.7 * found[0] + 0.3 * found[1]
    size = np.abs(found[0]) + np.abs(found[1])
    return bool(np.all(np.abs(found[2] - mean) <= _SAME * size))


_SAME, _SEED = 1e-9, 17
"""Of two values: a difference below is rounding. Any seed does."""


def shown_of(parts: Parts) -> Shown:
    """The outputs of a system whose block begins with its parts' states and open inputs."""
    rows = outputs_of(parts)
    able, layout, sources = makers(parts), parts.layout, pure_sources(parts)
    number = {p: k for k, p in enumerate(able)}
    signals = set(signals_of(parts))
    return Shown(
        first=layout.state_first[-1] + STRIDE * len(parts.open_inputs),
        with_nodes=sum(len(i.component.declaration.node_outputs) for i in parts.instances),
        part=tuple(number.get(p, -1) for p, _ in rows),
        timed=tuple(k for k, row in enumerate(rows) if row[0] in sources and row not in signals),
        states=tuple((layout.state_first[p], layout.state_first[p + 1]) for p in able),
        feeding=tuple(
            tuple(rows.index((c.source, c.output)) for c in parts.network.inputs(p)) for p in able
        ),
    )


def pure_sources(parts: Parts) -> list[int]:
    """Sources whose outputs are known over time."""
    return [
        p
        for p in parts.network.sources
        if not parts.instances[p].component.declaration.state_count
        and not any(name.startswith(f"{parts.instances[p].name}.") for name in parts.open_inputs)
    ]


def signals_of(parts: Parts) -> list[tuple[int, str]]:
    """Outputs of sources that others take: part and name."""
    sources = set(pure_sources(parts))
    used = {(c.source, c.output) for c in parts.network.connections if c.source in sources}
    return sorted(used)
