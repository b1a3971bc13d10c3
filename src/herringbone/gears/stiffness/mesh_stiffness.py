"""Mesh stiffness of one half over phase and load, as every method of computing it gives it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from herringbone.components.resources.stiffness_table import mesh_harmonics
from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification


@dataclass(frozen=True)
class Uncertainty:
    """How far a table may be from that of finite elements without limit of resolution.

    What all methods leave out is not in it: teeth that move each other by the gear's body.

    Attributes:
        mean: of the mean stiffness, over it [1].
        harmonics: (n, 4) of the amplitudes of mesh harmonics 1 to 4 at n loads, over the mean [1].
    """

    mean: float
    harmonics: np.ndarray


@dataclass(frozen=True)
class MeshStiffness:
    """Mesh stiffness of one half of a pair; both halves have the same.

    Attributes:
        pair: gear pair.
        modification: of its flanks.
        method: how it was computed, in one line.
        loads: (n,) normal forces of the half [N], ascending, the first may be zero.
        phases: (m,) mesh periods, i / m.
        deflection: (n, m) approach of the gears normal to the flank [m].
        tangent: (n, m) tangent stiffness d(load)/d(deflection) [N/m].
        zero_load_secant: (m,) limit of load / deflection at zero load [N/m].
        uncertainty: of mean and harmonics; None: not known.
    """

    pair: GearPair
    modification: Modification
    method: str
    loads: np.ndarray
    phases: np.ndarray
    deflection: np.ndarray
    tangent: np.ndarray
    zero_load_secant: np.ndarray
    uncertainty: Uncertainty | None = None

    @cached_property
    def secant(self) -> np.ndarray:
        """(n, m) secant stiffness load / deflection [N/m]; at zero load its limit."""
        secant = np.broadcast_to(self.zero_load_secant, self.deflection.shape).copy()
        loaded = self.loads > 0.0
        secant[loaded] = self.loads[loaded, None] / self.deflection[loaded]
        return secant

    @cached_property
    def transmission_error(self) -> np.ndarray:
        """(n, m) static transmission error of the half, along the line of action [m]."""
        return self.deflection / np.cos(self.pair.base_helix_angle)

    def resampled(self, phases: int) -> "MeshStiffness":
        """The same at fewer phases, without the harmonics that they cannot show.

        Points taken out of a curve with kinks would turn what lies above half of their number into
        false low harmonics.
        """
        kept: dict[str, Any] = {
            name: self._band_limited(getattr(self, name), phases)
            for name in ("deflection", "tangent", "zero_load_secant")
        }
        return replace(self, phases=np.arange(phases) / phases, **kept)

    @staticmethod
    def _band_limited(values: np.ndarray, phases: int) -> np.ndarray:
        spectrum = np.fft.rfft(values, axis=-1)[..., : phases // 2 + 1]
        if phases % 2 == 0:
            spectrum[..., -1] = 2.0 * spectrum[..., -1].real
        limited = np.fft.irfft(spectrum, phases, axis=-1) * phases / values.shape[-1]
        return np.maximum(limited, 0.0)

    def mean(self, load: float) -> float:
        """Mean secant stiffness of one half at a load [N/m], between loads by interpolation."""
        return float(np.interp(load, self.loads, self.secant.mean(axis=1)))

    def harmonics(self) -> np.ndarray:
        """(n, m//2) amplitudes of the secant's mesh harmonics 1 to m//2, over its mean.

        Zero where the stiffness is.
        """
        amplitudes = mesh_harmonics(self.secant)
        mean = self.secant.mean(axis=1, keepdims=True)
        return np.divide(amplitudes, mean, out=np.zeros_like(amplitudes), where=mean > 0.0)


def checked_loads(loads: Sequence[float]) -> np.ndarray:
    """Loads [N] as an array.

    Raises:
        ParameterError: not finite, not ascending, or none above zero.
    """
    forces = np.asarray(loads, dtype=float)
    if forces.ndim != 1 or forces.size == 0 or not np.all(np.isfinite(forces)):
        raise ParameterError(f"loads {loads} N must be finite numbers, at least one")
    if forces[0] < 0.0 or np.any(np.diff(forces) <= 0.0) or forces[-1] == 0.0:
        raise ParameterError(
            f"loads {', '.join(f'{f:g}' for f in forces)} N must ascend from zero or above"
        )
    return forces
