"""What the parts of a run do not answer, and why."""

from collections.abc import Iterator

from herringbone.analysis.asked import by_half, shaft_side, shaft_torques
from herringbone.analysis.figures.flange_power import mean_powers
from herringbone.analysis.figures.radiated_power import power_inputs
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, SIDES, Quantity, Role
from herringbone.result.result import Result

_POWER, _ELECTRICAL = "power", "electrical power"
_QUESTIONS: tuple[tuple[str, Role, Quantity, str | None], ...] = (
    ("pinion speed", Role.GEAR_PAIR, Quantity.SPEED, "pinion"),
    *(("mesh force", Role.GEAR_PAIR, Quantity.MESH_FORCE, side) for side in SIDES),
    *(
        (_POWER, Role.DRIVE, quantity, None)
        for quantity in (Quantity.ELECTRICAL_POWER, Quantity.TORQUE, Quantity.SPEED)
    ),
    *(
        (_POWER, Role.LOAD, quantity, None)
        for quantity in (Quantity.RECOVERED_POWER, Quantity.LOSS_POWER)
    ),
)
"""What is asked for, of which role, as which quantity, at which place."""


def unanswered(result: Result) -> dict[str, list[str]]:
    """What cannot be said of a run, by the reason: no part has the role, or a part lacks something.

    Empty where all parts are known and answer.
    """
    reasons: dict[str, list[str]] = {}
    for what, why in _missing(result):
        known = reasons.setdefault(what, [])
        if why not in known:
            known.append(why)
    if not any(map(result.parts_with, Role)):
        return {"what the parts are for is not known": list(reasons)}
    found: dict[str, list[str]] = {}
    for what, all_reasons in reasons.items():
        found.setdefault("; ".join(all_reasons), []).append(what)
    return found


def _missing(result: Result) -> Iterator[tuple[str, str]]:
    for what, role, quantity, place in _QUESTIONS:
        if what != _POWER:
            yield from ((what, why) for why in _unoffered(result, role, quantity, place))
    yield from _unpowered(result)
    if result.parts_with(Role.GEAR_PAIR):
        yield from (("number of teeth, mesh orders", why) for why in _untoothed(result))
    yield from (("torque", why) for why in _unmeasured(result))
    for what, channel, role in (
        ("bearing forces", "bearing_force", Role.BEARING),
        ("seat velocities", "seat_velocity", Role.HOUSING),
    ):
        if not any(by_half(result, channel, axis) for axis in "xyz"):
            parts = result.parts_with(role)
            why = (
                f"{', '.join(parts)}: recorded nothing of that" if parts else _nobody(result, role)
            )
            yield what, why
    for name, why in sensor_figures(result)[1].items() if result.info.sensors else ():
        yield f"sensor {name}", why
    for part in result.parts_with(Role.HOUSING) or ("",):
        try:
            power_inputs(result, part=part)
        except ParameterError as error:
            yield "radiated power", str(error) if part else _nobody(result, Role.HOUSING)


def _unpowered(result: Result) -> Iterator[tuple[str, str]]:
    """Why no power is known; where flanges tell the mechanical ones, why no electrical one is.

    Then, a system without a drive or load has none: what drives or loads it is a source.
    """
    told = mean_powers(result) is not None
    machines = result.parts_with(Role.DRIVE) or result.parts_with(Role.LOAD)
    strangers = any(not info.roles for info in result.info.anatomy.parts.values())
    for what, role, quantity, place in _QUESTIONS:
        if what != _POWER or (told and not machines):
            continue
        if told and not strangers and not result.parts_with(role):
            continue
        name = _ELECTRICAL if told else _POWER
        yield from ((name, why) for why in _unoffered(result, role, quantity, place))


def _nobody(result: Result, role: Role) -> str:
    unknown = [name for name, info in result.info.anatomy.parts.items() if not info.roles]
    foreign = f", and nothing is known of {', '.join(unknown)}" if unknown else ""
    return f"no part is known as {role}{foreign}"


def _unoffered(result: Result, role: Role, quantity: Quantity, place: str | None) -> Iterator[str]:
    """Why parts of a role do not show a quantity."""
    parts = result.parts_with(role)
    if not parts:
        yield _nobody(result, role)
    for part in parts:
        column = result.info.anatomy.column(part, quantity, place)
        at = f" at its {place}" if place else ""
        if column is None:
            yield f"{part}, a {role}, offers no {quantity}{at}"
        elif column not in result.data:
            yield f"{column} is not recorded"


def _untoothed(result: Result) -> Iterator[str]:
    for part in result.parts_with(Role.GEAR_PAIR):
        name = result.info.anatomy.column(part, Quantity.NUMBER_OF_TEETH, "pinion")
        if name not in result.info.parameters:
            yield f"{part} does not tell it"


def _unmeasured(result: Result) -> Iterator[str]:
    """Why the torque at a side of a gear pair is not known."""
    gears = result.parts_with(Role.GEAR_PAIR)
    if not gears:
        yield _nobody(result, Role.GEAR_PAIR)
    for gear in gears:
        known = shaft_torques(result, gear)
        for place in [place for place in GEARS if place not in known]:
            coupling = shaft_side(result, place, gear).coupling
            if not result.parts_with(Role.COUPLING):
                yield _nobody(result, Role.COUPLING)
            elif coupling:
                yield f"{coupling} shows none"
            else:
                yield f"no part is known as {Role.COUPLING} at the {place} of {gear}"
