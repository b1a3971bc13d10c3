"""Steps of a system as one component that follow a tolerance: condensed core, and Runge-Kutta."""

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from types import ModuleType
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.block_core.content import content_of
from herringbone.analysis.twin.block_core.form import equations_of
from herringbone.core import (
    Asked,
    ByTolerance,
    Declaration,
    Experiment,
    Remark,
    Variable,
    local,
)
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.declaring.hosting import FAILS_STEPS, HOLDS_NOW
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import inner, inner_kept
from herringbone.kernels.condensed.in_block.condensing.condense import FOUND
from herringbone.kernels.condensed.in_block.form import Form
from herringbone.kernels.condensed.in_block.leaps import core_kernels, leaper
from herringbone.kernels.condensed.in_block.places import WorkPlaces, kept_size, work_places
from herringbone.kernels.condensed.in_block.states import HOLDS, STALE
from herringbone.kernels.stepping.adaptive import (
    FIRST,
    LARGEST,
    LONGEST_STEP,
    adaptive_stepper,
    adaptive_work,
)
from herringbone.kernels.stepping.explicit import TOO_SMALL

TOLERANCE, NEXT_STEP = "tolerance", "next_inner_step"
_USUAL = 1e-3
LENGTHS = (1e-4, 1e-3 / 15.0, 5e-5, 4e-5, 2.5e-5, 1.25e-5, 1e-5)
"""Of steps of the condensed core, by rung [s]; the last one divides the usual short communication
steps, so that nothing is left in which a bend of a law would not be known."""
ROUGH = 1.0
"""See `Form`; the error of a rig is a third to twice the largest power."""
_EXPERIMENT = Experiment(stop=1.0, step=1e-3, tolerance=_USUAL)
_STABLE = 2.0
"""Of Runge-Kutta: largest eigenvalue times step; the limit is 2.8, and tangents may be steeper."""
_HIDDEN = 1e-6
"""Usual size of elements of vectors, in their units."""
_NOT_LINEAR = Remark(
    "Runge-Kutta alone integrates, at several times the CPU time of the condensed core: with these "
    "parameters the equations have no condensed form; look for stiffnesses and dampings of 0, and "
    "for parts that are not linear beside the laws they had at export"
)
_TOO_LONG = Remark(
    "micro_step = %g s: with these parameters Runge-Kutta is stable up to some %g s; make it "
    "shorter, or 0, by which inner steps follow the tolerance",
    warning=True,
)
_OTHER_PAIR = Remark(
    "parameters are not those at export by which the condensed core knows what to look at closely, "
    "as teeth, base radii and helix of a gear pair: it may err ten times the tolerance; export "
    "it with these values, or set micro_step"
)
_APART = 10.0
"""Relative difference of parameters by which directions err, over the tolerance: errors are 7e-3
where they differ by 0.2, and such a difference moves them by a third of the tolerance."""
_LIMIT, _DOUBTFUL = 2.785, 0.7
"""Of Runge-Kutta: eigenvalue times step beyond which something grows, be it a decay (Hairer and
Wanner, Solving Ordinary Differential Equations II, 1996, section IV.2); and a share of it beyond
which steeper tangents than the mean ones may do."""
_REMARK = """

DIRECTED_BY = {directed_by}
DIRECTED_AT = {directed_at}


@kernel
def longest_inner_step(b: np.ndarray, w: np.ndarray) -> float:
    if b[{micro_step}] > 0.0:
        return b[{micro_step}]
    if w[{status}] != {found}:
        return {without_form!r}
    return min({longest!r}, {stable!r} / w[{fastest}])


@kernel
def remark(b: np.ndarray, w: np.ndarray, which: int, report: np.ndarray) -> int:
    micro_step = b[{micro_step}]
    if which == 0:
        return {holds} if w[{status}] < 0.0 and micro_step == 0.0 else 0
    if w[{status}] <= 0.0:
        return 0
    if which == 2:
        for i in range({directed}):
            value = DIRECTED_AT[i]
            if abs(b[DIRECTED_BY[i]] - value) > {apart} * b[{tolerance}] * abs(value):
                return {holds} if micro_step == 0.0 else 0
        return 0
    report[0], report[1] = micro_step, {limit} / w[{fastest}]
    if micro_step > report[1]:
        return {holds} | {causes}
    return {causes} if micro_step > {doubtful} * report[1] else 0
"""


class Stepping(NamedTuple):
    """How a system as one component steps.

    Attributes:
        form: in which it is condensed.
        at: places in the work space.
        micro_step: of Runge-Kutta where there is no condensed form [s].
    """

    form: Form
    at: WorkPlaces
    micro_step: float


