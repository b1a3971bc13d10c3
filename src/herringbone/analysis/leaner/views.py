"""What sensors and the sound feel of the forces on a housing: lines, and signals, of these.

As of a run's results: the forces on the seats drive all oscillators of the housing's data, whatever
a leaner model holds; see `analysis.figures.sensing.sensors` and `analysis.figures.radiated_power`.
"""

import math
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.figures.modal_response import (
    modal_velocity,
    modal_velocity_amplitudes,
    ports_at_seats,
)
from herringbone.analysis.figures.radiated_power import level_db, power_of_lines
from herringbone.analysis.figures.sensing.sensors import chain_of
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.figures.system_housings import data_of
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.cosim.structure.system import System
from herringbone.housing import SEAT_DOFS, ModalHousing

_MM = 1e3


class View(Protocol):
    """What is made of some outputs.

    Attributes:
        adds: levels are sums over lines, as of powers, and not roots of sums of squares.
    """

    adds: ClassVar[bool]

    @property
    def names(self) -> tuple[str, ...]:
        """Of its rows."""
        ...

    def lines(self, given: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
        """Rows (n, harmonics) of coefficients (columns, harmonics), the mean first."""
        ...

    def signals(self, given: np.ndarray, step: float) -> np.ndarray:
        """Rows (times, n) of outputs (times, columns), every `step` [s]."""
        ...

    def told(self, lines: np.ndarray) -> str:
        """Levels of rows, for people."""
        ...


@dataclass(frozen=True, eq=False)
class Sensors:
    """Velocities at sensors behind their filters, before they are sampled [m/s]."""

    names: tuple[str, ...]
    housings: tuple[ModalHousing, ...]
    at: tuple[int, ...]
    shapes: tuple[np.ndarray, ...]
    chains: tuple[VelocitySensor, ...]
    adds: ClassVar[bool] = False

    def lines(self, given: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
        """See `View`."""
        modal = [_answer(h, own, frequency_hz) for h, own in _by_housing(self.housings, given)]
        rows = [shape @ modal[k] for k, shape in zip(self.at, self.shapes, strict=True)]
        gains = [chain.gain(frequency_hz) for chain in self.chains]
        return np.array(gains) * np.array(rows)

    def signals(self, given: np.ndarray, step: float) -> np.ndarray:
        """See `View`."""
        modal = [modal_velocity(h, own.T, step) for h, own in _by_housing(self.housings, given.T)]
        rows = [modal[k] @ shape for k, shape in zip(self.at, self.shapes, strict=True)]
        pairs = zip(rows, self.chains, strict=True)
        return np.stack([chain.filtered(row, step) for row, chain in pairs], axis=1)

    def told(self, lines: np.ndarray) -> str:
        """See `View`."""
        sizes = math.sqrt(2.0) * np.linalg.norm(lines[:, 1:], axis=1)
        pairs = zip(self.names, sizes, strict=True)
        return ", ".join(f"{name} {_MM * size:.3g} mm/s rms" for name, size in pairs)


@dataclass(frozen=True, eq=False)
class Power:
    """Equivalent radiated power of each line [W], of each housing."""

    names: tuple[str, ...]
    housings: tuple[ModalHousing, ...]
    adds: ClassVar[bool] = True

    def lines(self, given: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
        """See `View`; up to where the housing's data hold."""
        rows = []
        for housing, own in _by_housing(self.housings, given):
            power = power_of_lines(housing, frequency_hz[1:], 2.0 * own[:, 1:])
            rows.append(np.concatenate([[0.0], power]))
        return np.array(rows)

    def signals(self, given: np.ndarray, step: float) -> np.ndarray:
        """Refused: power is a mean over time."""
        raise ParameterError("ask: radiated power is a mean over time; ask for it as level")

    def told(self, lines: np.ndarray) -> str:
        """See `View`."""
        sizes = level_db(lines[:, 1:].real.sum(axis=1))
        return ", ".join(f"{n} {s:.1f} dB re 1 pW" for n, s in zip(self.names, sizes, strict=True))


def sensors_view(system: System, names: tuple[str, ...]) -> tuple[Sensors, list[str]]:
    """Sensors by name, and the outputs that they feel.

    Raises:
        ParameterError: the system has no such sensor, or its housing no such point.
    """
    if missing := [name for name in names if name not in system.sensors] or not names:
        known = ", ".join(system.sensors) or "none"
        what = f"sensor '{missing[0]}'" if isinstance(missing, list) else "sensors"
        raise ParameterError(f"ask: {system.name} has no {what}; there are: {known}")
    specs = [system.sensors[name] for name in names]
    parts = tuple(dict.fromkeys(spec.part for spec in specs))
    housings = tuple(data_of(system, part) for part in parts)
    at = tuple(parts.index(spec.part) for spec in specs)
    shapes = []
    for spec, k in zip(specs, at, strict=True):
        if (spec.point, spec.axis) not in housings[k].dofs:
            raise ParameterError(
                f"ask: the data of {spec.part} have no point {spec.point} along {spec.axis}"
            )
        shapes.append(housings[k].shape(spec.point, spec.axis))
    chains = tuple(chain_of(name, spec)[0] for name, spec in zip(names, specs, strict=True))
    return Sensors(names, housings, at, tuple(shapes), chains), _forces(system, parts)


def power_view(system: System) -> tuple[Power, list[str]]:
    """Radiated power of all housings, and the outputs that drive it.

    Raises:
        ParameterError: there is no housing, or its data have no Gram matrix of the surface.
    """
    parts = tuple(anatomy(system).with_role(Role.HOUSING))
    housings = tuple(data_of(system, part) for part in parts)
    if not parts or any(housing.gram is None for housing in housings):
        raise ParameterError(
            f"ask: radiated power: {system.name} has no housing whose data have surface_gram.csv"
        )
    return Power(parts, housings), _forces(system, parts)


def _by_housing(housings: tuple[ModalHousing, ...], given: np.ndarray) -> list:
    return list(zip(housings, np.split(given, len(housings)), strict=True))


def _answer(housing: ModalHousing, forces: np.ndarray, frequency_hz: np.ndarray) -> np.ndarray:
    """Velocities (modes, harmonics) of the oscillators; none of the mean."""
    found = np.zeros((housing.frequency_hz.size, frequency_hz.size), dtype=complex)
    found[:, 1:] = modal_velocity_amplitudes(housing, frequency_hz[1:], forces[:, 1:])
    return found


def _forces(system: System, parts: tuple[str, ...]) -> list[str]:
    """Outputs that drive housings, in the order of `SEAT_DOFS`."""
    known, found = anatomy(system), []
    for part in parts:
        ports = ports_at_seats(known, part)
        if missing := [seat for seat, _ in SEAT_DOFS if seat not in ports]:
            raise ParameterError(f"ask: no part is a {Role.BEARING} at {part}.{missing[0]}")
        found += [f"{ports[seat]}.f_{axis}" for seat, axis in SEAT_DOFS]
    return found
