"""Shapes of coupled modes: gears and bearing seats, displaced; as pictures and as animation."""

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from herringbone.analysis.modes.natural_modes import NaturalModes
from herringbone.analysis.modes.skeleton import Skeleton, skeleton
from herringbone.core import HerringboneError
from herringbone.core.wording import percent
from herringbone.plotting.style import COLOURS, HALF_STYLE, MARKER_COLOUR, new_figure, styled

_LARGEST = 0.3
"""Drawn length of the largest displacement."""
_RADII = 0.28, 0.28, 0.42, 0.42
"""Drawn radii of pinion and wheel halves."""
_OBLIQUE = 0.55, 0.38
"""How z is drawn: to the right and up."""
_SHARES = 3
_LEAST_SHARE = 0.01
_PANEL = 3.4
"""Height [inch]."""
_FRAMES, _PERIOD_S = 24, 1.6
_SHAFTS = (0, 1), (2, 3)
_FRAME = (0, 2), (2, 3), (3, 1), (1, 0)


@styled
def mode_shapes(found: NaturalModes, chosen: Sequence[int] = (), count: int = 6) -> Figure:
    """Displaced gears (circles with a spoke) and seats (squares), each mode to its own scale.

    Schematic, see `analysis.modes.skeleton`; grey: at rest. The titles tell frequency, damping and
    who takes part.

    Args:
        found: modes.
        chosen: numbers of modes, from 1; those that answer most to the mesh if none are given.
        count: how many of these.

    Raises:
        ParameterError: nothing of the system can be drawn.
        HerringboneError: there is no such mode.
    """
    modes = _chosen(found, chosen, count)
    bones = skeleton(found)
    columns = min(3, len(modes))
    rows = -(-len(modes) // columns)
    what = "Coupled modes, schematic (blue: pinion, orange: wheel, squares: bearing seats)"
    figure = new_figure(f"{what}: {found.system.name}", rows, columns, width=13.5)
    height = 1.0 + _PANEL * rows
    figure.set_figheight(height)
    figure.subplots_adjust(left=0.02, right=0.98, top=1.0 - 0.9 / height, bottom=0.01, hspace=0.2,
                           wspace=0.05)  # fmt: skip
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes in grid.flat[len(modes) :]:
        axes.set_visible(False)
    for axes, mode in zip(grid.flat, modes, strict=False):
        _empty(axes, found, mode)
        _draw(axes, bones, mode, 0.0)
    return figure


def animate_mode(found: NaturalModes, mode: int, file: str | Path) -> None:
    """Write a GIF of one mode's motion, without its decay.

    Args:
        found: modes.
        mode: its number, from 1.
        file: to be written.

    Raises:
        ParameterError: nothing of the system can be drawn.
        HerringboneError: there is no such mode, or the file cannot be written.
    """
    (k,) = _chosen(found, (mode,), 1)
    bones = skeleton(found)
    figure = _canvas(found)
    axes = figure.subplots()

    def frame(i: int) -> list:
        axes.clear()
        _empty(axes, found, k)
        _draw(axes, bones, k, 2.0 * math.pi * i / _FRAMES)
        return []

    motion = FuncAnimation(figure, frame, frames=_FRAMES)
    try:
        motion.save(str(file), writer=PillowWriter(fps=round(_FRAMES / _PERIOD_S)))
    except OSError as error:
        raise HerringboneError(
            f"cannot write {file}: {error.strerror}; choose another folder"
        ) from error


@styled
def _canvas(found: NaturalModes) -> Figure:
    figure = new_figure(found.system.name, 1, width=5.5)
    figure.set_figheight(5.0)
    return figure


def check_numbers(found: NaturalModes, numbers: Sequence[int]) -> None:
    """Raise HerringboneError if there is no mode of one of some numbers, from 1."""
    if wrong := [n for n in numbers if not 1 <= n <= found.rates.size]:
        raise HerringboneError(
            f"there is no mode {wrong[0]}: system '{found.system.name}' has 1 to {found.rates.size}"
        )


def _chosen(found: NaturalModes, numbers: Sequence[int], count: int) -> list[int]:
    check_numbers(found, numbers)
    return [n - 1 for n in numbers] or found.largest(count, math.inf)


def _empty(axes: Axes, found: NaturalModes, mode: int) -> None:
    shares = found.participation.iloc[mode].sort_values(ascending=False)[:_SHARES]
    shares = shares[shares >= _LEAST_SHARE]
    told = ", ".join(f"{str(n).rpartition('.')[2]} {100.0 * s:.0f} %" for n, s in shares.items())
    axes.set_title(
        f"{mode + 1}: {found.frequency_hz[mode]:.1f} Hz, damping "
        f"{percent(found.damping_ratio[mode])}\n{told}", fontsize=8.5,
    )  # fmt: skip
    axes.set_axis_off()
    axes.set_aspect("equal")
    axes.set_xlim(-0.9, 2.0)
    axes.set_ylim(-0.75, 0.85)


def _draw(axes: Axes, bones: Skeleton, mode: int, phase: float) -> None:
    """The skeleton at rest in grey, and displaced at a phase of the mode."""
    moved = [x[..., mode] for x in (bones.gears, bones.seats, bones.turns) if x is not None]
    largest = max(float(np.abs(x).max(initial=0.0)) for x in moved) or 1.0
    biggest = max(moved, key=lambda x: float(np.abs(x).max(initial=0.0)))
    reference = biggest.ravel()[np.abs(biggest).argmax()]
    turn = (
        np.exp(1j * phase) * _LARGEST / largest * np.conj(reference) / max(abs(reference), 1e-300)
    )
    still = np.zeros_like(bones.places)
    seats = still if bones.seats is None else (bones.seats[..., mode] * turn).real
    gears = still if bones.gears is None else (bones.gears[..., mode] * turn).real
    spin = np.zeros(4) if bones.turns is None else (bones.turns[..., mode] * turn).real
    for offset, colour, width in ((still, "#C8C8C8", 0.9), (seats, MARKER_COLOUR, 1.8)):
        if bones.seats is not None:
            at = _screen(bones.places + offset)
            for one, other in _FRAME:
                axes.plot(*at[[one, other]].T, color=colour, linewidth=width, marker="s",
                          markersize=5.0, zorder=2)  # fmt: skip
    if bones.gears is None:
        return
    for shown, angle, faint in ((still, np.zeros(4), True), (gears, spin, False)):
        _gears(axes, bones.places + shown, angle, faint=faint)


def _gears(axes: Axes, places: np.ndarray, spin: np.ndarray, *, faint: bool) -> None:
    """Circles with a spoke, joined by their shafts."""
    at = _screen(places)
    for one, other in _SHAFTS:
        axes.plot(*at[[one, other]].T, color="#C8C8C8" if faint else COLOURS[6], linewidth=1.2,
                  zorder=3)  # fmt: skip
    around = np.linspace(0.0, 2.0 * math.pi, 60)
    for i, half in enumerate(("pinion_left", "pinion_right", "wheel_left", "wheel_right")):
        colour = "#D5D5D5" if faint else HALF_STYLE[half]["color"]
        radius = _RADII[i]
        axes.plot(at[i, 0] + radius * np.cos(around), at[i, 1] + radius * np.sin(around),
                  color=colour, linewidth=0.8 if faint else 1.5, zorder=4)  # fmt: skip
        tip = at[i] + radius * np.array([-math.sin(spin[i] / radius), math.cos(spin[i] / radius)])
        axes.plot(
            *np.array([at[i], tip]).T, color=colour, linewidth=0.8 if faint else 2.0, zorder=4
        )


def _screen(places: np.ndarray) -> np.ndarray:
    """(4, 2) of places (4, 3), seen obliquely."""
    right, up = _OBLIQUE
    return np.column_stack([places[:, 0] + right * places[:, 2], places[:, 1] + up * places[:, 2]])
