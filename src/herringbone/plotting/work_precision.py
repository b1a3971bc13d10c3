"""The picture of a speed-accuracy chart: error against passes and against time."""

import math
from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpecFromSubplotSpec
from PIL import Image

from herringbone.analysis.accuracy.variant_labels import variant_labels
from herringbone.analysis.accuracy.work_precision import MARKS, Point, WorkPrecision
from herringbone.plotting.style import COLOURS, MARKER_COLOUR, new_figure, styled

LEVEL = 1e-3
"""Error at which the legend compares steps [1]."""
_FAMILY_COLOURS = tuple(COLOURS[i] for i in (0, 1, 2, 3, 6, 5, 4, 7))
_VARIANTS: tuple[dict[str, Any], ...] = (
    {"marker": "o", "linestyle": "-"},
    {"marker": "s", "linestyle": (0, (5, 1.5))},
    {"marker": "^", "linestyle": (0, (1.2, 1.2))},
    {"marker": "D", "linestyle": (0, (5, 1.5, 1, 1.5))},
    {"marker": "v", "linestyle": (0, (8, 2))},
)
_WIDTH, _ROW, _LEGEND = 12.8, 0.15, 3.15  # inch
_PALETTE = 96
_PARTS = {
    "native": "native FMUs",
    "python": "Python FMUs",
    "in-process": "parts in process, without FMU",
}
Cost = Callable[[Point], float]


def _looks(algorithms: tuple[str, ...]) -> dict[str, dict[str, Any]]:
    """One colour per algorithm, one marker and dash per variant."""
    families = list(dict.fromkeys(a.partition(":")[0] for a in algorithms))
    seen = dict.fromkeys(families, 0)
    found = {}
    for algorithm in algorithms:
        family = algorithm.partition(":")[0]
        colour = _FAMILY_COLOURS[families.index(family) % len(_FAMILY_COLOURS)]
        found[algorithm] = {"color": colour, **_VARIANTS[seen[family] % len(_VARIANTS)]}
        seen[family] += 1
    return found


def write_chart(found: WorkPrecision, file: str | Path) -> None:
    """Write the picture as PNG with few colours, a third of the usual size."""
    buffer = BytesIO()
    chart_picture(found).savefig(buffer, format="png")
    Image.open(buffer).convert("RGB").quantize(_PALETTE).save(file, optimize=True)


@styled
def chart_picture(found: WorkPrecision) -> Figure:
    """Draw error against passes and against time, failures above, the Pareto front marked.

    Time is that of the processor, or of the clock where parts may run in child processes.
    """
    title = (
        f"{found.system}, {found.scene}: error against the monolithic twin over "
        f"{1e3 * found.t_end:g} ms\n"
    )
    details = (
        f"{_PARTS.get(found.fmu, found.fmu)}, {found.mode_count} housing modes, shortest "
        f"micro step {found.micro_step * 1e6:g} µs"
    )
    figure = new_figure(title, 1, 2, width=_WIDTH, gap=0.65)
    failing = [a for a in found.algorithms if any(p.failed for p in found.of(a))]
    strip = _ROW * max(len(failing), 1)
    height = 5.6 + strip
    figure.set_size_inches(_WIDTH, height)
    figure.subplots_adjust(
        left=0.8 / _WIDTH,
        right=1.0 - _LEGEND / _WIDTH,
        bottom=0.5 / height,
        top=1.0 - 0.8 / height,
    )
    figure.text(0.01, 1.0 - 0.32 / height, details, va="top", fontsize=8.5)
    grid = figure.add_gridspec(1, 2)
    looks = _looks(found.algorithms)
    panels: tuple[tuple[Cost, str], ...] = (
        (lambda p: p.passes_per_ms, "passes (doStep calls per part) per simulated ms [1/ms]"),
        (lambda p: p.wall_per_ms, "wall time of the loop per simulated time [ms/ms]")
        if found.foreign
        else (lambda p: p.cpu_per_ms, "CPU time of the loop per simulated time [ms/ms]"),
    )
    axes: list[Axes] = []
    for column, (cost, label) in enumerate(panels):
        inner = GridSpecFromSubplotSpec(
            2, 1, grid[column], height_ratios=[strip, 4.2], hspace=0.015
        )
        axes.append(figure.add_subplot(inner[1]))
        _draw_errors(axes[-1], found, cost, looks)
        axes[-1].set_xlabel(label)
        above = figure.add_subplot(inner[0], sharex=axes[-1])
        _draw_failures(above, found, failing, cost, looks)
        above.set_title("failed: ended early, or error > 100 %", fontweight="normal", fontsize=8.0)
    axes[0].set_ylabel("relative error, worst channel group [1]")
    axes[1].sharey(axes[0])
    _mark_real_time(axes[1])
    _legend(figure, axes[0], found)
    return figure


