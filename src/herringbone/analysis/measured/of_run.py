"""What a run predicts of a sensor, and a measured record beside it."""

import math
from pathlib import Path

from herringbone.analysis.asked import of_both_gears
from herringbone.analysis.figures.operating_point import (
    no_mesh_frequency,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.analysis.figures.sensing.velocity_sensor import sensor_velocity
from herringbone.analysis.gearboxes import gearbox_of_sensor
from herringbone.analysis.measured.beside import Beside, beside
from herringbone.analysis.measured.predicted import Predicted
from herringbone.analysis.measured.record import read_measured
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import TIME, Result


def predicted_of(result: Result, sensor: str) -> Predicted:
    """What a sensor of a run feels over the steady part.

    Raises:
        ParameterError: no such sensor, or none that the run answers; no steady speed, or a gear
            pair of unknown teeth.
    """
    found, refused = sensor_figures(result, (sensor,))
    if sensor in refused:
        raise ParameterError(f"sensor {sensor}: {refused[sensor]}")
    one, result = found[sensor], gearbox_of_sensor(result, sensor)
    pairs = result.parts_with(Role.GEAR_PAIR)
    teeth = of_both_gears(result, pairs[0], Quantity.NUMBER_OF_TEETH) if pairs else None
    mesh = run_mesh_frequency(result)
    if teeth is None or mesh is None:
        raise ParameterError(
            f"system '{result.info.system}': the run has {no_mesh_frequency(result)}, with which "
            "lines could be told"
        )
    even = result.uniform()
    time = even.data[TIME].to_numpy()
    rows = steady_part(even).rows
    spec, chain = one.spec, one.chain
    velocity = sensor_velocity(even, (spec.point,), axis=spec.axis, part=spec.part)[rows, 0]
    step = float(time[-1] - time[0]) / (time.size - 1)
    meshes = math.lcm(*(round(z) for z in teeth))
    return Predicted(velocity, step, chain, mesh, meshes)


def compare_record(
    result: Result,
    file: str | Path,
    sensor: str = "A",
    *,
    channel: str = "",
    full_scale: float | None = None,
) -> Beside:
    """A measured velocity beside what a sensor of a run would see; see `docs/measured.md`.

    Args:
        result: of a run at a steady speed, of some turns of the wheel.
        file: CSV, WAV or universal file, see `analysis.measured.record`.
        sensor: of the system.
        channel: of the file; may be left out if it has one.
        full_scale: of WAV: velocity of its largest number [m/s].

    Raises:
        HerringboneError: see `read_measured`, `predicted_of` and `beside`.
    """
    record = read_measured(file, channel, full_scale)
    return beside(record, predicted_of(result, sensor))
