"""A part that is stepped before the run, to be in steady motion when that begins."""

from dataclasses import replace

from herringbone.core import FmuError
from herringbone.core.part import Part, reals
from herringbone.cosim.adapter import PartAdapter
from herringbone.cosim.signature.trial import Trial
from herringbone.cosim.structure.approach import Approach


class ApproachedPart(PartAdapter):
    """A part in front of which its inputs are brought to steady motion.

    Initialisation of the run finds it in step mode already.

    Args:
        part: instantiated, start values set; it belongs to this one.
        approach: what it is given.

    Attributes:
        first: outputs behind the last step before the run, by name, of one that takes steps of one
            length only: those that it gives when it is stepped on so.
    """

    def __init__(self, part: Part, approach: Approach, *, in_trial: bool) -> None:
        super().__init__(part)
        self._approach, self._closed, self._in_trial = approach, False, in_trial
        self.first = dict[str, float]()

    def step_alike(self, step: float, share: float) -> None:
        """Take the steps of a run before it, where all must have one length.

        Args:
            step: that the part takes in the run [s].
            share: of it at which the run takes the inputs that it holds.
        """
        if self._approach.even:
            self._approach = replace(self._approach, step=step, share=share)

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Initialise it earlier, and step it up to the start time; raises FmuError."""
        names = [u.name for u in self._approach.inputs]
        begin_at(self.part, self._approach)
        early = start_time + self._approach.begin
        shown = reals(self, "output") if self._approach.even else []
        try:
            trial = Trial(
                self.part, names, shown, early, stop_time, tolerance, counted=self._in_trial
            )
        except FmuError:
            self._closed = True  # a trial closes what does not initialise
            raise
        for _, h, held in self._approach.given():
            trial.set(held)
            trial.step(h)
        self.first = dict(zip(shown, trial.values().tolist(), strict=True))
        trial.set(self._approach.at_end())

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
    begin = given.held(given.begin, 0.0)
    for u, value in zip(given.inputs, begin, strict=True):
        part.set(u.name, float(value))


def approached_of(part: Part) -> ApproachedPart | None:
    """What brings a part to the start of the run, behind its adapters; None: nothing does."""
    inner: Part | None = part
    while inner is not None and not isinstance(inner, ApproachedPart):
        inner = getattr(inner, "part", None)
    return inner
