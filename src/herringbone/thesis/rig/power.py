"""Power through the closed loop over a test cycle."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.asked import shaft_torques, signal
from herringbone.analysis.figures.sensing.plateaus import plateaus
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.units import R_MIN
from herringbone.result.result import TIME, Result
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.rig.runs import SPEEDS, cycle_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_EVERY = 50
"""Records of a run per row: 5 ms, which hides the mesh."""
_POWERS = ("from_supply", "circulating", "recovered", "loss_of_load_motor")


def compute() -> Outcome:
    """Powers over the cycle of speeds, with perfect teeth."""
    result = cycle_run(SPEEDS, 0)
    powers = _powers(result)
    means = _means(result, powers)
    last = means.iloc[-1]
    share = 100.0 * last["net"] / last["circulating"]
    return Outcome(
        {"powers": _thinned(powers), "plateaus": means},
        (
            Finding(
                "The closed loop recycles energy and loads the gears without much power.",
                Verdict.NEEDS_AN_ASSUMPTION,
                share,
                "%",
                f"of the circulating {1e-3 * last['circulating']:.1f} kW come from the supply at "
                f"{last['speed']:.0f} r/min and 200 N m",
                "Losses of the motors are ours; our gears have neither friction nor drag.",
            ),
        ),
    )


def _powers(result: Result) -> pd.DataFrame:
    at = shaft_torques(result)["pinion"]
    pinion = at.sign * result.data[at.column].to_numpy()
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    found = {
        "time": result.data[TIME].to_numpy(),
        "speed": R_MIN * np.asarray(speed),
        "from_supply": signal(result, Role.DRIVE, Quantity.ELECTRICAL_POWER),
        "circulating": pinion * speed,
        "recovered": signal(result, Role.LOAD, Quantity.RECOVERED_POWER),
        "loss_of_load_motor": signal(result, Role.LOAD, Quantity.LOSS_POWER),
    }
    return pd.DataFrame(found)


def _thinned(powers: pd.DataFrame) -> pd.DataFrame:
    """Means of blocks of rows."""
    blocks = powers.groupby(np.arange(len(powers)) // _EVERY).mean()
    return table(
        {name: blocks[name].to_numpy() for name in blocks},
        {"time": "s", "speed": "r/min", **dict.fromkeys(_POWERS, "W")},
    )


def _means(result: Result, powers: pd.DataFrame) -> pd.DataFrame:
    """A row per plateau: means of its second half."""
    rows = []
    for plateau in plateaus(result):
        begin = 0.5 * (plateau.begin + plateau.end)
        inside = powers[(powers["time"] >= begin) & (powers["time"] <= plateau.end)].mean()
        net = inside["from_supply"] - inside["recovered"]
        rows.append({**inside.drop("time").to_dict(), "net": net})
    names = {"speed": "r/min", **dict.fromkeys((*_POWERS, "net"), "W")}
    return table({name: [row[name] for row in rows] for name in names}, names)


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Powers and speed over time."""
    from herringbone.plotting.style import legend, new_figure  # noqa: PLC0415 (matplotlib: lazy)

    figure = new_figure("Power through the closed loop, 800, 1200, 1500 r/min at 200 N m", 2)
    upper, lower = figure.subplots(2, 1, sharex=True)
    powers = tables["powers"]
    for name in _POWERS:
        upper.plot(powers["time"], 1e-3 * powers[name], label=name.replace("_", " "))
    upper.set_ylabel("power [kW]")
    legend(upper, 4)
    lower.plot(powers["time"], powers["speed"])
    lower.set_ylabel("speed [r/min]")
    lower.set_xlabel("time [s]")
    return {"power": figure}


ENTRY = Entry(
    name="power_flow",
    group="rig",
    title="Power through the test rig",
    source="chapter 5.1, figure 5.1",
    shows="A drive motor, transducers and a load motor in a closed loop; no power is stated.",
    compute=compute,
    draw=draw,
    seconds=3.0,
)
