"""The flank whose line of action is y: the same for a pair and its bearings, and the loaded one."""

from collections.abc import Iterable, Iterator

from herringbone.analysis.asked import mesh_forces, parameter
from herringbone.core.declaring.roles import PortKind, Quantity
from herringbone.core.wording import settings
from herringbone.result.result import TIME, Result

_NAMES = {1.0: "drive", -1.0: "coast"}
_MOSTLY = 0.5
"""Share of a run from which a loaded flank is the one that carries."""


def of_flank(result: Result, gear: str) -> Iterator[str]:
    """Lines on bearings with y along the other flank, and on the time that this one is loaded."""
    flank = parameter(result, gear, Quantity.CARRYING_FLANK)
    if flank is None:
        return
    carries = _sign(flank)
    name, opposite = _NAMES[carries], _NAMES[-carries]
    anatomy = result.info.anatomy
    joined = dict.fromkeys(part for part, _ in anatomy.joined(gear, PortKind.JOURNAL))
    for part in joined:
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
        mostly = other.mean() > _MOSTLY
        yield (
            f"{gear}: the {opposite} flank is loaded for {1e3 * share:.4g} ms of "
            f"{1e3 * (time[-1] - time[0]):.4g} ms; y is the line of action of the {name} flank, so "
            "that the separating part of the force has the wrong direction then"
            f"{_remedy(result, (gear, *joined), -carries) if mostly else ''}"
        )


def _remedy(result: Result, parts: Iterable[str], flank: float) -> str:
    """How a pair and its bearings are told which flank carries."""
    columns = (result.info.anatomy.column(part, Quantity.CARRYING_FLANK) for part in parts)
    given = settings({column: flank for column in columns if column})
    return f"; it carries most of the time: {given} takes its line of action"


def _sign(flank: float) -> float:
    return -1.0 if flank < 0.0 else 1.0
