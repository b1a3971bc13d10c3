"""The chart of a plan: error against cost over joint choices of model and solver."""

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from herringbone.plotting.style import COLOURS, MARKER_COLOUR, legend_beside, new_figure, styled

if TYPE_CHECKING:
    from herringbone.studies.planning.plan import Plan

_MARKERS = "osv^D<>pPX*h"


@styled
def plan_chart(plan: "Plan") -> Figure:
    """One curve per model, over the tolerance of the solver; its floor is what it leaves out.

    The Pareto front is drawn through what no other choice beats, and the choice is ringed.

    Args:
        plan: with joint choices.
    """
    figure = new_figure(f"{plan.system}, {plan.scene.name}: error against cost", 1, 1, width=12.5)
    figure.subplots_adjust(right=0.66)
    axes = figure.add_subplot(1, 1, 1)
    for k, model in enumerate(dict.fromkeys(joint.model for joint in plan.joint)):
        own = [joint for joint in plan.joint if joint.model == model]
        colour = COLOURS[k % len(COLOURS)]
        costs, errors = ([1e3 * j.cost for j in own], [j.error for j in own])
        axes.plot(costs, errors, color=colour, marker=_MARKERS[k % len(_MARKERS)], label=model)
        if own[0].floor:
            axes.axhline(own[0].floor, color=colour, linewidth=0.6, linestyle=":")
        if model == plan.choice.name:
            near = min(own, key=lambda joint: abs(joint.tolerance - plan.tolerance))
            axes.plot(
                1e3 * near.cost, near.error, "o", markersize=16, markerfacecolor="none",
                markeredgecolor=MARKER_COLOUR, markeredgewidth=2, label="choice",
            )  # fmt: skip
    front = sorted((joint.cost, joint.error) for joint in plan.joint)
    best = [(c, e) for k, (c, e) in enumerate(front) if all(e < other for _, other in front[:k])]
    axes.plot([1e3 * c for c, _ in best], [e for _, e in best], color=MARKER_COLOUR, linewidth=4,
              alpha=0.3, label="Pareto front", zorder=0)  # fmt: skip
    tolerance = min(question.tolerance for question in plan.questions)
    axes.axhline(tolerance, color=MARKER_COLOUR, linestyle="--", label="tolerance")
    axes.set(xscale="log", yscale="log", xlabel="CPU time of an answer [ms]", ylabel="error [1]")
    legend_beside(axes)
    return figure
