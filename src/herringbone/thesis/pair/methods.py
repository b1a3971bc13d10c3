"""The mesh stiffness by slices, coupled slices, finite elements and ISO 6336-1."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.gears import MeshStiffness
from herringbone.gears.stiffness.methods import mesh_stiffness
from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.pair.finite_elements import TORQUES, by_elements, loads
from herringbone.thesis.pair.given import JOB
from herringbone.thesis.pair.periods import two_periods
from herringbone.thesis.trends import LEAST

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PUBLISHED = 2.011e9
"""Mesh stiffness without modification [N/m]."""
WITHIN = 0.02
"""Share by which a mean stiffness may differ and is the same."""
_SHOWN = 2000.0
_FE, _COUPLED, _SLICES, _ISO = "finite elements", "coupled slices", "plain slices", "ISO 6336-1"
_COLUMNS = {_FE: "fe", _COUPLED: "coupled_slices", _SLICES: "slices", _ISO: "iso"}


def compute() -> Outcome:
    """Means over torque, and curves over the phase at one torque."""
    found = {
        _FE: by_elements(),
        _COUPLED: _by("coupled-slices"),
        _SLICES: _by("slices"),
    }
    at = TORQUES.index(_SHOWN) + 1
    means = {name: 2.0 * one.secant[1:].mean(axis=1) for name, one in found.items()}
    means[_ISO] = np.array([_iso(torque) for torque in TORQUES])
    curves = {_COLUMNS[name]: 2.0 * one.secant[at] for name, one in found.items()}
    over_torque = table(
        {"torque": TORQUES, **{_COLUMNS[name]: mean for name, mean in means.items()}},
        {"torque": "N.m", **dict.fromkeys(_COLUMNS.values(), "N/m")},
    )
    over_phase = table(
        {"phase": by_elements().phases, **curves},
        {"phase": "mesh periods", **dict.fromkeys(curves, "N/m")},
    )
    return Outcome(
        {"over_torque": over_torque, "over_phase": over_phase, "harmonics": _harmonics(found, at)},
        _findings(over_torque, over_phase),
    )


def _by(method: str) -> MeshStiffness:
    return mesh_stiffness(replace(JOB.task(), loads=loads()), method)


def _iso(torque: float) -> float:
    """Mean stiffness normal to the flanks, with the factor of low loads [N/m]."""
    return JOB.pair.iso6336_stiffness(torque / JOB.pair.reference_radius[0]).normal


def _harmonics(found: dict[str, MeshStiffness], at: int) -> pd.DataFrame:
    shares = {_COLUMNS[n]: 100.0 * one.harmonics()[at, :4] for n, one in found.items()}
    return table({"mesh_harmonic": [1, 2, 3, 4], **shares}, dict.fromkeys(shares, "%"))


def torque_of(stiffness: float, torques: np.ndarray, means: np.ndarray) -> float:
    """Torque [N m] at which a mean stiffness is reached; it grows with torque."""
    return float(np.exp(np.interp(stiffness, means, np.log(torques))))


def _findings(over_torque: pd.DataFrame, over_phase: pd.DataFrame) -> tuple[Finding, ...]:
    torques, fe = over_torque["torque"].to_numpy(), over_torque["fe"].to_numpy()
    reached = torque_of(PUBLISHED, torques, fe)
    low, high = (torque_of(PUBLISHED * (1.0 + w), torques, fe) for w in (-WITHIN, WITHIN))
    at_200 = 100.0 * (fe[TORQUES.index(200.0)] / PUBLISHED - 1.0)
    apart = 100.0 * np.abs(over_torque["coupled_slices"] / fe - 1.0).max()
    ripple = 100.0 * np.ptp(over_phase["fe"]) / over_phase["fe"].mean()
    iso = 100.0 * (over_torque["iso"].max() / PUBLISHED - 1.0)
    width = 1e3 * JOB.pair.face_width
    return (
        Finding(
            "The mesh stiffness without modification is 2.011·10⁹ N/m.",
            Verdict.NEEDS_AN_ASSUMPTION,
            reached,
            "N m",
            f"at the pinion, where finite elements reach it; within 2 % from {low:.0f} to "
            f"{high:.0f} N m",
            f"The thesis states neither the torque nor the face width. With {width:g} mm per half "
            f"ISO 6336-1, method B, is {iso:+.1f} % from it; finite elements are {at_200:+.1f} % "
            "from it at the 200 N m of the thesis' dynamics.",
            margin=5.0,
        ),
        Finding(
            "High-quality hexahedral meshing is required for an accurate mesh stiffness.",
            Verdict.of(apart > 100.0 * WITHIN),
            apart,
            "%",
            "at most between coupled slices, in a second, and finite elements, in the mean from "
            f"{TORQUES[0]:g} to {TORQUES[-1]:g} N m",
            "Mesh harmonics differ more; see the table.",
            margin=0.02,
        ),
        Finding(
            "The mesh stiffness varies periodically, which excites vibration.",
            Verdict.of(ripple > 100.0 * LEAST),
            ripple,
            "%",
            f"of the mean, peak to peak at {_SHOWN:g} N m by finite elements",
        ),
    )


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Over the phase, and the mean over torque with the thesis' figure."""
    from herringbone.plotting.style import COLOURS, new_figure  # noqa: PLC0415 (lazy)

    phases, torques = tables["over_phase"], tables["over_torque"]
    figure = new_figure("Mesh stiffness by four methods", 1, 2)
    left, right = figure.subplots(1, 2)
    for colour, (name, column) in zip(COLOURS, _COLUMNS.items(), strict=False):
        if column in phases:
            left.plot(*two_periods(phases["phase"], 1e-9 * phases[column]), color=colour)
        right.semilogx(
            torques["torque"], 1e-9 * torques[column], "o-", markersize=3.0, color=colour,
            label=name,
        )  # fmt: skip
    left.set(
        title=f"Both halves at {_SHOWN:g} N m", xlabel="phase [mesh periods]",
        ylabel="k [10⁹ N/m]", xlim=(0.0, 2.0),
    )  # fmt: skip
    right.axhspan(
        1e-9 * PUBLISHED * (1.0 - WITHIN), 1e-9 * PUBLISHED * (1.0 + WITHIN), color="#EEEEEE",
        label="thesis ±2 %",
    )  # fmt: skip
    right.axhline(1e-9 * PUBLISHED, color="black", linestyle=":")
    right.set(title="Mean", xlabel="torque of the pinion [N m]", ylabel="k [10⁹ N/m]")
    right.legend(loc="lower right")
    return {"methods": figure}


ENTRY = Entry(
    name="stiffness_by_methods",
    group="pair",
    title="The mesh stiffness by four methods, and its 2.011·10⁹ N/m",
    source="chapters 2.2 and 2.4",
    shows="A mesh of hexahedra and contact analysis; 2.011·10⁹ N/m without modification, at a "
    "torque that is not stated. Meshing of high quality is said to be required.",
    compute=compute,
    draw=draw,
    seconds=8.0,
)
