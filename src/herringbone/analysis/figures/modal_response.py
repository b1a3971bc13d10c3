"""Motion of a housing's oscillators under the bearing forces that a run has recorded."""

import math
from pathlib import Path

import numpy as np

from herringbone.analysis.figures.operating_point import instance
from herringbone.core import ParameterError
from herringbone.core.paths import resources_folder
from herringbone.housing import SEAT_DOFS, ModalHousing, read_housing
from herringbone.housing.files.file_format import HEAD, MODES, SHAPES
from herringbone.result.result import Result

_SERIES = 1e-4
_COMPONENT = "modal_housing"


def housing_of(result: Result) -> ModalHousing | None:
    """The modal data that a run used; None if they are not of a housing in the neutral format."""
    name = instance(result, _COMPONENT)
    files = [result.info.resources.get(f"{name}.{text}", "") for text in ("modes", "shapes")]
    modes, shapes = (resources_folder(_COMPONENT) / file for file in files)
    same_folder = modes.parent == shapes.parent and (modes.parent / HEAD).is_file()
    if not same_folder or (modes.name, shapes.name) != (MODES, SHAPES):
        return None
    return read_housing(Path(modes.parent))


def seat_forces(result: Result) -> np.ndarray:
    """Forces (n, 12) on the housing at its seats [N], in the order of `SEAT_DOFS`.

    Raises:
        ParameterError: they are not recorded.
    """
    name = instance(result, "bearing_supports")
    columns = [f"{name}.seat.{seat}.f_{axis}" for seat, axis in SEAT_DOFS]
    if missing := [column for column in columns if column not in result.data]:
        raise ParameterError(f"system '{result.info.system}' records no {missing[0]}")
    return result.data[columns].to_numpy()


def modal_velocity(housing: ModalHousing, forces: np.ndarray, step: float) -> np.ndarray:
    """Velocities (n, modes) [kg^1/2 m/s] of the oscillators, at rest under the first forces.

    Exact for straight lines: with a the eigenvalue in the upper half plane, z = q' - conj(a) q
    obeys z' = a z + F.

    Args:
        housing: of n oscillators, underdamped.
        forces: (n, 12) at the seats [N], straight lines in between.
        step: between rows [s].
    """
    modal = forces @ housing.seat_shapes
    omega, zeta = 2.0 * math.pi * housing.frequency_hz, housing.damping_ratio
    damped = np.sqrt(1.0 - zeta**2)
    eigenvalues = omega * (-zeta + 1j * damped)
    x = eigenvalues * step
    near = np.abs(x) < _SERIES
    safe = np.where(near, 1.0, x)
    first = np.where(near, 1.0 + x / 2.0, np.expm1(safe) / safe)
    second = np.where(near, 0.5 + x / 6.0, (np.expm1(safe) - safe) / safe**2)
    driven = step * ((first - second) * modal[:-1] + second * modal[1:])
    rest = np.divide(modal[0], omega**2, out=np.zeros_like(omega), where=omega > 0.0)
    z = np.vstack([-np.conj(eigenvalues) * rest, driven])
    decay = np.exp(x)
    for n in range(1, len(z)):
        z[n] += decay * z[n - 1]
    return z.real - zeta / damped * z.imag
