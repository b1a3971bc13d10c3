"""What parts whose equations are not known answer to a system of components in steady motion.

Their answers are inputs of components, as straight lines: z = c + G u + g a of the outputs u that
they are given, and of the acceleration a of the fastest shaft. What has no memory answers at once,
by its direct feedthrough; what has states is given the time to settle.
"""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.rigid_rotation import rigid_rotation
from herringbone.analysis.twin.monolithic import Twin

_SIZE = 100.0
"""Of accelerations [rad/s^2]."""


@dataclass(frozen=True)
class Answers:
    """Straight lines through what parts answer.

    Attributes:
        inputs: paths of components' inputs, (m,).
        values: c (m,).
        outputs: paths of components' outputs, (n,).
        slopes: G (m, n).
        by_acceleration: g (m,).
    """

    inputs: tuple[str, ...]
    values: np.ndarray
    outputs: tuple[str, ...]
    slopes: np.ndarray
    by_acceleration: np.ndarray


NO_ANSWERS = Answers((), np.empty(0), (), np.empty((0, 0)), np.empty(0))


class Answered:
    """A twin whose inputs follow answers.

    Args:
        twin: of the components.
        answers: of the others.
        x: states (n,) at which the search begins.
        speeds_up: the drivetrain may speed up, if its shafts are joined.

    Attributes:
        rotation: rates of the states (n,) at an acceleration of 1 rad/s^2 of the fastest shaft.
        kept: states that stay: angle and speed of what may speed up.
        size: of the acceleration; nothing answers to it where there is none.
    """

    def __init__(self, twin: Twin, answers: Answers, x: np.ndarray, *, speeds_up: bool) -> None:
        self._twin, self._answers = twin, answers
        self._places = np.array([twin.index(path) for path in answers.inputs], dtype=np.int64)
        self._sloping = bool(answers.slopes.any())
        self.size, self.kept = _SIZE, list[int]()
        self.set(np.append(x, 0.0))
        self.rotation = rigid_rotation(twin, x) if speeds_up else np.zeros_like(x)
        if self.rotation.any():
            self.kept = [int(np.argmax(np.abs(self.rotation))), *twin.turning[:1]]

    def set(self, x: np.ndarray) -> float:
        """Give the twin what is answered to states and acceleration (n + 1,); the latter."""
        a, states = float(x[-1]), x[:-1]
        given = self._answers.values + self._answers.by_acceleration * a
        if self._sloping:
            seen = self._twin.observe(np.zeros(1), states[:, None], self._answers.outputs)[0]
            given = given + self._answers.slopes @ seen
        self._twin.block[self._places] = given
        return a
