"""Motion of a housing's oscillators under the bearing forces that a run has recorded."""

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.analysis.asked import resource_file
from herringbone.core import ParameterError
from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.housing import SEAT_DOFS, ModalHousing, read_housing
from herringbone.housing.files.file_format import HEAD, MODES, SHAPES
from herringbone.result.result import TIME, Result
from herringbone.result.tables import PIECE

_housings: Remembered[ModalHousing] = Remembered(8)
_NEAR, _TERMS = 1.0, 20
"""Where the last of `_phi` is a series, and of how many terms: 1 / 23! is left."""
_CUBIC = 3
_FORGOTTEN = 20.0
"""Time over which what is left of a start counts for nothing, in time constants."""


def the_housing(result: Result, part: str = "") -> str:
    """Name of the housing that is meant, the first one of a run if none is given.

    Raises:
        ParameterError: there is none.
    """
    housings = result.parts_with(Role.HOUSING)
    if part and part not in housings:
        raise ParameterError(f"'{part}' is not a {Role.HOUSING}; there are: {', '.join(housings)}")
    if not housings:
        raise ParameterError(f"system '{result.info.system}': no part is known as {Role.HOUSING}")
    return part or housings[0]


def housing_of(result: Result, part: str = "") -> ModalHousing | None:
    """The modal data that a housing used; None if they are not in the neutral format.

    Args:
        result: of a run.
        part: name of the housing; the first one if not given.

    Raises:
        ParameterError: there is no such housing.
    """
    name = the_housing(result, part)
    modes, shapes = (resource_file(result, name, q) for q in (Quantity.MODES, Quantity.SHAPES))
    return None if modes is None or shapes is None else housing_in(modes, shapes)


def housing_in(modes: Path, shapes: Path) -> ModalHousing | None:
    """The modal data of two files; None if they are not in the neutral format."""
    same_folder = modes.parent == shapes.parent and (modes.parent / HEAD).is_file()
    if not same_folder or (modes.name, shapes.name) != (MODES, SHAPES):
        return None
    return housing_at(modes.parent)


def housing_at(folder: Path) -> ModalHousing:
    """The modal data of a folder, not read again while they are the same.

    Raises:
        ResourceError: they cannot be read.
    """
    content = tuple((file.name, content_key(file)) for file in sorted(folder.iterdir()))
    return _housings((folder, content), lambda: read_housing(folder))


def seat_forces(result: Result, part: str = "") -> np.ndarray:
    """Forces (n, 12) on a housing at its seats [N], in the order of `SEAT_DOFS`.

    Args:
        result: of a run.
        part: name of the housing; the first one if not given. In a system without housing the
            bearings' forces on the ground are taken.

    Raises:
        ParameterError: there is no such housing, no bearing at a seat, or its force is not
            recorded.
    """
    known = result.info.anatomy
    name = the_housing(result, part) if part or known.with_role(Role.HOUSING) else ""
    ports = ports_at_seats(known, name)
    if missing := [seat for seat, _ in SEAT_DOFS if seat not in ports]:
        raise ParameterError(
            f"system '{result.info.system}' records no forces on the housing: no part is known as "
            f"{Role.BEARING} at {missing[0]}"
        )
    columns = [f"{ports[seat]}.f_{axis}" for seat, axis in SEAT_DOFS]
    if missing := [column for column in columns if column not in result.data]:
        raise ParameterError(f"system '{result.info.system}' records no {missing[0]}")
    return result.data[columns].to_numpy()


def ports_at_seats(anatomy: Anatomy, part: str = "") -> dict[str, str]:
    """`part.port` of the bearings by seat of a housing; without one, of all bearings."""
    if part:
        joined = {p.place: anatomy.joined(part, p.kind, p.place) for p in anatomy.parts[part].ports}
        return {seat: ".".join(ends[0]) for seat, ends in joined.items() if ends}
    return {
        port.place: f"{bearing}.{port.name}"
        for bearing in reversed(anatomy.with_role(Role.BEARING))
        for port in anatomy.ports(bearing, PortKind.SEAT)
    }


def modal_velocity_amplitudes(
    housing: ModalHousing, frequency_hz: np.ndarray, forces: np.ndarray
) -> np.ndarray:
    """Velocities (modes, k) [kg^1/2 m/s] of the oscillators under harmonic forces, complex.

    Args:
        housing: of n oscillators.
        frequency_hz: (k,) of the forces, not 0 if there are rigid modes [Hz].
        forces: (12, k) amplitudes at the seats [N], in the order of `SEAT_DOFS`.
    """
    omega = 2.0 * math.pi * np.asarray(frequency_hz, dtype=float)
    own = 2.0 * math.pi * housing.frequency_hz[:, None]
    inverse = own**2 - omega**2 + 2j * housing.damping_ratio[:, None] * own * omega
    return 1j * omega * (housing.seat_shapes.T @ forces) / inverse


