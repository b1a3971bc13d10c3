"""The flank whose line of action is y: the same for a pair and its bearings, and the loaded one."""

from collections.abc import Iterator

from herringbone.analysis.asked import mesh_forces, parameter
from herringbone.core.declaring.roles import PortKind, Quantity
from herringbone.result.result import TIME, Result

_NAMES = {1.0: "drive", -1.0: "coast"}


def of_flank(result: Result, gear: str) -> Iterator[str]:
    """Lines on bearings with y along the other flank, and on the time that this one is loaded."""
    flank = parameter(result, gear, Quantity.CARRYING_FLANK)
    if flank is None:
        return
    carries = _sign(flank)
    name, opposite = _NAMES[carries], _NAMES[-carries]
    joined = (part for part, _ in result.info.anatomy.joined(gear, PortKind.JOURNAL))
    for part in dict.fromkeys(joined):
        own = parameter(result, part, Quantity.CARRYING_FLANK)
        if own is not None and _sign(own) != carries:
            yield (
                f"{gear} has y along the line of action of its {name} flank ({flank:g}), {part} "
                f"along that of the {opposite} flank ({own:g}): the housing gets the force in the "
                "wrong direction; set both alike"
            )
    forces = [column for column in mesh_forces(result, gear).values() if column in result.data]
    other = (carries * result.data[forces].to_numpy() < 0.0).any(axis=1)
    if other.any():
        time = result.data[TIME].to_numpy()
        share = float(other.mean()) * (time[-1] - time[0])
        yield (
            f"{gear}: the {opposite} flank is loaded for {1e3 * share:.4g} ms of "
            f"{1e3 * (time[-1] - time[0]):.4g} ms; y is the line of action of the {name} flank, so "
            "that the separating part of the force has the wrong direction then"
        )


def _sign(flank: float) -> float:
    return -1.0 if flank < 0.0 else 1.0
