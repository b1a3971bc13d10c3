"""Modes of universal files: data sets 55 and 2414."""

import logging
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from herringbone.core import ResourceError
from herringbone.housing.importers.mode_set import (
    check_modal_mass,
    mass_of_complex_mode,
    real_shape,
)
from herringbone.housing.importers.modes_twice import check_no_number_twice

_LOG = logging.getLogger("herringbone")
_NORMAL, _COMPLEX, _COMPLEX_VELOCITY = 2, 3, 7
"""Analysis types: normal modes, complex modes of first order, and of second order."""
_DISPLACEMENT = (0, 1, 8)
"""Specific data types that can be displacements: unknown, general, displacement."""
_MOTION = {*_DISPLACEMENT, 11, 12}
"""And velocity and acceleration, of which a mode could be made, too."""
_TRANSLATIONS = 3
_CONJUGATE = 1e-4
"""Difference of an eigenvalue and its conjugate, over its size, that rounding of a file makes."""


class Mode(NamedTuple):
    """A mass-normalised mode at nodes, in the units of the file.

    Attributes:
        number: in the file.
        frequency: [Hz].
        damping_ratio: [1]; NaN where the file does not tell.
        labels: (k,) nodes.
        shape: (k, 3) [mass^-1/2].
    """

    number: int
    frequency: float
    damping_ratio: float
    labels: np.ndarray
    shape: np.ndarray


def modes_of(sets: Sequence[Mapping[str, Any]], path: Path) -> list[Mode]:
    """Modes of a file, in its order; a line tells which it has beside them that are not read.

    Args:
        sets: its data sets.
        path: named in that line.

    Raises:
        ResourceError: there is none, one is unscaled or too complex, or a mode stands twice.
    """
    eigenvalues = np.array([item["eig"] for item in sets if _is_read(item) and "eig" in item])
    read = [item for item in sets if _is_read(item) and not _is_conjugate(item, eigenvalues)]
    modes = [_mode_55(item) if item["type"] == 55 else _mode_2414(item) for item in read]
    if not modes:
        raise ResourceError("no data set 55 or 2414 holds normal modes at nodes")
    check_no_number_twice([mode.number for mode in modes], [mode.frequency for mode in modes])
    _tell_left_out(sets, {mode.number for mode in modes}, path)
    return modes


def _kind(item: Mapping[str, Any]) -> tuple[int, int, int]:
    """Number of the data set, analysis type and specific data type, 0 of what has no such types."""
    quantity = item.get("spec_data_type", item.get("result_type", 0))
    return item["type"], item.get("analysis_type", 0), quantity


def _is_read(item: Mapping[str, Any]) -> bool:
    number, analysis, quantity = _kind(item)
    analyses = {55: {_NORMAL, _COMPLEX}, 2414: {_NORMAL}}
    return analysis in analyses.get(number, ()) and quantity in _DISPLACEMENT


def _is_conjugate(item: Mapping[str, Any], eigenvalues: np.ndarray) -> bool:
    """True of the second of a pair of conjugate complex modes, which are one mode."""
    eigenvalue = complex(item.get("eig", 0.0))
    near = np.abs(eigenvalues - eigenvalue.conjugate()) <= _CONJUGATE * abs(eigenvalue)
    return eigenvalue.imag < 0.0 and bool(near.any())


def _tell_left_out(sets: Sequence[Mapping[str, Any]], numbers: set[int], path: Path) -> None:
    """A line for each kind of modes that are not read, unless they are known by others that are."""
    left_out: Counter[tuple[int, int, int]] = Counter()
    for item in sets:
        analysis, quantity = _kind(item)[1:]
        number = item.get("mode_n", item.get("record10_field6"))
        modal = analysis in {_NORMAL, _COMPLEX, _COMPLEX_VELOCITY} and quantity in _MOTION
        if modal and not _is_read(item) and number not in numbers:
            left_out[_kind(item)] += 1
    for (number, analysis, quantity), count in left_out.items():
        _LOG.warning(
            "%s: %d data sets %d of analysis type %d, specific data type %d, are left out; modes "
            "are read of analysis type 2 (55: 3, too) and specific data types 0, 1 and 8",
            path, count, number, analysis, quantity,
        )  # fmt: skip


def _damping(viscous: float, hysteretic: float) -> float:
    return viscous or 0.5 * hysteretic or math.nan


def _check_size(shape: np.ndarray, labels: np.ndarray, where: str) -> None:
    if len(shape) != labels.size:
        raise ResourceError(f"{where}: {labels.size} nodes, {len(shape)} values")


def _mode_55(item: Mapping[str, Any]) -> Mode:
    where = f"mode {item['mode_n']}"
    labels = np.asarray(item["node_nums"]).astype(int)
    shape = np.column_stack([item["r1"], item["r2"], item["r3"]])
    _check_size(shape, labels, where)
    factor = 1.0 + 0.0j
    if np.iscomplexobj(shape):
        shape, factor = real_shape(shape, where)
    if item["analysis_type"] == _NORMAL:
        mass = check_modal_mass(item["modal_m"], where)
        zeta = _damping(item["modal_damp_vis"], item["modal_damp_his"])
        return Mode(item["mode_n"], item["freq"], zeta, labels, shape / math.sqrt(mass))
    eigenvalue = complex(item["eig"])
    mass = mass_of_complex_mode(item["modal_a"], factor, eigenvalue.imag, where)
    w = abs(eigenvalue)
    zeta = -eigenvalue.real / w
    return Mode(item["mode_n"], w / (2.0 * math.pi), zeta, labels, shape / math.sqrt(mass))


def _mode_2414(item: Mapping[str, Any]) -> Mode:
    """Record 12 holds time, frequency, eigenvalue, modal mass, viscous and hysteretic damping."""
    number = item["record10_field6"]
    where = f"mode {number}"
    if item["dataset_location"] != 1 or item["data_type"] not in {2, 4}:
        raise ResourceError(f"{where}: data set 2414 must hold real data at nodes")
    labels = np.asarray(item["node_nums"]).astype(int)
    values = item["data_at_node"]
    if few := [n for n, found in zip(labels, values, strict=False) if len(found) < _TRANSLATIONS]:
        raise ResourceError(f"{where}: node {few[0]} has fewer than three values")
    shape = np.array([found[:_TRANSLATIONS] for found in values])
    _check_size(shape, labels, where)
    mass = check_modal_mass(item["record12_field4"], where)
    zeta = _damping(item["record12_field5"], item["record12_field6"])
    return Mode(number, item["record12_field2"], zeta, labels, shape / math.sqrt(mass))
