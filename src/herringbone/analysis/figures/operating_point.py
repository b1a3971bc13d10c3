"""Operating point of a run: steady part, mesh frequency, mean torques and the power balance.

Everything is read from a `Result` and is None or empty where the system has no such outputs.
"""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.figures.spectra import mesh_frequency
from herringbone.components.ports import HALVES
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError
from herringbone.result.result import TIME, Result

SETTLING_SHARE = 0.2
"""Share of a run that is left out of means and spectra."""
SPEED_BAND = 0.01
"""The steady part's speed stays within this share of its final value."""
_SHORTEST_SHARE = 0.1
_TEETH = "pinion.number_of_teeth"


def instance(result: Result, component: str) -> str:
    """Name of the first instance of a component; the component's own name if there is none."""
    found = (name for name, model in result.info.model.items() if model == component)
    return next(found, component)


def signal(result: Result, component: str, variable: str) -> np.ndarray | None:
    """Recorded output of the first instance of a component, SI unit; None if there is none."""
    name = f"{instance(result, component)}.{variable}"
    return result.data[name].to_numpy() if name in result.data else None


def group(result: Result, name: str) -> list[str]:
    """Columns of a channel group, empty if the system has none."""
    try:
        return result.channel(name)
    except ParameterError:
        return []


def by_half(result: Result, channel: str, axis: str) -> dict[str, str]:
    """Columns of a channel group along an axis, by gear half."""
    found = {}
    for column in group(result, channel):
        *_, half, quantity = ("", *column.split("."))
        if half in HALVES and quantity.endswith(f"_{axis}"):
            found[half] = column
    return found


@dataclass(frozen=True)
class SteadyPart:
    """The part of a run on which means and spectra are taken.

    Attributes:
        rows: of the table.
        begin, end: [s].
        sample_step: time between records [s]; 0 with less than two rows.
        steady: the speed stays within 1 % of its final value, or is not known.
    """

    rows: slice
    begin: float
    end: float
    sample_step: float
    steady: bool


def steady_part(result: Result) -> SteadyPart:
    """The run without its first 20 % and without run-up.

    If the speed settles only in the last 10 % of the run, the last 80 % are taken as not steady.
    """
    time = result.data[TIME].to_numpy()
    count = time.size
    if count < 2:
        begin = float(time[0]) if count else 0.0
        return SteadyPart(slice(0, count), begin, begin, 0.0, steady=False)
    first, steady = int(SETTLING_SHARE * count), not result.outcome.unstable
    speed = signal(result, "gear_mesh", "pinion.w")
    if speed is not None and steady:
        outside = np.flatnonzero(np.abs(speed - speed[-1]) > SPEED_BAND * abs(speed[-1]))
        settled = int(outside[-1]) + 1 if outside.size else 0
        steady = settled <= (1.0 - _SHORTEST_SHARE) * count
        first = max(first, settled) if steady else first
    step = float(time[-1] - time[0]) / (count - 1)
    return SteadyPart(slice(first, count), float(time[first]), float(time[-1]), step, steady)


def run_mesh_frequency(result: Result, number_of_teeth: float | None = None) -> float | None:
    """Mesh frequency [Hz] at the mean speed of the steady part.

    Args:
        result: of a run.
        number_of_teeth: of the pinion; the run's own parameter if not given.

    Returns:
        None without gear mesh, when the speed is not steady, or when the steady part is shorter
        than a mesh period (a gear at rest): no order could be told from its neighbours.
    """
    speed = signal(result, "gear_mesh", "pinion.w")
    part = steady_part(result)
    if speed is None or not part.steady:
        return None
    if number_of_teeth is None:
        declared = COMPONENTS["gear_mesh"].declaration.variable(_TEETH).start
        name = f"{instance(result, 'gear_mesh')}.{_TEETH}"
        number_of_teeth = result.info.parameters.get(name, declared)
    frequency = mesh_frequency(float(speed[part.rows].mean()), number_of_teeth)
    time = result.data[TIME].to_numpy()[part.rows]
    return frequency if frequency * (time[-1] - time[0]) >= 1.0 else None


@dataclass(frozen=True)
class PowerBalance:
    """Mean powers of the closed-power-flow rig [W].

    Attributes:
        drive_electrical: from the supply into the drive motor.
        recovered: fed back by the load motor.
        circulating: through the pinion shaft.
        drive_loss, load_loss: in the motors.
        transmission_loss: between the rotors, gearbox and couplings: mechanical power out of the
            drive rotor minus power into the load rotor; it contains what is stored.
    """

    drive_electrical: float
    recovered: float
    circulating: float
    drive_loss: float
    load_loss: float
    transmission_loss: float

    @property
    def supplied(self) -> float:
        """Net power from the supply [W]: the sum of all losses."""
        return self.drive_electrical - self.recovered


def shaft_torques(result: Result) -> dict[str, str]:
    """Columns of the coupling torques by gear: pinion (drive side) and wheel (load side)."""
    columns = {"pinion": "drive_coupling.torque", "wheel": "load_coupling.torque"}
    return {gear: column for gear, column in columns.items() if column in result.data}


def mesh_forces(result: Result) -> dict[str, str]:
    """Columns of the normal forces of the meshes by side: left and right."""
    mesh = instance(result, "gear_mesh")
    columns = {side: f"{mesh}.mesh_{side}.force" for side in ("left", "right")}
    return {side: column for side, column in columns.items() if column in result.data}


def power_balance(result: Result) -> PowerBalance | None:
    """Mean powers over the steady part; None without both motors and the pinion's transducer."""
    needed = [
        signal(result, "drive_motor", "electrical_power"),
        signal(result, "drive_motor", "torque"),
        signal(result, "drive_motor", "flange.w"),
        signal(result, "load_motor", "recovered_power"),
        signal(result, "load_motor", "loss_power"),
        signal(result, "gear_mesh", "pinion.w"),
    ]
    pinion = shaft_torques(result).get("pinion")
    if pinion is None or any(values is None for values in needed):
        return None
    rows = steady_part(result).rows
    drive, torque, speed, recovered, load_loss, pinion_speed = (
        values[rows] for values in needed if values is not None
    )
    mechanical = float((torque * speed).mean())
    return PowerBalance(
        float(drive.mean()),
        float(recovered.mean()),
        float((result.data[pinion].to_numpy()[rows] * pinion_speed).mean()),
        float(drive.mean()) - mechanical,
        float(load_loss.mean()),
        mechanical - float((recovered + load_loss).mean()),
    )
