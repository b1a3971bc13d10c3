"""Modes of universal files: data sets 55 and 2414."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from herringbone.core import ResourceError
from herringbone.housing.importers.mode_set import (
    check_modal_mass,
    mass_of_complex_mode,
    real_shape,
)
from herringbone.housing.importers.modes_twice import check_no_number_twice

_NORMAL, _COMPLEX = 2, 3
_DISPLACEMENT = (0, 1, 8)
"""Specific data types that can be displacements: unknown, general, displacement."""


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


def modes_of(sets: Sequence[Mapping[str, Any]]) -> list[Mode]:
    """Modes of a file, in its order.

    Raises:
        ResourceError: there is none, one is unscaled or too complex, or a mode stands twice.
    """
    modes = [mode for mode in map(_mode, sets) if mode is not None]
    if not modes:
        raise ResourceError("no data set 55 or 2414 holds normal modes at nodes")
    check_no_number_twice([mode.number for mode in modes], [mode.frequency for mode in modes])
    return modes


def _mode(item: Mapping[str, Any]) -> Mode | None:
    if item["type"] == 55:
        return _mode_55(item)
    if item["type"] == 2414 and item["analysis_type"] == _NORMAL:
        return _mode_2414(item) if item["result_type"] in _DISPLACEMENT else None
    return None


def _damping(viscous: float, hysteretic: float) -> float:
    return viscous or 0.5 * hysteretic or math.nan


def _mode_55(item: Mapping[str, Any]) -> Mode | None:
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
        return Mode(item["mode_n"], item["freq"], zeta, labels, shape / math.sqrt(mass))
    eigenvalue = complex(item["eig"])
    mass = mass_of_complex_mode(item["modal_a"], factor, abs(eigenvalue.imag), where)
    w = abs(eigenvalue)
    zeta = -eigenvalue.real / w
    return Mode(item["mode_n"], w / (2.0 * math.pi), zeta, labels, shape / math.sqrt(mass))


def _mode_2414(item: Mapping[str, Any]) -> Mode:
    """Record 12 holds time, frequency, eigenvalue, modal mass, viscous and hysteretic damping."""
    number = item["record10_field6"]
    where = f"mode {number}"
    if item["dataset_location"] != 1 or item["data_type"] not in {2, 4}:
        raise ResourceError(f"{where}: data set 2414 must hold real data at nodes")
    shape = np.array([values[:3] for values in item["data_at_node"]])
    mass = check_modal_mass(item["record12_field4"], where)
    zeta = _damping(item["record12_field5"], item["record12_field6"])
    labels = np.asarray(item["node_nums"]).astype(int)
    return Mode(number, item["record12_field2"], zeta, labels, shape / math.sqrt(mass))
