"""What a master of one's own needs of a system: start values and connections of variables."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.set_points import at_pinion
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System
from herringbone.running.loading import open_parts, system_and_folder
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Scene


class Link(NamedTuple):
    """An output that feeds an input.

    Attributes:
        source, output: part and variable that give.
        target, input: part and variable that take.
    """

    source: str
    output: str
    target: str
    input: str


def start_values(
    system: str | Path | System,
    *,
    speed: float | None = None,
    torque: float | None = None,
    scene: str | Path | Scene | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
) -> dict[str, dict[str, float | str]]:
    """Start values of all parts in steady rotation under load.

    Set them in each FMU before initialisation; then hand outputs on to inputs, see `connections`,
    twice in initialisation mode.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        speed: of the pinion [rad/s], where nothing is joined to the gear pair; else the scene's.
        torque: at the pinion [N m], likewise; what balances it at the wheel follows.
        scene, values, gear, housing: see `herringbone.run`.

    Returns:
        By part: value by variable. Names of resource files are among them where they are set.

    Raises:
        HerringboneError: something about the input is wrong, or there is no steady rotation.
    """
    structure = system_and_folder(system)[0]
    wanted = dict(values or {})
    if speed is not None or torque is not None:
        wanted = {**at_pinion(structure, speed, torque), **wanted}
    found = prepared(system, scene, Wishes(values=wanted, gear=gear, housing=housing)).system
    return {str(part.name): dict(part.values) for part in found.parts}


def connections(system: str | Path | System) -> tuple[Link, ...]:
    """All connections of a system, variable by variable: motions first, then forces.

    Handed on in this order in initialisation mode, all signals have arrived after two passes.

    Raises:
        HerringboneError: the system is wrong, or an FMU in it cannot be opened.
    """
    structure = system_and_folder(system)[0]
    parts = open_parts(structure, "in-process")
    try:
        network = build_network(structure, parts)
        links = sorted(network.every_connection, key=lambda c: c.source in network.elements)
        return tuple(
            Link(parts[c.source].name, c.output, parts[c.target].name, c.input) for c in links
        )
    finally:
        for part in parts:
            part.close()
