"""Stability of a system's coupling as text and as one JSON object."""

import math
from collections.abc import Sequence
from textwrap import wrap
from typing import Any

from herringbone.analysis.stability.bonds import Bond
from herringbone.analysis.stability.limit_lines import in_us, said_of_limits, short
from herringbone.analysis.stability.limits import Stability
from herringbone.analysis.stability.linear_parts import MeshStiffness
from herringbone.analysis.stability.recommendation import Ranking, Recommendation
from herringbone.analysis.stability.steps.simulated_limit import HIGHEST, LOWEST
from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.core.wording import option, percent

_WIDTH = 100
"""Longest line of the text, in characters."""


def _simulated(step: float | None) -> str:
    return "-" if step is None else in_us(step)


def _bands(found: StepLimits) -> str:
    parts = [
        f"{in_us(low)}-{in_us(high)}" if math.isfinite(high) else f"from {in_us(low)}"
        for low, high in found.unstable_bands
    ]
    return ", ".join(parts) or "none"


def _table(rows: Sequence[tuple[str, ...]], *, wrap_last: bool = False) -> list[str]:
    """Rows in columns, the first one left-aligned, the last one too if it is to be wrapped."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    left = {0, len(widths) - 1} if wrap_last else {0}
    indent = sum(widths[:-1]) + 2 * (len(widths) - 1)
    lines = []
    for row in rows:
        first, *more = _pieces(row[-1], _WIDTH - indent) if wrap_last else (row[-1],)
        cells = zip((*row[:-1], first), widths, strict=True)
        text = [c.ljust(w) if k in left else c.rjust(w) for k, (c, w) in enumerate(cells)]
        lines += ["  ".join(text).rstrip(), *(" " * indent + line for line in more)]
    return lines


def _pieces(bands: str, width: int) -> list[str]:
    """Lines of whole bands."""
    lines = wrap(bands.replace("from ", "from\N{NO-BREAK SPACE}"), max(width, 1))
    return [line.replace("\N{NO-BREAK SPACE}", " ") for line in lines]


def _limit_rows(found: Stability, *, runs: bool) -> list[tuple[str, ...]]:
    names = [stiffness.value for stiffness in MeshStiffness]
    rows: list[tuple[str, ...]] = [
        ("", *names, *(("runs",) if runs else ()), "grows at", "unstable at mean"),
        ("algorithm", *("[us]" for _ in names), *(("[us]",) if runs else ()), "[Hz]", "[us]"),
    ]
    for limits in found.limits:
        seen = (_simulated(limits.simulated_limit),) if runs else ()
        frequency = f"{limits.frequency:.0f}" if math.isfinite(limits.frequency) else "-"
        steps = (in_us(limits.mesh_stiffness[name], limits.largest) for name in names)
        name = short(limits.algorithm)
        rows.append((name, *steps, *seen, frequency, _bands(limits)))
    return rows


def _bond_lines(bonds: Sequence[Bond]) -> list[str]:
    """A line of numbers for each bond, and below it the bodies with their effective masses."""
    rules = "jacobi:order=0", "jacobi:order=1", "jacobi:order=2", "li:degree=3"
    rows: list[tuple[str, ...]] = [
        ("bond", "local", "damping", "J0", "J1", "J2", "LI-3"),
        ("  bodies, effective masses", "[Hz]", "ratio [1]", *("[us]" for _ in rules)),
    ]
    for bond in bonds:
        frequency = f"{bond.frequency / (2.0 * math.pi):.0f}"
        limits = (in_us(bond.limits[rule]) for rule in rules)
        rows.append((bond.name, frequency, f"{bond.damping_ratio:.3f}", *limits))
    head, units, *numbers = _table(rows)
    below = map(_bodies, bonds)
    pairs = [line for pair in zip(numbers, below, strict=True) for line in pair]
    return [head, units, *pairs, "J0, J1, J2, LI-3: limits of jacobi and li by the two-mass rule"]


def _bodies(bond: Bond) -> str:
    unit = "kg.m2" if bond.name.endswith(".tau") else "kg"
    masses = zip(bond.bodies, bond.masses, strict=True)
    return "  " + ", ".join(f"{body} {mass:.4g} {unit}" for body, mass in masses)


def stability_text(found: Stability) -> str:
    """Limits, bonds and recommendation, for people; up to 100 characters wide."""
    scene = f", scene {found.scene}" if found.scene else ""
    runs = any(limits.simulated_limit for limits in found.limits)
    lines = [
        f"{found.system}{scene}: first unstable step at minimum, mean and maximum mesh stiffness,",
        "predicted from the linear parts",
        "",
        *_table(_limit_rows(found, runs=runs), wrap_last=True),
    ]
    if runs:
        lines.append(
            "runs: of the non-linear system; - if none was found from "
            f"{LOWEST:g} to {HIGHEST:g} times the predicted one"
        )
    if found.orders:
        lines += _foreign_lines(found)
    if found.bonds:
        lines += ["", *_bond_lines(found.bonds)]
        lines.append(f"all bonds together: {found.highest_frequency / (2.0 * math.pi):.0f} Hz")
    if found.ranking.best:
        lines += ["", *_recommended(found.ranking, found.tolerance)]
    said = [*said_of_limits(found.limits), *(f"note: {note}" for note in found.notes)]
    return "\n".join([*lines, *(line for n in said for line in wrap(n, _WIDTH))])


def _foreign_lines(found: Stability) -> list[str]:
    """What stands for foreign parts, how well, and what is not promised therefore."""
    parts = ", ".join(f"{name} of order {order}" for name, order in found.orders.items())
    missed = max((100.0 * limits.residual for limits in found.limits), default=0.0)
    lines = [
        f"foreign parts as linear systems that trial steps show: {parts}; on other trials, at the "
        f"limits, they miss by {missed:.1g} % at most"
    ]
    if found.fresh_instances:
        tried = ", ".join(f"{name} on {n}" for name, n in found.fresh_instances.items())
        lines.append(f"without saved states, each trial on an instance of its own: {tried}")
    lines += [
        f"nothing is promised for {short(limits.algorithm)}: at its limit they "
        f"miss by {percent(limits.residual)}"
        for limits in found.limits
        if not limits.promised
    ]
    return [piece for line in lines for piece in wrap(line, _WIDTH)]


def _recommended(ranking: Ranking, tolerance: float) -> list[str]:
    """The best algorithm and step, and a line for each that is ranked."""
    chosen = ranking.ranked[0]
    rows: list[tuple[str, ...]] = [("ranked", "step", "doStep calls"), ("", "[us]", "[1/ms]")]
    for found in ranking.ranked:
        name = short(found.algorithm)
        rows.append((name, in_us(found.step), f"{found.passes_per_ms:.3g}"))
    return [
        f"recommended for {100.0 * tolerance:g} %: "
        f"{option('algorithm', short(chosen.algorithm))} "
        f"{option('step', float(f'{chosen.step:.3g}'))}",
        f"expected error {percent(chosen.expected_error)}, bounded by "
        f"{chosen.bounded_by}; {percent(chosen.separation_error)} where teeth separate",
        *wrap(f"rule: {chosen.source}", _WIDTH),
        "",
        *_table(rows),
    ]


def _entry(found: Recommendation) -> dict[str, Any]:
    """Plain values of an algorithm that is ranked."""
    return {
        "algorithm": found.algorithm,
        "step": found.step,
        "expected_error": found.expected_error,
        "separation_error": found.separation_error,
        "bounded_by": found.bounded_by,
        "passes_per_ms": found.passes_per_ms,
        "source": found.source,
    }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def stability_summary(found: Stability) -> dict[str, Any]:
    """Plain values, for JSON: steps in s, frequencies in Hz; None where no limit was found."""
    ranked = [_entry(recommendation) for recommendation in found.ranking.ranked]
    return {
        "system": found.system,
        "scene": found.scene,
        "tolerance": found.tolerance,
        "algorithms": [
            {
                "algorithm": limits.algorithm,
                "limit": _number(limits.limit),
                "below": limits.below if limits.steps else None,
                "own_growth": limits.own,
                "unstable_bands": [[_number(x) for x in band] for band in limits.unstable_bands],
                "mesh_stiffness": {k: _number(v) for k, v in limits.mesh_stiffness.items()},
                "frequency": _number(limits.frequency),
                "simulated_limit": limits.simulated_limit,
                "residual": limits.residual,
                "promised": limits.promised and not found.left_out,
            }
            for limits in found.limits
        ],
        "bonds": [
            {
                "bond": bond.name,
                "bodies": list(bond.bodies),
                "masses": list(bond.masses),
                "stiffness": bond.stiffness,
                "damping": bond.damping,
                "frequency": bond.frequency / (2.0 * math.pi),
                "damping_ratio": bond.damping_ratio,
                "limits": bond.limits,
            }
            for bond in found.bonds
        ],
        "all_bonds_frequency": found.highest_frequency / (2.0 * math.pi),
        "recommended": ranked[0] if ranked else None,
        "ranking": ranked,
        "unranked": dict(found.ranking.unranked),
        "foreign_orders": dict(found.orders),
        "foreign_instances": dict(found.fresh_instances),
        "notes": list(found.notes),
    }
