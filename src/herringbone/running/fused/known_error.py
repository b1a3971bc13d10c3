"""What is known of a fused run's error by half the step: lines for the user, and figures."""

from collections.abc import Iterator
from typing import NamedTuple

from herringbone.analysis.twin.fused.later import Later
from herringbone.analysis.twin.fused.measured import Measured
from herringbone.core.wording import option, percent
from herringbone.cosim.tolerance import DEFAULT_TOLERANCE
from herringbone.result.verification import Verification


class KnownError(NamedTuple):
    """Errors of the steps.

    Attributes:
        trial: over the time for which they were tried.
        later: after that; nothing before the run has ended.
    """

    trial: Measured
    later: Later = Later()

    def lines(self, step: float | None, tolerance: float | None) -> Iterator[str]:
        """Lines on the steps and their error.

        Args:
            step: that was asked for [s]; None: it was chosen.
            tolerance: that was asked for; None: none.
        """
        aim, worst = tolerance or DEFAULT_TOLERANCE, self.later.worst
        yield self._steps(step, aim)
        if worst and worst.error > aim and (step is None or tolerance is not None):
            yield self._too_large(worst, aim)
        elif self.later.bends:
            yield (
                f"fused: laws bend {self.later.bends} times outside of the windows in which the "
                "error is measured (teeth part or meet, play is crossed), and what it grows to "
                f"there is not known; {_over_all()}"
            )

    def _steps(self, step: float | None, aim: float) -> str:
        """Steps, and what they err."""
        trial, worst = self.trial, self.later.worst
        steps = f"fused: steps of {1e6 * trial.steps.length:.4g} us, degree {trial.steps.degree}"
        found = [window for window in (trial, worst) if window and window.groups]
        errors = ", ".join(f"{percent(window.error)} {self._over(window)}" for window in found)
        if not errors:
            then = "" if self.later.whole else f"; {_over_all()}"
            quiet = f"no channel varies {self._all_over()}, so that its error is not known"
            return f"{steps}; {quiet}{then}"
        if step is None:
            return f"{steps}, for an error of {100.0 * aim:g} %: {errors}"
        return f"{steps}, as asked for: error {errors}"

    def _too_large(self, worst: Measured, aim: float) -> str:
        """What to do about an error above the one that was asked for."""
        shorter = f"{option('step', 0.5 * self.trial.steps.length)} or less"
        if not self.later.whole:
            shorter += f", and {option('verify', True)} for the error over the whole run"
        return (
            f"fused: {percent(worst.error)} {self._over(worst)} is above the {100.0 * aim:g} % "
            f"asked for, as steps are chosen by the first {_ms(self.trial.window)}; use {shorter}"
        )

    @property
    def verification(self) -> Verification | None:
        """The largest errors of all windows, or those of the whole run; None if nothing varies."""
        later = self.later.windows
        windows = [w for w in (later if self.later.whole else (self.trial, *later)) if w.groups]
        if not windows:
            return None
        groups: dict[str, float] = {}
        for window in windows:
            for name, error in window.groups.items():
                groups[name] = max(error, groups.get(name, 0.0))
        worst = max(windows, key=lambda window: window.worst_error)
        half = 0.5 * self.trial.steps.length
        how = f"by half the step, {self._all_over()}"
        return Verification(groups, worst.worst, worst.worst_error, half, how)

    def _all_over(self) -> str:
        """What was measured, in words."""
        if self.later.whole or not self.later.windows:
            return self._over(self.later.worst or self.trial)
        count, last = len(self.later.windows), self._over(self.later.windows[-1])
        more = f"{count} later windows" if count > 1 else last.removeprefix("over ")
        return f"{self._over(self.trial)} and {more}"

    def _over(self, window: Measured) -> str:
        """A window, in words."""
        if window is self.trial:
            return f"over the first {_ms(window.window)}"
        if window.begin == 0.0:
            return "over the whole run"
        if window is self.later.windows[-1]:
            return f"over the last {_ms(window.window)}"
        return f"over {_ms(window.window)} from {window.begin:.3g} s on"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.3g} ms"


def _over_all() -> str:
    return f"{option('verify', True)} measures it over the whole run"
