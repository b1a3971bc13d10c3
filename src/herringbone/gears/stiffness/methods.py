"""Methods of computing the mesh stiffness, by name."""

import importlib.util
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.process.activity import A_WHILE
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.stiffness.calibration import default_calibration
from herringbone.gears.stiffness.contact_slices import SLICES
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness, Uncertainty
from herringbone.gears.stiffness.point_mesh import PointMesh, Progress, silent
from herringbone.gears.stiffness.slices import PHASES, SliceMesh

AUTO = "auto"
"""The best method that this installation has."""
OVERSAMPLING = 4
"""Phases that the slices are solved at, over those of the table."""
_STATED = 4
"""Mesh harmonics whose uncertainty is stated."""


@dataclass(frozen=True)
class Task:
    """What is asked of a method.

    Attributes:
        pair: gear pair.
        loads: normal forces of one half [N], ascending from zero.
        modification: of the flanks.
        phases: number of equidistant phases.
        calibration: factors on the compliance of teeth and bodies, by method; of a method that is
            not named: see `calibration`.
        slices: across the face; of the method "slices".
        corner_contact: follow tip corners outside the path of contact.
    """

    pair: GearPair
    loads: Sequence[float]
    modification: Modification = field(default_factory=Modification)
    phases: int = PHASES
    calibration: Mapping[str, float] = field(default_factory=dict)
    slices: int = SLICES
    corner_contact: bool = False

    def calibration_of(self, method: str) -> float:
        """Factor of a method."""
        given = self.calibration.get(method)
        return default_calibration(self.pair, method) if given is None else given


def _slices(task: Task, progress: Progress) -> SliceMesh:
    return SliceMesh(
        task.pair,
        task.modification,
        calibration=task.calibration_of("slices"),
        slices=task.slices,
        corner_contact=task.corner_contact,
    )


def _coupled_slices(task: Task, progress: Progress) -> PointMesh:
    return CoupledSliceMesh(
        task.pair,
        task.modification,
        calibration=task.calibration_of("coupled-slices"),
        corner_contact=task.corner_contact,
    )


def _finite_elements(task: Task, progress: Progress) -> PointMesh:
    from herringbone.gears.finite_elements import FiniteElementMesh  # noqa: PLC0415 (uses METHODS)

    return FiniteElementMesh(
        task.pair, task.modification, corner_contact=task.corner_contact, progress=progress
    )


@dataclass(frozen=True)
class Accuracy:
    """How far tables of a method were found from those of finer and finer finite elements.

    Attributes:
        mean: of the mean stiffness, over it [1].
        share: of a mesh harmonic's amplitude, over the amplitude [1].
        floor: of a harmonic's amplitude at least, over the mean stiffness [1].
    """

    mean: float
    share: float
    floor: float

    def of_harmonics(self, stiffness: MeshStiffness) -> np.ndarray:
        """(n, 4) bounds of the amplitudes of mesh harmonics 1 to 4, over the mean."""
        return np.maximum(self.share * stiffness.harmonics()[:, :_STATED], self.floor)


@dataclass(frozen=True)
class Method:
    """A method.

    Attributes:
        title: for people.
        mesh: what makes its mesh.
        accuracy: of its tables; of plain slices: of what they are measured by, coupled slices.
        calibrated: it takes a calibration.
        takes: how long, for people.
    """

    title: str
    mesh: Callable[[Task, Progress], SliceMesh | PointMesh]
    accuracy: Accuracy
    calibrated: bool = True
    takes: str = A_WHILE


