"""Variables of a gearbox for hosts: few are shown, all others keep their places in the block."""

from collections.abc import Iterator
from dataclasses import replace

from herringbone.analysis.hosted.boundary import Boundary, HostFlange, mean_torque
from herringbone.analysis.hosted.gear_data import texts_with_gear_data
from herringbone.analysis.twin.composite_parts import (
    Parts,
    feedthrough_of,
    full_name,
    vectors_of,
)
from herringbone.core import (
    Declaration,
    Instance,
    Variable,
    choice,
    local,
    output,
    parameter,
    state,
)
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.declaring.hosting import Given
from herringbone.core.declaring.roles import Port, PortKind, Quantity
from herringbone.core.declaring.variable import NODES, Causality, Variability
from herringbone.kernels.stepping.adaptive import FIRST, LARGEST

START_MODES = ("as_set", "equilibrium", "periodic")
AS_SET, EQUILIBRIUM, PERIODIC = range(len(START_MODES))
"""Start modes, and their numbers."""
START_MODE, INITIAL_SPEED = "start_mode", "initial_speed"
TOLERANCE, NEXT_STEP, INNER_STEP, STEP_START, STEPPING, FLANK = (
    "tolerance", "next_inner_step", "longest_inner_step", "step_start", "stepping",
    "carrying_flank",
)  # fmt: skip
MICRO_STEP = "micro_step"
_OWN = (MICRO_STEP, INTERFACE_DEGREE)


def own_states(flange: HostFlange) -> tuple[str, ...]:
    """Names of the states that a flange adds: its angle where it gives speed, its impulse."""
    if not flange.shaft:
        return ()
    angle = (f"{flange.name}.angle",) if flange.given is Given.SPEED else ()
    return (*angle, f"{flange.name}.impulse")


def initial_torque(flange: HostFlange) -> str:
    """Name of the parameter: torque of the shaft on the gearbox at the start."""
    return f"{flange.name}.initial_torque"


def offset(flange: HostFlange) -> str:
    """Name of the local: angle of the shaft's end where the host's angle is 0 [rad]."""
    return f"{flange.name}.offset"


def since(flange: HostFlange) -> str:
    """Name of the local: time at which the angle has the value of the input [s]."""
    return f"{flange.name}.since"


def lead(flange: HostFlange) -> str:
    """Name of the local: time between that and the start of the communication step [s]."""
    return f"{flange.name}.lead"


def host_declaration(
    boundary: Boundary, parts: Parts, tolerance: float, scratch: int, further: list[Variable],
    work: int,
) -> Declaration:  # fmt: skip
    """The declaration.

    Args:
        boundary, parts: what lies inside.
        tolerance: of the default experiment.
        scratch: room behind the parts.
        further: hidden parameters.
        work: length of the work space.
    """
    variables = [*_own_states(boundary), *_of_parts(boundary, parts)]
    variables += [*_outputs(boundary), *_locals(boundary, tolerance)]
    variables += [*_parameters(boundary, parts), *further]
    shown, system = {v.name for v in _shown(boundary, parts, variables)}, boundary.system
    names = [v.name for v in variables] + [INTERFACE_DEGREE]
    hidden = set(names) - shown - ({INTERFACE_DEGREE} if boundary.wanted.nodes else set())
    hidden |= {
        node_name(v.name, node)
        for v in variables
        for node in range(1, NODES + 1)
        if v.nodes and not (boundary.wanted.nodes and v.name in shown)
    }
    return Declaration(
        system.name,
        system.description,
        variables,
        texts=texts_with_gear_data(parts.instances, boundary.pair),
        vectors=vectors_of(parts.instances, parts.layout.block_first),
        tables=sum(i.component.declaration.size for i in parts.instances) + scratch,
        work=work,
        ports=_ports(boundary, variables),
        hidden=hidden,
    )


def _ports(boundary: Boundary, variables: list[Variable]) -> list[Port]:
    """The flanges, and where forces of bearings and velocities of seats are shown."""
    found = [Port(f.name, PortKind.FLANGE) for f in boundary.flanges]
    kinds = {"bearing": PortKind.JOURNAL, "seat": PortKind.SEAT}
    shown = (v.name.rpartition(".")[0] for v in variables if v.causality is Causality.OUTPUT)
    for name in dict.fromkeys(shown):
        kind, _, place = name.partition(".")
        if kind in kinds and place:
            found.append(Port(name, kinds[kind], place))
    return found


def _own_states(boundary: Boundary) -> Iterator[Variable]:
    for f in boundary.flanges:
        for name in own_states(f):
            if name.endswith(".angle"):
                yield state(name, "rad", f"integral of {f.name}.w", steady="rotating")
            else:
                yield state(name, "N.m.s", f"integral of {f.name}.tau over the step", nominal=1.0)


def _of_parts(boundary: Boundary, parts: Parts) -> Iterator[Variable]:
    """States, inputs, outputs, locals and parameters of the parts."""
    depends = feedthrough_of(parts)
    speeds = {f"{f.shaft}.flange_a.phi" for f in boundary.flanges if f.given is Given.SPEED}
    carrying = set(_flanks(parts))
    speeds_at_start = {
        f"{f.shaft}.flange_a.w": _of_gear(f, parts, "w") for f in boundary.flanges if f.shaft
    }
    for instance in parts.instances:
        declaration = instance.component.declaration
        for declared in declaration.variables:
            full = full_name(instance, declared.name)
            v = replace(declared, description=boundary.describe(full, declared.description))
            name = boundary.name(full)
            if v.causality is Causality.OUTPUT:
                if boundary.wanted.internals or boundary.shows_output(full):
                    yield _output(boundary, instance, v, depends(instance.name, v.name), speeds)
            elif v.state:
                yield replace(v, name=name, start=0.0)
            elif v.causality is Causality.INPUT:
                if full in parts.open_inputs - speeds:
                    start = speeds_at_start.get(full, instance[v.name])
                    yield replace(v, name=name, start=start)
            elif v.causality is Causality.LOCAL:
                yield replace(v, name=name)
            elif v.name not in _OWN and full not in carrying:
                start = 0.0 if v.at_rest else float(instance.block[declaration.index[v.name]])
                tunable = v.quantity is Quantity.DAMPING or v.name.endswith("damping_ratio")
                kind = Variability.TUNABLE if tunable else v.variability
                yield replace(v, name=name, start=start, at_rest="", variability=kind)


