"""How far a run may be from the gearbox that is meant: one row per source of error.

    table           uncertainty of the mesh harmonics of the stiffness table, over their amplitudes,
                    weighted with the lines that the run's bearing forces have at these harmonics:
                    sqrt(sum (a_k u_k / h_k)^2) / sqrt(sum a_k^2), k = 1 ... 4, u_k / h_k at most 1;
                    where the response is linear, a line follows its harmonic
    coupling        error against the monolithic twin if it was solved, else by the rule of
                    `analysis.stability.recommendation`
    inner steps     floor of the gear's micro steps, by the same rule
    housing         certified bound of a reduction up to the end of its band
    dampings        assumed ones: nobody has measured them
    tooth errors    none are given: perfect teeth; or as a whole, not of single teeth

Rows are sorted by their value, the largest first, then those without.
"""

from collections.abc import Iterable, Iterator

import numpy as np

from herringbone.analysis.accuracy.beyond import share_beyond
from herringbone.analysis.asked import group, has_own, resource_file, signal
from herringbone.analysis.figures.modal_response import housing_of
from herringbone.analysis.figures.operating_point import (
    no_mesh_frequency,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.stability.recommendation import (
    SOURCE,
    contact_floor,
    rule_error,
    separation_floor,
)
from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.stiffness_table import read_uncertainty
from herringbone.core.declaring.roles import SIDES, Quantity, Role
from herringbone.core.wording import option, percent
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.result.budget import BudgetRow, Known
from herringbone.result.result import TIME, Result

_FORCE = "bearing force, alternating part"
_CHANNEL = "bearing_force"
_FEWEST_PERIODS = 4.0


def error_budget(result: Result, bond_frequency: float = 0.0) -> tuple[BudgetRow, ...]:
    """Rows of a run, the largest first.

    Args:
        result: of the run.
        bond_frequency: the highest of all bonds together [rad/s]; 0 if unknown.
    """
    rows = [
        *_tables(result),
        *([coupling_row(result, bond_frequency)] if len(result.info.model) > 1 else []),
        *_inner_steps(result),
        *_housings(result),
        *_assumptions(result),
    ]
    return by_size(rows)


def by_size(rows: Iterable[BudgetRow]) -> tuple[BudgetRow, ...]:
    """The rows with a value, the largest first, then the others."""
    return tuple(sorted(rows, key=lambda row: (row.value is None, -(row.value or 0.0))))


def _tables(result: Result) -> Iterator[BudgetRow]:
    for gear in result.parts_with(Role.GEAR_PAIR):
        source = f"stiffness table of {gear}"
        file = resource_file(result, gear, Quantity.STIFFNESS_TABLE)
        if file is None:
            yield BudgetRow(source, _FORCE, None, Known.UNKNOWN, "a part whose table is not known")
            continue
        stated = read_uncertainty(file, _mean_force(result, gear))
        if stated is None:
            yield BudgetRow(source, _FORCE, None, Known.UNKNOWN, "the table states no uncertainty")
            continue
        lines = _lines(result, gear, len(stated.harmonics))
        if lines is None:
            why = f"{_no_lines(result, gear)}, to weigh the harmonics with"
            yield BudgetRow(source, _FORCE, None, Known.UNKNOWN, why)
            continue
        share = stated.harmonics / np.maximum(stated.amplitudes, stated.harmonics)
        value = float(np.linalg.norm(lines * share) / np.linalg.norm(lines))
        how = (
            "the table's uncertainty at mesh harmonics 1 to 4, weighted with the run's lines there"
        )
        yield BudgetRow(source, _FORCE, value, Known.ESTIMATED, how)


def _mean_force(result: Result, gear: str) -> float:
    """Mean normal force [N] of the left mesh, on either flank; 0 if it is not recorded."""
    force = signal(result, Role.GEAR_PAIR, Quantity.MESH_FORCE, "left", part=gear)
    return 0.0 if force is None else abs(float(force[steady_part(result).rows].mean()))


def _lines(result: Result, gear: str, count: int) -> np.ndarray | None:
    """Amplitudes (count,) of the bearing forces at mesh harmonics, over all channels."""
    columns, frequency = group(result, _CHANNEL), run_mesh_frequency(result, gear=gear)
    part = steady_part(result)
    time = result.data[TIME].to_numpy()[part.rows]
    if not columns or not frequency or time.size < 2:
        return None
    periods = int((time[-1] - time[0]) * frequency)
    if periods < _FEWEST_PERIODS:
        return None
    used = time - time[0] <= periods / frequency
    forces = result.data[columns].to_numpy()[part.rows][used]
    forces = forces - forces.mean(axis=0)
    turns = np.exp(-2j * np.pi * frequency * np.outer(np.arange(1, count + 1), time[used]))
    found = np.abs(turns @ forces) * 2.0 / forces.shape[0]
    lines = np.linalg.norm(found, axis=1)
    return lines if lines.any() else None


def _no_lines(result: Result, gear: str) -> str:
    """Why bearing forces have no lines at mesh harmonics."""
    if not group(result, _CHANNEL):
        return "no bearing forces"
    if run_mesh_frequency(result, gear=gear):
        return "too few mesh periods, or nothing in them"
    return no_mesh_frequency(result, gear)


def coupling_row(result: Result, bond_frequency: float) -> BudgetRow:
    """What the coupling errs, of a fused run its steps; see `error_budget`."""
    source = "steps of the core" if result.info.all_fused else "coupling"
    if result.error:
        name, value = max(result.error.items(), key=lambda item: item[1])
        quantity = f"{name.replace('_', ' ')}, alternating part"
        how = "against the monolithic solution of the same equations"
        return BudgetRow(source, quantity, value, Known.MEASURED, how)
    if result.verification is not None and result.verification.groups:
        name, value = max(result.verification.groups.items(), key=lambda item: item[1])
        quantity = f"{name.replace('_', ' ')}, alternating part"
        return BudgetRow(source, quantity, value, Known.ESTIMATED, result.verification.how)
    if result.info.all_fused:
        return BudgetRow(source, _FORCE, None, Known.UNKNOWN, "nothing varies")
    if (estimate := result.info.estimate) is not None:
        how = f"by the differences of the forces in each step; {_measures('reference')}"
        return BudgetRow(source, _FORCE, estimate["coupling"], Known.ESTIMATED, how)
    algorithm = parse_algorithm(result.info.algorithm)
    rule = algorithm.accurate_step
    if rule is None or not bond_frequency or result.info.slow:
        foreign = not COMPONENTS.keys() >= set(result.info.model.values())
        measures = _measures("verify" if foreign else "reference")
        how = f"no rule for this algorithm and system; {measures}"
        return BudgetRow("coupling", _FORCE, None, Known.UNKNOWN, how)
    step = result.info.communication_step * bond_frequency / rule
    gears = result.parts_with(Role.GEAR_PAIR)
    value = rule_error(algorithm, step, apart=any(_separates(result, gear) for gear in gears))
    how = f"{SOURCE}; {_measures('reference')}"
    return BudgetRow("coupling", _FORCE, value, Known.ESTIMATED, how)


def _measures(name: str) -> str:
    """Which option measures what is estimated."""
    return f"{option(name, True)} measures"


def _inner_steps(result: Result) -> Iterator[BudgetRow]:
    for part, step in result.info.micro_steps.items():
        if Role.GEAR_PAIR not in result.info.anatomy.parts[part].roles:
            continue
        apart, estimate = _separates(result, part), result.info.estimate
        value = separation_floor(step) if apart else contact_floor(step)
        where = "where teeth separate" if apart else "in contact"
        how = f"micro steps of {1e6 * step:.3g} us {where}, as on the test rig"
        if estimate is not None and not apart:  # macro steps cut them shorter
            value, how = estimate["inner_steps"], "by the differences of the forces in each step"
        yield BudgetRow(f"inner steps of {part}", _FORCE, value, Known.ESTIMATED, how)


def _separates(result: Result, gear: str) -> bool:
    forces = (
        signal(result, Role.GEAR_PAIR, Quantity.MESH_FORCE, side, part=gear) for side in SIDES
    )
    return any(force is not None and not np.all(force != 0.0) for force in forces)


def _housings(result: Result) -> Iterator[BudgetRow]:
    for part in result.parts_with(Role.HOUSING):
        source, quantity = f"reduction of {part}", "receptance at the seats, over statics"
        housing = housing_of(result, part)
        bound = housing.certificate.get("error_bound") if housing else None
        if housing is None or bound is None:
            how = "its data carry no certificate"
            yield BudgetRow(source, quantity, None, Known.UNKNOWN, how)
            continue
        band = float(housing.certificate.get("band_hz", 0.0))
        how = f"certified bound up to {band:g} Hz"
        if (share := share_beyond(result, _CHANNEL, band)) > float(bound):
            how += f"; {percent(share)} of the bearing forces lie beyond, where nothing is known"
        yield BudgetRow(source, quantity, float(bound), Known.ESTIMATED, how)


def _assumptions(result: Result) -> Iterator[BudgetRow]:
    for gear in result.parts_with(Role.GEAR_PAIR):
        given = {
            kind: has_own(result, gear, kind)
            for kind in (Quantity.TOOTH_ERRORS, Quantity.TOOTH_DEVIATIONS)
            if result.info.anatomy.column(gear, kind) in result.info.resources
        }
        if given and not given.get(Quantity.TOOTH_DEVIATIONS):
            how = "none are given: perfect teeth"
            if given.get(Quantity.TOOTH_ERRORS):
                how = "as a whole: where teeth differ, harmonics may be wrong by a multiple"
            yield BudgetRow(f"tooth errors of {gear}", _FORCE, None, Known.UNKNOWN, how)
    if result.parts_with(Role.GEAR_PAIR):
        how = "damping ratios are assumed; the height of a resonance goes with their reciprocal"
        yield BudgetRow("dampings", "resonances", None, Known.UNKNOWN, how)
