"""What a path of answers has come to: as it is, or as means over a period if it pulsates."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.cosim.structure.approach import Approach
from herringbone.running.settling.settled import CHANGES, Settled
from herringbone.running.settling.turn_means import means, shafts_of, turns_of


class Path(NamedTuple):
    """Answers in the second half of a trial.

    Attributes:
        times: (k,) [s].
        answers: (k, m); of a part that answers at once, in one step, k is 0 or 1.
        last: (m,) at the end.
    """

    times: np.ndarray
    answers: np.ndarray
    last: np.ndarray


def come_to(
    given: Approach,
    path: Path,
    names: Sequence[str],
    watched: Sequence[int],
    sizes_of: Callable[[np.ndarray], np.ndarray],
) -> Settled:
    """What answers have come to.

    Args:
        given: how the part was brought there.
        path: its answers.
        names: of the watched outputs, at least one.
        watched: their numbers.
        sizes_of: sizes (m,) by which changes are judged, of the largest values (m,).
    """
    late = path.times > -0.25 * given.duration
    if not late.any():
        path, late = Path(np.zeros(1), path.last[None], path.last), np.ones(1, dtype=bool)
    peak, last = np.abs(path.answers[late]).max(axis=0), path.last.copy()
    sizes, shafts, pulsation = sizes_of(peak)[watched], shafts_of(given), ("", 0.0)
    answers = path.answers[:, watched] / sizes
    if np.ptp(answers[late], axis=0).max() > CHANGES and (
        even := means(shafts, path.times, answers)
    ):
        answers, last[watched] = even.path, even.last * sizes
        most = int(np.argmax(even.pulsation))
        pulsation = names[most], float((even.pulsation * sizes)[most])
    moved = answers[late]
    line = np.linspace(-1.0, 1.0, len(moved))
    bent = moved - np.outer(line, line @ moved / (line @ line))
    changes = np.ptp(moved, axis=0)
    worst = int(np.argmax(changes))
    before = answers[~late, worst]
    before = before[np.isfinite(before)]
    return Settled(
        last,
        float(changes[worst]),
        float(np.ptp(bent, axis=0).max()),
        names[worst],
        peak,
        float(changes[worst] * sizes[worst]),
        float(np.ptp(before)) if before.size else 0.0,
        turns_of(shafts, given.duration),
        pulsation,
    )
