"""Stable communication steps of an FMU whose flange a host couples to an inertia."""

import json
from dataclasses import dataclass, field, replace
from pathlib import Path
from zipfile import ZipFile

import numpy as np

from herringbone.analysis.flange.hosted_flange import Host, HostLimit, host_limits
from herringbone.analysis.flange.variables import NEEDS, Flange, asked, find_flanges
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.surrogate import PROMISED, Surrogate
from herringbone.analysis.stability.surrogates.trials import tell_cost
from herringbone.core import FmuError, ParameterError
from herringbone.core.part import Part
from herringbone.core.process.activity import activity
from herringbone.core.wording import option, percent
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature import Kind, Laboratory
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.structure.system import Values
from herringbone.fmi.packed.documentation import FLANGE_MODELS
from herringbone.running.foreign.hosted_text import hosted_text
from herringbone.running.foreign.start_inputs import start_inputs
from herringbone.running.foreign.started import own_step, started, started_content
from herringbone.running.foreign.trials import signature_of

_TRIED = (2e-4, 1e-4, 5e-5, 1e-3)
"""Steps of further trials [s], while the model is too far from the FMU: an FMU of a gearbox
proposes 1 ms, and what bounds the step of its host vibrates at kilohertz."""
_NO_MODEL = 1.0
"""Residual from which a model tells nothing: it misses by as much as there is to be told."""


@dataclass(frozen=True)
class HostedFlange:
    """What is known of an FMU at a host.

    Attributes:
        fmu: file.
        flange: its variables.
        host: what it is coupled to.
        limits: by order and schedule.
        takes_derivatives: the FMU offers derivatives of its inputs.
        order, base: of the FMU's model: number of states, and step of its trials [s]; 0: the FMU
            carries the model, of its equations.
        residual: of the model on trials that were not fitted, at the largest finite limit.
        notes: on the FMU.
    """

    fmu: Path
    flange: Flange
    host: Host
    limits: tuple[HostLimit, ...]
    takes_derivatives: bool
    order: int
    base: float
    residual: float
    notes: tuple[str, ...] = field(default=())

    @property
    def promised(self) -> bool:
        """False if the model is too far from the FMU."""
        return self.residual <= PROMISED

    def __str__(self) -> str:
        return hosted_text(self)


def hosted_flange(fmu: Path, flange: str, host: Host, values: Values | None = None) -> HostedFlange:
    """Limits of an FMU at a host.

    Args:
        fmu: file.
        flange: its port, or `tau=NAME,phi=NAME,w=NAME`, the angle may be missing; "": guessed.
        host: what it is coupled to.
        values: start values by variable.

    Raises:
        FmuError: the FMU cannot be used, or trials tell nothing of it.
        ParameterError: there is no such flange, or the host does not fit it.
    """
    with many_of(fmu.stem, fmu) as new:
        make = started(new, values or {})
        part = make()
        found = _flange_of(part, flange)
        _check(found, host)
        torque, motion = [found.tau], [name for name in (found.phi, found.w) if name]
        inputs, outputs = (torque, motion) if found.takes_torque else (motion, torque)
        step = own_step(fmu)
        takes_derivatives = bool(part.addresses.set_derivatives)
        if not values and (model := _carried(fmu, found)):
            part.close()
            limits = host_limits(model, host, takes_torque=found.takes_torque)
            return HostedFlange(fmu, found, host, limits, takes_derivatives, len(model.a), 0.0, 0.0)
        with activity(f"identifying {found.tau} of {fmu.name}"):
            start = start_inputs(part, inputs)
            content = started_content(fmu, values or {})
            signature = signature_of(part, make, step, content)
            if signature.kind is Kind.NOISY:
                raise FmuError(f"{fmu}: {signature.notes[0]}")
            tried: list[HostedFlange] = []
            for h in (step, *_TRIED):
                with Laboratory(make, inputs, outputs, start, h, content=content) as lab:
                    tell_cost(lab, fmu.name)
                    surrogate = Surrogate(lab, signature, part.variables)
                    if surrogate.model is not None:
                        tried.append(_hosted(fmu, found, host, surrogate, takes_derivatives))
                if tried and tried[-1].promised:
                    break
    if not tried:
        raise FmuError(f"{fmu}: nothing is promised: {surrogate.why}")
    best = min(tried, key=lambda one: one.residual)
    if best.residual >= _NO_MODEL:
        raise FmuError(
            f"{fmu}: nothing is promised: as a linear system it misses trials of {best.base:g} s "
            f"by {percent(best.residual)}, and others by more; find the limit by runs at "
            "your host"
        )
    return best


