"""Stable communication steps of an FMU whose flange a host couples to an inertia."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from herringbone.analysis.flange.hosted_flange import Host, HostLimit, host_limits
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.surrogate import PROMISED, Surrogate
from herringbone.core import FmuError, ParameterError
from herringbone.core.activity import activity
from herringbone.core.part import Part
from herringbone.core.part_path import PartPath
from herringbone.cosim.fmu.opening import many_of
from herringbone.cosim.signature import Kind, Laboratory
from herringbone.cosim.signature.rotation import Given
from herringbone.running.foreign.foreign_parts import signature_of, start_inputs

STEP = 1e-4
"""Step of the first trials [s], unless the FMU has one."""
_TRIED = (1e-4, 1e-3)
"""Steps of further trials [s], while the model is too far from the FMU."""
_QUANTITIES = ("tau", "phi", "w")


@dataclass(frozen=True)
class Flange:
    """Variables of a flange; the angle may be missing.

    Attributes:
        torque, speed, angle: names; "" if there is no angle.
        takes_torque: the torque is an input of the FMU, else the motion.
    """

    torque: str
    speed: str
    angle: str
    takes_torque: bool

    @property
    def motion(self) -> tuple[str, ...]:
        """Angle, if there is one, and speed."""
        return tuple(filter(None, (self.angle, self.speed)))

    @property
    def inputs(self) -> list[str]:
        """What the FMU takes."""
        return [self.torque] if self.takes_torque else list(self.motion)

    @property
    def outputs(self) -> list[str]:
        """What the FMU gives."""
        return list(self.motion) if self.takes_torque else [self.torque]


@dataclass(frozen=True)
class HostedFlange:
    """What is known of an FMU at a host.

    Attributes:
        fmu: file.
        flange: its variables.
        host: what it is coupled to.
        limits: by order and schedule.
        takes_derivatives: the FMU offers derivatives of its inputs.
        order, base: of the FMU's model: number of states, and step of its trials [s].
        residual: of the model on trials that were not fitted, at the largest finite limit.
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


def hosted_flange(fmu: Path, flange: str, host: Host) -> HostedFlange:
    """Limits of an FMU at a host.

    Args:
        fmu: file.
        flange: name of a port with tau, phi and w, or `TORQUE,SPEED`, or `TORQUE,ANGLE,SPEED`.
        host: what it is coupled to.

    Raises:
        FmuError: the FMU cannot be used, or trials tell nothing of it.
        ParameterError: there is no such flange, or the host does not fit it.
    """
    with many_of(fmu.stem, fmu) as make:
        part = make()
        found = flange_of(part, flange)
        _check(found, host, flange)
        experiment = part.model.defaultExperiment
        step = float(experiment.stepSize) if experiment and experiment.stepSize else STEP
        takes_derivatives = bool(part.addresses.set_derivatives)
        with activity(f"identifying {found.torque} of {fmu.name}"):
            start = start_inputs(part, found.inputs)
            signature = signature_of(make(), make, step)
            if signature.kind is Kind.NOISY:
                raise FmuError(f"{fmu}: {signature.notes[0]}")
            tried: list[HostedFlange] = []
            for h in (step, *_TRIED):
                with Laboratory(make, found.inputs, found.outputs, start, h) as lab:
                    surrogate = Surrogate(lab, signature, part.variables)
                    if surrogate.model is not None:
                        tried.append(_hosted(fmu, found, host, surrogate, takes_derivatives))
                if tried and tried[-1].promised:
                    break
    if not tried:
        raise FmuError(f"{fmu}: nothing is promised: {surrogate.why}")
    return min(tried, key=lambda one: one.residual)


def _hosted(
    fmu: Path, flange: Flange, host: Host, surrogate: Surrogate, takes_derivatives: bool
) -> HostedFlange:
    """What a surrogate, which has a model, tells of the FMU at the host."""
    assert surrogate.model is not None
    model = _with_angle(surrogate.model, flange)
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