_COUPLED = Accuracy(mean=0.04, share=0.15, floor=0.0003)
METHODS = {
    "slices": Method("plain slices", _slices, _COUPLED),
    "coupled-slices": Method("coupled slices", _coupled_slices, _COUPLED),
    "fe": Method(
        "finite elements",
        _finite_elements,
        Accuracy(mean=0.015, share=0.03, floor=0.0001),
        calibrated=False,
        takes="less than a minute on two idle cores",
    ),
}
"""Methods by name. Evidence: `finite_elements.calibration` and `finite_elements.compliance`."""
_NARROW = 6.9
"""Face width over the normal module of the narrowest helical pair that coupled slices have seen."""
_NARROWER = Accuracy(mean=0.15, share=0.4, floor=0.003)
"""Below that: the 27/81 pair errs 4 % in the mean and 29 % in a harmonic at 20 mm, 11 % in the mean
at 10 mm, where the body's tilt yields most."""


def accuracy_of(method: str, pair: GearPair) -> Accuracy:
    """How far tables of a method are off for a pair."""
    return _NARROWER if method != "fe" and _is_narrow(pair) else METHODS[method].accuracy


def _is_narrow(pair: GearPair) -> bool:
    return pair.helix_angle != 0.0 and pair.face_width < _NARROW * pair.normal_module


def check_method(method: str) -> None:
    """Raises ParameterError if there is no such method."""
    if method != AUTO and method not in METHODS:
        raise ParameterError(f"method '{method}' is none of {', '.join(METHODS)}, {AUTO}")


def check_calibration(calibration: Mapping[str, float]) -> None:
    """Raises ParameterError if a calibration names no method, or one that takes none."""
    allowed = [name for name, method in METHODS.items() if method.calibrated]
    for name in calibration:
        if name not in allowed:
            raise ParameterError(
                f"calibration of method '{name}' is unknown; it is of {' or '.join(allowed)}"
            )


def has_finite_elements() -> bool:
    """True if the extra 'fe' is installed."""
    return importlib.util.find_spec("skfem") is not None


def chosen_method(method: str = AUTO) -> str:
    """The method of a name: "auto" is finite elements, coupled slices without the extra 'fe'.

    Raises:
        ParameterError: there is no such method.
    """
    check_method(method)
    if method != AUTO:
        return method
    return "fe" if has_finite_elements() else "coupled-slices"


def mesh_stiffness(
    task: Task, method: str = AUTO, progress: Progress | None = None
) -> MeshStiffness:
    """Mesh stiffness of one half over phase and load, on one thread of BLAS.

    Raises:
        ParameterError: the method is unknown, or see the method.
    """
    name = chosen_method(method)
    with one_blas_thread():
        found, solved = _table(task, name, progress or silent)
        accuracy = accuracy_of(name, task.pair)
        stated = Uncertainty(accuracy.mean, accuracy.of_harmonics(found))
        if name == "slices":
            better, _ = _table(task, "coupled-slices", silent)
            stated = _apart(found, better, accuracy)
    narrow = ""
    if accuracy is _NARROWER:
        wide = task.pair.face_width / task.pair.normal_module
        narrow = f"; a face of {wide:.2g} modules is narrower than the {_NARROW:g} it was fitted to"
    return replace(
        found,
        method=f"{found.method}, {task.phases} phases out of {solved}{narrow}",
        uncertainty=stated,
    )


def _apart(found: MeshStiffness, better: MeshStiffness, accuracy: Accuracy) -> Uncertainty:
    """Uncertainty of a table: its distance from a better one on top of that one's.

    Of the mean it is the largest at any load: teeth with crowning yield most at small ones.
    """
    loaded = found.loads > 0.0
    mean, of_better = (table.secant[loaded].mean(axis=1) for table in (found, better))
    off = (np.abs(mean - of_better) + accuracy.mean * of_better) / mean
    apart = np.abs(found.harmonics() - better.harmonics())[:, :_STATED]
    return Uncertainty(float(off.max()), accuracy.of_harmonics(better) + apart)


def _table(task: Task, method: str, progress: Progress) -> tuple[MeshStiffness, int]:
    """Table of a method, and the number of phases that it was solved at."""
    solved = OVERSAMPLING * task.phases
    mesh = METHODS[method].mesh(task, progress)
    return mesh.solve(task.loads, solved).resampled(task.phases), solved
