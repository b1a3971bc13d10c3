"""Figure 5.6: the prediction at 1000 r/min and 200 N m, and a place for what was measured."""

from typing import TYPE_CHECKING

import numpy as np

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor, sensor_velocity
from herringbone.analysis.measured.beside import Beside, beside
from herringbone.analysis.measured.predicted import Predicted
from herringbone.analysis.measured.record import MeasuredRecord
from herringbone.result.result import TIME
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.rig.runs import REAL, STATED, TEETH, cycle_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SPEED, _MM = 1000.0, 1e3
_SEEDS = (1, 2, 3, 4)
"""Pairs of one class: the first is the prediction."""
_SHOWN = 50


def predicted(grade: int, seed: int = 1) -> Predicted:
    """What sensor A would see of a pair with teeth of a class."""
    result = cycle_run(STATED, grade, seed)
    time = result.data[TIME].to_numpy()
    step = float(time[-1] - time[0]) / (time.size - 1)
    velocity = sensor_velocity(result, ("A",))[:, 0]
    teeth = JOB.pair.number_of_teeth
    mesh = teeth[0] * _SPEED / 60.0
    return Predicted(velocity, step, VelocitySensor(), mesh, int(np.lcm(*teeth)))


def _samples(one: Predicted) -> np.ndarray:
    """All that the run gives [m/s]."""
    return one.samples(int(one.duration * one.sensor.sampling_hz))


def compute() -> Outcome:
    """Samples and lines with perfect and with real teeth; other pairs of the same class beside."""
    own = {words: predicted(TEETH[words]) for words in ("perfect", REAL)}
    others = [_of_pair(own[REAL], seed) for seed in _SEEDS[1:]]
    likeness = [one.likeness for one in others]
    samples = table(
        {
            "time": 1e3 * np.arange(_SHOWN) / own[REAL].sensor.sampling_hz,
            **{words: _MM * _samples(one)[-_SHOWN:] for words, one in own.items()},
            **{f"pair {k}": _MM * one.record.velocity[-_SHOWN:] for k, one in enumerate(others, 2)},
        },
        {"time": "ms", "perfect": "mm/s", REAL: "mm/s",
         **{f"pair {k}": "mm/s" for k in range(2, len(_SEEDS) + 1)}},
    )  # fmt: skip
    lines = others[0].lines
    units = {"frequency": "Hz", "shows_at": "Hz", "predicted": "m/s", "measured": "m/s"}
    return Outcome(
        {
            "samples": samples,
            "pair_2_beside_pair_1": table({c: lines[c] for c in lines}, units),
            "pairs": table(
                {"pair": list(range(2, len(_SEEDS) + 1)), "likeness": likeness,
                 "gain": [one.gain for one in others], "shift": [one.shift for one in others]},
                {"shift": "s"},
            ),
        },
        (
            Finding(
                "Measured and predicted curves agree in shape and dominant frequencies (5.6).",
                Verdict.CANNOT_BE_TESTED,
                max(likeness),
                "",
                f"is the likeness of the lines of the most alike of {len(others)} other pairs of "
                f"{REAL} to the first one; 1 is the same",
                "No data are published. What two pairs of one class do differs by so much that a "
                "curve can be predicted only of teeth that were measured. Yours: "
                "'herringbone compare RESULTS RECORD --sensor A'.",
                0.01,
            ),
            Finding(
                "There is a small discrepancy in amplitude (5.6).",
                Verdict.CANNOT_BE_TESTED,
                float(_samples(own[REAL]).std() / _samples(own["perfect"]).std()),
                "",
                f"times as large is the level with teeth of {REAL} as with perfect ones",
                "No number is published.",
                0.2,
            ),
        ),
    )  # fmt: skip


def _of_pair(own: Predicted, seed: int) -> Beside:
    """Another pair of the class, as if it had been measured."""
    other = predicted(TEETH[REAL], seed)
    record = MeasuredRecord(_samples(other), other.sensor.sampling_hz, "A", f"pair {seed}")
    return beside(record, own)


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Curves in the layout of figure 5.6, and lines."""
    from herringbone.plotting.style import new_figure  # noqa: PLC0415 (matplotlib: lazy)

    figure = new_figure("Sensor A, 1000 r/min, 200 N m: prediction; the measured curve is not "
                        "published", 1, 3, width=15.0)  # fmt: skip
    perfect, real, lines = figure.subplots(1, 3)
    samples = tables["samples"]
    perfect.plot(samples["time"], samples["perfect"], marker=".", markersize=3)
    perfect.set_title("perfect teeth")
    real.plot(samples["time"], samples[REAL], marker=".", markersize=3, label="pair 1")
    real.plot(samples["time"], samples["pair 2"], marker=".", markersize=3, label="pair 2")
    real.set_title(f"two pairs with teeth of {REAL}")
    real.legend(loc="upper right", ncols=2)
    real.margins(y=0.2)
    for axes in (perfect, real):
        axes.set_xlabel("time [ms]")
        axes.set_ylabel("velocity [mm/s]")
    found = tables["pair_2_beside_pair_1"]
    for name, words, off in (("predicted", "pair 1", -1.0), ("measured", "pair 2", 1.0)):
        lines.vlines(found["shows_at"] + off, 0.0, _MM * found[name], label=words,
                     color=f"C{int(off > 0.0)}", linewidth=1.4)  # fmt: skip
    lines.set_title("lines at multiples of the wheel's turn")
    lines.set_xlabel("frequency as sampled [Hz]")
    lines.set_ylabel("amplitude [mm/s]")
    lines.legend(loc="upper right")
    return {"prediction": figure}


ENTRY = Entry(
    name="prediction_and_measurement",
    group="rig",
    title="Prediction and measurement at 1000 r/min, 200 N m",
    source="chapter 5.3.4, figure 5.6",
    shows="A measured and a predicted curve of axial velocity that agree, without data. Here the "
    "prediction for perfect and for real teeth, and other pairs of the same class beside it, as a "
    "record would be; a record of your own is compared by 'herringbone compare RESULTS RECORD'.",
    compute=compute,
    draw=draw,
    seconds=6.0,
)
