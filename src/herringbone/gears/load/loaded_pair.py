r"""A pair under load over a mesh period: forces and deflections of its halves, transmission error.

The transmission error is how far the wheel stays behind, on the line of action in the transverse
plane: the approach of the gears normal to the flanks over cos(beta_b), mean of both halves. The
halves share the load equally unless there is a symmetry deviation; then see `load_sharing`. It
counts from where the flanks would touch without that deviation.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.load.table_law import TableLaw
from herringbone.gears.stiffness.load_sharing import RIGID, load_sharing
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.two_halves import share, upper_approach


@dataclass(frozen=True)
class Symmetry:
    """Symmetry deviation of a double-helical pair, and what holds its gears axially.

    Attributes:
        deviation: f_A [m].
        pinion_axial_stiffness: [N/m]; 0: it floats; `RIGID`.
        wheel_axial_stiffness: [N/m].
    """

    deviation: float = 0.0
    pinion_axial_stiffness: float = 0.0
    wheel_axial_stiffness: float = RIGID


@dataclass(frozen=True)
class LoadedHalf:
    """One half over a mesh period, each (n,).

    Attributes:
        phases: of its contact lines [mesh periods].
        force: normal force [N].
        deflection: normal to the flank; negative: apart [m].
        secant: force over deflection, 0 where it is apart [N/m].
    """

    phases: np.ndarray
    force: np.ndarray
    deflection: np.ndarray
    secant: np.ndarray


@dataclass(frozen=True)
class LoadedPair:
    """A pair at a torque.

    Attributes:
        pair: gear pair.
        torque: of the pinion [N m].
        phases: (n,) mesh periods.
        halves: left and right, or the only one.
        axial_shift: (n,) of the pinion against the wheel [m].
    """

    pair: GearPair
    torque: float
    phases: np.ndarray
    halves: tuple[LoadedHalf, ...]
    axial_shift: np.ndarray

    @property
    def transmission_error(self) -> np.ndarray:
        """(n,) how far the wheel stays behind, on the transverse line of action [m]."""
        approach = np.mean([half.deflection for half in self.halves], axis=0)
        return approach / math.cos(self.pair.base_helix_angle)

    @property
    def peak_to_peak(self) -> float:
        """Of the transmission error [m]."""
        return float(np.ptp(self.transmission_error))

    @property
    def share_left(self) -> float:
        """Mean share of the load on the left half; 1 for the only half."""
        return float(np.mean(self.halves[0].force / sum(half.force for half in self.halves)))


def loaded_pair(
    stiffness: MeshStiffness, torque: float, symmetry: Symmetry | None = None
) -> LoadedPair:
    """A pair at a torque, from the stiffness table of its half.

    Args:
        stiffness: its loads begin with zero.
        torque: of the pinion [N m].
        symmetry: None: none, and the halves are alike.

    Raises:
        ParameterError: torque not positive, or a symmetry deviation of a pair that is not double
            helical.
    """
    pair, phases, law = stiffness.pair, stiffness.phases, TableLaw(stiffness)
    if symmetry is None:
        force = pair.tooth_forces(torque).normal
        laws = (law.law(phases),) * 2
        nothing = np.zeros(phases.size)
        both = share(laws, 2.0 * force, nothing, upper_approach(laws, force, phases.size))
        halves = tuple(_half(phases, s.force, s.deflection) for s in both[: pair.halves])
        return LoadedPair(pair, torque, phases, halves, nothing)
    found = load_sharing(
        law,
        torque,
        symmetry.deviation,
        pinion_axial_stiffness=symmetry.pinion_axial_stiffness,
        wheel_axial_stiffness=symmetry.wheel_axial_stiffness,
        phases=phases.size,
    )
    shift = symmetry.deviation * math.tan(pair.base_helix_angle) / pair.transverse_base_pitch
    left = _half(phases + shift, found.force_left, found.deflection_left)
    right = _half(phases - shift, found.force_right, found.deflection_right)
    return LoadedPair(pair, torque, phases, (left, right), found.axial_shift)


def over_torque(stiffness: MeshStiffness, symmetry: Symmetry | None = None) -> Sequence[LoadedPair]:
    """A pair at the torques of its table, as far as one half alone can carry them in the table."""
    pair = stiffness.pair
    arm = pair.base_radius[0] * math.cos(pair.base_helix_angle)
    reach = stiffness.loads[-1] if symmetry is None else 0.5 * stiffness.loads[-1]
    loads = [load for load in stiffness.loads if 0.0 < load <= reach]
    return [loaded_pair(stiffness, pair.halves * load * arm, symmetry) for load in loads]


def _half(phases: np.ndarray, force: np.ndarray, deflection: np.ndarray) -> LoadedHalf:
    pressed = deflection > 0.0
    secant = np.divide(force, deflection, out=np.zeros_like(force), where=pressed)
    return LoadedHalf(phases, force, deflection, secant)
