"""Limits of the communication step, kept by what they depend on: system, algorithm, and trials."""

from collections.abc import Callable
from dataclasses import asdict, dataclass

from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import digest_of, kernels_key, versions_of
from herringbone.core.caching.tried import tried_folder
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.structure.system import System
from herringbone.running.content import contents_of_system

_SOURCES = "herringbone.analysis.stability.limits", "herringbone.running.foreign.surrogates"
_LIBRARIES = "numpy", "scipy"


@dataclass(frozen=True)
class KnownLimits:
    """Limits of a system that were found before, or are found now and kept.

    Attributes:
        system: as its limits are asked for.
        step: of the first trials of its foreign parts [s].
    """

    system: System
    step: float

    def __call__(
        self, algorithm: Algorithm, simulated: bool, find: Callable[[], StepLimits]
    ) -> StepLimits:
        """Limits of an algorithm.

        Args:
            algorithm: of the coupling.
            simulated: with those that runs show.
            find: finds them; what it raises is raised.
        """
        file = tried_folder("limits") / f"{self._key(algorithm, simulated)}.json"
        if (known := kept(file)) is not None:
            bands = tuple((low, high) for low, high in known.pop("unstable_bands"))
            return StepLimits(unstable_bands=bands, **known)
        found = find()
        lost = any(policy().lost[spec.name] for spec in self.system.parts)
        if not policy().trials_ended and not lost:  # a further run may tell more
            keep(file, asdict(found))
        return found

    def _key(self, algorithm: Algorithm, simulated: bool) -> str:
        return digest_of(
            kernels_key(*_SOURCES),
            *versions_of(*_LIBRARIES),
            *contents_of_system(self.system),
            *(repr(spec.approach) for spec in self.system.parts),
            f"{algorithm!r} {simulated} {self.step!r}",
        )
