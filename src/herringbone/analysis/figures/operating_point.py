"""Operating point of a run: steady part, mesh frequency, mean torques and the power balance.

Everything is read from a `Result` and is None or empty where the system has no such outputs.
"""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.asked import parameter, shaft_torques, signal
from herringbone.analysis.figures.spectra import mesh_frequency
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import TIME, Result

SETTLING_SHARE = 0.2
"""Share of a run that is left out of means and spectra."""
SPEED_BAND = 0.01
"""The steady part's speed stays within this share of its final value."""
_SHORTEST_SHARE = 0.1
_FEWEST = 2
"""Records of which anything can be said."""
_TOLD_SHARE, _TOLD_RECORDS = 0.01, 100
"""A run that failed before this share of its duration, and so many records, tells its start."""


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


def has_figures(result: Result) -> bool:
    """True if means and spectra of a run say anything.

    They do not if its values grew without bound, or if it failed as soon as it had begun.
    """
    outcome, count = result.outcome, len(result.data)
    if count < _FEWEST or outcome.unstable:
        return False
    begun = outcome.time < _TOLD_SHARE * result.info.t_end and count < _TOLD_RECORDS
    return not (outcome.failed and begun)


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
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion")
    if speed is not None and steady:
        outside = np.flatnonzero(np.abs(speed - speed[-1]) > SPEED_BAND * abs(speed[-1]))
        settled = int(outside[-1]) + 1 if outside.size else 0
        steady = settled <= (1.0 - _SHORTEST_SHARE) * count
        first = max(first, settled) if steady else first
    step = float(time[-1] - time[0]) / (count - 1)
    return SteadyPart(slice(first, count), float(time[first]), float(time[-1]), step, steady)


def run_mesh_frequency(
    result: Result,
    number_of_teeth: float | None = None,
    *,
    gear: str = "",
    part: SteadyPart | None = None,
) -> float | None:
    """Mesh frequency [Hz] at the mean speed of the steady part.

    Args:
        result: of a run.
        number_of_teeth: of the pinion; the run's own parameter if not given.
        gear: name of the gear pair; the first one if not given.
        part: in place of the run's own steady part.

    Returns:
        None without gear pair of known teeth, when the speed is not steady, or when the steady part
        is shorter than a mesh period (a gear at rest): no order could be told from its neighbours.
    """
    speed = signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion", part=gear)
    part = part or steady_part(result)
    if speed is None or not part.steady:
        return None
    if number_of_teeth is None:
        number_of_teeth = _teeth(result, gear or result.parts_with(Role.GEAR_PAIR)[0])
        if number_of_teeth is None:
            return None
    frequency = mesh_frequency(float(speed[part.rows].mean()), number_of_teeth)
    time = result.data[TIME].to_numpy()[part.rows]
    return frequency if frequency * (time[-1] - time[0]) >= 1.0 else None


def no_mesh_frequency(result: Result, gear: str = "") -> str:
    """Why a run tells no mesh frequency, where `run_mesh_frequency` is None.

    Args:
        result: of a run.
        gear: name of the gear pair; the first one if not given.
    """
    for pair in (gear,) if gear else result.parts_with(Role.GEAR_PAIR)[:1]:
        speed = result.info.anatomy.column(pair, Quantity.SPEED, "pinion")
        if speed is not None and speed not in result.data:
            return f"no mesh frequency, as {speed} is not recorded"
    return "no steady mesh frequency"


def _teeth(result: Result, gear: str) -> float | None:
    return parameter(result, gear, Quantity.NUMBER_OF_TEETH, "pinion")


_ENDS = 2
"""Of a rig's shafts: one that drives and one that loads."""


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


def power_balance(result: Result) -> PowerBalance | None:
    """Mean powers over the steady part; None without both motors and the pinion's transducer.

    Where there are more drives, loads or gear pairs, powers are those of flanges, see
    `flange_power`: one of each would leave out what the others take.
    """
    ends = [*result.parts_with(Role.DRIVE), *result.parts_with(Role.LOAD)]
    if len(ends) > _ENDS or len(result.parts_with(Role.GEAR_PAIR)) > 1:
        return None
    needed = [
        signal(result, Role.DRIVE, Quantity.ELECTRICAL_POWER),
        signal(result, Role.DRIVE, Quantity.TORQUE),
        signal(result, Role.DRIVE, Quantity.SPEED),
        signal(result, Role.LOAD, Quantity.RECOVERED_POWER),
        signal(result, Role.LOAD, Quantity.LOSS_POWER),
        signal(result, Role.GEAR_PAIR, Quantity.SPEED, "pinion"),
    ]
    pinion = shaft_torques(result).get("pinion")
    if pinion is None or any(values is None for values in needed):
        return None
    rows = steady_part(result).rows
    drive, torque, speed, recovered, load_loss, pinion_speed = (
        values[rows] for values in needed if values is not None
    )
    mechanical = float((torque * speed).mean())
    given = pinion.sign * result.data[pinion.column].to_numpy()[rows]
    return PowerBalance(
        float(drive.mean()),
        float(recovered.mean()),
        float((given * pinion_speed).mean()),
        float(drive.mean()) - mechanical,
        float(load_loss.mean()),
        mechanical - float((recovered + load_loss).mean()),
    )
