"""The printed mesh damping against that which follows from the modal mass."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis import names
from herringbone.thesis.dynamics.equations import PUBLISHED_STIFFNESS, Bodies
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.ground import SIGNALS, levels, settled, unit
from herringbone.thesis.trends import LEAST

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RATIO = 0.1
"""zeta of table 3.1."""
_SPEEDS = tuple(np.arange(800.0, 1500.1, 10.0))
_SHOWN = [name for name in SIGNALS if "radial" in name]
_FORMS = ("corrected form", "as printed")


def compute() -> Outcome:
    """Damping constants, and levels over speed with both."""
    damping = _constants()
    ratio = float(damping["damping"][1] / damping["damping"][0])
    rows = []
    for form, zeta in zip(_FORMS, (_RATIO, _RATIO * ratio), strict=True):
        values = {f"{names.GEAR}.mesh_damping_ratio": zeta}
        for speed, state in zip(
            _SPEEDS, settled(_SPEEDS, deviation=0.0, values=values), strict=True
        ):
            found = levels(state)
            rows.append({"form": form, "speed": speed} | {name: found[name] for name in _SHOWN})
    over_speed = table(
        pd.DataFrame(rows), {"speed": "r/min"} | {name: unit(name) for name in _SHOWN}
    )
    return Outcome({"constants": damping, "levels": over_speed}, _findings(ratio, over_speed))


def _constants() -> pd.DataFrame:
    """Modal mass and mean damping constant of a half, both forms."""
    bodies = Bodies()
    (pinion, wheel), (r_pinion, r_wheel) = bodies.inertia, bodies.base_radius
    masses = [
        pinion * wheel / (r_pinion**2 * wheel + r_wheel**2 * pinion),
        pinion * wheel / (r_pinion**2 * pinion + r_wheel**2 * wheel),
    ]
    constants = [2.0 * _RATIO * np.sqrt(0.5 * PUBLISHED_STIFFNESS * m) for m in masses]
    return table(
        {"form": _FORMS, "modal mass": masses, "damping": constants},
        {"modal mass": "kg", "damping": "N s/m"},
    )


def _findings(ratio: float, found: pd.DataFrame) -> tuple[Finding, ...]:
    wide = found.pivot(index="speed", columns="form", values="pinion radial velocity")
    change = 100.0 * (wide["as printed"] / wide["corrected form"] - 1.0)
    at = float(change.abs().idxmax())
    return (
        Finding(
            "Mesh damping is 2 zeta sqrt(k I_p I_g / (r_p² I_p + r_g² I_g)).",
            Verdict.of(abs(ratio - 1.0) < LEAST),
            ratio,
            "",
            f"times that of the damping ratio which it states: 0.1 acts as {_RATIO * ratio:.3f}",
            "The base radii are swapped: the mass of the mesh's motion is "
            "I_p I_g / (r_p² I_g + r_g² I_p). Units do not show it.",
        ),
        Finding(
            "The mesh damping is one of the most important parameters.",
            Verdict.CANNOT_BE_TESTED,
            float(change[at]),
            "%",
            f"at most, change of the pinion's radial velocity by the printed form ({at:.0f} r/min; "
            "800 to 1500 r/min)",
            "No curve of the thesis is published whose decay could be read.",
            margin=0.1,
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Levels over speed by both forms."""
    from herringbone.thesis.panels import level_panels  # noqa: PLC0415 (matplotlib: lazy)

    title = "200 N m, f_A 0: mesh damping as it should be and as printed"
    panels = level_panels(title, tables["levels"], "speed", _SHOWN, "speed [r/min]", "form")
    return {"levels": panels}


ENTRY = Entry(
    name="mesh_damping",
    group="dynamics",
    title="Two forms of the mesh damping",
    source="chapter 3.3.1",
    shows="Mesh damping from a damping ratio, the mesh stiffness, inertias and base radii.",
    compute=compute,
    draw=draw,
    seconds=1.0,
)
