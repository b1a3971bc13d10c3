"""Sound power that a housing radiates: an estimate from the bearing forces of a run.

The forces on the seats drive the housing's oscillators; their velocities v(t) give the normal
velocity of the outer surface, and with the Gram matrix S of the surface the equivalent radiated
power (ERP)

    P = rho c  mean of  v^T S v

which takes every piece of surface to radiate as a large plane does. It is an upper-type estimate:
a boundary-element solution of the default housing's envelope gave 5 dB less for the modes below
500 Hz, and -1 to +2 dB from there to 1200 Hz. Bearing forces are taken as cubic splines
between records, for which the oscillators are solved exactly.

Source: F. Fahy, P. Gardonio, Sound and Structural Vibration, 2nd ed., sections 3.3 and 3.6.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np

from herringbone.analysis.figures.modal_response import (
    housing_of,
    modal_velocity_amplitudes,
    recorded_motion,
    seat_forces,
)
from herringbone.analysis.figures.operating_point import SteadyPart, steady_part
from herringbone.analysis.figures.remembered_figures import figure_of
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, amplitude_spectrum
from herringbone.core import ParameterError
from herringbone.core.facts import Facts
from herringbone.housing import ModalHousing
from herringbone.result.result import Result

AIR_DENSITY = 1.204
"""[kg/m3] at 20 degrees Celsius."""
SPEED_OF_SOUND = 343.2
"""[m/s] at 20 degrees Celsius."""
REFERENCE_POWER = 1e-12
"""Of levels [W] (ISO 1683)."""
RADIATED = "radiated_power"
"""Column of its level [dB re 1 pW] in the table of a study."""
LABEL = "equivalent radiated power, upper-type estimate, about +5 dB below 500 Hz"
_HANN_BANDWIDTH = 1.5
"""Equivalent noise bandwidth of the Hann window, in bins."""


@dataclass(frozen=True, repr=False)
class RadiatedPower(Facts):
    """Equivalent radiated power over the steady part of a run, or of a steady state.

    Attributes:
        frequency_hz: (k,) up to where the housing's data hold [Hz]; of a steady state its lines.
        power: (k,) in each bin [W]; a single tone spreads over three bins, whose sum is its power.
            Of a steady state that of each line.
        resolution_hz: distance of bins [Hz]; of a steady state that of two harmonics.
        highest_hz: up to where it is known [Hz].
    """

    frequency_hz: np.ndarray
    power: np.ndarray
    resolution_hz: float
    highest_hz: float

    @property
    def total(self) -> float:
        """Sum of all bins [W]."""
        return float(self.power.sum())

    @property
    def level_db(self) -> float:
        """Sound power level [dB re 1 pW]; -inf if nothing moves."""
        return float(level_db(self.total))

    @property
    def told(self) -> str:
        """Level and loudest frequency, for people."""
        level = f"{self.level_db:.1f} dB re 1 pW up to {self.highest_hz:.0f} Hz"
        if not self.total > 0.0:
            return level
        return f"{level}, most at {self.frequency_hz[self.power.argmax()]:.0f} Hz"

    def _facts(self) -> dict[str, str]:
        return {"level": self.told}


def level_db(power: np.ndarray | float) -> np.ndarray:
    """Levels of powers [W] in dB re 1 pW; -inf of zero."""
    with np.errstate(divide="ignore"):
        return 10.0 * np.log10(np.asarray(power) / REFERENCE_POWER)


def power_inputs(
    result: Result, housing: ModalHousing | None = None, *, part: str = ""
) -> tuple[ModalHousing, np.ndarray, SteadyPart]:
    """What the radiated power is computed of: modal data, forces (n, 12) [N], the steady part.

    Args and errors: as of `radiated_power`; the result has equidistant records.
    """
    forces = seat_forces(result, part)
    housing = housing or housing_of(result, part)
    housing = with_surface(housing)
    steady = steady_part(result)
    if result.outcome.unstable:
        raise ParameterError("the run diverged: no radiated power")
    if steady.end - steady.begin < FEWEST_SAMPLES / housing.valid_to_hz:
        raise ParameterError(f"{steady.end - steady.begin:g} s are too short for a radiated power")
    return housing, forces, steady


def with_surface(housing: ModalHousing | None) -> ModalHousing:
    """The same data; raises ParameterError if they do not tell of the surface."""
    if housing is None or housing.gram is None:
        raise ParameterError(
            "no Gram matrix of the surface: the radiated power takes modal data with "
            "surface_gram.csv, as `herringbone housing build` makes them"
        )
    return housing


def power_of_lines(
    housing: ModalHousing, frequency_hz: np.ndarray, forces: np.ndarray
) -> np.ndarray:
    """Power (k,) that each of harmonic forces has radiated [W]; 0 where the data do not hold.

    Args:
        housing: with a Gram matrix of the surface.
        frequency_hz: (k,) of the forces, not 0 [Hz].
        forces: (12, k) complex amplitudes at the seats [N], in the order of `SEAT_DOFS`.
    """
    modal = modal_velocity_amplitudes(housing, frequency_hz, forces)
    power = np.einsum("mk,mn,nk->k", modal.conj(), np.asarray(housing.gram), modal).real
    power[frequency_hz > housing.valid_to_hz] = 0.0
    return 0.5 * AIR_DENSITY * SPEED_OF_SOUND * power


def radiated_power(
    result: Result, housing: ModalHousing | None = None, *, part: str = ""
) -> RadiatedPower:
    """Estimate the sound power that a housing radiates under the bearing forces of a run.

    Args:
        result: of a run that records the forces on the seats.
        housing: modal data with a Gram matrix of the surface; what the run used if not given.
        part: name of the housing; the first one of the run if not given.

    Raises:
        ParameterError: there is no housing, no forces are recorded, the run diverged or is too
            short, or there is no Gram matrix.
    """
    result = result.uniform()
    housing, forces, steady = power_inputs(result, housing, part=part)
    data = (housing.frequency_hz, housing.damping_ratio, housing.seat_shapes, housing.gram)
    return figure_of(
        partial(_estimate, result, housing, part, steady),
        "radiated power", *data, housing.valid_to_hz, forces, result.first_record, steady,
    )  # fmt: skip


def _estimate(
    result: Result, housing: ModalHousing, part: str, steady: SteadyPart
) -> RadiatedPower:
    gram = np.asarray(housing.gram)  # it is there: see above
    velocity = recorded_motion(result, housing, steady.sample_step, part)[steady.rows]
    squares, directions = np.linalg.eigh(gram)
    surface = velocity @ (directions * np.sqrt(np.maximum(squares, 0.0)))
    spectrum = amplitude_spectrum(surface, steady.sample_step)
    power = 0.5 * AIR_DENSITY * SPEED_OF_SOUND * np.square(spectrum.amplitude).sum(axis=1)
    if len(surface) % 2 == 0:  # a line at half the rate has the mean square of its amplitude
        power[-1] *= 2.0
    shown = spectrum.frequency <= housing.valid_to_hz
    highest = min(housing.valid_to_hz, float(spectrum.frequency[-1]))
    return RadiatedPower(
        spectrum.frequency[shown], power[shown] / _HANN_BANDWIDTH, spectrum.resolution, highest
    )
