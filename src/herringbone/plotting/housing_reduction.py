"""Picture of a reduced housing beside the full one: receptance, error, static stiffness."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from herringbone.core.declaring.roles import HALVES
from herringbone.plotting.style import COLOURS, ShownFigure, styled

_WIDTH, _HEIGHT = 12.0, 7.0
_AXES = "xyz"


@styled
def reduction_picture(
    frequency_hz: np.ndarray,
    full: np.ndarray,
    reduced: np.ndarray,
    static: tuple[np.ndarray, np.ndarray],
    errors: np.ndarray,
    bound: float,
    oscillators: tuple[int, int],
) -> Figure:
    """Draw a comparison.

    Args:
        frequency_hz: (f,) [Hz].
        full, reduced: receptance at the seats (f, 12, 12) [m/N].
        static: compliance at 0 Hz of the full and of the reduced data (12, 12) [m/N].
        errors: (f, 12) at drive points, relative to static compliance [1].
        bound: certified bound of the errors at the highest frequency [1].
        oscillators: of the full and of the reduced data.
    """
    figure = ShownFigure(figsize=(_WIDTH, _HEIGHT), layout="constrained")
    axes = figure.subplots(2, 3)
    panels = [axes[0, 0], axes[0, 1], axes[1, 0], axes[1, 1]]
    for n, (ax, seat) in enumerate(zip(panels, HALVES, strict=True)):
        for k, axis in enumerate(_AXES):
            at = 3 * n + k
            drive = (np.abs(data[:, at, at]) * 1e9 for data in (full, reduced))
            ax.plot(frequency_hz, next(drive), color=COLOURS[k], alpha=0.45, linewidth=2.4)
            ax.plot(frequency_hz, next(drive), color=COLOURS[k], label=axis, linewidth=1.0)
        ax.set(xscale="log", yscale="log", title=f"{seat.replace('_', ' ').capitalize()}, |s/f|")
        ax.set_ylabel("receptance [µm/kN]")
        _label_frequencies(ax)
    panels[0].legend(title="direction", loc="lower left")
    _draw_errors(axes[0, 2], frequency_hz, errors, bound)
    _draw_stiffness(axes[1, 2], *static)
    figure.suptitle(
        f"{oscillators[0]} oscillators (wide) reduced to {oscillators[1]} (narrow)", x=0.01,
        ha="left",
    )  # fmt: skip
    return figure


def _label_frequencies(ax: Axes) -> None:
    """Whole numbers at 1, 2, 5 of each decade; a decade and a half has too few powers of ten."""
    ax.set_xlabel("frequency [Hz]")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter(NullFormatter())


def _draw_errors(ax: Axes, frequency_hz: np.ndarray, errors: np.ndarray, bound: float) -> None:
    shown = np.maximum(errors.max(axis=1), 1e-10)
    ax.plot(frequency_hz, 100.0 * shown, label="largest of 12 directions")
    if bound > 0.0:
        ax.axhline(
            100.0 * bound, color=COLOURS[1], linestyle="--", label="certified up to the band"
        )
    ax.set(xscale="log", yscale="log", title="Error over static compliance")
    ax.set_ylabel("error [%]")
    _label_frequencies(ax)
    ax.legend(loc="lower right")


def _draw_stiffness(ax: Axes, full: np.ndarray, reduced: np.ndarray) -> None:
    names = [f"{seat.replace('_', ' ')} {axis}" for seat in HALVES for axis in _AXES]
    at = np.arange(len(names))
    for shift, compliance, label in ((-0.2, full, "full"), (0.2, reduced, "reduced")):
        ax.barh(at + shift, 1e-6 / np.diag(compliance), 0.4, label=label)
    ax.set_yticks(at, names)
    ax.invert_yaxis()
    ax.set(title="Static stiffness", xlabel="stiffness [N/µm]")
    ax.set_xlim(right=1.4 * ax.get_xlim()[1])
    ax.legend(loc="upper right")
