"""A leaner model: constraints on the arrays of a condensed system, whatever its parts are.

States that are held keep their start values, and what would move them is taken up by a reaction.
Parts that are driven one way see the forces of the others as if they stood still themselves, and
are not felt by them. Nothing of a component is changed, so that a leaner model is marched, and its
steady states are found, as those of the whole one.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from herringbone.analysis.twin.condensed.equations import Equations, laws_of
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import Instance, StructureError
from herringbone.core.lean import Lean
from herringbone.core.names import shown

_NONE = 1e-9
"""Of the singular values of what drives a part: no direction of its own."""


def state_names(twin: Twin) -> tuple[str, ...]:
    """Names of all states, `instance.state`; elements of vectors are `x[1]`, `der(x[1])`, ..."""
    return names_of_states(twin.instances)


def names_of_states(instances: Iterable[Instance]) -> tuple[str, ...]:
    """The same of instances, in their order."""
    found = []
    for instance in instances:
        declaration = instance.component.declaration
        own = [v.name for v in declaration.states]
        for vector in declaration.vectors:
            own += [vector.element(k + 1) for k in range(vector.capacity)]
        found += [f"{instance.name}.{name}" for name in own]
    return tuple(found)


def _part(twin: Twin, name: str) -> int:
    """Index of a part."""
    for p, instance in enumerate(twin.instances):
        if instance.name == name:
            return p
    raise StructureError(f"{twin.system.name}: model: it has no part {shown(name, 60)}")


def with_harmonics(twin: Twin, lean: Lean) -> Twin:
    """The twin of a leaner model, as far as that is one of tables with fewer harmonics.

    Raises:
        StructureError: a part is not there, or its laws take no table.
    """
    blocks: dict[str, np.ndarray] = {}
    for part, count in lean.harmonics:
        found = twin.instances[_part(twin, part)]
        laws = laws_of(found)
        block = blocks.setdefault(part, found.block.copy())
        why = laws.keep_harmonics(block, count) if laws else "it has no laws"
        if why:
            raise StructureError(f"{part}: model: {count} harmonics of its tables: {why}")
    return twin.with_blocks(blocks) if blocks else twin


def held_states(twin: Twin, lean: Lean) -> list[int]:
    """Indices of the states that are held.

    Raises:
        StructureError: one is not there, or grows with every turn.
    """
    names = {name: k for k, name in enumerate(state_names(twin))}
    for name in lean.hold:
        if name not in names:
            raise StructureError(
                f"{twin.system.name}: model: it has no state {shown(name, 60)} that could be held"
            )
        if names[name] in twin.turning:
            raise StructureError(f"{name}: model: an angle that turns cannot be held")
    return [names[name] for name in lean.hold]


def leaner(twin: Twin, equations: Equations, lean: Lean, seen: Sequence[int]) -> Equations:
    """Equations of a leaner model.

    Args:
        twin: the system.
        equations: of the whole model.
        lean: what is left out.
        seen: places that the equations show, see `take_apart`.

    Raises:
        StructureError: it names what is not there.
    """
    for part in lean.one_way:
        equations = _driven(twin, equations, part, seen)
    held = held_states(twin, lean)
    a, b = equations.a.copy(), equations.b.copy()
    a[held], b[held] = 0.0, 0.0
    return replace(equations, a=a, b=b)


def _driven(twin: Twin, equations: Equations, name: str, seen: Sequence[int]) -> Equations:
    """A part sees its inputs u = E_o x_o + E_h x_h without its own motion x_h, as do the others.

    Its rates are A_h x_h + B u, and B follows from what the others drive them by, B E_o.
    """
    p = _part(twin, name)
    first = twin.layout.block_first[p]
    declaration = twin.instances[p].component.declaration
    inputs = {first + declaration.index[v.name] for v in declaration.inputs}
    own = slice(twin.layout.state_first[p], twin.layout.state_first[p + 1])
    others = np.ones(twin.state.size, dtype=bool)
    others[own] = False
    rows = [row for row, place in enumerate(seen) if place in inputs]
    last = first + twin.instances[p].block.size
    shown_by_it = np.array([first <= place < last for place in seen], dtype=bool)
    inverse = np.linalg.pinv(equations.e[rows][:, others], rcond=_NONE)
    start = twin.state[own]
    a, b = equations.a.copy(), equations.b.copy()
    e, g = equations.e.copy(), equations.g.copy()
    for over, constant, of_part in ((a, b, ~others), (e, g, shown_by_it)):
        back = over[of_part][:, others] @ inverse @ equations.e[rows][:, own]
        rest = np.zeros((len(over), start.size))
        rest[of_part] = back
        rest[~of_part] = over[~of_part][:, own]
        over[:, own] -= rest
        constant[:, -1] += rest @ start
    return replace(equations, a=a, b=b, e=e, g=g)