def flange_of(part: Part, asked: str) -> Flange:
    """The variables that are meant.

    Raises:
        ParameterError: there are none, or their causality is that of no flange.
    """
    names = [name.strip() for name in asked.split(",")]
    variables = part.variables
    if len(names) == 1:
        ports = [
            name.removesuffix(".tau")
            for name in variables
            if name.endswith(".tau") and PartPath(name.removesuffix(".tau")).answers_to(asked)
        ]
        if len(ports) != 1:
            known = ", ".join(n.removesuffix(".tau") for n in variables if n.endswith(".tau"))
            raise ParameterError(
                f"--flange {asked}: {part.name} has {len(ports) or 'no'} such ports with a torque "
                f"'tau'; it has {known or 'none'}; or name variables: TORQUE,SPEED"
            )
        torque, angle, speed = (f"{ports[0]}.{q}" for q in _QUANTITIES)
        angle = angle if angle in variables else ""
    elif len(names) in {2, 3}:
        torque, speed, angle = names[0], names[-1], names[1] if len(names) == 3 else ""
    else:
        raise ParameterError(
            f"--flange {asked}: it must be a port, or TORQUE,SPEED, or TORQUE,ANGLE,SPEED"
        )
    kinds = {}
    for name in filter(None, (torque, speed, angle)):
        if name not in variables or not variables[name].is_real:
            raise ParameterError(f"--flange {asked}: {part.name} has no real variable '{name}'")
        kinds[name] = variables[name].causality
    motion = {kinds[name] for name in (speed, angle) if name}
    if (kinds[torque], motion) not in [("input", {"output"}), ("output", {"input"})]:
        told = ", ".join(f"{name} is {kind}" for name, kind in kinds.items())
        raise ParameterError(
            f"--flange {asked}: {told}; a flange takes torque and gives motion, or takes motion "
            "and gives torque"
        )
    return Flange(torque, speed, angle, kinds[torque] == "input")


def _check(flange: Flange, host: Host, asked: str) -> None:
    """Check that the host fits the flange; raises ParameterError."""
    if not host.inertia > 0.0:
        raise ParameterError(f"--inertia {host.inertia:g}: it must be positive, in kg.m2")
    if host.stiffness < 0.0 or host.damping < 0.0:
        raise ParameterError(
            f"--stiffness {host.stiffness:g} --damping {host.damping:g}: neither may be negative"
        )
    shaft = host.stiffness > 0.0 or host.damping > 0.0
    if flange.takes_torque and not shaft:
        raise ParameterError(
            f"--flange {asked} takes torque: give the host's shaft, --stiffness in N.m/rad and "
            "--damping in N.m.s/rad"
        )
    if shaft and not flange.takes_torque:
        raise ParameterError(
            f"--flange {asked} takes motion and has its shaft inside: leave out --stiffness and "
            "--damping; --inertia is at the flange"
        )


def _with_angle(model: LinearModel, flange: Flange) -> LinearModel:
    """From or to angle and speed, the integral of a speed where the FMU has no angle."""
    if flange.angle:
        return model
    n, (m, p) = len(model.a), model.d.shape
    if not flange.takes_torque:
        # An angle at the input that nothing follows.
        b, d = np.hstack([np.zeros((n, 1)), model.b]), np.hstack([np.zeros((m, 1)), model.d])
        return LinearModel(model.a, b, model.c, d, (Given.MEAN, Given.MEAN), (-1, -1))
    a = np.block([[model.a, np.zeros((n, 1))], [model.c, np.zeros((1, 1))]])
    b = np.vstack([model.b, model.d])
    c = np.zeros((2, n + 1))
    c[0, n], c[1, :n] = 1.0, model.c[0]
    return LinearModel(a, b, c, np.vstack([np.zeros((1, p)), model.d]), model.given, model.rates)
