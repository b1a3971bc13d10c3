"""Importer of universal files with modes: nodes 15 or 2411, shapes 55 or 2414, units 164.

Reading is done by pyuff, see `core.reading.universal`.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.reading.universal import universal_sets
from herringbone.housing.importers import universal_coordinates
from herringbone.housing.importers.mode_set import ModeSet, in_order
from herringbone.housing.importers.seat_file import SeatFile
from herringbone.housing.importers.universal_modes import modes_of

_KINDS = {15, 55, 164, 2411, 2414} | universal_coordinates.KINDS
_DIGITS = 1e-4


def read_uff(path: str | Path, seats: SeatFile) -> ModeSet:
    """Read the modes of a universal file.

    Args:
        path: the file.
        seats: its units are compared with those of data set 164; its nodes must be given in
            global coordinates and directions, and its unit of time must be s.

    Raises:
        ResourceError: pyuff is missing, not readable, truncated, without nodes or modes, unscaled,
            complex, of two analyses, in local coordinates, or the units disagree.
    """
    path = Path(path)
    if seats.time != 1.0:
        raise ResourceError(
            f"{seats.path}: a unit of time is {seats.time:g} s; frequencies of universal files are "
            "in Hz, of whatever units the rest is: leave time out"
        )
    sets = universal_sets(path, _KINDS)
    units = [s for s in sets if s.get("type") == 164]
    try:
        if units:
            _check_units(units[-1], seats)
        node, coordinates = _nodes(sets, seats)
        modes = modes_of(sets, path)
        shapes = [in_order(node, mode.labels, mode.shape) for mode in modes]
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    except (ValueError, KeyError, TypeError, IndexError, ArithmeticError) as error:
        raise ResourceError(f"{path}: nodes or modes are malformed: {error}") from error
    return ModeSet(
        node,
        coordinates,
        np.array([mode.frequency for mode in modes]),
        np.array([mode.damping_ratio for mode in modes]),
        np.stack(shapes, axis=-1),
        {"tool": "universal file", "file": path.name},
    )


def _check_units(units: Mapping[str, Any], seats: SeatFile) -> None:
    length, force = 1.0 / units["length"], 1.0 / units["force"]  # of one unit, in SI
    mass = force / length  # the time unit of a universal file is 1 s
    if not np.allclose((seats.length, seats.mass), (length, mass), rtol=_DIGITS):
        raise ResourceError(
            f"data set 164 says that a unit of length is {length:g} m and of mass {mass:g} kg; "
            f"{seats.path} says {seats.length:g} m, {seats.mass:g} kg"
        )


def _nodes(sets: list[dict[str, Any]], seats: SeatFile) -> tuple[np.ndarray, np.ndarray]:
    """Labels (k,) and coordinates (k, 3) of all sets of nodes."""
    found = [item for item in sets if item["type"] in {15, 2411}]
    if not found:
        raise ResourceError("no data set 15 or 2411 holds nodes")
    for item in found:
        if len(item["node_nums"]) != len(item["x"]):
            raise ResourceError(f"{len(item['node_nums'])} nodes have {len(item['x'])} coordinates")
    labels = np.concatenate([np.asarray(item["node_nums"]).astype(int) for item in found])
    places = np.vstack([np.column_stack([item["x"], item["y"], item["z"]]) for item in found])
    _check_places(labels, places)
    _check_global(labels, found, sets, seats)
    return labels, places


def _check_places(labels: np.ndarray, places: np.ndarray) -> None:
    """Refuse a node that has another place in another set."""
    _, first, which = np.unique(labels, return_index=True, return_inverse=True)
    apart = np.abs(places - places[first][which]).max(axis=1)
    if (apart > _DIGITS * np.abs(places).max()).any():
        raise ResourceError(f"node {labels[int(apart.argmax())]} stands twice, at two places")


def _check_global(
    labels: np.ndarray,
    nodes: list[dict[str, Any]],
    sets: list[dict[str, Any]],
    seats: SeatFile,
) -> None:
    """Refuse seats and sensors in coordinates that are not the global ones."""
    used = np.isin(labels, [node for selection in seats.selections for node in selection.nodes])
    for key, what in (("def_cs", "definition"), ("disp_cs", "displacement")):
        system = np.concatenate([np.asarray(item[key]).astype(int) for item in nodes])
        several = sorted(set(system[used].tolist()))
        for label in several:
            if why := universal_coordinates.why_local(sets, label):
                node = labels[used & (system == label)][0]
                raise ResourceError(
                    f"node {node} is in the {what} coordinate system {label}, {why}; export seats "
                    "and sensors in global coordinates and directions"
                )
        if len(several) > 1:
            raise ResourceError(
                f"nodes of seats and sensors are in the {what} coordinate systems "
                f"{several[0]} and {several[1]}; export all in one, the global one"
            )
