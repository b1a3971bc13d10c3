r"""Static loaded contact of a whole double-helical pair with a symmetry deviation.

The apex of the chevron lies f_A beside its place; the pinion moves axially by zeta against the
wheel, held by axial stiffnesses k_p of the pinion and k_w of the wheel. With the approach delta of
the gears normal to the flanks, shared by both halves:

    delta_L = delta + u,   delta_R = delta - u,   u = sin(beta_b) (zeta + f_A) - c (F_L - F_R) / 2
    F_L(delta_L) + F_R(delta_R) = T_1 / (r_b1 cos(beta_b))
    sin(beta_b) (F_L - F_R) = -k zeta,    1/k = 1/k_p + 1/k_w

c is the compliance of the gap shafts, through which a half that carries more twists and bends away
from its sister (`gap_shaft_compliance`). The contact lines of the halves are shifted by
+-f_A tan(beta_b) / p_bt of a mesh period. A floating pinion (k_p = 0) takes zeta = -f_A but for the
ripple of the mesh: no constant deviation loads the halves unequally then. The deviation is never
part of a stiffness table: that is a function of the phase and of the half's own load.

The half's force law comes from a slice model, or from a stiffness table of any method (`TableLaw`).

What the stiffness of the whole pair is, is a matter of definition once the halves differ; see the
properties of `LoadSharing`.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.slices import Law
from herringbone.gears.stiffness.two_halves import half_difference, share, upper_approach

RIGID = math.inf


class HalfMesh(Protocol):
    """One half of a pair with its force law: `SliceMesh` or `TableLaw`."""

    @property
    def pair(self) -> GearPair:
        """Gear pair."""

    def law(self, phases: np.ndarray) -> Law:
        """Force law at phases (n,) [mesh periods]."""


@dataclass(frozen=True)
class LoadSharing:
    """Equilibrium of both halves; arrays over the phases.

    Attributes:
        phases: (n,) mesh periods.
        force_left, force_right: normal forces [N].
        deflection_left, deflection_right: normal deflections; negative: apart [m].
        axial_shift: zeta [m].
    """

    phases: np.ndarray
    force_left: np.ndarray
    force_right: np.ndarray
    deflection_left: np.ndarray
    deflection_right: np.ndarray
    axial_shift: np.ndarray

    @property
    def approach(self) -> np.ndarray:
        """(n,) approach of the gears normal to the flanks, mean of both halves [m]."""
        return 0.5 * (self.deflection_left + self.deflection_right)

    @property
    def secant_left(self) -> np.ndarray:
        """(n,) k_L: force over own deflection [N/m]; 0 where the half is apart."""
        return _secant(self.force_left, self.deflection_left)

    @property
    def secant_right(self) -> np.ndarray:
        """(n,) k_R: force over own deflection [N/m]; 0 where the half is apart."""
        return _secant(self.force_right, self.deflection_right)

    @property
    def share_left(self) -> float:
        """Mean share of the load that the left half carries."""
        return float(np.mean(self.force_left / (self.force_left + self.force_right)))

    @property
    def stiffness_left(self) -> float:
        """Mean of k_L [N/m]."""
        return float(np.mean(self.secant_left))

    @property
    def stiffness_right(self) -> float:
        """Mean of k_R [N/m]."""
        return float(np.mean(self.secant_right))

    @property
    def stiffness_by_mean_approach(self) -> float:
        """Mean of the whole force over the mean of both deflections [N/m]."""
        return float(np.mean((self.force_left + self.force_right) / self.approach))

    @property
    def stiffness_by_loaded_half(self) -> float:
        """Mean of the whole force over the larger deflection [N/m]."""
        larger = np.maximum(self.deflection_left, self.deflection_right)
        return float(np.mean((self.force_left + self.force_right) / larger))


def _secant(force: np.ndarray, deflection: np.ndarray) -> np.ndarray:
    return np.divide(force, deflection, out=np.zeros_like(force), where=deflection > 0.0)


def gap_shaft_compliance(pair: GearPair, radial_bearing_stiffness: float = 0.0) -> float:
    """Difference of both halves' deflections over that of their forces, through the shafts [m/N].

        c = cos(beta_b)^2 sum over gears of 1/(k_r + 2 k_y) + r_b^2 / (2 k_t)

    Args:
        pair: double-helical pair.
        radial_bearing_stiffness: k_r of each half against ground [N/m].
    """
    total = 0.0
    for base, shaft in zip(pair.base_radius, pair.gap_shaft, strict=True):
        total += 1.0 / (radial_bearing_stiffness + 2.0 * shaft.radial)
        total += base**2 / (2.0 * shaft.torsional)
    return math.cos(pair.base_helix_angle) ** 2 * total


def load_sharing(
    mesh: HalfMesh,
    torque: float,
    symmetry_deviation: float,
    *,
    pinion_axial_stiffness: float = 0.0,
    wheel_axial_stiffness: float = RIGID,
    shaft_compliance: float = 0.0,
    phases: int = 16,
) -> LoadSharing:
    """Solve the equilibrium of both halves over a mesh period.

    Args:
        mesh: one half.
        torque: of the pinion, half of it on either side [N m].
        symmetry_deviation: f_A, constant over the mesh period [m].
        pinion_axial_stiffness: k_p against ground [N/m]; 0: it floats; `RIGID`.
        wheel_axial_stiffness: k_w against ground [N/m].
        shaft_compliance: c [m/N].
        phases: number of equidistant phases.

    Raises:
        ParameterError: the pair is not double helical, torque not positive, or a stiffness or the
            compliance negative.
    """
    _check(mesh.pair, torque, pinion_axial_stiffness, wheel_axial_stiffness, shaft_compliance)
    pair, at = mesh.pair, np.arange(phases) / phases
    angle = pair.base_helix_angle  # its sign is the hand
    sine, shift = math.sin(angle), symmetry_deviation * math.tan(angle) / pair.transverse_base_pitch
    laws = mesh.law(at + shift), mesh.law(at - shift)
    force = torque / (pair.base_radius[0] * math.cos(angle))
    most = upper_approach(laws, force, phases)
    axial = sum(
        1.0 / k if k > 0.0 else math.inf for k in (pinion_axial_stiffness, wheel_axial_stiffness)
    )
    compliance = sine**2 * axial + 0.5 * shaft_compliance
    offset = sine * symmetry_deviation
    half = half_difference(laws, force, most, offset, compliance)
    left, right = share(laws, force, half, most)
    own = 0.5 * shaft_compliance * (left.force - right.force)
    zeta = (half + own) / sine - symmetry_deviation
    return LoadSharing(at, left.force, right.force, left.deflection, right.deflection, zeta)


def check_held(pair: GearPair, torque: float, pinion: float, wheel: float) -> None:
    """Check what a load is shared by: a double-helical pair, its torque, axial stiffnesses [N/m].

    Raises:
        ParameterError: the pair is not double helical, torque not positive, a stiffness negative.
    """
    if pair.halves != 2 or pair.helix_angle == 0.0:
        raise ParameterError("load sharing is of double-helical pairs: halves 2 and a helix angle")
    if not torque > 0.0:
        raise ParameterError(f"torque {torque:g} N m must be positive")
    for name, value in (("pinion", pinion), ("wheel", wheel)):
        if not value >= 0.0:
            raise ParameterError(
                f"axial stiffness {value:g} N/m of the {name} must not be negative"
            )


def _check(pair: GearPair, torque: float, pinion: float, wheel: float, compliance: float) -> None:
    check_held(pair, torque, pinion, wheel)
    if not compliance >= 0.0:
        raise ParameterError(f"shaft compliance {compliance:g} m/N must not be negative")
