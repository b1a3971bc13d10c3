"""Methods of computing the mesh stiffness, by name."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from herringbone.core import ParameterError
from herringbone.gears.gear_pair import GearPair
from herringbone.gears.mesh_stiffness import MeshStiffness
from herringbone.gears.modification import Modification
from herringbone.gears.slices import PHASES, SLICES, SliceMesh

_OVERSAMPLING = 4
"""Phases that the slices are solved at, over those of the table."""
Progress = Callable[[str, float], None]
"""Called with what is done and how much of it, 0 to 1."""


@dataclass(frozen=True)
class Task:
    """What is asked of a method.

    Attributes:
        pair: gear pair.
        loads: normal forces of one half [N], ascending from zero.
        modification: of the flanks.
        phases: number of equidistant phases.
        calibration: factor on the compliance of teeth and foundations; of slices only.
        slices: across the face; of slices only.
        corner_contact: follow tip corners outside the path of contact.
    """

    pair: GearPair
    loads: Sequence[float]
    modification: Modification = field(default_factory=Modification)
    phases: int = PHASES
    calibration: float = 1.0
    slices: int = SLICES
    corner_contact: bool = False


def _slices(task: Task, progress: Progress | None = None) -> MeshStiffness:
    mesh = SliceMesh(
        task.pair,
        task.modification,
        calibration=task.calibration,
        slices=task.slices,
        corner_contact=task.corner_contact,
    )
    return mesh.solve(task.loads, _OVERSAMPLING * task.phases).resampled(task.phases)


METHODS: dict[str, Callable[..., MeshStiffness]] = {"slices": _slices}
"""`method(task, progress)`."""


def mesh_stiffness(
    task: Task, method: str = "slices", progress: Progress | None = None
) -> MeshStiffness:
    """Mesh stiffness of one half over phase and load.

    Raises:
        ParameterError: the method is unknown, or see the method.
    """
    if method not in METHODS:
        raise ParameterError(f"method '{method}' is none of {', '.join(METHODS)}")
    return METHODS[method](task, progress)
