"""The parametric housing, from its dimensions to a modal model."""

from dataclasses import asdict, dataclass, replace
from datetime import date
from importlib.metadata import version
from typing import TYPE_CHECKING

import numpy as np

from herringbone.core import HerringboneError
from herringbone.core.process.telling import Tell, untold
from herringbone.housing.modal_model import ModalHousing
from herringbone.housing.reduction.reduce import Reduction, reduce_model
from herringbone.housing.welded.design import HousingDesign, ModeOptions, check_mesh_size
from herringbone.housing.welded.mesher import mesh_housing

if TYPE_CHECKING:
    from herringbone.housing.welded.finite_elements import FiniteElements
    from herringbone.housing.welded.mode_shares import ModeShares

STAGES = 9
"""Calls of `progress`; one more if the first guess at the number of modes is too low."""
_SHARED_MODES = 8


@dataclass(frozen=True)
class BuiltHousing:
    """A modal model and how it came about.

    Attributes:
        model: the oscillators.
        shares: what the lowest modes do.
        mass: of the housing [kg].
        unknowns: of the finite-element model.
    """

    model: ModalHousing
    shares: "ModeShares"
    mass: float
    unknowns: int


def build_housing(
    design: HousingDesign,
    *,
    mesh_size: float | None = None,
    progress: Tell = untold,
) -> BuiltHousing:
    """Mesh, assemble, solve and reduce a housing.

    Args:
        design: dimensions and options.
        mesh_size: largest edge of a tetrahedron [m]; the design's if not given.
        progress: called with what begins.

    Raises:
        HerringboneError: a tool is missing, no mesh, or the modes cannot be found or certified.
    """
    try:
        from herringbone.housing.welded.finite_elements import FiniteElements  # noqa: PLC0415 (optional)
        from herringbone.housing.welded.mode_shares import mode_shares  # noqa: PLC0415
    except ImportError as error:
        raise HerringboneError(
            f"finite elements take scikit-fem, which does not load ({error}); "
            "install it with: pip install 'herringbone[fe]'"
        ) from error
    if mesh_size is not None:
        design = replace(design, mesh_size=check_mesh_size(mesh_size, "--mesh-size"))
    progress("mesh")
    mesh = mesh_housing(design.dimensions, design.mesh_size)
    progress(f"assemble {len(mesh.tetrahedra)} tetrahedra")
    elements = FiniteElements(design, mesh)
    sensors = elements.sensor_output()  # before the long solution: it may fail
    found = reduce_model(
        elements.stiffness,
        elements.mass,
        elements.seat_input,
        band_hz=design.modes.band_hz,
        tolerance=design.modes.tolerance,
        progress=progress,
    )
    progress("energy shares")
    lowest = slice(0, _SHARED_MODES)
    shares = mode_shares(elements, found.frequency_hz[lowest], found.vectors[:, lowest])
    progress("surface")
    gram = found.vectors.T @ (elements.radiating_form() @ found.vectors)
    shapes = np.vstack([found.seat_shapes, sensors @ found.vectors])
    gram = (gram + gram.T) / 2.0
    model = _modal_housing(design, elements, found, shapes, gram, len(mesh.tetrahedra))
    return BuiltHousing(model, shares, elements.total_mass, elements.stiffness.shape[0])


def _modal_housing(
    design: HousingDesign,
    elements: "FiniteElements",
    found: Reduction,
    shapes: np.ndarray,
    gram: np.ndarray,
    tetrahedra: int,
) -> ModalHousing:
    """The modal data of a reduced model: at seats and sensors, with where they come from."""
    return ModalHousing(
        kind=found.kind,
        frequency_hz=found.frequency_hz,
        damping_ratio=_damping_ratio(found, design.modes),
        points=elements.points,
        shapes=shapes,
        valid_to_hz=design.modes.band_hz,
        damping={"model": "viscous-modal", "source": "given with the dimensions: assumed"},
        boundary="faces of the base bolt holes fixed",
        source=_source(design, tetrahedra, elements.stiffness.shape[0]),
        static=found.static,
        gram=gram,
        certificate=found.certificate,
    )


def _damping_ratio(found: Reduction, options: ModeOptions) -> np.ndarray:
    ratio = {"normal": options.damping_ratio, "residual": options.residual_damping_ratio}
    return np.array([ratio[kind] for kind in found.kind])


def _source(design: HousingDesign, tetrahedra: int, unknowns: int) -> dict[str, object]:
    tools = ", ".join(f"{name} {version(name)}" for name in ("herringbone", "gmsh", "scikit-fem"))
    return {
        "description": design.description,
        "tool": tools,
        "date": date.today().isoformat(),
        "mesh": {"element": "quadratic tetrahedron", "size_m": design.mesh_size,
                 "elements": tetrahedra, "unknowns": unknowns},
        "dimensions_m": asdict(design.dimensions),
        "material": asdict(design.material),
        "sensors": asdict(design.sensors),
    }  # fmt: skip
