"""Pictures of which sentences hold in which reading."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Tables
from herringbone.thesis.readings.findings import RELIEF

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOURS = ("#E8A188", "#F5E3B5", "#9CCBB0")
"""Contradicts; not to be seen; holds."""
_LARGE, _WIDTH = 10.0, 17.5
_NOTHING = 5e-4
"""A margin this near to zero says that nothing changes."""


def over_assumptions(tables: Tables) -> "Figure":
    """Margins of the sentences as shipped, with one assumption changed, and where most hold."""
    from herringbone.plotting.cells import coloured_cells  # noqa: PLC0415 (matplotlib: lazy)
    from herringbone.plotting.style import new_figure  # noqa: PLC0415

    sentences, margins = tables["sentences"], tables["margins"]
    cases = margins[margins["changes"] <= 1].drop_duplicates("assumptions")
    sets = tables["smallest_sets"]
    of_motion = sets[sets["about"] != RELIEF]
    best = of_motion.groupby("about", sort=False)["case"].last().drop_duplicates()
    cases = pd.concat([cases, margins.loc[[k for k in best if k not in cases.index]]])
    values = cases[list(sentences["sentence"])].to_numpy().T
    needed = sentences["needs"].to_numpy()[:, None]
    holds = np.where(values >= needed, 2, np.where(values > -_NOTHING, 1, 0))
    figure = new_figure("", 1, width=_WIDTH)
    figure.set_size_inches(_WIDTH, 10.5)
    axes = figure.subplots()
    coloured_cells(axes, holds, _COLOURS)
    for row, column in np.ndindex(values.shape):
        axes.text(column, row, _short(values[row, column]), ha="center", va="center", fontsize=7)
    labels = [f"{t.replace('; ', chr(10))}" for t in cases["assumptions"]]
    axes.set_xticks(range(len(cases)), labels, rotation=55, ha="left", rotation_mode="anchor")
    axes.xaxis.tick_top()
    told = [f"{t} ({c})" for t, c in zip(sentences["text"], sentences["chapter"], strict=True)]
    axes.set_yticks(range(len(sentences)), told)
    for column, count in enumerate(cases["sentences"]):
        axes.text(
            column, len(sentences) - 0.3, str(count), ha="center", va="top", fontweight="bold"
        )
    axes.text(-0.6, len(sentences) - 0.3, f"hold, of {len(sentences)}", ha="right", va="top",
              fontsize=8, fontweight="bold")  # fmt: skip
    figure.suptitle(
        "Margins of the thesis' sentences, one assumption changed at a time (right: most hold). "
        "Green: holds; yellow: too little to be seen; red: the other way",
        x=0.01, ha="left", fontsize=10, fontweight="bold",
    )  # fmt: skip
    figure.subplots_adjust(left=0.31, right=0.95, top=0.79, bottom=0.03)
    return figure


def _short(value: float) -> str:
    """A margin in percent, or by how many times where it is large."""
    if abs(value) >= _LARGE:
        return f"{value + 1.0:.0f} x" if value > 0.0 else "<"
    text = f"{100.0 * value:+.0f} %" if abs(value) >= 0.1 else f"{100.0 * value:+.1f} %"
    return "0 %" if text in {"+0.0 %", "-0.0 %"} else text


def exclusions(tables: Tables) -> "Figure":
    """Which pairs of sentences never hold together."""
    from herringbone.plotting.cells import coloured_cells  # noqa: PLC0415 (matplotlib: lazy)
    from herringbone.plotting.style import new_figure  # noqa: PLC0415

    names = list(tables["sentences"]["sentence"])
    count = tables["sentences"]["cases"].to_numpy()
    matrix = np.full((len(names), len(names)), np.nan)
    pairs = tables["excluding_pairs"]
    for row in pairs[pairs["one"].isin(names)].itertuples():
        one, other = names.index(str(row.one)), names.index(str(row.other))
        matrix[one, other] = matrix[other, one] = 1.0
    figure = new_figure("Pairs of sentences that never hold in one case (red)", 2, 1, width=10.5)
    figure.set_size_inches(10.5, 9.5)
    axes = figure.subplots()
    coloured_cells(axes, matrix - 1.0, _COLOURS[:1])
    words = [name.replace("_", " ") for name in names]
    axes.set_xticks(range(len(names)), words, rotation=55, ha="right", rotation_mode="anchor")
    told = [f"{w} ({c} cases)" for w, c in zip(words, count, strict=True)]
    axes.set_yticks(range(len(names)), told)
    axes.set_xticks(np.arange(len(names)) - 0.5, minor=True)
    axes.set_yticks(np.arange(len(names)) - 0.5, minor=True)
    axes.grid(which="minor")
    axes.tick_params(length=0, which="both")
    figure.subplots_adjust(left=0.32, right=0.98, top=0.93, bottom=0.2)
    return figure
