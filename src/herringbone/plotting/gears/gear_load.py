"""Picture of a loaded pair: pressure on its flanks, transmission error, stiffness of the halves."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from herringbone.core.declaring.roles import SIDES
from herringbone.gears.load.figures import Loaded
from herringbone.gears.load.flank_load import MEANS, axial_position
from herringbone.plotting.style import HALF_STYLE, ShownFigure, legend, legend_beside, styled

_MM, _UM, _MPA, _N_UM = 1e3, 1e6, 1e-6, 1e-6
_AROUND = 5.001
"""Torques whose transmission error is drawn, over the pair's or under it."""


@styled
def gear_load_picture(loaded: Loaded, title: str) -> Figure:
    """Draw the figures of a loaded pair.

    Args:
        loaded: figures.
        title: of the figure; torque and symmetry deviation are added.
    """
    figure = ShownFigure(figsize=(14.0, 7.4), layout="constrained")
    figure.suptitle(f"{title}: {_conditions(loaded)}", x=0.01, ha="left", fontweight="bold")
    above, below = figure.subfigures(2, 1, squeeze=False)[:, 0]
    _flanks(above, loaded)
    curves, torques, halves = below.subplots(1, 3)
    _transmission_error(curves, loaded)
    _over_torque(torques, loaded)
    _halves(halves, loaded)
    return figure


def write_gear_load_picture(loaded: Loaded, title: str, file: str | Path) -> None:
    """Write the picture.

    Raises:
        HerringboneError: it cannot be written.
    """
    gear_load_picture(loaded, title).savefig(file)


def _conditions(loaded: Loaded) -> str:
    text = f"{loaded.pair.torque:.6g} N m"
    symmetry = loaded.conditions.symmetry
    if symmetry is None:
        return text
    held = symmetry.pinion_axial_stiffness
    how = "floating" if held == 0.0 else "rigid" if np.isinf(held) else f"held by {held:g} N/m"
    return f"{text}, f_A = {_UM * symmetry.deviation:g} µm, pinion axially {how}"


def _flanks(figure: SubFigure, loaded: Loaded) -> None:
    """Contact pressure of both halves, as they lie on the pair."""
    panels = figure.subplots(1, len(loaded.flanks), sharey=True, squeeze=False)[0]
    most = max(float(flank.pressure.max()) for flank in loaded.flanks)
    for side, (axes, flank) in enumerate(zip(panels, loaded.flanks, strict=True)):
        axial = _MM * axial_position(loaded.pair.pair, side, flank.face)
        order = np.argsort(-axial)
        map_ = axes.pcolormesh(
            axial[order], _MM * flank.path, _MPA * flank.pressure[:, order],
            cmap="viridis", vmin=0.0, vmax=_MPA * most, shading="gouraud", rasterized=True,
        )  # fmt: skip
        name = f" {SIDES[side]}" if len(loaded.flanks) == 2 else ""
        largest = _MPA * flank.largest_pressure
        axes.set(
            title=f"Contact pressure{name}, at most {largest:.0f} MPa at a point",
            xlabel="axial, from the middle of the pair [mm]",
            xlim=(axial.max(), axial.min()),
        )
        axes.grid(visible=False)
    panels[0].set_ylabel("path of contact, A to E [mm]")
    figure.colorbar(map_, ax=panels, label=f"MPa, {MEANS}", pad=0.01)


def _transmission_error(axes: Axes, loaded: Loaded) -> None:
    """About its mean over two mesh periods, at torques around that of the pair."""
    own = loaded.pair.torque
    near = [pair for pair in loaded.torques if own / _AROUND <= pair.torque <= _AROUND * own]
    pairs = {round(pair.torque, 6): pair for pair in (*near, loaded.pair)}
    for torque, pair in sorted(pairs.items()):
        error = np.tile(pair.transmission_error - pair.transmission_error.mean(), 2)
        phases = np.concatenate([pair.phases, pair.phases + 1.0])
        axes.plot(phases, _UM * error, label=f"{torque:.4g} N m")
    axes.set(
        title="Transmission error about its mean", xlabel="phase [mesh periods]",
        ylabel="on the line of action [µm]", xlim=(0.0, 2.0),
    )  # fmt: skip
    legend_beside(axes)


def _over_torque(axes: Axes, loaded: Loaded) -> None:
    """Peak to peak of the transmission error."""
    torques = [pair.torque for pair in loaded.torques]
    axes.loglog(torques, [_UM * pair.peak_to_peak for pair in loaded.torques], "o-", markersize=3)
    axes.set(
        title="Transmission error, peak to peak", xlabel="torque of the pinion [N m]",
        ylabel="[µm]",
    )  # fmt: skip


def _halves(axes: Axes, loaded: Loaded) -> None:
    """Secant stiffness of each half over two mesh periods, at the torque."""
    phases = np.concatenate([loaded.pair.phases, loaded.pair.phases + 1.0])
    for side, half in zip(SIDES, loaded.pair.halves, strict=False):
        label = f"{side}, {100.0 * np.mean(half.force) / _whole(loaded):.1f} % of the load"
        how = HALF_STYLE[f"mesh_{side}"]
        axes.plot(phases, _N_UM * np.tile(half.secant, 2), label=label, **how)
    axes.set(
        title="Secant stiffness", xlabel="phase [mesh periods]", ylabel="[N/µm]",
        xlim=(0.0, 2.0),
    )  # fmt: skip
    if len(loaded.pair.halves) == 2:
        legend(axes, 1)


def _whole(loaded: Loaded) -> float:
    """Normal forces of all halves together [N]."""
    return float(np.mean(sum(half.force for half in loaded.pair.halves)))
