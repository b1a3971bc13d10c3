"""What sampling at 2000 Hz makes of mesh harmonics."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.figures.sensing.plateaus import plateaus
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor, sensor_velocity
from herringbone.analysis.figures.spectra import PADDING, amplitude_spectrum, mesh_frequency
from herringbone.core.declaring.units import R_MIN
from herringbone.result.result import TIME
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.rig.runs import SPEEDS, cycle_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MM = 1e3
_UNITS = {"speed": "r/min", "frequency": "Hz", "shows_at": "Hz", "amplitude": "mm/s"}
_FILTERS = {"no filter": False, "anti-alias filter": True}
_LIFT = 0.045
"""Of every second mark: neighbours do not cover each other."""
_SETTLING = 0.3
"""Share of a plateau."""


def compute() -> Outcome:
    """Spectra at sensor A on the three plateaus, with and without an anti-alias filter."""
    result = cycle_run(SPEEDS, 0)
    time = result.data[TIME].to_numpy()
    step = float(time[-1] - time[0]) / (time.size - 1)
    velocity = sensor_velocity(result, ("A",))[:, 0]
    parts, lines = [], []
    for plateau in plateaus(result):
        mesh = mesh_frequency(plateau.speed, JOB.pair.number_of_teeth[0])
        begin = plateau.begin + _SETTLING * (plateau.end - plateau.begin)
        for words, filtered in _FILTERS.items():
            sensor = VelocitySensor(anti_alias=filtered)
            record = sensor.measure(velocity, step)
            at = time[0] + record.time
            own = record.velocity[(at >= begin) & (at <= plateau.end)]
            found = amplitude_spectrum(own, 1.0 / sensor.sampling_hz, padding=PADDING)
            speed = round(R_MIN * plateau.speed)
            parts += [(speed, words, f, _MM * a)
                      for f, a in zip(found.frequency, found.amplitude, strict=True)]  # fmt: skip
            for order in range(1, 7):
                shows = sensor.alias_hz(order * mesh)
                near = np.abs(found.frequency - shows) < 2.0 * found.resolution
                height = _MM * float(found.amplitude[near].max())
                lines.append((speed, words, order, order * mesh, shows, height))
    spectra = _table(("speed", "filter", "frequency", "amplitude"), parts)
    names = ("speed", "filter", "mesh_order", "frequency", "shows_at", "amplitude")
    orders = _table(names, lines)
    return Outcome({"spectra": spectra, "orders": orders}, _findings({"orders": orders}))


def _table(names: Sequence[str], rows: Sequence[Sequence[object]]) -> pd.DataFrame:
    """A table of rows, with the units of the columns that have one."""
    columns = dict(zip(names, zip(*rows, strict=True), strict=True))
    return table(columns, {name: unit for name, unit in _UNITS.items() if name in columns})


def _findings(tables: Tables) -> tuple[Finding, ...]:
    orders = tables["orders"]
    fast = orders[orders["speed"] == orders["speed"].max()]
    plain, filtered = (fast[fast["filter"] == w].set_index("mesh_order") for w in _FILTERS)
    second = plain.loc[2]
    return (
        Finding(
            "Vibration is sampled at 2000 Hz; a filter is not mentioned.",
            Verdict.NEEDS_AN_ASSUMPTION,
            float(second["amplitude"] / plain.loc[1, "amplitude"]),
            "",
            f"times the first mesh harmonic at 1500 r/min is the line at {second['shows_at']:.0f} "
            f"Hz, which is the second one, of {second['frequency']:.0f} Hz, folded",
            "With an anti-alias filter at 0.4 of the rate it would be "
            f"{filtered.loc[2, 'amplitude'] / second['amplitude']:.1e} of that.",
            0.02,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Spectra as sampled, with mesh harmonics where they show."""
    from herringbone.plotting.style import MARKER_COLOUR, new_figure  # noqa: PLC0415

    spectra, orders = tables["spectra"], tables["orders"]
    speeds = sorted(spectra["speed"].unique())
    figure = new_figure(
        "Sensor A, sampled at 2000 Hz, perfect teeth; mesh orders, (folded)",
        1,
        len(speeds),
    )
    top = spectra["amplitude"].max()
    for axes, speed in zip(figure.subplots(1, len(speeds)), speeds, strict=True):
        for words, part in spectra[spectra["speed"] == speed].groupby("filter", sort=False):
            axes.plot(part["frequency"], part["amplitude"], label=words)
        own = orders[(orders["speed"] == speed) & (orders["filter"] == next(iter(_FILTERS)))]
        for k, row in enumerate(own.sort_values("shows_at").itertuples()):
            axes.axvline(
                row.shows_at, color=MARKER_COLOUR, linewidth=0.8, linestyle=":", zorder=0.5
            )
            text = str(row.mesh_order)
            text = text if row.shows_at == row.frequency else f"({text})"
            lift = 1.01 + _LIFT * (k % 2)
            axes.text(row.shows_at, lift, text, ha="center", va="bottom", fontsize=8,
                      transform=axes.get_xaxis_transform(), color=MARKER_COLOUR)  # fmt: skip
        axes.set_yscale("log")
        axes.set_ylim(1e-5 * top, 2.0 * top)
        axes.set_xlim(0.0, 1000.0)
        axes.set_title(f"{speed:.0f} r/min", pad=24.0)
        axes.set_xlabel("frequency as sampled [Hz]")
    figure.axes[0].set_ylabel("amplitude [mm/s]")
    figure.axes[0].legend(loc="lower left")
    return {"aliasing": figure}


ENTRY = Entry(
    name="aliasing",
    group="rig",
    title="Lines that sampling folds",
    source="chapter 5.1",
    shows="Sensors are sampled at 2000 Hz, at mesh frequencies of 360 to 675 Hz.",
    compute=compute,
    draw=draw,
    seconds=3.0,
)
