"""Which nodes of a foreign model are the seats and sensors, and in which units it is.

A sample with all keys is `seats.toml` in the folder of the shipped housing.
"""

import itertools
import logging
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.declaring.roles import HALVES
from herringbone.core.reading.structured import read_toml
from herringbone.housing.modal_model import AXES

_UNITS: Mapping[str, Mapping[str, float]] = {
    "length": {"m": 1.0, "mm": 1e-3},
    "mass": {"kg": 1.0, "t": 1e3, "g": 1e-3},
    "time": {"s": 1.0, "ms": 1e-3},
}
_LOG = logging.getLogger("herringbone")
_KEYS = {
    "": {
        "valid_to_hz", "boundary", "source", "units", "frame", "damping", "seats", "sensors",
        "matrix", "static",
    },
    "units": set(_UNITS),
    "frame": {"origin", "rotation"},
    "damping": {"ratio", "source"},
    "matrix": {"rows"},
    "point": {"nodes", "weights", "dofs", "coupling", "position"},
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Selection:
    """Nodes whose mean motion is a seat's or a sensor's.

    Attributes:
        name, role: see `Point`.
        nodes: labels in the file.
        weights: (k,) of the mean; sum 1.
        dofs: directions in the gearbox frame.
        coupling: see `Point`.
        position: in the file's coordinates; the mean of the nodes if None.
    """

    name: str
    role: str
    nodes: tuple[int, ...]
    weights: np.ndarray
    dofs: tuple[str, ...]
    coupling: str
    position: tuple[float, ...] | None


@dataclass(frozen=True, eq=False)
class SeatFile:
    """What a seat file says; see the module.

    Attributes:
        path: the file.
        selections: seats in the order pinion_left, ..., then sensors.
        length, mass, time: of one unit of the file [m], [kg], [s].
        origin, rotation: frame of the gearbox in the file's coordinates and length unit.
        damping_ratio, damping_source: for modes without damping.
        valid_to_hz, boundary, source: for the data file; 0 Hz if not given.
        rows: file that labels the rows of matrices, if any.
        static: file of the static compliance at the seats, if any.
    """

    path: Path
    selections: tuple[Selection, ...]
    length: float
    mass: float
    time: float
    origin: np.ndarray
    rotation: np.ndarray
    damping_ratio: float
    damping_source: str
    valid_to_hz: float
    boundary: str
    source: str
    rows: Path | None
    static: Path | None


def read_seats(path: str | Path) -> SeatFile:
    """Read a seat file.

    Raises:
        ResourceError: not readable, unknown key, wrong unit, missing seat, or a value of the wrong
            kind.
    """
    path = Path(path)
    data = read_toml(path)
    try:
        return _seat_file(path, data)
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None


def _seat_file(path: Path, data: Mapping[str, Any]) -> SeatFile:
    _known(data, "", "the file")
    sections = {name: data.get(name, {}) for name in ("units", "frame", "damping", "matrix")}
    for name, section in sections.items():
        _known(section, name, f"[{name}]")
    factors = {}
    for quantity, known in _UNITS.items():
        unit = sections["units"].get(quantity, next(iter(known)))
        if not isinstance(unit, str) or unit not in known:
            raise ResourceError(f"unit of {quantity} '{unit}' is none of {', '.join(known)}")
        factors[quantity] = known[unit]
    damping, rows = sections["damping"], sections["matrix"].get("rows")
    return SeatFile(
        path=path,
        selections=_selections(data),
        **factors,
        origin=_numbers(sections["frame"].get("origin", [0.0] * 3), (3,), "frame origin"),
        rotation=_numbers(
            sections["frame"].get("rotation", np.eye(3).tolist()), (3, 3), "frame rotation"
        ),
        damping_ratio=_damping_ratio(damping),
        damping_source=str(damping.get("source", "assumed")),
        valid_to_hz=float(_numbers(data.get("valid_to_hz", 0.0), (), "valid_to_hz")),
        boundary=str(data.get("boundary", "")),
        source=str(data.get("source", "")),
        rows=path.parent / str(rows) if rows else None,
        static=path.parent / str(data["static"]) if "static" in data else None,
    )


def _damping_ratio(damping: Mapping[str, Any]) -> float:
    ratio = float(_numbers(damping.get("ratio", 0.01), (), "damping ratio"))
    if not 0.0 < ratio < 1.0:
        raise ResourceError(f"damping ratio {ratio:g} must lie between 0 and 1")
    return ratio


def _known(section: object, name: str, where: str) -> None:
    if not isinstance(section, dict):
        raise ResourceError(f"{where} must be a table")
    if unknown := sorted(set(section) - _KEYS[name]):
        known = ", ".join(sorted(_KEYS[name]))
        raise ResourceError(f"{where} has the unknown key '{unknown[0]}'; it takes {known}")


def _numbers(value: object, shape: tuple[int, ...], what: str) -> np.ndarray:
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError):
        found = np.full(1, np.nan)
    if found.shape != shape or not np.isfinite(found).all():
        size = " x ".join(map(str, shape)) or "one"
        raise ResourceError(f"{what} is missing or not {size} finite number{'s' if shape else ''}")
    return found


