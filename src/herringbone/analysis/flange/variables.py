"""Which variables of a part are its flanges: by the names of ports, as told, or by units."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from herringbone.analysis.finding import Finding, Verdict, judged, remark
from herringbone.analysis.flange.guess import (
    POWERS,
    QUANTITIES,
    UNITS,
    by_ports,
    by_units,
    powers,
    reals,
)
from herringbone.core import ParameterError
from herringbone.core.part import PartVariable

_NAMED_UNITS = {"rad/s": 1.0, "rad": 1.0, "N.m": 1.0, "Nm": 1.0}
_MOST = 6
NEEDS = (
    "a flange takes tau [N.m] and gives phi [rad] and w [rad/s], or takes phi and w and gives tau; "
    "name them with --flange PORT or --flange tau=...,phi=...,w=..."
)


@dataclass(frozen=True)
class Flange:
    """The variables of a flange.

    Attributes:
        name: of the port.
        tau, phi, w: names of variables, "" if the part has none.
        takes_torque: tau is an input; else phi and w are.
        factors: of the units of tau, phi, w to N m, rad, rad/s.
    """

    name: str
    tau: str
    phi: str
    w: str
    takes_torque: bool
    factors: Mapping[str, float]

    def variable(self, quantity: str) -> str:
        """Name of the variable of a quantity, "" without."""
        return {"tau": self.tau, "phi": self.phi, "w": self.w}[quantity]

    def moves(self, quantity: str) -> bool:
        """True if the quantity is an input of the part."""
        return (quantity == "tau") == self.takes_torque


def asked(texts: Sequence[str]) -> list[dict[str, str]]:
    """Variables of flanges by quantity, from `port` or `tau=...,phi=...,w=...`.

    Raises:
        ParameterError: a text is neither.
    """
    found = []
    for text in texts:
        if "=" not in text:
            found.append({q: f"{text}.{q}" for q in QUANTITIES})
            continue
        pairs = [piece.partition("=")[::2] for piece in text.split(",")]
        given = {quantity.strip(): name.strip() for quantity, name in pairs}
        if (
            not given.keys() <= set(QUANTITIES)
            or len(given) < len(pairs)
            or not all(given.values())
        ):
            raise ParameterError(
                f"--flange {text}: write a port's name, or tau=NAME,phi=NAME,w=NAME"
            )
        found.append(given)
    return found


def find_flanges(
    variables: Mapping[str, PartVariable],
    wanted: Sequence[Mapping[str, str]],
    count: int,
    *,
    whole: bool = True,
) -> tuple[list[Flange], list[Finding]]:
    """The flanges of a part, and what is wrong with their variables.

    Args:
        variables: of the part.
        wanted: names by quantity, one mapping a flange; by ports and units if empty.
        count: flanges that the role has.
        whole: a flange that takes torque must give angle and speed, not one of them alone.
    """
    how = "as told"
    if not wanted:
        wanted, how = by_ports(variables), "by the names of ports"
    if not wanted and count == 1:
        wanted, how = by_units(variables), "as the only ones of their units and names"
    if len(wanted) != count:
        ports = ", ".join(_port(names) for names in wanted) or "none"
        shown = f"{len(wanted)} found ({ports}); it has {_offered(variables)}"
        return [], [judged("variables", False, shown, f"{count} flange(s): {NEEDS}")]
    missing = [line for names in wanted for line in _missing(names, variables, whole)]
    if missing:
        shown = "; ".join(missing)
        return [], [judged("variables", False, shown, f"{count} flange(s): {NEEDS}")]
    flanges = [_flange(names, variables) for names in wanted]
    shown = "; ".join(_taken(flange) for flange in flanges)
    findings = [judged("variables", True, f"{shown}, {how}", f"{count} flange(s)")]
    findings += [
        remark(f"{flange.name}: {quantity}", f"there is none: {flange.tau} follows {other} alone")
        for flange in flanges
        for quantity, other in (("phi", "w"), ("w", "phi"))
        if not flange.variable(quantity)
    ]
    return flanges, [*findings, _units(flanges, variables)]


def _offered(variables: Mapping[str, PartVariable]) -> str:
    """Its real inputs and outputs, some of them."""
    there_are = reals(variables)
    by_causality = (
        f"{causality}s {', '.join(names[:_MOST])}{', ...' if len(names) > _MOST else ''}"
        for causality in ("input", "output")
        if (names := [name for name, v in there_are.items() if v.causality == causality])
    )
    return " and ".join(by_causality) or "no real inputs or outputs"


def _port(names: Mapping[str, str]) -> str:
    first = next(iter(names.values()))
    port, _, last = first.rpartition(".")
    return port or last


def _missing(
    names: Mapping[str, str], variables: Mapping[str, PartVariable], whole: bool
) -> Iterable[str]:
    """What a flange lacks; one that takes motion may do with one of phi and w."""
    there_are = reals(variables)
    there = {q: there_are[name] for q, name in names.items() if name in there_are}
    torque = there.get("tau")
    if torque is None:
        yield f"{_port(names)}: no variable {names.get('tau', 'for tau')}"
        return
    motion = "output" if torque.causality == "input" else "input"
    fit = [q for q in ("phi", "w") if q in there and there[q].causality == motion]
    lack = [q for q in ("phi", "w") if q not in fit]
    if lack and ((whole and motion == "output") or not fit):
        listed = " and ".join(names.get(q, q) for q in lack)
        yield f"{torque.name} is an {torque.causality}, but there is no {motion} {listed}"


def _flange(names: Mapping[str, str], variables: Mapping[str, PartVariable]) -> Flange:
    takes = variables[names["tau"]].causality == "input"
    motion = "output" if takes else "input"
    taken = {"tau": names["tau"]}
    for quantity in ("phi", "w"):
        v = variables.get(names.get(quantity, ""))
        fits = v is not None and v.is_real and v.causality == motion
        taken[quantity] = names[quantity] if fits else ""
    dimensions = {q: variables[name].dimension for q, name in taken.items() if name}
    factors = {q: float(d[0]) if d else 1.0 for q, d in dimensions.items()}
    return Flange(_port(names), **taken, takes_torque=takes, factors=factors)


def _taken(flange: Flange) -> str:
    motion = " and ".join(name for name in (flange.phi, flange.w) if name)
    if flange.takes_torque:
        return f"takes {flange.tau}, gives {motion}"
    return f"takes {motion}, gives {flange.tau}"


def _units(flanges: Sequence[Flange], variables: Mapping[str, PartVariable]) -> Finding:
    """Units of the right dimension; others than SI units are told."""
    wrong, other, bare = [], [], []
    for flange in flanges:
        for quantity in QUANTITIES:
            v = variables.get(flange.variable(quantity))
            if v is None:
                continue
            shown = f"{v.name} in {v.unit}"
            if v.unit is None:
                bare.append(v.name)
            elif v.dimension is None:
                other += [] if v.unit in _NAMED_UNITS else [f"{shown}, which it does not define"]
            elif powers(v) != POWERS[quantity] or v.dimension[1]:
                wrong.append(shown)
            elif not math.isclose(v.dimension[0], 1.0, rel_tol=1e-9):
                other.append(f"{shown}, {v.dimension[0]:.6g} {UNITS[quantity]}")
    limit = "N.m, rad, rad/s"
    if wrong:
        return judged("units", False, ", ".join(wrong), limit)
    if bare:
        other.append(f"{', '.join(bare)} without unit, taken as SI")
    if other:
        return Finding("units", Verdict.REMARK, ", ".join(other), limit)
    return judged("units", True, "declared", limit)
