"""The backlash law, where it matters, and the jumps that it makes."""

import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.steady.state import SteadyState
from herringbone.core import HerringboneError
from herringbone.core.declaring.units import RAD_S
from herringbone.core.places.temporary import temporary_folder
from herringbone.running.api import run
from herringbone.scenes import Start
from herringbone.thesis import names
from herringbone.thesis.dynamics.equations import Bodies
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SPEEDS, TORQUE, settled
from herringbone.thesis.pair.given import JOB

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_TORQUES = (100.0, 200.0, 300.0, 400.0)
_DEFLECTION = f"{names.GEAR}.mesh_left.deflection"
_FORCE, _SPEED = f"{names.BEARINGS}.shaft.pinion_left.f_y", f"{names.GEAR}.pinion.w"
_LIGHT, _ERROR = 30.0, 1e-6
"""Torque [N m], amplitude of the transmission error at mesh frequency [m]: so teeth part."""
_BETWEEN, _LENGTHS = (2300.0, 2700.0), (1.4, 1.45, 1.5)
"""Speeds of all sweeps [r/min], below the pinion's radial mode at 1292 Hz; lengths of pairs [s].

Teeth that rattle fall back when chance has it: pairs of sweeps that differ by a thousandth of their
length jump 65 to 260 r/min apart.
"""
_APART = 100.0
"""Of the median distance of the jumps over the pairs [r/min], whatever the last digits."""
_BIN, _STEP = 0.05, 5e-5
"""Of a level, and between values [s]."""
_BACKLASH = 180.0
"""2 delta of table 3.1 [µm]."""


def compute() -> Outcome:
    """Least deflection under load, both laws, and sweeps up and down."""
    under_load = table(pd.DataFrame([
        {"torque": torque, "speed": speed, "least": _least(state)}
        for torque in _TORQUES
        for speed, state in zip(SPEEDS, settled(SPEEDS, torque), strict=True)
    ]), {"torque": "N m", "speed": "r/min"})  # fmt: skip
    with temporary_folder() as folder:
        jumps = table(
            pd.DataFrame(_sweeps(folder)),
            {"length": "s", "speed": "r/min", "bearing force": "N"},
        )
    return Outcome({"least deflection": under_load, "jumps": jumps}, _findings(under_load, jumps))


def _least(state: SteadyState) -> float:
    """Smallest deflection of the left mesh over its mean."""
    times = np.linspace(0.0, state.period, 64 * state.meshes, endpoint=False)
    values = state.signal(_DEFLECTION, times)
    return float(values.min() / values.mean())


def _sweeps(folder: Path) -> Iterator[dict[str, float | str]]:
    """Levels while the speed grows, and while it falls again."""
    file = folder / "errors.csv"
    _write_errors(file)
    ways = ("up", _BETWEEN), ("down", _BETWEEN[::-1])
    for length, (sweep, (begin, end)) in itertools.product(_LENGTHS, ways):
        speed, force = _sweep(file, begin, end, length)
        count = round(_BIN / _STEP)
        for k in range(count, len(speed) - count + 1, count):
            own = slice(k, k + count)
            yield {"length": length, "sweep": sweep, "speed": float(speed[own].mean()),
                   "bearing force": float(force[own].std())}  # fmt: skip


def _write_errors(file: Path) -> None:
    """A transmission error at mesh frequency, of both halves."""
    rows = [f"{side},drive,pinion,27,{_ERROR!r},0.0" for side in ("left", "right")]
    head = "# units: order 1, amplitude m, phase rad\nside,flank,gear,order,amplitude,phase\n"
    file.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")


