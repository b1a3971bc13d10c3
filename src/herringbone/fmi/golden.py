"""Golden results: a short run of each component's FMU.

`python -m herringbone.fmi.generate` renews them, those that differ by no more than processors round
apart aside. Every input is a sine of its own frequency and
phase; the amplitude goes by the unit.
"""

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from herringbone.components.registry import component
from herringbone.core import Component
from herringbone.fmi.host import Host
from herringbone.fmi.python.build import build_python_fmus

STEP_SIZE: Final = 2e-5
STEPS: Final = 100
STEPS_PER_ROW: Final = 5
ROUNDING: Final = 1e-12
"""Over the largest value of a column: what processors round apart; 4e-14 was seen."""
_AMPLITUDES: Final = {
    "N": 1e3, "N.m": 50.0, "m": 1e-6, "m/s": 1e-2, "rad": 1e-3, "rad/s": 10.0,
}  # fmt: skip


def golden_file(component: Component) -> Path:
    """Where the golden result of a component lies."""
    return component.folder / "golden.csv"


def columns(component: Component) -> list[str]:
    """Time and all outputs, without their nodes."""
    return ["time", *(v.name for v in component.declaration.outputs)]


def inputs(component: Component, time: float) -> dict[str, float]:
    """Values of all inputs at `time` [s]."""
    return {
        v.name: _AMPLITUDES[v.unit] * math.sin(2.0 * math.pi * (300.0 + 70.0 * i) * time + i)
        for i, v in enumerate(component.declaration.inputs)
    }


def golden_run(component: Component, fmu: Path) -> np.ndarray:
    """Run an FMU of the component.

    Returns:
        Rows of `columns(component)`, every STEPS_PER_ROW steps of STEP_SIZE [s].
    """
    names = columns(component)[1:]
    with Host(component.name, fmu) as host:
        host.initialise(inputs(component, 0.0))
        rows = [[0.0, *host.values(*names)]]
        for n in range(STEPS):
            host.set_values(inputs(component, n * STEP_SIZE))
            host.step(n * STEP_SIZE, STEP_SIZE)
            if (n + 1) % STEPS_PER_ROW == 0:
                rows.append([(n + 1) * STEP_SIZE, *host.values(*names)])
    return np.array(rows)


def write_golden(names: Sequence[str]) -> None:
    """Write the golden results of components into their folders, where they have changed."""
    for name, fmu in build_python_fmus(names).items():
        found = component(name)
        file, header, rows = golden_file(found), ",".join(columns(found)), golden_run(found, fmu)
        if not _holds(file, header, rows):
            np.savetxt(file, rows, "%.13g", ",", header=header, comments="")


def _holds(file: Path, header: str, rows: np.ndarray) -> bool:
    """True if a file has these rows, rounding aside."""
    if not file.is_file() or file.read_text(encoding="utf-8").partition("\n")[0] != header:
        return False
    there = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
    if there.shape != rows.shape:
        return False
    return bool((np.abs(there - rows) <= ROUNDING * np.abs(rows).max(axis=0)).all())


if __name__ == "__main__":
    write_golden(sys.argv[1:])
