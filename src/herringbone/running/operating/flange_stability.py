"""Stable communication steps of one FMU at a host, see `running.foreign.hosted_flange`."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.flange.hosted_flange import Host
from herringbone.core.places.files import as_texts
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.cell.policy import foreign_fmus_housed
from herringbone.running.foreign.hosted_flange import HostedFlange, hosted_flange


def flange_stability(
    fmu: str | Path,
    *,
    inertia: float,
    stiffness: float = 0.0,
    damping: float = 0.0,
    flange: str = "",
    values: Mapping[str, float | str | Path] | None = None,
    in_process: bool | None = None,
    call_deadline: float | None = None,
    most_trial_steps: int | None = None,
) -> HostedFlange:
    """The largest communication step at which a host can couple a flange of an FMU to an inertia.

    Args:
        fmu: file.
        inertia: of the host at the flange [kg m2].
        stiffness, damping: of the host's shaft [N m/rad], [N m s/rad], where the flange takes
            torque; one that takes motion has its shaft inside.
        flange: port, or `tau=NAME,phi=NAME,w=NAME`, without `phi` if there is none; "": the only
            one that there is.
        values: start values by variable.
        in_process, call_deadline, most_trial_steps: as in `herringbone.run`.

    Returns:
        Limits [s] by order of what is exchanged and by schedule; `str` tells them as the command
        `stability X.fmu` does.

    Raises:
        FmuError: the FMU cannot be used, or trials tell nothing of it.
        ParameterError: there is no such flange, or the host does not fit it.
    """
    host = Host(inertia, stiffness, damping)
    with (
        one_blas_thread(),
        foreign_fmus_housed(in_process, call_deadline, None, most_trial_steps) as remarks,
    ):
        found = hosted_flange(Path(fmu), flange, host, as_texts(values))
        return replace(found, notes=(*found.notes, *map(str, remarks)))
