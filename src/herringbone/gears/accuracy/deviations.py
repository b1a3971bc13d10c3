r"""Deviations of the teeth of a gear, and gears whose deviations use up the tolerances of a class.

All deviations are those of one flank of each tooth, the drive flank, which carries when the pinion
drives, or the coast flank, in the transverse plane, positive where there is more material than the
ideal flank has:

    pitch    position of the flank at the reference circle, along its arc
    profile  slope over the active profile: from -1/2 of it at the root to +1/2 at the tip,
             along the base tangent
    helix    slope over the face width: from -1/2 of it at face coordinate 0 to +1/2 at b,
             along the base tangent

**Run-out is no deviation of its own.** Teeth whose centre lies e beside the axis have a run-out
e cos(theta_j) and a cumulative pitch -s e sin(theta_j - s alpha_t) / cos(alpha_t), theta counted as
the flanks are; s = 1 for flanks that face that way (drive flanks of the wheel, coast flanks of the
pinion), -1 for the others. The pitch, measured about the gear's axis, holds the run-out: who adds
both counts it twice.

**Gears of a class.** Cumulative pitch is the eccentric part and a random one of each tooth, in the
shares at which both the single pitch deviation and the range of the cumulative one are those of the
tolerances. Gears of few teeth reach the first only: half a turn of pitches, all at their limit, has
less than the cumulative tolerance. Slopes have a part that all teeth share and a random one.
Extremes equal the tolerances, which makes the gear the worst that the class lets pass. Drive and
coast flanks of a gear lie about one centre, in one direction beside the axis, and have tolerances
used up in the same way; their random parts have nothing in common.
"""

from dataclasses import dataclass, replace

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.accuracy.iso1328 import FlankTolerances, flank_tolerances
from herringbone.gears.geometry.gear_pair import GearPair

_MIX = 0.999
"""Largest share of the random part of the cumulative pitch."""
_COMMON = 0.5
"""Part of a slope that all teeth share, of its tolerance at most."""


@dataclass(frozen=True)
class ToothDeviations:
    """Deviations of one flank of the teeth of one half of one gear [m], each of shape (z,).

    Teeth are counted in the order in which they mesh when the pinion drives, against the rotation;
    face coordinates are those of the drive flank. Both hold for either flank.

    Attributes:
        cumulative_pitch: of each tooth; only differences count.
        run_out: radial position of each tooth, the same of both flanks; see the module.
        profile_slope: f_Halpha.
        helix_slope: f_Hbeta.
    """

    cumulative_pitch: np.ndarray
    run_out: np.ndarray
    profile_slope: np.ndarray
    helix_slope: np.ndarray

    @property
    def single_pitch(self) -> np.ndarray:
        """(z,) of the pitch before each tooth [m]; the first follows the last."""
        return self.cumulative_pitch - np.roll(self.cumulative_pitch, 1)


def deviations(
    pair: GearPair,
    grade: int | tuple[int, int],
    seed: int,
    half: int = 0,
    *,
    coast: bool = False,
) -> tuple[ToothDeviations, ToothDeviations]:
    """Deviations of pinion and wheel whose extremes equal the tolerances of a class.

    The same seed gives the same deviations on every platform: random numbers of the drive flanks
    of a gear are of PCG64 with (seed, half, gear), those of the coast flanks with
    (seed, half, gear, 1); gear 0 is the pinion.

    Args:
        pair: gear pair.
        grade: ISO 1328-1 tolerance class, one or (pinion, wheel).
        seed: zero or positive.
        half: 0 left, 1 right: cut on their own, halves differ.
        coast: of the coast flanks, in place of the drive flanks.

    Raises:
        ParameterError: see `flank_tolerances`; or the seed is negative.
    """
    if seed < 0:
        raise ParameterError(f"seed {seed} of the tooth deviations must be zero or positive")
    grades = grade if isinstance(grade, tuple) else (grade, grade)
    pinion, wheel = (
        _gear(pair, gear, flank_tolerances(pair, gear, grades[gear]), [seed, half, gear], coast)
        for gear in range(2)
    )
    return pinion, wheel


class _Random:
    """Evenly distributed numbers -1 to 1, of which numpy guarantees the bits for all times."""

    def __init__(self, seed: list[int]) -> None:
        self._bits = np.random.PCG64(np.random.SeedSequence(seed))

    def __call__(self, count: int) -> np.ndarray:
        raw = np.atleast_1d(self._bits.random_raw(count))
        return (raw >> np.uint64(11)).astype(float) * 2.0**-52 - 1.0


def _gear(
    pair: GearPair, gear: int, tolerances: FlankTolerances, seed: list[int], coast: bool
) -> ToothDeviations:
    teeth, faces = pair.number_of_teeth[gear], (-1.0, 1.0)[gear]
    random = _Random(seed)
    angle = 2.0 * np.pi * np.arange(teeth) / teeth + np.pi * random(1)
    drive = _flank(pair, angle, faces, tolerances, random)
    if not coast:
        return drive
    angle -= faces * np.pi / teeth  # the other side of the tooth
    other = _flank(pair, angle, -faces, tolerances, _Random([*seed, 1]))
    return replace(other, run_out=drive.run_out)


def _flank(
    pair: GearPair, angle: np.ndarray, faces: float, tolerances: FlankTolerances, random: _Random
) -> ToothDeviations:
    """Flanks at angles from where the centre lies, that face along the count or (-1) against it."""
    teeth = angle.size
    scatter = random(teeth)
    eccentric = -faces * np.sin(angle - faces * pair.transverse_pressure_angle)
    cumulative, share = _cumulative_pitch(eccentric, scatter, tolerances)
    run_out = (1.0 - share) * np.cos(angle) + share * random(teeth)
    return ToothDeviations(
        cumulative,
        run_out * tolerances.run_out / np.ptp(run_out),
        _slopes(tolerances.profile_slope, teeth, random),
        _slopes(tolerances.helix_slope, teeth, random),
    )


def _cumulative_pitch(
    eccentric: np.ndarray, scatter: np.ndarray, tolerances: FlankTolerances
) -> tuple[np.ndarray, float]:
    """Cumulative pitch [m], and the share of its random part."""
    from scipy.optimize import brentq  # noqa: PLC0415 (lazy)

    wanted = tolerances.single_pitch / tolerances.cumulative_pitch

    def shape(share: float) -> np.ndarray:
        return (1.0 - share) * eccentric + share * scatter

    def excess(share: float) -> float:
        return _steepest(shape(share)) / np.ptp(shape(share)) - wanted

    if excess(0.0) >= 0.0:
        return eccentric * tolerances.single_pitch / _steepest(eccentric), 0.0
    share = brentq(excess, 0.0, _MIX, xtol=1e-14) if excess(_MIX) > 0.0 else _MIX
    found = shape(share)
    return found * tolerances.cumulative_pitch / np.ptp(found), share


def _steepest(position: np.ndarray) -> float:
    """Largest difference of neighbours."""
    return float(np.abs(position - np.roll(position, 1)).max())


def _slopes(tolerance: float, teeth: int, random: _Random) -> np.ndarray:
    values = _COMMON * random(1) + (1.0 - _COMMON) * random(teeth)
    return values * tolerance / np.abs(values).max()
