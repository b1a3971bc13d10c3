"""The standard pictures of a run, and their files."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from herringbone.analysis.figures.standstill import has_pictures
from herringbone.analysis.gearboxes import by_gearbox
from herringbone.core import ParameterError
from herringbone.plotting.runs.over_time import bearing_forces, seat_velocities, torques
from herringbone.plotting.runs.overview import overview
from herringbone.plotting.runs.runup import run_up
from herringbone.plotting.runs.sensors import sensors
from herringbone.plotting.runs.spectra import radiated_power, spectra
from herringbone.result.result import Result

PICTURES: dict[str, Callable[[Result], Figure]] = {
    "bearing_forces": bearing_forces,
    "seat_velocities": seat_velocities,
    "spectra": spectra,
    "torques": torques,
    "radiated_power": radiated_power,
    "sensors": sensors,
}
_OF_SOME: dict[str, Callable[[Result], Figure]] = {"run_up": run_up}
"""Pictures of runs of a kind: those whose speed changes."""


def write_pictures(result: Result, folder: str | Path, highest: float | None = None) -> list[Path]:
    """Write the overview and the standard pictures as PNG; those without columns are left out.

    Several gearboxes have pictures of their own, such as `overview.first.png`. A run of less than
    two records has no pictures, and neither has one in which nothing turns.

    Args:
        result: of a run.
        folder: existing folder.
        highest: end of spectra and waterfalls [Hz]; each picture's own if not given.

    Raises:
        HerringboneError: a file cannot be written.
    """
    drawn: dict[str, Callable[[Result], Figure]] = {"overview": overview, **PICTURES, **_OF_SOME}
    if highest is not None:
        drawn["spectra"] = partial(spectra, highest=highest)
        drawn["run_up"] = partial(run_up, highest=highest)
    files: list[Path] = []
    if not has_pictures(result):
        return files
    for box, seen in by_gearbox(result).items():
        for name, draw in drawn.items():
            try:
                figure = draw(seen)
            except ParameterError:
                continue
            file = Path(folder) / f"{name}{box and f'.{box}'}.png"
            figure.savefig(file)
            files.append(file)
    return files
