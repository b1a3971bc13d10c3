"""Factor on the slices' compliance of teeth and foundations that finite elements ask for.

Both slice methods against finite elements, each pair with its own factor, the same in the mean:
amplitudes of the first two mesh harmonics over those of the finite elements
(`calibrate(...).harmonic_ratio`).

    pair, pinion torque           k N/m   slices: factor  H1    H2   coupled: factor  H1    H2
    FZG C spur 16/24, 200 N m    2.372e8          0.934  1.03  0.99           0.934  1.03  0.99
    27/81, 30 deg, 200 N m       1.859e9          0.884  0.89  0.91           1.188  1.13  1.00
    27/81, 30 deg, 2000 N m      2.029e9          0.880  0.81  1.02           1.188  1.12  0.93
    24/95, 10 deg, 20 kN m       7.519e9          0.827  1.23  0.24           0.914  0.99  1.10

One factor holds for all loads: from 200 to 4000 N m the mean of the 27/81 pair departs by 0.5 %
(slices) and 0.1 % (coupled slices).  What the slices miss is that the parts of a tooth support each
other along the face; where that is taken from the finite elements, they show the slices' harmonics.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from herringbone.core import ParameterError
from herringbone.gears.finite_elements.mesh import FiniteElementMesh
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.calibration import full_torque
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.slices import PHASES, SliceMesh

_RANGE = (0.2, 4.0)
_TOLERANCE = 1e-5

SliceModel = Callable[..., SliceMesh | CoupledSliceMesh]


@dataclass(frozen=True)
class Calibration:
    """Slices against finite elements at one load, equal in the mean.

    Attributes:
        factor: on the slices' compliance of teeth and foundations.
        elements: mesh stiffness by finite elements.
        slices: mesh stiffness by the calibrated slices.
    """

    factor: float
    elements: MeshStiffness
    slices: MeshStiffness

    @property
    def harmonic_ratio(self) -> np.ndarray:
        """Amplitudes of the mesh harmonics, slices over finite elements."""
        return self.slices.harmonics()[0] / self.elements.harmonics()[0]


def calibrate(
    mesh: FiniteElementMesh, load: float, model: SliceModel = SliceMesh, phases: int = PHASES
) -> Calibration:
    """Calibrate a slice model so that its mean secant stiffness is that of finite elements.

    Args:
        mesh: finite-element model; its compliance is computed if it was not yet.
        load: normal force of one half [N].
        model: `SliceMesh` or `CoupledSliceMesh`.
        phases: number of equidistant phases.

    Raises:
        ParameterError: no factor between 0.2 and 4 will do.
    """
    elements = mesh.solve([load], phases)
    wanted = elements.secant.mean()

    def slices(factor: float) -> MeshStiffness:
        return model(mesh.pair, mesh.modification, calibration=factor).solve([load], phases)

    def excess(factor: float) -> float:
        return slices(factor).secant.mean() / wanted - 1.0

    if excess(_RANGE[0]) * excess(_RANGE[1]) > 0.0:
        raise ParameterError(
            f"no calibration factor between {_RANGE[0]:g} and {_RANGE[1]:g} gives the slices the "
            f"mean stiffness {wanted:.4g} N/m of the finite elements at {load:g} N; check the "
            "hub: bore_diameter of the pair"
        )
    factor = float(brentq(excess, *_RANGE, xtol=_TOLERANCE))
    return Calibration(factor, elements, slices(factor))


def calibration_factor(
    pair: GearPair, load: float | None = None, model: SliceModel = SliceMesh
) -> float:
    """Calibration factor of a pair.

    Args:
        pair: gear pair.
        load: normal force of one half [N]; None: that of 100 N/mm of tangential load per face
            width, above which ISO 6336-1 takes the stiffness as constant.
        model: `SliceMesh` or `CoupledSliceMesh`.

    Raises:
        ParameterError: see `calibrate` and `FiniteElementMesh`.
    """
    if load is None:
        load = pair.tooth_forces(full_torque(pair)).normal
    return calibrate(FiniteElementMesh(pair), load, model).factor