def _carried(fmu: Path, flange: Flange) -> LinearModel | None:
    """The linear equations of a flange that an exported gearbox carries; None if it has none."""
    with ZipFile(fmu) as archive:
        if FLANGE_MODELS not in archive.namelist():
            return None
        models = json.loads(archive.read(FLANGE_MODELS))
    if flange.tau.rpartition(".")[0] not in models:
        return None
    return LinearModel.from_lists(models[flange.tau.rpartition(".")[0]])


def _hosted(
    fmu: Path, flange: Flange, host: Host, surrogate: Surrogate, takes_derivatives: bool
) -> HostedFlange:
    """What a surrogate, which has a model, tells of the FMU at the host."""
    assert surrogate.model is not None
    model = _with_angle(_in_si(surrogate.model, flange), flange)
    limits = host_limits(model, host, takes_torque=flange.takes_torque)
    finite = [x.limit for x in limits if np.isfinite(x.limit)] or [surrogate.base]
    return HostedFlange(
        fmu,
        flange,
        host,
        limits,
        takes_derivatives,
        surrogate.order,
        surrogate.base,
        max(surrogate.residual(x) for x in finite),
    )


def _flange_of(part: Part, asked_for: str) -> Flange:
    """The flange that is meant, or the only one that there is.

    Raises:
        ParameterError: there is no such flange, or it has no speed.
    """
    wanted = asked([asked_for] if asked_for else [])
    flanges, findings = find_flanges(part.variables, wanted, 1, whole=False)
    if not flanges:
        raise ParameterError(f"{part.name}: {findings[0].measured}; {NEEDS}")
    (flange,) = flanges
    if not flange.w:
        raise ParameterError(f"{part.name}: {flange.tau} has no speed w beside it; {NEEDS}")
    return flange


def _check(flange: Flange, host: Host) -> None:
    """Check that the host fits the flange; raises ParameterError."""
    if not host.inertia > 0.0:
        raise ParameterError(f"{option('inertia', host.inertia)}: it must be positive, in kg.m2")
    if host.stiffness < 0.0 or host.damping < 0.0:
        raise ParameterError(
            f"{option('stiffness', host.stiffness)} {option('damping', host.damping)}: neither may "
            "be negative"
        )
    shaft = host.stiffness > 0.0 or host.damping > 0.0
    if flange.takes_torque and not shaft:
        raise ParameterError(
            f"flange {flange.name} takes torque: give the host's shaft, {option('stiffness')} in "
            f"N.m/rad and {option('damping')} in N.m.s/rad"
        )
    if shaft and not flange.takes_torque:
        raise ParameterError(
            f"flange {flange.name} takes motion and has its shaft inside: leave out "
            f"{option('stiffness')} and {option('damping')}; {option('inertia')} is at the flange"
        )


def _in_si(model: LinearModel, flange: Flange) -> LinearModel:
    """From or to SI units."""
    motion = [flange.factors[q] for q in ("phi", "w") if flange.variable(q)]
    torque = [flange.factors["tau"]]
    given, gives = (torque, motion) if flange.takes_torque else (motion, torque)
    into, out = 1.0 / np.array(given), np.array(gives)[:, None]
    return replace(model, b=model.b * into, c=out * model.c, d=out * model.d * into)


def _with_angle(model: LinearModel, flange: Flange) -> LinearModel:
    """From or to angle and speed, the integral of a speed where the FMU has no angle."""
    if flange.phi:
        return model
    n, (m, p) = len(model.a), model.d.shape
    if not flange.takes_torque:
        # An angle at the input that nothing follows.
        b, d = np.hstack([np.zeros((n, 1)), model.b]), np.hstack([np.zeros((m, 1)), model.d])
        return LinearModel(model.a, b, model.c, d, (InputRule.MEAN, InputRule.MEAN), (-1, -1))
    a = np.block([[model.a, np.zeros((n, 1))], [model.c, np.zeros((1, 1))]])
    b = np.vstack([model.b, model.d])
    c = np.zeros((2, n + 1))
    c[0, n], c[1, :n] = 1.0, model.c[0]
    return LinearModel(a, b, c, np.vstack([np.zeros((1, p)), model.d]), model.given, model.rates)
