"""Own parts fused into one, beside foreign FMUs: what is coupled is that part and the strangers."""

from collections.abc import Sequence
from dataclasses import replace

from herringbone.analysis.twin.core_part.part import CorePart
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.components.in_process import InProcessPart
from herringbone.core import StructureError
from herringbone.core.part import Part, column
from herringbone.core.places.part_path import PartPath, find_columns
from herringbone.core.process.activity import activity
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.units import in_si_units

KIND = "fused"
"""What stands in place of the kind of FMUs, and the part's name."""
LONGEST = 5e-5
"""Base step of the condensed parts [s]."""
_DEGREES = {1.25e-5: 2, 3e-5: 3}
"""Degrees by the longest base step that they suit [s]; 4 beyond. Each errs about 3e-5 there."""
_CLOSE = closeness(1e-8)
"""A step that is repeated begins from what laws were before, and ends within that. Answers at
interfaces are differences of such steps by torques of 1e-7 N m: with 1e-5 they were noise, and a
run whose teeth hit hard at no torque diverged. It costs no time that can be measured."""


def strangers_of(system: System) -> System:
    """The system's foreign parts, and how they are connected with each other.

    Raises:
        StructureError: there are no others.
    """
    own = [part.name for part in system.parts if not part.foreign]
    if not own:
        raise StructureError(
            f"fuse: all parts of {system.name} are foreign FMUs, whose equations are not known, so "
            "that nothing can be fused; run without fuse"
        )
    return system.without(*own)


def fused_beside(
    system: System, strangers: Sequence[Part], record: Sequence[str], step: float | None
) -> tuple[System, list[Part], list[str]]:
    """The system as it is coupled: one part of all own ones, and the strangers.

    Args:
        system: of all parts.
        strangers: instantiated, in the order of `strangers_of`.
        record: groups of channels, or patterns of outputs, that are recorded; all if empty.
        step: longest base step [s]; None: `LONGEST`.

    Raises:
        StructureError: a part cannot be condensed, or nothing matches what is to be recorded.
    """
    outer = strangers_of(system)
    inside = system.without(*outer.paths)
    others = [in_si_units(part) for part in strangers]
    crossing = _crossing(system, inside, others)
    inputs = [path for path, _, is_input in crossing if is_input]
    sent = list(dict.fromkeys(path for path, _, is_input in crossing if not is_input))
    with activity(f"fusing the parts of {system.name} that are no foreign FMUs"):
        core = Core(inside, open_inputs=inputs)
        wanted = _recorded(core, system, others, record)
        if lost := [name for name in sent if name not in core.names]:
            raise StructureError(
                f"fuse: {', '.join(lost)}: only steps of the part make it, so that it cannot be "
                "fused; run without fuse"
            )
        rest = [name for name in wanted if name not in sent]
        steps = Steps(step or LONGEST, 4, _CLOSE)
        part = CorePart(_free_name(outer), core, inputs, sent, rest, steps)
    coupled = replace(
        outer,
        parts=(PartSpec(PartPath(part.name), component=KIND), *outer.parts),
        connections=(
            *outer.connections,
            *((f"{part.name}.{own}", other) for own, other, _ in crossing),
        ),
        ports={},
        channels={},
    )
    lines = [
        f"fused: {', '.join(inside.paths)}; coupled with them: {', '.join(outer.paths)}",
    ]
    return coupled, [part, *others], [*lines, *core.unrecorded]


def _crossing(
    system: System, inside: System, strangers: Sequence[Part]
) -> list[tuple[str, str, bool]]:
    """Connections of own parts with strangers: own and other path, and if the own is an input."""
    own = {i.name: InProcessPart(i) for i in make_instances(inside)}
    by_name = own | {part.name: part for part in strangers}
    parts = [by_name[path] for path in system.paths]
    found = build_network(system, parts)

    def paths(c: Connection) -> tuple[str, str]:
        return f"{parts[c.source].name}.{c.output}", f"{parts[c.target].name}.{c.input}"

    rows = []
    for c in found.every_connection:
        (first, second), is_own = paths(c), [parts[p].name in own for p in (c.source, c.target)]
        if is_own == [True, False]:
            rows.append((first, second, False))
        elif is_own == [False, True]:
            rows.append((second, first, True))
    return rows


def _recorded(
    core: Core, system: System, strangers: Sequence[Part], record: Sequence[str]
) -> Sequence[str]:
    """Outputs of own parts that are recorded; those of strangers always are.

    Raises:
        StructureError: a pattern matches nothing.
    """
    if not record:
        return core.names
    return core.chosen(record, system, _outputs(strangers))


def _outputs(parts: Sequence[Part]) -> list[str]:
    """Columns of all outputs of parts."""
    return [
        column(part, name)
        for part in parts
        for name, v in part.variables.items()
        if v.causality == "output"
    ]


def _free_name(outer: System) -> str:
    """A name that no stranger has."""
    name = KIND
    while any(path.split(".")[0] == name for path in outer.paths):
        name += "_"
    return name


def with_channels(system: System, columns: Sequence[str]) -> System:
    """The system with the patterns of its channels that match recorded outputs."""
    found = {
        group: tuple(p for p, own in find_columns(system.paths, columns, patterns).items() if own)
        for group, patterns in system.channels.items()
    }
    return replace(system, channels={group: own for group, own in found.items() if own})


def with_recorded_channels(system: System, parts: Sequence[Part]) -> System:
    """The same by what parts have."""
    return with_channels(system, _outputs(parts))


def suit(parts: Sequence[Part], step: float) -> None:
    """Let fused parts choose the degree of their polynomials for a macro step [s]."""
    for part in parts:
        if isinstance(part, CorePart):
            length = min(step, part.steps.length)
            degree = next((d for most, d in _DEGREES.items() if length <= most), 4)
            part.take(part.steps._replace(degree=degree))


def with_core_steps(recording: Recording, parts: Sequence[Part]) -> Recording:
    """The recording with what its fused parts, if there are any, tell of their steps."""
    for part in parts:
        if isinstance(part, CorePart):
            return replace(recording, core=part.statistics)
    return recording