def _sweep(errors: Path, begin: float, end: float, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Speed [r/min] and bearing force [N] over a run in which a torque to spare changes the speed.

    Raises:
        HerringboneError: it does not come to its end.
    """
    bodies, teeth = Bodies(), JOB.pair.number_of_teeth
    inertia = 2.0 * (bodies.inertia[0] + bodies.inertia[1] * (teeth[0] / teeth[1]) ** 2)
    spare = inertia * (end - begin) * RAD_S / length
    values: dict[str, float | str | Path] = {
        f"{names.GEAR}.der(angle)": begin * RAD_S,
        f"{names.GEAR}.tooth_errors": str(errors),
        names.SYMMETRY_DEVIATION: 0.0,
        "pinion_torque.torque_factor": (_LIGHT + 0.5 * spare) / TORQUE,
        "wheel_torque.torque_factor": -(_LIGHT - 0.5 * spare) / TORQUE,
    }
    result = run(
        names.ON_GROUND, scene=names.GRADUAL, start=Start.RAMP, values=values, t_end=length,
        record_step=_STEP, fuse=True,
    )  # fmt: skip
    if not result.outcome.completed:
        raise HerringboneError(f"the sweep from {begin:g} r/min failed: {result.outcome.message}")
    speed, force = (result.data[result.column(name)].to_numpy() for name in (_SPEED, _FORCE))
    return speed / RAD_S, force


def _jump(sweep: pd.DataFrame) -> float:
    """Speed [r/min] between which points the level changes most over itself."""
    steps = np.abs(np.diff(np.log(sweep["bearing force"])))
    k = int(np.argmax(steps))
    return float(sweep["speed"].iloc[k : k + 2].mean())


def _findings(under_load: pd.DataFrame, jumps: pd.DataFrame) -> tuple[Finding, ...]:
    least = float(under_load["least"].min())
    found = {key: _jump(own) for key, own in jumps.groupby(["length", "sweep"])}
    up, down = ([found[length, sweep] for length in _LENGTHS] for sweep in ("up", "down"))
    apart = np.subtract(up, down)
    return (
        Finding(
            "Under heavy load the influence of backlash is small.",
            Verdict.of(least > 0.0),
            100.0 * least,
            "%",
            "of the mean deflection stays at the least over 100 to 400 N m and 800 to 1500 r/min: "
            "teeth never part, backlash has no influence at all",
            "With perfect teeth and settled.",
            margin=0.5,
        ),
        Finding(
            "Backlash is retained for generality.",
            Verdict.of(apart.min() > _BIN * (_BETWEEN[1] - _BETWEEN[0]) / min(_LENGTHS)),
            float(np.median(apart)),
            "r/min",
            f"lie at the median between jumps while the speed grows, at {min(up):.0f} to "
            f"{max(up):.0f} r/min in {len(up)} sweeps, and while it falls, at {min(down):.0f} to "
            f"{max(down):.0f} r/min, at {_LIGHT:.0f} N m and a transmission error of "
            f"{1e6 * _ERROR:g} µm",
            "At light load teeth part near a resonance, and there are two motions at one speed. "
            "Which one a sweep leaves when is chance: jumps differ from sweep to sweep.",
            margin=_APART,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Both laws, the least deflection, and both sweeps."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    figure = new_figure("Backlash: the law, heavy load, and jumps at light load", 1, 3)
    law, least, jumps = figure.subplots(1, 3)
    x = np.linspace(-150.0, 150.0, 301)
    half = 0.5 * _BACKLASH
    law.plot(x, np.sign(x) * np.maximum(0.0, np.abs(x) - half), label="thesis: from the middle")
    drive = x + half
    law.plot(drive - half, np.maximum(0.0, x - half) + np.minimum(0.0, x + half),
             linestyle="--", label="here: the same, from the drive flank")  # fmt: skip
    law.set_title("elastic deflection over play [µm]")
    law.set_xlabel("position in the play [µm]")
    _curves(least, tables["least deflection"], "torque", "least", "{:.0f} N m")
    least.set_title("least deflection / mean")
    least.set_ylim(0.0, 1.0)
    sweeps = tables["jumps"]
    first = sweeps[sweeps["length"] == sweeps["length"].min()]
    _curves(jumps, first, "sweep", "bearing force", "sweep {}")
    jumps.set_title(f"pinion bearing force, rms [N], {_LIGHT:.0f} N m")
    for axes in (law, least, jumps):
        axes.legend(fontsize=7.5)
    for axes in (least, jumps):
        axes.set_xlabel("speed [r/min]")
    return {"backlash": figure}


def _curves(axes: "Axes", rows: pd.DataFrame, split: str, what: str, told: str) -> None:
    for name, own in rows.groupby(split, sort=False):
        axes.plot(own["speed"], own[what], marker="o", markersize=3.5, label=told.format(name))


ENTRY = Entry(
    name="backlash",
    group="dynamics",
    title="The backlash law and its jumps",
    source="chapter 3.3.2, table 3.1",
    shows="A dead zone of 180 µm between both flanks, said to matter little under heavy load.",
    compute=compute,
    draw=draw,
    seconds=10.0,
)
