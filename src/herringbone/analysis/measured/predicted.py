"""What a run predicts of a sensor: its vibration, its lines, and samples of it from any time on."""

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.measured.lines import line_amplitudes

if TYPE_CHECKING:
    from scipy.interpolate import BSpline

SHARE = 0.01
"""Lines below this share of the largest one are left out."""
_MESH_ORDERS = 5
_SETTLING = 0.2
"""Time in which filters of a sensor settle [s]."""
_DEGREE = 5
"""Of splines: with 4.4 rows in a period, as the sensor's finest input may have, 0.1 % of a line."""


@dataclass(frozen=True)
class Predicted:
    """A predicted vibration, and the sensor that would sample it.

    Attributes:
        vibration: (n,) velocity, before the sensor [m/s].
        step: between its rows [s].
        sensor: what it does to the vibration.
        mesh_hz: mesh frequency [Hz].
        meshes: mesh periods in the period after which all repeats.
    """

    vibration: np.ndarray
    step: float
    sensor: VelocitySensor
    mesh_hz: float
    meshes: int

    @property
    def turn_hz(self) -> float:
        """Of the period after which all repeats [Hz]."""
        return self.mesh_hz / self.meshes

    @cached_property
    def settled(self) -> np.ndarray:
        """Velocity (m,) behind the filters, without the time in which they settle [m/s]."""
        self.sensor.check_input(self.step)
        felt = self.sensor.filtered(self.vibration, self.step)
        return felt[round(_SETTLING / self.step) :]

    @property
    def duration(self) -> float:
        """Of what has settled [s]."""
        return self.settled.size * self.step

    @cached_property
    def lines(self) -> tuple[np.ndarray, np.ndarray]:
        """Orders (k,) of the lines that count, and amplitudes before the sensor [m/s]."""
        orders, found = self._large(self.vibration)
        return orders, np.abs(found)

    @cached_property
    def felt_lines(self) -> tuple[np.ndarray, np.ndarray]:
        """Orders (k,) of the lines that count behind the filters, and complex amplitudes [m/s]."""
        return self._large(self.settled)

    def _large(self, velocity: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        orders = np.arange(1, _MESH_ORDERS * self.meshes + 1)
        orders = orders[orders < 0.5 / self.step / self.turn_hz]
        found = line_amplitudes(velocity, 1.0 / self.step, self.turn_hz * orders)
        large = np.abs(found) >= SHARE * np.abs(found).max()
        return orders[large], found[large]

    def samples(self, count: int, shift: float = 0.0, speed: float = 1.0) -> np.ndarray:
        """Samples (count,) that begin later and run faster [m/s].

        They go on with the first of the whole periods where these end, as all repeats.

        Args:
            count: of samples.
            shift: by which they begin later [s].
            speed: over the stated one.
        """
        return self.sensor.recorded(self._between(self._times(count, shift, speed)))

    def slopes(self, count: int, shift: float, speed: float) -> np.ndarray:
        """Changes (count,) of these samples with time, before the recorder [m/s^2]."""
        return self._between(self._times(count, shift, speed), 1)

    def _times(self, count: int, shift: float, speed: float) -> np.ndarray:
        whole = int((self.settled.size - 1) * self.step * self.turn_hz) / self.turn_hz
        return (shift + speed / self.sensor.sampling_hz * np.arange(count)) % whole

    @cached_property
    def _between(self) -> "BSpline":
        """Velocity at any time since it has settled."""
        from scipy.interpolate import make_interp_spline  # noqa: PLC0415 (lazy)

        times = self.step * np.arange(self.settled.size)
        return make_interp_spline(times, self.settled, _DEGREE)
