"""What the sensors of a system show of a run, evaluated from its rows.

A sensor acts on nothing, so that no loop needs to step it: the bearing forces of the rows drive the
housing's oscillators (`modal_response`), their velocity at the sensor's point runs through the
chain of the component that is a sensor. Rows whose distance does not divide the distance of samples
are interpolated by cubic splines.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np

from herringbone.analysis.asked import signal
from herringbone.analysis.figures.modal_response import housing_of, recorded_motion, seat_forces
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.remembered_figures import figure_of
from herringbone.analysis.figures.sensing.lines import Felt, SensorLine, sensor_lines
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.gearboxes import gearbox_of_sensor
from herringbone.components.registry import component_for
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.instance import check_value
from herringbone.core.sensor_spec import SensorSpec
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing
from herringbone.result.result import TIME, Result

_CHAIN = tuple(f.name for f in fields(VelocitySensor))
_FIRST = "first_sample"
_FEWEST_ROWS = 4


@dataclass(frozen=True)
class SensorFigures:
    """Record of a sensor, and figures over the steady part of the run.

    Attributes:
        spec: where it sits.
        chain: what it does to a vibration.
        time: (n,) of the samples [s].
        velocity: (n,) samples [m/s].
        steady: (n,) samples of the steady part.
        saturated: samples that were clipped.
        lines: the largest ones of the steady part, largest first; none if the speed is not steady.
    """

    spec: SensorSpec
    chain: VelocitySensor
    time: np.ndarray
    velocity: np.ndarray
    steady: np.ndarray
    saturated: int
    lines: tuple[SensorLine, ...]

    @property
    def rms(self) -> float:
        """Of the steady part, without its mean [m/s]."""
        return float(self.velocity[self.steady].std()) if self.steady.any() else math.nan

    @property
    def peak(self) -> float:
        """Largest magnitude of the steady part [m/s]."""
        return float(np.abs(self.velocity[self.steady]).max(initial=0.0))


def check_sensors(system: System) -> None:
    """Refuse sensors whose parameters the component that is a sensor does not have.

    Raises:
        ParameterError: unknown parameter, or a value that is not allowed.
    """
    for name, spec in system.sensors.items():
        chain_of(name, spec)


def sensor_figures(
    result: Result, names: tuple[str, ...] = ()
) -> tuple[dict[str, SensorFigures], dict[str, str]]:
    """What the sensors of a run show.

    Args:
        result: of a run.
        names: of sensors; all if none is given.

    Returns:
        Figures by name, and why there are none, by name of the others.

    Raises:
        ParameterError: there is no such sensor.
    """
    known = result.info.sensors
    if missing := [name for name in names if name not in known]:
        raise ParameterError(
            f"there is no sensor '{missing[0]}'; there are: {', '.join(known) or 'none'}"
        )
    found, refused = _kept(result)
    wanted = names or tuple(known)
    return (
        {name: found[name] for name in wanted if name in found},
        {name: refused[name] for name in wanted if name in refused},
    )


_Found = tuple[dict[str, SensorFigures], dict[str, str]]


def _kept(result: Result) -> _Found:
    """Figures of all sensors, or why there are none, by name."""
    return figure_of(lambda: _of_all(result.uniform()), "sensors", *_followed(result))


def _followed(result: Result) -> Iterator[object]:
    """What figures of sensors follow from: a table may be changed in place."""
    info = result.info
    yield from (info.system, info.sensors, info.anatomy, result.outcome.unstable)
    yield from (result.first_record, result.data[TIME].to_numpy(float))
    for part in dict.fromkeys(spec.part for spec in info.sensors.values()):
        try:
            housing = housing_of(result, part)
            if housing is not None:
                yield from (housing.frequency_hz, housing.damping_ratio, housing.shapes)
                yield from (housing.kind, housing.points, part, seat_forces(result, part))
        except ParameterError as error:
            yield str(error)
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    yield from (np.zeros(0) if speed is None else speed, run_mesh_frequency(result))


def _of_all(result: Result) -> _Found:
    found: dict[str, SensorFigures] = {}
    refused: dict[str, str] = {}
    motions: dict[str, tuple[ModalHousing, np.ndarray]] = {}
    for name, spec in result.info.sensors.items():
        try:
            if spec.part not in motions:
                motions[spec.part] = _motion(result, spec.part)
            own = gearbox_of_sensor(result, name)
            found[name] = _figures(own, name, spec, *motions[spec.part])
        except ParameterError as error:
            refused[name] = str(error)
    return found, refused


def _motion(result: Result, part: str) -> tuple[ModalHousing, np.ndarray]:
    """A housing's data and the velocities of its oscillators at the rows."""
    if part not in result.parts_with(Role.HOUSING):
        raise ParameterError(f"{part} is no {Role.HOUSING} of known data")
    housing = housing_of(result, part)
    if housing is None:
        raise ParameterError(f"{part} has no modal data with points for sensors")
    if result.outcome.unstable or len(result.data) < _FEWEST_ROWS:
        raise ParameterError("the run left too few rows, or diverged")
    time = result.data[TIME].to_numpy()
    step = float(time[-1] - time[0]) / (time.size - 1)
    return housing, recorded_motion(result, housing, step, part)


