"""The thesis' start and window beside a run that goes on until it has settled."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SIGNALS, SPEED, WINDOW, levels, natural, settled, unit, window
from herringbone.thesis.pair.given import JOB

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_UNTIL, _SHOWN_UNTIL = 0.4, 0.2
_ALIKE = 0.05
"""Difference of levels that counts as none."""
_SHOWN = [name for name in SIGNALS if "velocity" in name]
_WHEEL = "one wheel turn later"


def compute() -> Outcome:
    """Signals of a long run, and levels in windows of 0.02 s, over those of the settled state."""
    rows = window(until=_UNTIL)
    (state,) = settled()
    still = levels(state)
    length = WINDOW[1] - WINDOW[0]
    begins = np.arange(WINDOW[0], _UNTIL - 0.5 * length, length)
    found = [
        {"begin": begin}
        | {
            name: float(rows[(rows["time"] >= begin - 1e-9) & (rows["time"] < begin + length)][
                name
            ].std(ddof=0)) / still[name]
            for name in SIGNALS
        }
        for begin in begins
    ]  # fmt: skip
    over = table(pd.DataFrame(found), {"begin": "s"})
    rows = rows[rows["time"] <= _SHOWN_UNTIL].iloc[::2]
    shown = table(
        rows[["time", *_SHOWN]].reset_index(drop=True), {"time": "s"} | {n: unit(n) for n in _SHOWN}
    )
    settled_levels = table({"signal": list(still), "level": list(still.values()),
                            "unit": [unit(name) for name in still]})  # fmt: skip
    outcome = {"over settled": over, "run": shown, "settled": settled_levels}
    return Outcome(outcome, _findings(over))


def _findings(over: pd.DataFrame) -> tuple[Finding, ...]:
    first, slow = over.iloc[0], natural()
    axial = "pinion axial velocity"
    radial = [name for name in _SHOWN if "radial" in name]
    alike = over[np.abs(over[radial] - 1.0).max(axis=1) < _ALIKE]
    turn = SPEED / 60.0 * (WINDOW[1] - WINDOW[0])
    teeth = JOB.pair.number_of_teeth
    return (
        Finding(
            "Speed and load are applied gradually; after 0.02 s the motion is steady.",
            Verdict.of(abs(float(first[axial]) - 1.0) < _ALIKE),
            float(first[axial]),
            "",
            f"times its settled level has the {axial} in the window 0.02 to 0.04 s (rms; settled: "
            "over a turn of the wheel)",
            f"The wheel on its axial bearing, at {slow.frequency_hz[0]:.0f} Hz with a damping "
            f"ratio of {slow.damping_ratio[0]:.3f}, dies out slowly. Damping of shafts and "
            "bearings is an assumption: the thesis gives none.",
            margin=0.1,
        ),
        Finding(
            "The period from 0.02 to 0.04 s shows the steady state.",
            Verdict.NEEDS_AN_ASSUMPTION,
            float(alike["begin"].min()) if len(alike) else None,
            "s",
            "after the start, the radial velocities of both gears are for the first time within "
            f"{100.0 * _ALIKE:.0f} % of their settled levels",
            "So long a run, or the damping that lets it settle in 0.02 s.",
            margin=WINDOW[1] - WINDOW[0] + 1e-9,
        ),
        Finding(
            "Twenty milliseconds show the periodic motion.",
            Verdict.of(turn * teeth[0] / teeth[1] >= 1.0),
            turn,
            "",
            f"turns of the pinion at {SPEED:.0f} r/min, {turn * teeth[0] / teeth[1]:.3f} of the "
            "wheel: what turns with them is not seen whole",
            "Figures need whole turns of the wheel, here 0.18 s.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """The run with the window, and levels over the begin of a window."""
    from herringbone.plotting.style import COLOURS, figure_legend, new_figure  # noqa: PLC0415 (lazy)

    run, over = tables["run"], tables["over settled"]
    figure = new_figure("Start of the thesis: the load comes in over 0.02 s, f_A 10 µm", 3, 2)
    grid = figure.add_gridspec(3, 2)
    panels = [figure.add_subplot(grid[k // 2, k % 2]) for k in range(len(_SHOWN))]
    for axes, name in zip(panels, _SHOWN, strict=True):
        axes.axvspan(1e3 * WINDOW[0], 1e3 * WINDOW[1], color="#EFE7C8", label="window")
        axes.plot(1e3 * run["time"], run[name], linewidth=0.7, color=COLOURS[0], label="run")
        level = float(tables["settled"].set_index("signal")["level"][name])
        axes.axhline(level, color=COLOURS[1], label="± settled rms", linewidth=1.0)
        axes.axhline(-level, color=COLOURS[1], linewidth=1.0)
        axes.set_title(name)
        axes.set_ylabel(unit(name))
        axes.set_xlabel("time [ms]")
        axes.margins(x=0.0)
    figure_legend(figure, panels[0])
    axes = figure.add_subplot(grid[2, :])
    for name in SIGNALS:
        axes.semilogy(1e3 * over["begin"], over[name], marker=".", label=name,
                      linestyle="-" if "velocity" in name else "--")  # fmt: skip
    axes.axhline(1.0, color="black", linewidth=0.8)
    axes.set_title("rms in windows of 20 ms over the settled one")
    axes.set_xlabel("begin of the window [ms]")
    axes.legend(ncols=4, fontsize=7.5, loc="upper right")
    return {"start": figure}


ENTRY = Entry(
    name="start_and_window",
    group="dynamics",
    title="The original start and window beside a settled run",
    source="chapter 3.4",
    shows="Speed and load are applied gradually, the first 0.02 s are discarded, and 0.02 to "
    "0.04 s are taken as the steady state. Here the speed is there from the start: how it was "
    "applied is not stated; torques on the bodies grow over 0.02 s.",
    compute=compute,
    draw=draw,
    seconds=3.0,
)
