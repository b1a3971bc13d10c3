"""Methods of computing the mesh stiffness, by name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from herringbone.core import ParameterError
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.contact_slices import SLICES
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness
from herringbone.gears.stiffness.point_mesh import PointMesh, Progress, silent
from herringbone.gears.stiffness.slices import PHASES, SliceMesh

_OVERSAMPLING = 4
"""Phases that the slices are solved at, over those of the table."""


@dataclass(frozen=True)
class Task:
    """What is asked of a method.

    Attributes:
        pair: gear pair.
        loads: normal forces of one half [N], ascending from zero.
        modification: of the flanks.
        phases: number of equidistant phases.
        calibration: factor on the compliance of teeth and foundations; of both slice methods.
        slices: across the face; of the method "slices".
        corner_contact: follow tip corners outside the path of contact.
    """

    pair: GearPair
    loads: Sequence[float]
    modification: Modification = field(default_factory=Modification)
    phases: int = PHASES
    calibration: float = 1.0
    slices: int = SLICES
    corner_contact: bool = False


def _slices(task: Task, progress: Progress | None) -> SliceMesh:
    return SliceMesh(
        task.pair,
        task.modification,
        calibration=task.calibration,
        slices=task.slices,
        corner_contact=task.corner_contact,
    )


def _coupled_slices(task: Task, progress: Progress | None) -> PointMesh:
    return CoupledSliceMesh(
        task.pair,
        task.modification,
        calibration=task.calibration,
        corner_contact=task.corner_contact,
    )


def _finite_elements(task: Task, progress: Progress | None) -> PointMesh:
    from herringbone.gears.finite_elements import FiniteElementMesh  # noqa: PLC0415 (uses METHODS)

    return FiniteElementMesh(
        task.pair,
        task.modification,
        corner_contact=task.corner_contact,
        progress=progress or silent,
    )


METHODS: dict[str, Callable[[Task, Progress | None], SliceMesh | PointMesh]] = {
    "slices": _slices,
    "coupled-slices": _coupled_slices,
    "fe": _finite_elements,
}
"""What makes the mesh of each method."""


def check_method(method: str) -> None:
    """Raises ParameterError if there is no such method."""
    if method not in METHODS:
        raise ParameterError(f"method '{method}' is none of {', '.join(METHODS)}")


def mesh_stiffness(
    task: Task, method: str = "slices", progress: Progress | None = None
) -> MeshStiffness:
    """Mesh stiffness of one half over phase and load.

    Raises:
        ParameterError: the method is unknown, or see the method.
    """
    check_method(method)
    mesh = METHODS[method](task, progress)
    return mesh.solve(task.loads, _OVERSAMPLING * task.phases).resampled(task.phases)
