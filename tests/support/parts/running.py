"""Runs of systems of components, in-process and as FMUs, and what is read from recordings."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import component
from herringbone.core import Instance
from herringbone.core.part import closing_all
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.fmu.opening import open_fmu
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import System


def columns(recording: Recording, names: Sequence[str]) -> np.ndarray:
    """Recorded values (n, len(names))."""
    return recording.values[:, [recording.names.index(name) for name in names]]


def slope(steps: Sequence[float], errors: Sequence[float]) -> float:
    """Least-squares slope of log error over log step."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def open_in_process(system: System) -> list[InProcessPart]:
    """All parts of a system of components, in-process, values set."""
    parts = []
    for spec in system.parts:
        part = InProcessPart(Instance(component(spec.component), spec.name))
        for name, value in spec.values.items():
            part.set(name, value)
        parts.append(part)
    return parts


def run_fmus_and_in_process(
    system: System, fmus: Mapping[str, Path], algorithm: Algorithm, grid: Grid, **more
) -> tuple[Recording, Recording]:
    """Run a system of components as FMUs and in-process.

    Args:
        fmus: file of each component's FMU.
        more: further arguments of `simulate`.
    """
    parts = [open_fmu(spec.name, fmus[spec.component]) for spec in system.parts]
    with closing_all(parts):
        for part, spec in zip(parts, system.parts, strict=True):
            for name, value in spec.values.items():
                part.set(name, value)
        both = (parts, open_in_process(system))
        found, wanted = (simulate(system, each, algorithm, grid, **more) for each in both)
    return found, wanted


def run_in_process(system: System, algorithm: Algorithm, h: float, t_end: float, record=None):
    """Run a system of components in-process."""
    return simulate(system, open_in_process(system), algorithm, make_grid(t_end, h, record or h))
