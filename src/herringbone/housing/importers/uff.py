"""Importer of universal files with modes: nodes 15 or 2411, shapes 55 or 2414, units 164.

Reading is done by pyuff, see `core.reading.universal`.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.reading.universal import universal_sets
from herringbone.housing.importers import universal_coordinates
from herringbone.housing.importers.mode_set import (
    ModeSet,
    check_modal_mass,
    in_order,
    mass_of_complex_mode,
    real_shape,
)
from herringbone.housing.importers.seat_file import SeatFile

_KINDS = {15, 55, 164, 2411, 2414} | universal_coordinates.KINDS
_NORMAL, _COMPLEX = 2, 3
_DISPLACEMENT = (0, 1, 8)
"""Specific data types that can be displacements: unknown, general, displacement."""
_DIGITS = 1e-4


def read_uff(path: str | Path, seats: SeatFile) -> ModeSet:
    """Read the modes of a universal file.

    Args:
        path: the file.
        seats: its units are compared with those of data set 164; its nodes must be given in
            global coordinates and directions.

    Raises:
        ResourceError: pyuff is missing, not readable, truncated, without nodes or modes, unscaled,
            complex, in local coordinates, or the units disagree.
    """
    path = Path(path)
    sets = universal_sets(path, _KINDS)
    units = [s for s in sets if s.get("type") == 164]
    try:
        if units:
            _check_units(units[-1], seats)
        node, coordinates = _nodes(sets, seats)
        modes = _modes(sets)
        shapes = [in_order(node, labels, shape) for _, _, labels, shape in modes]
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    except (ValueError, KeyError, TypeError, IndexError, ArithmeticError) as error:
        raise ResourceError(f"{path}: nodes or modes are malformed: {error}") from error
    return ModeSet(
        node,
        coordinates,
        np.array([frequency for frequency, *_ in modes]),
        np.array([zeta for _, zeta, *_ in modes]),
        np.stack(shapes, axis=-1),
        {"tool": "universal file", "file": path.name},
    )


def _check_units(units: Mapping[str, Any], seats: SeatFile) -> None:
    length, force = 1.0 / units["length"], 1.0 / units["force"]  # of one unit, in SI
    mass = force / length  # the time unit of a universal file is 1 s
    given = (seats.length, seats.mass, seats.time)
    if not np.allclose(given, (length, mass, 1.0), rtol=_DIGITS):
        raise ResourceError(
            f"data set 164 says that a unit of length is {length:g} m and of mass {mass:g} kg; "
            f"{seats.path} says {seats.length:g} m, {seats.mass:g} kg, {seats.time:g} s"
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


def _modes(sets: list[dict[str, Any]]) -> list[tuple[float, float, np.ndarray, np.ndarray]]:
    if modes := [m for m in map(_mode, sets) if m is not None]:
        return modes
    raise ResourceError("no data set 55 or 2414 holds normal modes at nodes")


def _mode(item: Mapping[str, Any]) -> tuple[float, float, np.ndarray, np.ndarray] | None:
    """Frequency, damping ratio (NaN if none), labels and shape (k, 3); None if it is no mode."""
    if item["type"] == 55:
        return _mode_55(item)
    if item["type"] == 2414 and item["analysis_type"] == _NORMAL:
        return _mode_2414(item) if item["result_type"] in _DISPLACEMENT else None
    return None


def _damping(viscous: float, hysteretic: float) -> float:
    return viscous or 0.5 * hysteretic or math.nan


def _mode_55(item: Mapping[str, Any]) -> tuple[float, float, np.ndarray, np.ndarray] | None:
    kind, where = item["analysis_type"], f"mode {item.get('mode_n', '')}"
    if kind not in {_NORMAL, _COMPLEX} or item["spec_data_type"] not in _DISPLACEMENT:
        return None
    labels = np.asarray(item["node_nums"]).astype(int)
    shape = np.column_stack([item["r1"], item["r2"], item["r3"]])
    if shape.shape[0] != labels.size:
        raise ResourceError(f"{where}: {labels.size} nodes, {shape.shape[0]} values")
    factor = 1.0 + 0.0j
    if np.iscomplexobj(shape):
        shape, factor = real_shape(shape, where)
    if kind == _NORMAL:
        mass = check_modal_mass(item["modal_m"], where)
        zeta = _damping(item["modal_damp_vis"], item["modal_damp_his"])
        return item["freq"], zeta, labels, shape / math.sqrt(mass)
    eigenvalue = complex(item["eig"])
    mass = mass_of_complex_mode(item["modal_a"], factor, abs(eigenvalue.imag), where)
    w = abs(eigenvalue)
    return w / (2.0 * math.pi), -eigenvalue.real / w, labels, shape / math.sqrt(mass)


def _mode_2414(item: Mapping[str, Any]) -> tuple[float, float, np.ndarray, np.ndarray]:
    """Record 12 holds time, frequency, eigenvalue, modal mass, viscous and hysteretic damping."""
    where = f"mode {item['record10_field6']}"
    if item["dataset_location"] != 1 or item["data_type"] not in {2, 4}:
        raise ResourceError(f"{where}: data set 2414 must hold real data at nodes")
    shape = np.array([values[:3] for values in item["data_at_node"]])
    mass = check_modal_mass(item["record12_field4"], where)
    zeta = _damping(item["record12_field5"], item["record12_field6"])
    labels = np.asarray(item["node_nums"]).astype(int)
    return item["record12_field2"], zeta, labels, shape / math.sqrt(mass)