def _selections(data: Mapping[str, Any]) -> tuple[Selection, ...]:
    seats, sensors = data.get("seats", {}), data.get("sensors", {})
    for section, what in ((seats, "seats"), (sensors, "sensors")):
        if not isinstance(section, dict):
            raise ResourceError(f"[{what}] must be a table")
    if missing := [name for name in HALVES if name not in seats]:
        raise ResourceError(f"seat {', '.join(missing)} is missing; give [seats.{missing[0]}]")
    if unknown := sorted(set(seats) - set(HALVES)):
        raise ResourceError(f"seat '{unknown[0]}' is none of {', '.join(HALVES)}")
    found = tuple(_selection(name, "seat", seats[name]) for name in HALVES)
    for one, other in itertools.combinations(found, 2):
        if shared := sorted(set(one.nodes) & set(other.nodes)):
            _LOG.warning(
                "seats %s and %s share the node %d: they are not independent",
                one.name, other.name, shared[0],
            )  # fmt: skip
    return found + tuple(_selection(name, "sensor", item) for name, item in sensors.items())


def _selection(name: str, role: str, item: Mapping[str, Any]) -> Selection:
    _known(item, "point", f"[{role}s.{name}]")
    nodes = item.get("nodes")
    if not isinstance(nodes, list) or not nodes or not all(type(n) is int for n in nodes):
        raise ResourceError(f"{role} {name}: 'nodes' must be a list of node numbers")
    weights = _numbers(
        item.get("weights", [1.0] * len(nodes)), (len(nodes),), f"{role} {name}: weights"
    )
    if (weights < 0.0).any():
        node = nodes[int(np.argmax(weights < 0.0))]
        _LOG.warning(
            "%s %s: node %d has the weight %g; weights are shares of a mean, and not negative",
            role, name, node, weights.min(),
        )  # fmt: skip
    if weights.sum() <= 0.0:
        raise ResourceError(f"{role} {name}: the weights must have a positive sum")
    position = item.get("position")
    if position is not None:
        position = tuple(_numbers(position, (3,), f"{role} {name}: position").tolist())
    given = item.get("dofs", AXES)
    if not isinstance(given, list | tuple):
        raise ResourceError(f"{role} {name}: 'dofs' must be a list of {', '.join(AXES)}")
    dofs = tuple(map(str, given))
    if unknown := [dof for dof in dofs if dof not in AXES]:
        raise ResourceError(f"{role} {name}: dof '{unknown[0]}' is none of {', '.join(AXES)}")
    coupling = str(item.get("coupling", "node" if len(nodes) == 1 else "rbe3"))
    if len(nodes) > 1 and coupling != "rbe3":
        raise ResourceError(
            f"{role} {name}: coupling '{coupling}' of {len(nodes)} nodes: it moves as their "
            "weighted mean (rbe3); leave it out, or give the one node that a rigid element ties"
        )
    return Selection(name, role, tuple(nodes), weights / weights.sum(), dofs, coupling, position)
