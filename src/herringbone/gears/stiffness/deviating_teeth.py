"""Loaded contact of teeth that deviate, by the models of the mesh: every tooth with its own gaps.

At phase p the pair of teeth n, that is tooth n modulo z of either gear, counted from 0, is at the
position p - n of its way through the mesh. The gap along its line is that of ideal teeth less the
material that both teeth have beyond them (see `accuracy.deviations`), normal to the flank.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.gears.accuracy.deviations import ToothDeviations
from herringbone.gears.geometry.contact_lines import cut_lines
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.contact_slices import Line, LineLoad, Slices
from herringbone.gears.stiffness.equilibrium import balance
from herringbone.gears.stiffness.pair_law import line_number
from herringbone.gears.stiffness.point_mesh import PointMesh
from herringbone.gears.stiffness.slices import SliceMesh

_AT_ONCE = 128
"""Phases that are solved together."""
_NO_CONTACT = 1.0
"""Gap [m] of what lies outside of the path of contact."""


def normal_deviations(pair: GearPair, teeth: ToothDeviations) -> np.ndarray:
    """(z, 3) position, profile and helix slope of each tooth, normal to the flank [m]."""
    normal = math.cos(pair.base_helix_angle)
    arc = normal * math.cos(pair.transverse_pressure_angle)
    return np.column_stack(
        [arc * teeth.cumulative_pitch, normal * teeth.profile_slope, normal * teeth.helix_slope]
    )


@dataclass(frozen=True)
class DeviatingTeeth:
    """One half whose teeth deviate.

    Args:
        mesh: model of the half.
        deviations: of pinion and wheel.
    """

    mesh: SliceMesh | PointMesh
    deviations: Sequence[ToothDeviations]

    @property
    def pair(self) -> GearPair:
        """Gear pair."""
        return self.mesh.pair if isinstance(self.mesh, SliceMesh) else self.mesh.lines.pair

    def deflections(self, phases: np.ndarray, force: float) -> np.ndarray:
        """(n,) approach of the gears normal to the flanks [m], from where ideal teeth touch.

        Args:
            phases: (n,) mesh periods, of any turn.
            force: normal force of the half [N].

        Raises:
            ParameterError: the load is too large for the pair.
        """
        mesh = self.mesh
        if isinstance(mesh, SliceMesh):
            parts = np.split(phases, range(_AT_ONCE, len(phases), _AT_ONCE))
            found = [mesh.loaded(self._slices(mesh, part), force)[0] for part in parts]
            return np.concatenate(found)
        points = (mesh.points_of(self._lines(phase)) for phase in phases.tolist())
        return np.array([balance(of_phase, force).deflection for of_phase in points])

    def line_load(self, phase: float, force: float) -> LineLoad:
        """Load on the contact lines at a phase and a normal force of the half [N]."""
        return self.mesh.load_of(self._lines(phase), force)

    def material(self, number: np.ndarray, path: np.ndarray, face: np.ndarray) -> np.ndarray:
        """What both flanks of pairs have beyond ideal ones [m].

        Args:
            number: n of the pairs.
            path, face: places on path of contact and face [m].
        """
        pair = self.pair
        pinion, wheel = (
            normal_deviations(pair, teeth)[number % z]
            for teeth, z in zip(self.deviations, pair.number_of_teeth, strict=True)
        )
        of_profile = (pinion - wheel)[..., 1] * (path / pair.length_of_path_of_contact - 0.5)
        both = pinion + wheel
        return both[..., 0] + of_profile + both[..., 2] * (face / pair.face_width - 0.5)

    def _lines(self, phase: float) -> list[Line]:
        lines, turn = self.mesh if isinstance(self.mesh, SliceMesh) else self.mesh.lines, phase // 1
        found = []
        for line in lines.lines(phase - turn):
            path, face, slices = line
            number = np.array(int(turn) - line_number(self.pair, line, phase - turn))
            gap = slices.gap - self.material(number, path, face)
            found.append((path, face, slices._replace(gap=gap)))
        return found

    def _slices(self, mesh: SliceMesh, phases: np.ndarray) -> Slices:
        turn, pair = np.floor(phases), self.pair
        path, face, share = cut_lines(pair, mesh.slices, phases - turn, *mesh.limits())
        lean = math.tan(abs(pair.base_helix_angle)) * (pair.face_width - face)
        position = (path + lean) / pair.transverse_base_pitch
        number = np.rint(phases[:, None] - position).astype(int)
        slices = mesh.cut(phases - turn)
        gap = slices.gap - self.material(number, path, face)
        return slices._replace(gap=np.where(share > 0.0, gap, _NO_CONTACT))
