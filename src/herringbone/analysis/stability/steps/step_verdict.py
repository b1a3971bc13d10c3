"""What happens at one macro step: stable or not with each algorithm, and why not."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Self

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    Member,
    MeshStiffness,
    Strangers,
    linear_network,
)
from herringbone.analysis.stability.steps.clock_grid import clocks_of
from herringbone.analysis.stability.surrogates.surrogate import PROMISED
from herringbone.core import ParameterError
from herringbone.core.energy_report import Diagnosis, hertz
from herringbone.core.process.telling import Tell
from herringbone.core.wording import percent
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.system import System


@dataclass(frozen=True)
class StepVerdict:
    """One algorithm at one macro step.

    Attributes:
        algorithm: what it is called on the command line.
        step: macro step [s].
        growth: of the fastest growing motion per macro step, largest over the mesh stiffnesses;
            0.01 is 1 %, negative if it decays.
        mesh_stiffness: at which it grows most: minimum, mean or maximum.
        frequency: of that motion [Hz].
        why: what grows at mean stiffness and what helps; None if nothing does.
        residual: of what stands for foreign parts, on trials that were not fitted.
    """

    algorithm: str
    step: float
    growth: float
    mesh_stiffness: str
    frequency: float
    why: Diagnosis | None
    residual: float = 0.0

    @property
    def stable(self) -> bool:
        """True if no motion grows at any mesh stiffness."""
        return self.growth <= GROWTH

    def lines(self) -> list[str]:
        """For people."""
        name = f"{self.algorithm} at {self.step:.4g} s"
        if self.residual > PROMISED:
            return [
                f"{name}: nothing is promised, because what stands for foreign parts misses their "
                f"answers by {percent(self.residual)}"
            ]
        if self.stable:
            return [f"{name}: stable"]
        if self.why:
            return ["unstable: " + self.why.lines()[0], *self.why.lines()[1:]]
        return [
            f"unstable: {name}: a motion at {hertz(self.frequency)} grows by "
            f"{percent(self.growth, 3)} per step at {self.mesh_stiffness} mesh stiffness"
        ]


class StepVerdicts(tuple[StepVerdict, ...]):
    """A verdict of each algorithm at one macro step; `str` tells them, and the notes.

    Attributes:
        notes: algorithms that this system cannot have, and on how the verdicts came about.
    """

    notes: tuple[str, ...]

    def __new__(cls, verdicts: Iterable[StepVerdict], notes: Iterable[str] = ()) -> Self:
        """Verdicts, with notes."""
        found = super().__new__(cls, verdicts)
        found.notes = tuple(notes)
        return found

    def __str__(self) -> str:
        return "\n".join([*(line for verdict in self for line in verdict.lines()), *self.notes])


def step_verdicts(
    system: System,
    algorithms: Sequence[Algorithm],
    step: float,
    progress: Tell,
    strangers: Strangers = NO_STRANGERS,
) -> StepVerdicts:
    """Verdicts of algorithms at a macro step.

    Args:
        system: at the start values of an equilibrium under load.
        algorithms: to examine; if none, all that this system can have, with a note on others.
        step: macro step [s].
        progress: called before every matrix.
        strangers: what stands for foreign parts.

    Raises:
        StructureError: nothing stands for a foreign part.
        ParameterError: this system cannot have an algorithm that is named.
        HerringboneError: a mesh is open at the start, or a part fails within one step.
    """
    found, notes = [], []
    for algorithm in algorithms or default_algorithms():
        networks = {kind: linear_network(system, kind, strangers) for kind in MeshStiffness}
        try:
            found.append(_verdict(system, networks, algorithm, step, progress, strangers))
        except ParameterError as error:
            if algorithms:
                raise
            notes.append(f"{algorithm}: {error}")
    return StepVerdicts(found, notes)


def _verdict(
    system: System,
    networks: Mapping[MeshStiffness, tuple[Network, list[Member]]],
    algorithm: Algorithm,
    step: float,
    progress: Tell,
    strangers: Strangers,
) -> StepVerdict:
    """Of one algorithm; arguments as of `step_verdicts`."""
    by_stiffness, residual = {}, 0.0
    for stiffness, network in networks.items():
        progress(str(algorithm))
        amplification = Amplification(*network, algorithm)
        by_stiffness[stiffness] = amplification.growth(step)
        residual = max(residual, amplification.residual)
    worst = max(by_stiffness, key=lambda s: by_stiffness[s].radius)
    growth = by_stiffness[worst].radius - 1.0
    told = growth > GROWTH and not clocks_of(strangers)  # remedies are other steps, too
    why = diagnose(system, algorithm, step, strangers) if told else None
    frequency = by_stiffness[worst].frequency
    return StepVerdict(str(algorithm), step, growth, worst.value, frequency, why, residual)
