"""A steady state as text, as numbers of a JSON object, and as files."""

import json
import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from herringbone.analysis.figures.radiated_power import LABEL
from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.periodic import PeriodicMotion
from herringbone.analysis.steady.searching.irregular import Irregular
from herringbone.analysis.steady.sensitivities.sensitivity import Sensitivity
from herringbone.analysis.steady.sound import radiated_powers
from herringbone.analysis.steady.state import SteadyState
from herringbone.core.declaring.units import R_MIN
from herringbone.core.places.files import replacing
from herringbone.result.tables import pieces_of, write_csv

_FEW = 10
"""Meshes of a period whose multipliers take no second."""
_LINES = 5
"""Largest lines of a group that are told."""
_LARGEST = 8
"""Parameters that are told."""
ORDERS, SUMMARY = "orders.csv", "steady.json"


def steady_summary(state: SteadyState | SettledState) -> dict:
    """Figures of a state, for JSON; SI units, None where something is not known."""
    levels = {group: state.level(group) for group in state.channels} if state.found else {}
    known = {
        "system": state.system_name,
        "converged": state.converged,
        "speed": _known(state.speed) if state.found else None,
        "period": _known(state.period) if state.found else None,
        "meshes": state.meshes or None,
        "tolerance": state.tolerance,
    }
    if isinstance(state, SettledState):
        own: dict = {"duration": state.run.outcome.time, "change": dict(state.changes)}
    else:
        own = {
            "solver": state.solver,
            "marched": state.settled._asdict() if state.settled else None,
            "irregular": _irregular(state.irregular),
            "missed": state.shot.missed if state.shot else None,
            "left_out": dict(state.errors.left_out),
            "worst_channel": _worst(state),
            "change": dict(state.errors.change),
            "iterations": state.orbit.iterations,
            "places": state.orbit.places,
            "drift": state.drift if state.found else None,
            "slips": state.slips if state.found else {},
            "largest_multiplier": state.multipliers.largest if _are_cheap(state) else None,
            "bends": list(state.bends),
        }
    powers = radiated_powers(state) if state.found else {}
    return {
        **known,
        **own,
        "levels": levels,
        "radiated_power_dB": {part: _known(p.level_db) for part, p in powers.items()},
        "notes": list(state.notes),
    }


def _worst(state: SteadyState) -> dict[str, str | float] | None:
    """The channel that errs most; None: none moves."""
    name, error = state.worst_channel
    return {"name": name, "error": error} if name else None


def _irregular(found: Irregular | None) -> dict | None:
    """What a march tells that never repeats."""
    if found is None:
        return None
    return {**found._asdict(), "parting": found.parting._asdict(), "levels": dict(found.levels)}


