"""What the first steps of a part tell: whether they repeat, in a second instance or restored."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.core import FmuError
from herringbone.cosim.signature.trial import Refused, Trial


@dataclass(frozen=True)
class FirstSteps:
    """The first steps of a part.

    Attributes:
        at_start: (m,) outputs before them.
        after: (steps, m) outputs after each of them.
        restores: True if saving and restoring gives equal bits; False if not, None if the part does
            not offer it.
        repeats: True if two instances give equal bits.
        why: what is wrong with either, "" if nothing.
    """

    at_start: np.ndarray
    after: np.ndarray
    restores: bool | None = None
    repeats: bool = True
    why: str = ""

    def not_finite(self, outputs: Sequence[str]) -> tuple[str, ...]:
        """Which outputs are not."""
        finite = np.isfinite(np.vstack([self.at_start, self.after])).all(axis=0)
        return tuple(name for name, ok in zip(outputs, finite, strict=True) if not ok)

    def same(self, other: "FirstSteps") -> bool:
        """True if both are equal to the bit."""
        return self.restores == other.restores and all(
            np.array_equal(one, two, equal_nan=True)
            for one, two in ((self.at_start, other.at_start), (self.after, other.after))
        )


def first_steps(
    new: Callable[[], Trial],
    begin: Callable[[Trial], None],
    steps: Callable[[Trial], np.ndarray],
    outputs: Sequence[str],
) -> tuple[FirstSteps, tuple[Trial, int] | None]:
    """Test whether a part repeats.

    Args:
        new: makes an instance.
        begin: gives it its start inputs.
        steps: outputs (steps, m) after its first steps.
        outputs: their names.

    Returns:
        What was found; of a part that restores its state an instance, with the handle of its start.

    Raises:
        FmuError: it does not instantiate or initialise, or refuses the steps.
    """
    trial = new()
    try:
        saved, why = _saved(trial)
        begin(trial)
        at_start = trial.values()
        after = steps(trial)
        if saved is not None:
            why = _not_restored(trial, saved, steps, outputs, after)
            if not why:
                return FirstSteps(at_start, after, restores=True), (trial, saved)
    except BaseException:
        trial.close()
        raise
    trial.close()
    again = _in_another(new, steps)
    repeats = bool(np.array_equal(after, again, equal_nan=True))
    if not repeats:
        why = _differs(outputs, after, again, "in a second instance")
    restores = False if trial.can_restore else None
    return FirstSteps(at_start, after, restores, repeats, why), None


def _saved(trial: Trial) -> tuple[int | None, str]:
    """Handle of the start; None, with what the part said, if there is none."""
    if not trial.can_restore:
        return None, ""
    try:
        return trial.save(), ""
    except Refused as error:
        return None, str(error)


def _not_restored(
    trial: Trial,
    saved: int,
    steps: Callable[[Trial], np.ndarray],
    outputs: Sequence[str],
    after: np.ndarray,
) -> str:
    """What is wrong with a state that is restored, "" if nothing."""
    try:
        trial.restore(saved)
        again = steps(trial)
        trial.restore(saved)
    except Refused as error:
        return str(error)
    if np.array_equal(after, again, equal_nan=True):
        return ""
    return _differs(outputs, after, again, "after a restore")


def _in_another(new: Callable[[], Trial], steps: Callable[[Trial], np.ndarray]) -> np.ndarray:
    """The first steps of a second instance; raises FmuError."""
    try:
        trial = new()
    except FmuError as error:
        raise FmuError(f"no second instance for trials: {error}") from error
    try:
        return steps(trial)
    finally:
        trial.close()


def _differs(outputs: Sequence[str], first: np.ndarray, again: np.ndarray, where: str) -> str:
    column = int(np.argmax(np.abs(first - again).max(axis=0)))
    row = int(np.argmax(np.abs(first - again)[:, column]))
    return (
        f"{outputs[column]} is {again[row, column]:.17g} {where}, {first[row, column]:.17g} before"
    )
