"""A part that is stepped before the run, to be in steady motion when that begins."""

from herringbone.core import FmuError
from herringbone.core.part import Part
from herringbone.cosim.adapter import PartAdapter
from herringbone.cosim.signature.trial import Trial
from herringbone.cosim.structure.approach import Approach


class ApproachedPart(PartAdapter):
    """A part in front of which its inputs are brought to steady motion.

    Initialisation of the run finds it in step mode already.

    Args:
        part: instantiated, start values set; it belongs to this one.
        approach: what it is given.
    """

    def __init__(self, part: Part, approach: Approach, *, in_trial: bool) -> None:
        super().__init__(part)
        self._approach, self._closed, self._in_trial = approach, False, in_trial

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Initialise it earlier, and step it up to the start time; raises FmuError."""
        names = [u.name for u in self._approach.inputs]
        begin_at(self.part, self._approach)
        early = start_time - self._approach.duration
        try:
            trial = Trial(self.part, names, [], early, stop_time, tolerance, counted=self._in_trial)
        except FmuError:
            self._closed = True  # a trial closes what does not initialise
            raise
        approach(trial, self._approach)

    def exit_initialization(self) -> None:
        """It has left initialisation already."""

    def close(self) -> None:
        """See `Part`."""
        if not self._closed:
            super().close()


def approached(part: Part, given: Approach | None, *, in_trial: bool = False) -> Part:
    """The part, with its approach in front of it if it is stepped before the run, or a trial."""
    if not given or not given.duration:
        return part
    return ApproachedPart(part, given, in_trial=in_trial)


def begin_at(part: Part, given: Approach) -> None:
    """Set what a part begins with, before it is initialised: some take their angle from that."""
    begin = given.held(-given.duration, 0.0)
    for u, value in zip(given.inputs, begin, strict=True):
        part.set(u.name, float(value))


def approach(trial: Trial, given: Approach) -> None:
    """Step a part up to the start of the run; raises Refused."""
    for t, h in given.steps():
        trial.set(given.held(t, h))
        trial.step(h)
    trial.set(given.at_end())