def _known(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _are_cheap(state: SteadyState) -> bool:
    """True if multipliers are known, and take no second."""
    return state.converged and (state.meshes <= _FEW or state.shot is not None)


def steady_text(state: SteadyState | SettledState) -> list[str]:
    """Lines for people."""
    if not state.found:
        return [f"Steady state of {state.system_name}: none was found, no figures"]
    lines = _of_run(state) if isinstance(state, SettledState) else _of_balance(state)
    for group in state.channels:
        lines += ["", *_group(state, group)]
    if powers := radiated_powers(state):
        several = len(powers) > 1
        lines += ["", f"radiated power ({LABEL}):"]
        lines += [f"  {f'{part}: ' if several else ''}{p.told}" for part, p in powers.items()]
    return lines


def _of_run(state: SettledState) -> list[str]:
    """Head of what a run has settled to."""
    found = "settled" if state.converged else "UNSETTLED: figures below still change"
    lines = [f"Steady state of {state.system_name}: {found}, in a run as parts are foreign"]
    if math.isfinite(state.speed):
        known = math.isfinite(state.ending.rest)
        meshes = f", repeats after {_counted(state.meshes)} ({state.period:.6g} s)"
        lines.append(f"  speed {state.speed * R_MIN:.6g} r/min{meshes if known else ''}")
    if math.isfinite(state.error):
        lines.append(
            f"  levels and means change by {state.error:.2g} of the alternating part (asked "
            f"{state.tolerance:g}) from the third to the last quarter of "
            f"{state.run.outcome.time:g} s"
        )
    return lines


def _of_balance(state: SteadyState) -> list[str]:
    """Head of what harmonic balance has found."""
    found = (
        f"periodic, by {state.solver}"
        if state.converged
        else "NOT CONVERGED: no figure below can be trusted"
    )
    lines = [
        f"Steady state of {state.system_name}: {found}",
        f"  speed {state.speed * R_MIN:.6g} r/min, repeats after {_counted(state.meshes)} "
        f"({state.period:.6g} s)",
        f"  error {state.errors.worst:.2g} of the alternating part (asked {state.tolerance:g}), "
        f"measured{_after(state)} at twice the {state.orbit.places} points of the period",
    ]
    if worst := _worst(state):
        lines.append(
            f"  worst channel {worst['error']:.2g} of its own alternating part: {worst['name']}"
        )
    if state.settled:
        lines.append(
            f"  by marching: {state.settled.time:.3g} s from equilibrium; the last period differs "
            f"from the one before by {state.settled.change:.2g}"
        )
    if state.shot:
        lines.append(
            f"  by shooting: a period misses its start by {state.shot.missed:.2g} of the "
            f"alternating part; {state.shot.rounds} rounds of Newton"
        )
    if state.bends:
        lines.append(f"  laws bend within the period: {', '.join(state.bends)}")
    if _are_cheap(state):
        largest = state.multipliers.largest
        word = "stable" if state.stable else "UNSTABLE: a run would leave it"
        lines.append(f"  {word}: deviations are multiplied by {largest:.4g} in a period")
    if state.structure.problem.free is not None:
        lines.append(
            f"  nothing holds the speed: it would change by {state.drift:.3g} rad/s2, which is left"
            " out"
        )
    lines += [
        f"  {name} turns by {slip:+.4g} rad/s beside the rest, at a speed where its torques balance"
        for name, slip in state.slips.items()
    ]
    return lines


def _counted(meshes: int) -> str:
    return f"{meshes} mesh period{'s' * (meshes != 1)}"


def _after(state: SteadyState) -> str:
    """How many iterations of harmonic balance came before; "" of a march or a shot."""
    count = state.orbit.iterations
    return "" if state.by else f" after {count} iteration{'s' * (count != 1)}"


def _group(state: PeriodicMotion, group: str) -> list[str]:
    columns = state.chosen(group)
    unit = state.unit(columns[0])
    squares = np.abs(state.amplitudes(group)) ** 2 / 2.0
    sizes = np.sqrt(np.mean(squares, axis=0))
    largest = [k for k in np.argsort(sizes[1:])[::-1][:_LINES] + 1 if sizes[k] > 0.0]
    levels = np.sqrt(np.sum(squares[:, 1:], axis=1))
    loudest = int(levels.argmax())
    return [
        f"{group.replace('_', ' ')}: {state.level(group):.5g} {unit} rms over {len(columns)} "
        f"channels, most {levels[loudest]:.5g} {unit} at {columns[loudest]}",
        *(
            f"  mesh order {state.mesh_orders[k]:<8.5g} {state.frequencies[k]:9.5g} Hz "
            f"{sizes[k]:11.5g} {unit} rms"
            for k in sorted(largest)
        ),
    ]


def sensitivity_text(found: Mapping[str, Mapping[str, Sensitivity]]) -> list[str]:
    """Lines on what the levels of groups depend on most."""
    lines: list[str] = []
    for group, own in found.items():
        lines += ["", f"{group.replace('_', ' ')}: level goes with parameter to the power of"]
        largest = sorted(own, key=lambda name: -abs(own[name].relative))[:_LARGEST]
        lines += [f"  {own[name].relative:9.3f}  {name}" for name in largest]
    return lines


def write_steady(state: SteadyState | SettledState, folder: Path) -> list[Path]:
    """Write `orders.csv`, one row per output and harmonic, and `steady.json`; returns their names.

    Of a state that was not found the second one alone.

    Amplitudes have the unit of their row.

    Args:
        state: that was searched for.
        folder: that is there.

    Raises:
        OSError: a file cannot be written.
    """
    with replacing(folder / SUMMARY) as file:
        file.write(json.dumps(steady_summary(state), indent=1) + "\n")
    if not state.found:
        return [folder / SUMMARY]
    table = state.table()
    with replacing(folder / ORDERS) as file:
        write_csv(file, list(table.columns), pieces_of(table))
    return [folder / ORDERS, folder / SUMMARY]
