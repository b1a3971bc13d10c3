"""Tetrahedral mesh of the welded housing, by gmsh.

gmsh is a tool under the GPL: it is only called off line, to make data.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import NamedTuple

import numpy as np

from herringbone.core import HerringboneError
from herringbone.housing.welded.design import check_mesh_size
from herringbone.housing.welded.dimensions import Dimensions

_MM = 1e3  # the modeller's tolerances suit millimetres
_CURVATURE = 10  # elements around a circle, at least
_FINEST_SHARE = 0.3  # smallest element, as a share of the largest


class Mesh(NamedTuple):
    """Straight-sided tetrahedra: points (n, 3) [m], tetrahedra (t, 4) of indices of points."""

    points: np.ndarray
    tetrahedra: np.ndarray


def mesh_housing(dimensions: Dimensions, mesh_size: float) -> Mesh:
    """Mesh the housing.

    Args:
        dimensions: of the housing.
        mesh_size: largest edge of a tetrahedron [m].

    Raises:
        HerringboneError: gmsh is not there or fails, or the parts do not make one solid.
    """
    check_mesh_size(mesh_size, "housing")
    with _session() as gmsh:
        _solid(gmsh, dimensions)
        _options(gmsh, mesh_size)
        gmsh.model.mesh.generate(3)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        kinds, _, nodes = gmsh.model.mesh.getElements(3)
    if list(kinds) != [4]:
        raise HerringboneError(
            f"gmsh made no tetrahedra of {1e3 * mesh_size:g} mm: try another size"
        )
    index = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    index[tags.astype(np.int64)] = np.arange(tags.size)
    used, tetrahedra = np.unique(index[nodes[0].astype(np.int64)], return_inverse=True)
    return Mesh(coordinates.reshape(-1, 3)[used] / _MM, tetrahedra.reshape(-1, 4))


@contextmanager
def _session() -> Iterator[ModuleType]:
    """A gmsh of our own; its failures become one line."""
    try:
        import gmsh  # noqa: PLC0415 (a tool, optional)
    except (ImportError, OSError) as error:  # OSError: a system library of gmsh is missing
        raise HerringboneError(
            f"a housing is meshed with gmsh, which does not load ({error}); "
            "install it with: pip install 'herringbone[fe]'"
        ) from error
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        yield gmsh
    except HerringboneError:
        raise
    except Exception as error:  # gmsh raises nothing more special
        raise HerringboneError(
            f"gmsh cannot mesh the housing: {error}; change the dimensions or the mesh size"
        ) from error
    finally:
        gmsh.finalize()


def _options(gmsh: ModuleType, mesh_size: float) -> None:
    for name, value in {
        "General.NumThreads": 1,  # repeatable
        "Mesh.MeshSizeMax": mesh_size * _MM,
        "Mesh.MeshSizeMin": _FINEST_SHARE * mesh_size * _MM,
        "Mesh.MeshSizeFromCurvature": _CURVATURE,
        "Mesh.MeshSizeFromPoints": 0,
        "Mesh.MeshSizeExtendFromBoundary": 0,
    }.items():
        gmsh.option.setNumber(name, value)


def _solid(gmsh: ModuleType, dimensions: Dimensions) -> None:
    """The housing as one solid, in mm: all that is welded, minus all that is hollow."""
    occ = gmsh.model.occ
    box, *welded = _welded(gmsh, dimensions)
    body, _ = occ.fuse([box], welded)
    occ.cut(body, _hollow(gmsh, dimensions))
    occ.synchronize()
    if (count := len(gmsh.model.getEntities(3))) != 1:
        raise HerringboneError(
            f"the housing's plates make {count} separate solids instead of one; check that walls, "
            "feet, bosses and ribs touch"
        )


def _box(gmsh: ModuleType, low: tuple[float, ...], high: tuple[float, ...]) -> tuple[int, int]:
    """A box between two corners [m]."""
    sizes = [_MM * (b - a) for a, b in zip(low, high, strict=True)]
    return 3, gmsh.model.occ.addBox(*(_MM * a for a in low), *sizes)


def _cylinder(
    gmsh: ModuleType, center: tuple[float, ...], axis: tuple[float, ...], diameter: float
) -> tuple[int, int]:
    """A cylinder from the center of one end along its axis [m]."""
    values = [_MM * value for value in (*center, *axis, diameter / 2)]
    return 3, gmsh.model.occ.addCylinder(*values)


def _welded(gmsh: ModuleType, d: Dimensions) -> Iterator[tuple[int, int]]:
    """The full box, then base plate, flange, bosses, ribs and feet."""
    x0, x1 = d.box_x
    z, floor_bottom, base_top = d.half_width, -d.axis_height - d.floor, d.base_top
    yield _box(gmsh, (x0, floor_bottom, -z), (x1, d.cover_height + d.cover, z))
    bx, bz = d.base_overhang_x, z + d.base_overhang_z
    yield _box(gmsh, (x0 - bx, base_top - d.base_plate, -bz), (x1 + bx, base_top, bz))
    f, t = d.flange_width, d.flange_thickness
    yield _box(gmsh, (x0 - f, -t, -z - f), (x1 + f, t, z + f))
    inner = d.inner_width / 2
    for side in (-1, 1):
        for x, bore in d.bores.values():
            length = side * (d.side_wall + d.boss_length)
            yield _cylinder(gmsh, (x, 0, side * inner), (0, 0, length), bore + 2 * d.boss_wall)
            near, far = sorted((side * inner, side * (z + d.rib_depth)))
            rib = d.rib_thickness / 2
            yield _box(gmsh, (x - rib, -d.axis_height, near), (x + rib, d.cover_height, far))
        near = side * d.foot_position - d.foot_thickness / 2
        for x in (x0, x1 - d.foot_length):
            high = (x + d.foot_length, floor_bottom, near + d.foot_thickness)
            yield _box(gmsh, (x, base_top, near), high)


def _hollow(gmsh: ModuleType, d: Dimensions) -> list[tuple[int, int]]:
    """Inside of the box, bores and bolt holes, each longer than what it goes through."""
    x0, x1 = d.box_x
    inner, beyond = d.inner_width / 2, d.half_width + 2 * d.boss_length
    low = (x0 + d.end_wall, -d.axis_height, -inner)
    found = [_box(gmsh, low, (x1 - d.end_wall, d.cover_height, inner))]
    for x, bore in d.bores.values():
        found.append(_cylinder(gmsh, (x, 0, -beyond), (0, 0, 2 * beyond), bore))
    margin = d.foot_height / 4
    for x, z in d.bolts:
        start = (x, d.base_top - d.base_plate - margin, z)
        found.append(_cylinder(gmsh, start, (0, d.base_plate + 2 * margin, 0), d.bolt_diameter))
    return found
