"""What makes a modal model of a housing unusable, and what is only doubtful."""

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.declaring.roles import HALVES
from herringbone.housing.files.plausibility import implausible
from herringbone.housing.modal_model import AXES, SEAT_DOFS, Frame, ModalHousing, Point

KINDS = ("normal", "residual", "rigid")
_ROLES = ("seat", "sensor")
_COUPLINGS = ("rbe3", "rbe2", "node")
_DOFS = (*AXES, *(f"r{axis}" for axis in AXES))
_SYMMETRY = 1e-6
"""Largest asymmetry of a compliance or Gram matrix, over its largest entry."""
_LARGEST = 1e100
"""Above the largest entry of a compliance or Gram matrix in any unit; its square is finite."""
_NEGATIVE = -1e-9
"""Smallest eigenvalue of a positive semidefinite matrix, over its largest: rounding of files."""
BAND_OF_MODES = 1.5
"""Normal modes are needed up to this multiple of the band."""
_STATIC_DIFFERENCE = 0.05


def check_housing(housing: ModalHousing, where: object) -> None:
    """Refuse a model that cannot be used.

    Args:
        housing: the model.
        where: file or folder that messages name.

    Raises:
        ResourceError: not finite, wrong sizes, frequency or damping out of range, a seat or a
            direction missing or twice, complex shapes, or a matrix that is no compliance.
    """
    try:
        _check_sizes(housing)
        _check_oscillators(housing)
        _check_points(housing.points)
        _check_frame(housing.frame)
        for name in ("static", "residual", "gram"):
            _check_matrix(getattr(housing, name), name)
    except ResourceError as error:
        raise ResourceError(f"{where}: {error}") from None


def _check_sizes(housing: ModalHousing) -> None:
    n = housing.frequency_hz.size
    if n == 0:
        raise ResourceError("it has no modes")
    if len(housing.kind) != n or housing.damping_ratio.shape != (n,):
        raise ResourceError(
            f"{len(housing.kind)} kinds, {n} frequencies, {housing.damping_ratio.size} damping "
            "ratios; they must be as many"
        )
    if np.iscomplexobj(housing.shapes):
        raise ResourceError("the shapes are complex; give real normal modes")
    if housing.shapes.shape != (len(housing.dofs), n):
        raise ResourceError(
            f"shapes are {housing.shapes.shape}; points and modes give ({len(housing.dofs)}, {n})"
        )
    for name, size in (("static", 12), ("residual", 12), ("gram", n)):
        matrix = getattr(housing, name)
        if matrix is not None and matrix.shape != (size, size):
            raise ResourceError(f"matrix '{name}' is {matrix.shape}; it must be ({size}, {size})")


def _check_oscillators(housing: ModalHousing) -> None:
    rows = zip(housing.kind, housing.frequency_hz, housing.damping_ratio, strict=True)
    for n, (kind, f, zeta) in enumerate(rows, 1):
        if kind not in KINDS:
            raise ResourceError(f"mode {n}: kind '{kind}' is none of {', '.join(KINDS)}")
        if not np.isfinite(f) or f < 0.0 or (f == 0.0) != (kind == "rigid"):
            raise ResourceError(
                f"mode {n}: frequency {f:g} Hz must be positive and finite, and 0 if rigid"
            )
        if not 0.0 < zeta < 1.0 and not (kind == "rigid" and zeta == 0.0):
            raise ResourceError(f"mode {n}: damping ratio {zeta:g} must lie between 0 and 1")
    if not np.isfinite(housing.shapes).all():
        row, mode = np.argwhere(~np.isfinite(housing.shapes))[0]
        point, dof = housing.dofs[row]
        raise ResourceError(f"shape of mode {mode + 1} at {point} {dof} is not finite")
    if not housing.valid_to_hz > 0.0 or not np.isfinite(housing.valid_to_hz):
        raise ResourceError(f"valid_to_hz = {housing.valid_to_hz:g} Hz must be positive and finite")


