"""Sound power that a housing radiates: of a steady state line by line, of a run over its time.

The forces of the steady state on the seats drive all oscillators of the housing's data, whatever a
leaner model holds; see `analysis.figures.radiated_power`.
"""

from contextlib import suppress

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.figures import radiated_power as of_runs
from herringbone.analysis.figures.modal_response import ports_at_seats
from herringbone.analysis.figures.radiated_power import RadiatedPower, power_of_lines, with_surface
from herringbone.analysis.figures.system_housings import data_of
from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError, ResourceError
from herringbone.core.declaring.roles import Role
from herringbone.housing import SEAT_DOFS, ModalHousing
from herringbone.result.result import Result


def radiated_power(
    of: Result | SteadyState | SettledState, housing: ModalHousing | None = None, *, part: str = ""
) -> RadiatedPower:
    """Estimate the sound power that a housing radiates under its bearing forces.

    Args:
        of: a run that records the forces on the seats, or a steady state.
        housing: modal data with a Gram matrix of the surface; what the system used if not given.
        part: name of the housing; the first one of the system if not given.

    Raises:
        ParameterError: there is no housing, no forces are known, the run diverged or is too short,
            the state was not found, or there is no Gram matrix.
    """
    if isinstance(of, SteadyState):
        return _of_lines(of, housing, part)
    run = of.run if isinstance(of, SettledState) else of
    if not isinstance(run, Result):
        raise ParameterError(f"{run!r:.60}: radiated power is of a run's result or a steady state")
    return of_runs.radiated_power(run, housing, part=part)


def radiated_powers(of: Result | SteadyState | SettledState) -> dict[str, RadiatedPower]:
    """By housing, of those whose data are known and tell of their surface."""
    if isinstance(of, SteadyState):
        known = anatomy(of.structure.system)
    else:
        known = (of.run if isinstance(of, SettledState) else of).info.anatomy
    found = {}
    for name in known.with_role(Role.HOUSING):
        with suppress(ParameterError, ResourceError):
            found[name] = radiated_power(of, part=name)
    return found


def _of_lines(state: SteadyState, housing: ModalHousing | None, part: str) -> RadiatedPower:
    if not state.found:
        raise ParameterError("no motion was found: no radiated power")
    system = state.structure.system
    known = anatomy(system)
    housings = known.with_role(Role.HOUSING)
    if part and part not in housings:
        raise ParameterError(f"'{part}' is not a {Role.HOUSING}; there are: {', '.join(housings)}")
    if not part and not housings and housing is None:
        raise ParameterError(f"system '{state.system_name}': no part is known as {Role.HOUSING}")
    name = part or next(iter(housings), "")
    data = with_surface(housing or data_of(system, name))
    ports = ports_at_seats(known, name)
    if missing := [seat for seat, _ in SEAT_DOFS if seat not in ports]:
        raise ParameterError(f"no part is a {Role.BEARING} at {missing[0]}: no radiated power")
    forces = state.amplitudes(*(f"{ports[seat]}.f_{axis}" for seat, axis in SEAT_DOFS))
    heard = (state.frequencies > 0.0) & (state.frequencies <= data.valid_to_hz)
    lines = state.frequencies[heard]
    power = power_of_lines(data, lines, forces[:, heard])
    return RadiatedPower(lines, power, state.frequency, data.valid_to_hz)