def _output(
    boundary: Boundary, instance: Instance, v: Variable, through: tuple[str, ...], speeds: set[str]
) -> Variable:
    """An output of a part, or a local of the FMU where it is shown as internal alone."""
    full = full_name(instance, v.name)
    name = boundary.name(full)
    if not boundary.shows_output(full):
        return local(name, v.unit, v.description)
    rate = full_name(instance, v.rate) if v.rate else ""
    shown = rate and boundary.shows_output(rate)
    inputs = tuple(sorted(boundary.name(p) for p in through if p not in speeds))
    return replace(v, name=name, feedthrough=inputs, rate=boundary.name(rate) if shown else "")


def _flanks(parts: Parts) -> list[str]:
    """Paths of the parameters that say which flank carries."""
    return [
        full_name(i, v.name)
        for i in parts.instances
        for v in i.component.declaration.offered(Quantity.CARRYING_FLANK)
    ]


def _outputs(boundary: Boundary) -> Iterator[Variable]:
    for f in boundary.flanges:
        if f.shaft:
            motion = ("phi", "w") if f.given is Given.MOTION else ("w",)
            yield output(
                mean_torque(f),
                "N.m",
                f"mean of {f.name}.tau over the last communication step",
                feedthrough=tuple(f"{f.name}.{q}" for q in motion),
            )


def _locals(boundary: Boundary, tolerance: float) -> Iterator[Variable]:
    for f in boundary.flanges:
        if f.shaft:
            yield local(offset(f), "rad", "angle of the shaft's end where the host's angle is 0")
        if f.given is Given.MOTION:
            yield local(since(f), "s", f"time at which {f.name}.phi has its value")
            yield local(lead(f), "s", "time from then to the start of the communication step")
    yield replace(local(TOLERANCE, "1", "of inner steps"), start=tolerance)
    yield replace(local(NEXT_STEP, "s", "length of the next inner step"), start=FIRST)
    yield replace(local(INNER_STEP, "s", "no inner step is longer"), start=LARGEST)
    yield local(STEP_START, "s", "start of the last communication step")
    yield local(STEPPING, "1", "1 inside a communication step, where time counts from its start")
    yield replace(local(FLANK, "1", "flank that carries: 1 drive, -1 coast"), start=1.0)


def _parameters(boundary: Boundary, parts: Parts) -> Iterator[Variable]:
    yield choice(
        START_MODE,
        "start of the elastic coordinates; periodic: they vibrate as they do when all has settled; "
        "equilibrium: they move as one with the gears; as_set: undeformed or as the states were "
        "set",
        START_MODES,
        PERIODIC,
    )
    if all(f.given is Given.TORQUE for f in boundary.flanges):
        yield parameter(
            INITIAL_SPEED, "rad/s", "speed of the pinion at the start", _speed(boundary, parts)
        )
    for f in boundary.flanges:
        if f.shaft:
            yield parameter(
                initial_torque(f),
                "N.m",
                f"torque of the shaft at {f.name} on the gearbox at the start",
                _of_gear(f, parts, "tau"),
            )


def _pair(boundary: Boundary, parts: Parts) -> Instance:
    return next(i for i in parts.instances if i.name == boundary.pair)


def rotation(boundary: Boundary, parts: Parts) -> str:
    """Name, in the gear pair, of the state that is its angle."""
    states = _pair(boundary, parts).component.declaration.states
    return next(v.name for v in states if v.steady == "rotating")


def _speed(boundary: Boundary, parts: Parts) -> float:
    return _pair(boundary, parts)[f"der({rotation(boundary, parts)})"]


def _of_gear(flange: HostFlange, parts: Parts, variable: str) -> float:
    """Start value of a variable of the gear's own flange."""
    part, _, port = flange.path.rpartition(".")
    gear = next(i for i in parts.instances if i.name == part)
    return gear[f"{port}.{variable}"]


def _shown(boundary: Boundary, parts: Parts, variables: list[Variable]) -> Iterator[Variable]:
    """The variables that the FMU shows, signals' nodes aside."""
    of_parts = {
        boundary.name(full_name(i, v.name)): (i.name, v)
        for i in parts.instances
        for v in i.component.declaration.variables
    }
    own = {TOLERANCE, NEXT_STEP, INNER_STEP, STEP_START, STEPPING, FLANK}
    own |= {name(f) for f in boundary.flanges for name in (offset, since, lead)}
    for v in variables:
        if v.causality in {Causality.INPUT, Causality.OUTPUT}:
            yield v
        elif v.state:
            if boundary.wanted.exchange or boundary.wanted.internals:
                yield v
        elif v.causality is Causality.LOCAL:
            if boundary.wanted.internals and v.name not in own:
                yield v
        elif v.name not in of_parts:
            if ".guess" not in v.name:
                yield v
        else:
            part, declared = of_parts[v.name]
            if boundary.shows_parameter(part, declared.name, declared.quantity):
                yield v
