"""What harmonic balance needs to know: a linear part in modal coordinates, and laws.

    q' = rates q + inputs r,    theta' = Re(turns q)
    z = Re(arguments q) + of_angle theta + of_channels r
    r_v = f_v(z) - tangent_v z

Channels r are the laws' values, less mean tangents times arguments, and given signals. theta is the
angle of a rotation as a whole; without one `turns` and `of_angle` are zero. One mode of each pair
is there, as in `twin.condensed.modes`.

A neutral mode n has no rate, and neither z nor theta' sees it, as where a shaft engages again: all
else repeats whatever it does. Its phase is pinned, and what drives it in the mean is its slip,

    q_n = phase_n + slip_n t + what vibrates,    slip_n = mean of inputs_n r
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

_STILL = 1e-9
"""Rate of a mode, over the largest one, that is none."""


class Samples(NamedTuple):
    """Laws at places of a period, (places, ...).

    Attributes:
        z: arguments.
        f: values.
        k: tangents.
        e: indicators; a law bends where one changes its sign.
    """

    z: np.ndarray
    f: np.ndarray
    k: np.ndarray
    e: np.ndarray

    def kept(self) -> "Samples":
        """The same for good: laws write all their places into one room."""
        return Samples(*(array.copy() for array in self))


class LawsAlong(Protocol):
    """Laws at given arguments."""

    def __call__(self, z: np.ndarray) -> Samples:
        """What they give at arguments (places, arguments); good until the next call."""


def in_parts(rows: np.ndarray) -> np.ndarray:
    """Real rows (n, 2 modes), over the real parts of q, then the imaginary ones, of Re(rows q)."""
    return np.concatenate([rows.real, -rows.imag], axis=1)


@dataclass(frozen=True)
class Problem:
    """A linear part and its laws; see above.

    Attributes:
        rates: (modes,) [1/s].
        inputs: (modes, channels).
        arguments: (arguments, modes).
        of_angle: (arguments,).
        of_channels: (arguments, channels).
        turns: (modes,).
        tangent: (values, arguments), the mean tangents.
        directions: (tangents, arguments), see `core.Laws`.
        owner: (tangents,) the value that each tangent is of.
        mean: (tangents,).
        laws: the laws.
        neutral: modes that stay wherever they were brought to, and that nothing else sees.
        phases: where these are in the mean.
    """

    rates: np.ndarray
    inputs: np.ndarray
    arguments: np.ndarray
    of_angle: np.ndarray
    of_channels: np.ndarray
    turns: np.ndarray
    tangent: np.ndarray
    directions: np.ndarray
    owner: np.ndarray
    mean: np.ndarray
    laws: LawsAlong
    neutral: tuple[int, ...] = ()
    phases: tuple[float, ...] = ()

    @property
    def values(self) -> int:
        """How many values the laws have."""
        return len(self.tangent)

    @cached_property
    def input_parts(self) -> np.ndarray:
        """(2 modes, channels) real parts of the inputs, then the imaginary ones."""
        return np.concatenate([self.inputs.real, self.inputs.imag])

    @cached_property
    def seen_parts(self) -> np.ndarray:
        """(arguments + 1, 2 modes): the arguments, then `turns`, see `in_parts`."""
        return in_parts(np.vstack([self.arguments, self.turns]))

    @cached_property
    def mean_speed(self) -> np.ndarray:
        """(channels,): d theta / dt under the means of channels, where these decide on it."""
        turning = self.turns != 0.0  # neutral modes have no rate
        return (self.turns[turning] / -self.rates[turning] @ self.inputs[turning]).real

    @cached_property
    def stiff(self) -> np.ndarray:
        """Values with tangents."""
        return np.unique(self.owner)

    @cached_property
    def along(self) -> np.ndarray:
        """(tangents, modes): what the tangents are along."""
        return self.directions @ self.arguments

    @cached_property
    def along_angle(self) -> np.ndarray:
        """(tangents,): how theta moves that."""
        return self.directions @ self.of_angle

    @cached_property
    def free(self) -> int | None:
        """The mode that turns at any speed by itself; None: something decides on the speed."""
        turning = np.flatnonzero(still(self.rates) & (self.turns != 0.0))
        return int(turning[0]) if turning.size else None


def still(rates: np.ndarray) -> np.ndarray:
    """(modes,) True of those that neither decay nor vibrate."""
    sizes = np.abs(rates)
    found: np.ndarray = sizes <= _STILL * sizes.max(initial=0.0)
    return found
