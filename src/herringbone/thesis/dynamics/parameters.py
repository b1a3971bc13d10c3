"""Table 3.1: the parameters that the thesis gives of its model, and what they leave open."""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import pandas as pd

from herringbone.analysis.anatomy import value_at
from herringbone.running.loading import load_system
from herringbone.thesis import names
from herringbone.thesis.dynamics.equations import (
    PUBLISHED_STIFFNESS,
    Bodies,
    corrected,
    frequencies,
    mass_matrix,
)
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.given import JOB

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOUNTING_ERROR = 8e-6
"""Of the centre distance [m]."""
_RATIO, _PLAY, _RADIAL, _AXIAL = 0.1, 180.0, 6.34e8, 2.03e8
"""Damping ratio of the mesh, normal backlash [µm], stiffness of bearings [N/m]."""
_ALIKE = 1e-6
_WHEEL_AXIAL, _WHEEL_RADIAL = 1, 2
"""Modes, by their place."""


def compute() -> Outcome:
    """The table beside what the system has, and what its readings change."""
    listed, modes, geometry = _listed(), _modes(), _geometry()
    return Outcome(
        {"parameters": listed, "natural frequencies": modes, "centre distance": geometry},
        _findings(listed, modes, geometry),
    )


def _listed() -> pd.DataFrame:
    system, _ = load_system(names.ON_GROUND)

    def of(part: str, what: str) -> float:
        return value_at(system, f"{part}.{what}")

    radial, axial = (f"{{}}.{way}_stiffness" for way in ("radial", "axial"))
    rows = [
        ("mesh damping ratio zeta", "", _RATIO, of(names.GEAR, "mesh_damping_ratio")),
        ("normal backlash 2 delta", "µm", _PLAY, 1e6 * of(names.GEAR, "backlash")),
        ("centre distance mounting error", "µm", 1e6 * _MOUNTING_ERROR, 0.0),
        ("radial bearing stiffness, pinion", "N/m", _RADIAL,
         of(names.BEARINGS, radial.format("pinion"))),
        ("radial bearing stiffness, wheel", "N/m", _RADIAL,
         of(names.BEARINGS, radial.format("wheel"))),
        ("axial bearing stiffness, pinion", "N/m", math.nan,
         of(names.BEARINGS, axial.format("pinion"))),
        ("axial bearing stiffness, wheel", "N/m", _AXIAL,
         of(names.BEARINGS, axial.format("wheel"))),
    ]  # fmt: skip
    return table(pd.DataFrame(rows, columns=["quantity", "unit", "thesis", "here"]))


def _modes() -> pd.DataFrame:
    """Lowest natural frequencies if a stiffness is that of each half, or of a whole shaft."""
    each = {
        "each half's": (1.0, 1.0),
        "axial: the shaft's": (1.0, 0.5),
        "radial: the shaft's": (0.5, 1.0),
        "both: the shaft's": (0.5, 0.5),
    }
    rows = []
    for reading, (radial, axial) in each.items():
        bodies = Bodies()
        bodies.radial = tuple(radial * k for k in bodies.radial)
        bodies.axial = tuple(axial * k for k in bodies.axial)
        found, _ = frequencies(corrected(bodies, PUBLISHED_STIFFNESS), mass_matrix(bodies))
        rows.append((reading, found[_WHEEL_AXIAL], found[_WHEEL_RADIAL]))
    columns = ["stiffness is", "wheel axial", "wheel radial"]
    return table(pd.DataFrame(rows, columns=columns), dict.fromkeys(columns[1:], "Hz"))


def _geometry() -> pd.DataFrame:
    """The pair without and with the mounting error."""
    pair = JOB.pair
    rows = []
    for error in (0.0, _MOUNTING_ERROR):
        own = replace(pair, center_distance=pair.reference_center_distance + error)
        play = 2.0 * error * math.sin(own.working_transverse_pressure_angle)
        rows.append(
            (
                1e6 * error,
                math.degrees(own.working_transverse_pressure_angle),
                own.transverse_contact_ratio,
                _PLAY + 1e6 * play * math.cos(pair.base_helix_angle),
            )
        )
    columns = ["error", "alpha_wt", "epsilon_alpha", "normal backlash"]
    units = {"error": "µm", "alpha_wt": "°", "normal backlash": "µm"}
    return table(pd.DataFrame(rows, columns=columns), units)


def _findings(
    listed: pd.DataFrame, modes: pd.DataFrame, geometry: pd.DataFrame
) -> tuple[Finding, ...]:
    given = listed[listed["thesis"].notna() & ~listed["quantity"].str.contains("mounting")]
    deviation = float((given["here"] / given["thesis"] - 1.0).abs().max())
    both, shaft = (modes.set_index("stiffness is").loc[name] for name in
                   ("each half's", "both: the shaft's"))  # fmt: skip
    without, with_error = (geometry.iloc[k] for k in (0, 1))
    play = float(with_error["normal backlash"] - without["normal backlash"])
    return (
        Finding(
            "Table 3.1 gives the parameters of the dynamic model.",
            Verdict.of(deviation < _ALIKE, assuming=True),
            len(given),
            "",
            "values of it are those of the shipped system",
            "Masses, inertias, stiffness of the gaps, damping of shafts and bearings, parts and "
            "phases of the symmetry deviation and tooth deviations are not given; ours are "
            "assumptions.",
        ),
        Finding(
            "The wheel's bearings have an axial stiffness of 2.03·10⁸ N/m.",
            Verdict.NEEDS_AN_ASSUMPTION,
            float(shaft["wheel axial"]),
            "Hz",
            "is the wheel's axial mode if that is the stiffness of its shaft, "
            f"{both['wheel axial']:.1f} Hz if it is that of each half, as shipped",
            "The thesis does not say whose it is.",
        ),
        Finding(
            "Bearings have a radial stiffness of 6.34·10⁸ N/m.",
            Verdict.NEEDS_AN_ASSUMPTION,
            float(shaft["wheel radial"]),
            "Hz",
            "is the wheel's radial mode if that is the stiffness of a shaft, "
            f"{both['wheel radial']:.1f} Hz if it is that of each half, as shipped",
            "The thesis does not say whose it is.",
        ),
        Finding(
            "The centre distance has a mounting error of 8 µm.",
            Verdict.CANNOT_BE_TESTED,
            play,
            "µm",
            f"of normal backlash more; contact ratio {with_error['epsilon_alpha']:.4f} in place of "
            f"{without['epsilon_alpha']:.4f}",
            "Where it enters is not said. Shipped is no error: it changes next to nothing.",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """No picture: the tables say it all."""
    return {}


ENTRY = Entry(
    name="table_3_1",
    group="dynamics",
    title="Table 3.1 and what it leaves open",
    source="chapter 3.4, table 3.1",
    shows="Damping ratio of the mesh, backlash, a mounting error, and stiffness of bearings: "
    "radial for both gears, axial for the wheel alone.",
    compute=compute,
    draw=draw,
    seconds=0.2,
)