def _draw_errors(axes: Axes, found: WorkPrecision, cost: Cost, looks: dict[str, dict]) -> None:
    axes.set_xscale("log")
    axes.set_yscale("log")
    labels = variant_labels(found.algorithms)
    front = found.front(cost)
    axes.plot(
        [cost(p) for p in front],
        [p.worst for p in front],
        color="#F0E442",
        linewidth=7.0,
        alpha=0.75,
        solid_joinstyle="round",
        solid_capstyle="round",
        label="Pareto front",
        zorder=1.5,
    )
    for algorithm in found.algorithms:
        good = [p for p in found.of(algorithm) if not p.failed]
        reach = found.reach(algorithm, LEVEL)
        step = f"{reach.mark}{reach.step * 1e6:.3g} µs" if reach else "none"
        axes.plot(
            [cost(p) for p in good],
            [p.worst for p in good],
            markersize=4.5,
            markeredgecolor="white",
            markeredgewidth=0.4,
            label=f"{labels[algorithm]}  ({step})",
            **looks[algorithm],
        )
    axes.axhline(LEVEL, color=MARKER_COLOUR, linewidth=0.9, linestyle=(0, (2, 2)), zorder=1)
    axes.annotate(
        f"{100 * LEVEL:g} %", (0.995, LEVEL), xycoords=("axes fraction", "data"),
        xytext=(0, 2), textcoords="offset points", ha="right", fontsize=8, color=MARKER_COLOUR,
    )  # fmt: skip
    axes.set_ylim(_decade_below([p.worst for p in found.points if not p.failed]), 1.0)
    costs = [cost(p) for p in found.points if np.isfinite(cost(p))]
    axes.set_xlim(min(costs) / 1.7, max(costs) * 1.15)


def _decade_below(errors: Sequence[float]) -> float:
    """The power of ten below the smallest error that is not zero, and below LEVEL."""
    return 10.0 ** math.floor(math.log10(min([0.1 * LEVEL, *(e for e in errors if e > 0.0)])))


def _draw_failures(
    axes: Axes, found: WorkPrecision, failing: list[str], cost: Cost, looks: dict[str, dict]
) -> None:
    """One row of crosses per algorithm that fails somewhere, with the steps [us]."""
    labels = variant_labels(found.algorithms)
    for row, algorithm in enumerate(failing):
        bad = [p for p in found.of(algorithm) if p.failed and np.isfinite(cost(p))]
        colour = looks[algorithm]["color"]
        axes.plot([cost(p) for p in bad], [row] * len(bad), "x", color=colour, markersize=5)
        for side, p in zip(("right", "left"), sorted(bad, key=cost), strict=False):
            axes.annotate(
                f"{p.step * 1e6:.3g} µs", (cost(p), row), xytext=(-5 if side == "right" else 5, 0),
                textcoords="offset points", ha=side, va="center", fontsize=6.5, color=colour,
            )  # fmt: skip
        axes.annotate(
            labels[algorithm], (0.995, row), xycoords=("axes fraction", "data"),
            ha="right", va="center", fontsize=6.5, color=colour,
        )  # fmt: skip
    axes.set_ylim(max(len(failing), 1) - 0.4, -0.6)
    axes.set_yticks([])
    axes.tick_params(axis="x", which="both", bottom=False, labelbottom=False)
    axes.set_facecolor("#F6F6F6")
    axes.spines[["left", "bottom"]].set_visible(False)


def _mark_real_time(axes: Axes) -> None:
    least, most = axes.get_xlim()
    if not least < 1.0 < most:
        return
    axes.axvline(1.0, color=MARKER_COLOUR, linewidth=0.9, linestyle=(0, (2, 2)), zorder=1)
    axes.annotate(
        "real time", (1.0, 0.01), xycoords=("data", "axes fraction"), xytext=(-3, 2),
        textcoords="offset points", ha="right", rotation=90, fontsize=8, color=MARKER_COLOUR,
    )  # fmt: skip


def _legend(figure: Figure, axes: Axes, found: WorkPrecision) -> None:
    """Right of the panels, where it covers no data."""
    handles, labels = axes.get_legend_handles_labels()
    reached = [found.reach(algorithm, LEVEL) for algorithm in found.algorithms]
    marks = {reach.mark for reach in reached if reach}
    said = [f"{mark} {meaning}" for mark, meaning in MARKS.items() if mark in marks]
    title = f"algorithm  (largest step for {100 * LEVEL:g} %)"
    legend = figure.legend(
        handles,
        labels,
        loc="upper left",
        bbox_to_anchor=(1.0 - (_LEGEND - 0.1) / _WIDTH, axes.get_position().y1),
        borderaxespad=0.0,
        handlelength=3.2,
        labelspacing=0.55,
        title="\n".join((title, *said)),
        alignment="left",
    )
    legend.get_title().set_fontsize(8.5)