def _figures(
    result: Result, name: str, spec: SensorSpec, housing: ModalHousing, modal: np.ndarray
) -> SensorFigures:
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    if (spec.point, spec.axis) not in housing.dofs:
        raise ParameterError(
            f"the data of {spec.part} have no point {spec.point} along {spec.axis}"
        )
    chain, first = chain_of(name, spec)
    time = result.data[TIME].to_numpy()
    even, step = _even_times(time, chain, first)
    velocity = modal @ housing.shape(spec.point, spec.axis)
    if even.size < 2:
        raise ParameterError(f"the run ends before the second sample of sensor {name}")
    same = even.size == time.size and np.allclose(even, time, rtol=0.0, atol=1e-9 * step)
    record = chain.measure(velocity if same else CubicSpline(time, velocity)(even), step)
    part = steady_part(result)
    at = even[0] + record.time
    steady = (at >= part.begin) & (at <= part.end)
    lines: tuple[SensorLine, ...] = ()
    if part.steady:
        rows = (time >= part.begin) & (time <= part.end)
        felt, mesh = Felt(time[rows], velocity[rows]), run_mesh_frequency(result)
        lines = sensor_lines(chain, record.velocity[steady], felt, mesh)
    return SensorFigures(spec, chain, at, record.velocity, steady, int(record.saturated), lines)


def chain_of(name: str, spec: SensorSpec) -> tuple[VelocitySensor, float]:
    """The chain of a sensor, and the time of its first sample [s].

    Raises:
        ParameterError: unknown parameter, or a value that its declaration does not allow.
    """
    declared = component_for(Role.SENSOR).declaration
    known: Mapping[str, float] = {v.name: v.start for v in declared.parameters}
    allowed = [k for k in known if k in {*_CHAIN, _FIRST}]
    if unknown := [k for k in spec.values if k not in allowed]:
        raise ParameterError(
            f"sensor {name} has no parameter '{unknown[0]}'; it has: {', '.join(allowed)}"
        )
    for key, value in spec.values.items():
        check_value(f"sensor {name}", declared.variable(key), value)
    values = {k: spec.values.get(k, known[k]) for k in allowed}
    chain = VelocitySensor(
        values["high_pass_hz"],
        values["low_pass_hz"],
        bool(values["anti_alias"]),
        values["sampling_hz"],
        values["range"],
        int(values["bits"]),
    )
    return chain, values[_FIRST]


def _even_times(time: np.ndarray, chain: VelocitySensor, first: float) -> tuple[np.ndarray, float]:
    """Times [s] from a sample on, a whole number of steps per sample; and the step [s].

    Raises:
        ParameterError: the rows are too coarse.
    """
    own = float(time[-1] - time[0]) / (time.size - 1)
    chain.check_input(own)
    period = 1.0 / chain.sampling_hz
    every = math.ceil(period / own * (1.0 - 1e-9))
    step = period / every
    begin = first + period * max(0, math.ceil((time[0] - first) / period - 1e-9))
    count = int((time[-1] - begin) / step * (1.0 + 1e-12)) + 1
    return np.minimum(begin + step * np.arange(max(count, 0)), time[-1]), step