def stepping(form: Form, inputs: int, micro_step: float) -> Stepping:
    """Places for a form whose host gives so many inputs."""
    return Stepping(form, work_places(form, adaptive_work(form.states, inputs)), micro_step)


def locals_of(found: Stepping) -> tuple[list[Variable], int]:
    """Hidden locals, and the length of what else the steps go on with."""
    tolerance = replace(local(TOLERANCE, "1", "of inner steps"), start=_USUAL)
    following = replace(local(NEXT_STEP, "s", "length of the next inner step"), start=FIRST)
    return [tolerance, following], kept_size(found.form)


def by_tolerance(module: ModuleType) -> ByTolerance:
    """What the wrapper hands over and tells."""
    return ByTolerance(TOLERANCE, _EXPERIMENT, (_NOT_LINEAR, _TOO_LONG, _OTHER_PAIR), module.remark)


def remark_source(
    found: Stepping, micro_step: int, tolerance: int, directed: Mapping[int, float]
) -> str:
    """Source of the kernels of the remarks and of the longest inner step [s].

    Native code is kept by this source, so that the micro step that is compiled in stands in it.

    Args:
        found: how the system steps.
        micro_step: the parameter's place in the block.
        tolerance: place of the local.
        directed: values at export of the parameters that `Form.sharp` follows from, by place.
    """
    places = dict(directed) or {0: 0.0}  # a kernel has no empty tuples
    return _REMARK.format(
        without_form=float(found.micro_step),
        found=float(FOUND),
        longest=LARGEST,
        stable=_STABLE,
        micro_step=micro_step,
        tolerance=tolerance,
        directed=len(directed),
        directed_by=tuple(places),
        directed_at=tuple(places.values()),
        apart=_APART,
        status=found.at.status,
        fastest=found.at.fastest,
        limit=_LIMIT,
        doubtful=_DOUBTFUL,
        holds=HOLDS_NOW,
        causes=FAILS_STEPS,
    )


def longest_step(declaration: Declaration, micro_step: str) -> Callable[[np.ndarray], float]:
    """Compile the longest step [s] of one call, by the micro step if there is one."""
    of_micro_steps = steppers.longest_step(declaration, micro_step)

    @inner(declaration.name)
    def longest(b: np.ndarray) -> float:
        found = of_micro_steps(b)
        return found if found > 0.0 else LONGEST_STEP

    return longest


def step_kernel(
    declaration: Declaration, module: ModuleType, found: Stepping, micro_step: str
) -> tuple[Callable, Asked]:
    """Compile the step of a component, and how its native FMU makes outputs.

    Args:
        declaration: of the component.
        module: its kernels.
        found: how it steps.
        micro_step: name of the parameter that, above 0, asks for Runge-Kutta alone.
    """
    d, at = declaration, found.at
    kept, refresh = d.first_kept, module.refresh
    sizes = (*(v.nominal for v in d.states), *(_HIDDEN,) * d.hidden_states)
    equations = equations_of(d, module, sizes, kept)

    core = core_kernels(found.form, at, equations)
    ready = core.ready
    micro_at, tolerance, degree = d.indices(micro_step, TOLERANCE, INTERFACE_DEGREE)
    following = d.index[NEXT_STEP]

    def stepper(decorate: Callable, *, later: bool) -> Callable:
        by_core = adaptive_stepper(
            module.system_rhs,
            module.system_out,
            d,
            NEXT_STEP,
            module.longest_inner_step,
            partial(leaper, found.form, at, equations, core),
            LENGTHS[-1],
            later=later,
        )

        @decorate
        def step(b, w, t, h):  # noqa: ANN001, ANN202 (the contract of all steps)
            if w[at.status] == 0.0:  # parameters may have changed
                refresh(b)
            within, micro = b[tolerance], b[micro_at]
            if micro > 0.0:
                if not h <= steppers.MOST_MICRO_STEPS * micro:
                    return steppers.TOO_LONG
                within, b[following] = np.inf, micro
            status = by_core(b, w, t, h, within, int(b[degree]))
            return steppers.NOT_FINITE if status == TOO_SMALL and micro > 0.0 else status

        return step

    asked, everything = core.shown

    @inner(d.name)
    def answer(b, w, t, references, count):  # noqa: ANN001, ANN202 (see `Asked`)
        if w[at.status] == 0.0:
            refresh(b)
            ready(b, w, t)
        if b[kept + HOLDS] == 0.0 or b[kept + STALE] == 0.0:
            return
        if count > 0:
            asked(b, w, t, references, count)
        else:
            everything(b, w, t)

    content = content_of(d, module, found, sys.modules[__name__])
    own = stepper(inner_kept(d.name, content), later=False)
    return own, Asked(stepper(inner(d.name), later=True), answer, kept + STALE)
