"""What a velocity sensor with a sampled recorder shows of a vibration.

The chain: high pass and low pass of the sensor, an anti-alias filter or none, sampling, clipping at
the range, quantisation. Filters are Butterworth, made digital at the step of the input, which
therefore must be fine. Without an anti-alias filter a line at f shows at |f - k fs|.

Source: A. V. Oppenheim, R. W. Schafer, Discrete-Time Signal Processing, 3rd ed., chapters 4 and 7.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from herringbone.analysis.figures.modal_response import housing_of, recorded_motion
from herringbone.components.registry import component_for
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.wording import option
from herringbone.kernels.sampling import ANTI_ALIAS_CORNER, ANTI_ALIAS_ORDER, converted
from herringbone.result.result import TIME, Result

_FINEST = 5.0
"""Least input rate over sampling rate, and over twice the highest corner."""
_WHOLE = 1e-6
_START = {v.name: v.start for v in component_for(Role.SENSOR).declaration.parameters}


class SensorRecord(NamedTuple):
    """What was recorded.

    Attributes:
        time: (n,) of the samples [s].
        velocity: (n,) or (n, k) [m/s].
        saturated: samples that were clipped, () or (k,).
    """

    time: np.ndarray
    velocity: np.ndarray
    saturated: np.ndarray


@dataclass(frozen=True)
class VelocitySensor:
    """Sensor and recorder; the component that is a sensor has the same parameters.

    Attributes:
        high_pass_hz: of the sensor, second order [Hz]; 0 for none.
        low_pass_hz: of the sensor, second order [Hz]; 0 for none.
        anti_alias: an eighth-order low pass at 0.4 times the sampling rate.
        sampling_hz: [Hz].
        range: largest velocity, either sign [m/s].
        bits: of the converter over both signs; 0 for no quantisation.
    """

    high_pass_hz: float = _START["high_pass_hz"]
    low_pass_hz: float = _START["low_pass_hz"]
    anti_alias: bool = bool(_START["anti_alias"])
    sampling_hz: float = _START["sampling_hz"]
    range: float = _START["range"]
    bits: int = int(_START["bits"])

    def __post_init__(self) -> None:
        """Check; raises ParameterError."""
        for name, lowest in (("high_pass_hz", 0.0), ("low_pass_hz", 0.0)):
            if not lowest <= getattr(self, name) < np.inf:
                raise ParameterError(
                    f"{name} = {getattr(self, name):g} Hz must not be negative or infinite"
                )
        for name, unit in (("sampling_hz", "Hz"), ("range", "m/s")):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ParameterError(f"{name} = {getattr(self, name):g} {unit} must be positive")
        if not 0 <= self.bits <= 32:
            raise ParameterError(f"bits = {self.bits}: it must lie between 0 and 32")

    def alias_hz(self, frequency_hz: float) -> float:
        """Frequency at which a line shows after sampling [Hz]."""
        rest = frequency_hz % self.sampling_hz
        return min(rest, self.sampling_hz - rest)

    def measure(self, velocity: np.ndarray, step: float) -> SensorRecord:
        """Record a vibration that begins at time 0.

        Args:
            velocity: (n,) or (n, k) [m/s], one column per sensor.
            step: between rows [s].

        Raises:
            ParameterError: the input is too coarse, or its rate no multiple of the sampling rate.
        """
        velocity = np.asarray(velocity, dtype=float)
        every = self._every(step)
        sampled = self.filtered(velocity, step)[::every]
        saturated = (np.abs(sampled) > self.range).sum(axis=0)
        times = np.arange(len(sampled)) * every * step
        return SensorRecord(times, self.recorded(sampled), saturated)

    def recorded(self, sampled: np.ndarray) -> np.ndarray:
        """What the recorder makes of samples (n,) or (n, k): clipped, in its digits [m/s]."""
        return np.vectorize(converted, otypes=[float])(sampled, self.range, self.bits)

    def filtered(self, velocity: np.ndarray, step: float) -> np.ndarray:
        """A vibration (n,) or (n, k) behind the filters [m/s], every `step` [s]."""
        from scipy.signal import sosfilt  # noqa: PLC0415 (lazy)

        for sections in self._filters(step):
            velocity = sosfilt(sections, velocity, axis=0)
        return velocity

    def gain(self, frequency_hz: np.ndarray) -> np.ndarray:
        """What the filters make of lines (k,), complex; in continuous time."""
        from scipy.signal import butter, freqs_zpk  # noqa: PLC0415 (lazy)

        found = np.ones(len(frequency_hz), dtype=complex)
        for n, f, kind in self._wanted():
            if f > 0.0:
                zpk = butter(n, f, kind, analog=True, output="zpk")
                found *= freqs_zpk(*zpk, worN=frequency_hz)[1]
        return found

    def check_input(self, step: float) -> None:
        """Refuse an input that is too coarse for the sensor.

        Args:
            step: between rows [s].

        Raises:
            ParameterError: it is, or the step is not positive.
        """
        if not 0.0 < step < np.inf:
            raise ParameterError(f"step = {step:g} s must be positive")
        corner = max(self.high_pass_hz, self.low_pass_hz)
        needed = max(self.sampling_hz, 2.0 * corner) * _FINEST
        if 1.0 / step < needed * (1.0 - _WHOLE):
            raise ParameterError(
                f"records every {step:g} s are too coarse for the sensor; it takes "
                f"{1.0 / needed:g} s or less ({option('record_step')})"
            )

    def _every(self, step: float) -> int:
        """Input rows per sample."""
        self.check_input(step)
        ratio = 1.0 / (self.sampling_hz * step)
        if abs(ratio - round(ratio)) > _WHOLE * ratio:
            raise ParameterError(
                f"records every {step:g} s do not fit samples every {1.0 / self.sampling_hz:g} s; "
                "take a whole part of it"
            )
        return round(ratio)

    def _filters(self, step: float) -> list[np.ndarray]:
        """Second-order sections of the filters that are there."""
        from scipy.signal import butter  # noqa: PLC0415 (lazy)

        rate = 1.0 / step
        return [
            butter(n, f, kind, fs=rate, output="sos") for n, f, kind in self._wanted() if f > 0.0
        ]

    def _wanted(self) -> tuple[tuple[int, float, str], ...]:
        """Order, corner [Hz] and kind of the filters; those of 0 Hz are not there."""
        return (
            (2, self.high_pass_hz, "highpass"),
            (2, self.low_pass_hz, "lowpass"),
            (
                ANTI_ALIAS_ORDER,
                ANTI_ALIAS_CORNER * self.sampling_hz if self.anti_alias else 0.0,
                "lowpass",
            ),
        )


def sensor_velocity(
    result: Result, sensors: Sequence[str] = ("A", "B", "C"), *, axis: str = "z", part: str = ""
) -> np.ndarray:
    """Velocity of a housing at its sensors under the bearing forces of a run.

    Args:
        result: of a run with a housing whose modal data have the sensors.
        sensors: names.
        axis: direction that they feel; axial by default.
        part: name of the housing; the first one if not given.

    Returns:
        (n, len(sensors)) [m/s] at the records, equidistant ones if the step was adaptive.

    Raises:
        ParameterError: no forces are recorded, or there is no such sensor.
    """
    result = result.uniform()
    housing = housing_of(result, part)
    known = housing.dofs if housing else ()
    missing = [name for name in sensors if (name, axis) not in known]
    if housing is None or missing:
        raise ParameterError(
            f"the modal data of the run have no sensor {', '.join(missing[:1])} along {axis}; it "
            "takes data with sensors, as 'herringbone housing build' makes them"
        )
    step = float(np.diff(result.data[TIME].to_numpy()[:2])[0])
    modal = recorded_motion(result, housing, step, part)
    return modal @ np.array([housing.shape(name, axis) for name in sensors]).T