def _check_points(points: tuple[Point, ...]) -> None:
    names = [point.name for point in points]
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ResourceError(f"point {', '.join(twice)} stands twice")
    for point in points:
        where = f"point {point.name}"
        if point.role not in _ROLES:
            raise ResourceError(f"{where}: role '{point.role}' is none of {', '.join(_ROLES)}")
        if point.role == "seat" and point.name not in HALVES:
            raise ResourceError(f"{where} is no seat; seats are {', '.join(HALVES)}")
        if point.coupling not in _COUPLINGS:
            raise ResourceError(
                f"{where}: coupling '{point.coupling}' is none of {', '.join(_COUPLINGS)}"
            )
        if unknown := [dof for dof in point.dofs if dof not in _DOFS]:
            raise ResourceError(f"{where}: dof '{unknown[0]}' is none of {', '.join(_DOFS)}")
        if len(set(point.dofs)) < len(point.dofs):
            raise ResourceError(f"{where}: a dof stands twice")
        if len(point.position) != 3 or not np.isfinite(point.position).all():
            raise ResourceError(f"{where}: position {list(point.position)} must be 3 numbers, m")
        if not 0.0 <= point.area < np.inf:
            raise ResourceError(f"{where}: area {point.area:g} m2 must be finite, not negative")
    dofs = {(p.name, dof) for p in points if p.role == "seat" for dof in p.dofs}
    if missing := [f"{seat} {axis}" for seat, axis in SEAT_DOFS if (seat, axis) not in dofs]:
        raise ResourceError(f"seat directions are missing: {', '.join(missing)}")


def _check_frame(frame: Frame) -> None:
    origin = np.array(frame.origin, dtype=float)
    whole = len(frame.rotation) == 3 and all(len(row) == 3 for row in frame.rotation)
    rotation = np.array(frame.rotation if whole else [], dtype=float)
    if origin.shape != (3,) or not np.isfinite(origin).all():
        raise ResourceError(f"frame: origin {list(frame.origin)} must be 3 numbers, m")
    if (
        rotation.shape != (3, 3)
        or not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6)
        or np.linalg.det(rotation) < 0.0
    ):
        raise ResourceError(
            "frame: rotation must be a right-handed orthonormal 3 x 3 matrix whose rows are the "
            "gearbox axes in the source's coordinates"
        )


def _check_matrix(matrix: np.ndarray | None, name: str) -> None:
    if matrix is None:
        return
    if not np.isfinite(matrix).all():
        raise ResourceError(f"matrix '{name}' has a value that is not finite")
    largest = np.abs(matrix).max()
    if np.abs(matrix - matrix.T).max() > _SYMMETRY * largest:
        raise ResourceError(f"matrix '{name}' is not symmetric, against reciprocity")
    if not largest < _LARGEST:
        raise ResourceError(f"matrix '{name}' has the value {largest:g}; at most {_LARGEST:g}")
    lowest = float(np.linalg.eigvalsh((matrix + matrix.T) / 2.0)[0])
    if lowest < _NEGATIVE * largest:
        raise ResourceError(
            f"matrix '{name}' has the negative eigenvalue {lowest:.3g}; it would create power"
        )


def housing_warnings(housing: ModalHousing) -> list[str]:
    """What is doubtful about a model that `check_housing` accepts; one line each."""
    found = [*implausible(housing)]
    normal = housing.frequency_hz[[kind == "normal" for kind in housing.kind]]
    highest, needed = float(normal.max(initial=0.0)), BAND_OF_MODES * housing.valid_to_hz
    following = housing.certificate.get("next_frequency_hz", 0.0)
    all_kept = following is None
    if not all_kept and max(highest, float(following)) < needed:
        found.append(
            f"normal modes end at {highest:.0f} Hz; valid_to_hz = {housing.valid_to_hz:g} Hz asks "
            f"for modes to {needed:.0f} Hz"
        )
    if housing.static is not None:
        expected = np.diag(housing.static)
        given = np.diag(housing.static_compliance())
        worst = int(np.argmax(np.abs(given / expected - 1.0)))
        difference = float(given[worst] / expected[worst] - 1.0)
        if abs(difference) > _STATIC_DIFFERENCE:
            seat, axis = SEAT_DOFS[worst]
            found.append(
                f"static compliance of the modes at {seat} {axis} differs from static.csv by "
                f"{100.0 * difference:+.0f} %; are the shapes mass-normalised in kg?"
            )
    if housing.residual is not None:
        found.append(
            "residual.csv is not read by the FMU; 'herringbone housing reduce' makes pseudo modes "
            "of it"
        )
    return found
