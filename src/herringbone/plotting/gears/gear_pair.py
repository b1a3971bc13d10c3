"""Picture of a gear pair: teeth in mesh, contact lines in the plane of action, mesh stiffness."""

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.gears import GearPair
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.plotting.style import (
    COLOURS,
    MARKER_COLOUR,
    ShownFigure,
    legend,
    legend_beside,
    styled,
)

_MM = 1e3
_PINION, _WHEEL, _PATH = COLOURS[0], COLOURS[1], COLOURS[2]
_SHOWN_TEETH = range(-1, 3)
_SHOWN_LOADS = 4


@styled
def gear_pair_picture(stiffness: MeshStiffness, title: str) -> Figure:
    """Draw a pair and its mesh stiffness.

    Args:
        stiffness: of the pair.
        title: of the figure.
    """
    figure = ShownFigure(figsize=(14.0, 4.8), layout="constrained")
    figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
    teeth, lines, curves = figure.subplots(1, 3, width_ratios=(1.25, 1.0, 1.15))
    _teeth(teeth, stiffness.pair)
    _contact_lines(lines, stiffness.pair)
    _curves(curves, stiffness)
    return figure


def write_gear_pair_picture(stiffness: MeshStiffness, title: str, file: str | Path) -> None:
    """Write the picture.

    Raises:
        HerringboneError: it cannot be written.
    """
    gear_pair_picture(stiffness, title).savefig(file)


def _teeth(axes: Axes, pair: GearPair) -> None:
    """Transverse section, seen along the axis; the pitch point is the origin."""
    centres = (-pair.pitch_radius[0], pair.pitch_radius[1])
    for gear, colour in enumerate((_PINION, _WHEEL)):
        x, y = _outline(pair, gear)
        axes.plot(_MM * x, _MM * (y + centres[gear]), color=colour, label=("pinion", "wheel")[gear])
    angle = pair.working_transverse_pressure_angle
    along = (-math.cos(angle), math.sin(angle))  # the pinion turns counter-clockwise and drives
    points = pair.path_of_contact
    ends = np.array([points.start, points.end]) - points.pitch
    axes.plot(
        _MM * ends * along[0], _MM * ends * along[1], color=_PATH, linewidth=2.0,
        label="path of contact",
    )  # fmt: skip
    axes.plot(0.0, 0.0, "o", color=MARKER_COLOUR, markersize=4.0, label="pitch point")
    reach = 2.2 * _MM * math.pi * pair.transverse_module / 2.0
    axes.set(
        title="Teeth", xlabel="tangential [mm]", ylabel="toward the wheel [mm]",
        xlim=(-reach, reach), ylim=(-0.8 * reach, 0.8 * reach), aspect="equal",
    )  # fmt: skip
    legend(axes, 4)


def _outline(pair: GearPair, gear: int) -> tuple[np.ndarray, np.ndarray]:
    """Some teeth around the pitch point, in contact there; the gear's centre is the origin."""
    profile = pair.tooth_profile(gear)
    points = profile.points
    tooth = np.vstack([points * (-1.0, 1.0), points[::-1]])
    half = profile.half_angle(pair.pitch_radius[gear])
    sign = 1.0 if gear == 0 else -1.0
    whole = []
    for number in _SHOWN_TEETH:
        turn = sign * half + (number - 0.5 * (1 + sign)) * profile.pitch_angle
        turned = np.column_stack(
            [
                tooth[:, 0] * math.cos(turn) + tooth[:, 1] * math.sin(turn),
                tooth[:, 1] * math.cos(turn) - tooth[:, 0] * math.sin(turn),
            ]
        )
        whole.append(turned)
    x, y = np.vstack(whole).T
    return (x, y) if gear == 0 else (x, -y)


def _contact_lines(axes: Axes, pair: GearPair) -> None:
    """Lines of contact of one half in the plane of action, at phase 0."""
    path, width = pair.length_of_path_of_contact, pair.face_width
    slope, pitch = math.tan(abs(pair.base_helix_angle)), pair.transverse_base_pitch
    axes.plot(
        _MM * width * np.array([0, 1, 1, 0, 0]), _MM * path * np.array([0, 0, 1, 1, 0]),
        color=MARKER_COLOUR, linewidth=0.9,
    )  # fmt: skip
    for number in range(-1, math.ceil((path + width * slope) / pitch) + 1):
        x = np.linspace(0.0, width, 400)
        s = number * pitch + (x - width) * slope
        inside = (s >= 0.0) & (s <= path)
        if inside.any():
            axes.plot(_MM * x[inside], _MM * s[inside], color=_PATH, linewidth=2.0)
    axes.set(
        title="Contact lines, phase 0", xlabel="along the face [mm]",
        ylabel="path of contact, A to E [mm]",
    )  # fmt: skip


def _curves(axes: Axes, stiffness: MeshStiffness) -> None:
    """Secant stiffness of one half over two mesh periods, at some loads."""
    phases = np.concatenate([stiffness.phases, stiffness.phases + 1.0])
    loaded = np.flatnonzero(stiffness.loads > 0.0)
    shown = loaded[np.linspace(0, loaded.size - 1, min(_SHOWN_LOADS, loaded.size)).astype(int)]
    for row in shown:
        axes.plot(
            phases,
            1e-6 * np.tile(stiffness.secant[row], 2),
            label=f"{stiffness.loads[row]:.0f} N",
        )
    axes.set(
        title="Secant mesh stiffness, one half", xlabel="phase [mesh periods]",
        ylabel="stiffness [N/µm]", xlim=(0.0, 2.0),
    )  # fmt: skip
    legend_beside(axes, "normal force")