def modal_velocity(
    housing: ModalHousing, forces: np.ndarray, step: float, start: np.ndarray | None = None
) -> np.ndarray:
    """Velocities (n, modes) [kg^1/2 m/s] of the oscillators.

    Args:
        housing: of n oscillators, underdamped.
        forces: (n, 12) at the seats [N], of two rows at the least.
        step: between rows [s].
        start: (modes,) at the first row, see `moving_start`; at rest under its forces if not given.
    """
    zeta = housing.damping_ratio
    z = _oscillators(housing, forces, step, start)
    return z.real - zeta / np.sqrt(1.0 - zeta**2) * z.imag


def recorded_motion(
    result: Result, housing: ModalHousing, step: float, part: str = ""
) -> np.ndarray:
    """Velocities (n, modes) [kg^1/2 m/s] of the oscillators at the records of a run.

    Args:
        result: with equidistant records.
        housing: modal data.
        step: between records [s].
        part: see `seat_forces`, whose errors are raised.
    """
    start = moving_start(result, housing, part)
    return modal_velocity(housing, seat_forces(result, part), step, start)


def moving_start(result: Result, housing: ModalHousing, part: str = "") -> np.ndarray | None:
    """Oscillators (modes,) at the first record of what a long run has left in memory.

    They are at rest so long before that, or at the start of the run, that nothing is left of it.
    None if the first record is that of the run.

    Args:
        result: of a run, with equidistant records.
        housing: modal data.
        part: see `seat_forces`, whose errors are raised.
    """
    before = result.before
    if before is None or before.empty:
        return None
    rate = float(np.min(housing.damping_ratio * 2.0 * math.pi * housing.frequency_hz))
    begin = float(result.data[TIME].iloc[0]) - (_FORGOTTEN / rate if rate > 0.0 else math.inf)
    first = min(int(np.searchsorted(before[TIME].to_numpy(), begin)), len(before) - 1)
    shared, z = [name for name in before if name in result.data], None
    for row in range(first, len(before), PIECE):
        rows = before.iloc[row : row + PIECE + 1][shared]
        if row + PIECE >= len(before):
            rows = pd.concat([rows, result.data[shared].iloc[:1]])
        piece = replace(result, data=rows).uniform()
        time = piece.data[TIME].to_numpy()
        step = float(time[-1] - time[0]) / (time.size - 1)
        z = _oscillators(housing, seat_forces(piece, part), step, z)[-1]
    return z


def _oscillators(
    housing: ModalHousing, forces: np.ndarray, step: float, start: np.ndarray | None
) -> np.ndarray:
    """z (n, modes): of a the eigenvalue in the upper half plane, z = q' - conj(a) q.

    Forces are cubic splines between rows, and the motion under these is exact: z obeys
    z' = a z + F. Straight lines would take 6 % of a force of which there are seven rows a period;
    splines take 0.1 %.
    """
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    omega, zeta = 2.0 * math.pi * housing.frequency_hz, housing.damping_ratio
    eigenvalues = omega * (-zeta + 1j * np.sqrt(1.0 - zeta**2))
    x = eigenvalues * step
    powers = CubicSpline(np.arange(len(forces)), forces).c[::-1]
    factors = map(math.factorial, range(_CUBIC + 1))
    answers = [
        f * step * phi * housing.seat_shapes for f, phi in zip(factors, _phi(x), strict=True)
    ]
    if start is None:
        loads = forces[0] @ housing.seat_shapes
        rest = np.divide(loads, omega**2, out=np.zeros_like(omega), where=omega > 0.0)
        start = -np.conj(eigenvalues) * rest
    z = np.empty((len(forces), len(omega)), dtype=complex)
    z[0] = start
    np.matmul(np.hstack(powers), np.vstack(answers).view(float), out=z[1:].view(float))
    _decay(z, np.exp(x))
    return z


def _decay(z: np.ndarray, decay: np.ndarray) -> None:
    """Add to each row of z (n, k) what is left of the one before it: decay (k,) times it.

    Rows are taken in pieces, all pieces at once, and then what each piece leaves to the next one.
    """
    length = math.isqrt(len(z))
    whole = len(z) // length * length
    pieces = z[:whole].reshape(-1, length, z.shape[1])
    for n in range(1, length):
        pieces[:, n] += decay * pieces[:, n - 1]
    left = decay ** np.arange(1, length + 1)[:, None]
    for piece, after in pairwise(pieces):
        after += left * piece[-1]  # noqa: PLW2901 (of z)
    for n in range(whole, len(z)):
        z[n] += decay * z[n - 1]


def _phi(x: np.ndarray) -> list[np.ndarray]:
    """phi_1 ... phi_4 of numbers: k! phi_(k+1) is the answer to a force that is the power k.

    Source: M. Hochbruck, A. Ostermann, Exponential integrators, Acta Numerica 19 (2010), eq. 2.11:
    phi_k(x) = x phi_(k+1)(x) + 1 / k!.
    """
    last, near = _CUBIC + 1, np.abs(x) < _NEAR
    small, safe = np.where(near, x, 0.0), np.where(near, _NEAR, x)
    series = sum(small**j / math.factorial(j + last) for j in range(_TERMS))
    found = np.exp(safe)
    for k in range(last):
        found = (found - 1.0 / math.factorial(k)) / safe
    phi = [np.where(near, series, found)]
    for k in range(_CUBIC, 0, -1):
        phi.insert(0, x * phi[0] + 1.0 / math.factorial(k))
    return phi
