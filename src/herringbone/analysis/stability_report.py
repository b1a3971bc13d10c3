"""Stability of a system's coupling as text and as one JSON object."""

import json
import math
from pathlib import Path

from herringbone.analysis.bonds import Bond
from herringbone.analysis.linear_parts import MeshStiffness
from herringbone.analysis.simulated_limit import HIGHEST
from herringbone.analysis.stability import Stability, StepLimits
from herringbone.analysis.step_scan import LARGEST_STEP

_MICRO = 1e6


def _us(step: float) -> str:
    return f"{_MICRO * step:.1f}" if math.isfinite(step) else f"> {_MICRO * LARGEST_STEP:.0f}"


def _simulated(step: float | None) -> str:
    return "-" if step is None else _us(step)


def _bands(found: StepLimits) -> str:
    parts = [
        f"{_us(low)}-{_us(high)}" if math.isfinite(high) else f"from {_us(low)}"
        for low, high in found.unstable_bands
    ]
    return ", ".join(parts) or "none"


def _table(rows: list[tuple[str, ...]]) -> list[str]:
    """Rows in columns, the first one left-aligned."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return [
        "  ".join(
            text.ljust(width) if k in (0, len(row) - 1) else text.rjust(width)
            for k, (text, width) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]


def _bond_row(bond: Bond) -> tuple[str, ...]:
    masses = " / ".join(f"{mass:.4g}" for mass in bond.masses)
    rule = bond.limits
    return (
        bond.name,
        " - ".join(bond.bodies),
        masses,
        f"{bond.frequency / (2.0 * math.pi):.0f}",
        f"{bond.damping_ratio:.3f}",
        *(_us(rule[f"jacobi:order={order}"]) for order in range(3)),
        _us(rule["li:degree=3"]),
    )


def stability_text(found: Stability) -> str:
    """Limits, bonds and recommendation, for people."""
    scene = f", scene {found.scene}" if found.scene else ""
    lines = [
        f"{found.system}{scene}: stable steps, predicted from the linear parts",
        "",
    ]
    seen = any(limits.simulated_limit for limits in found.limits)
    runs = ("runs us",) if seen else ()
    meshes = (f"{s} mesh us" for s in MeshStiffness)
    head = ("algorithm", *meshes, *runs, "grows at Hz", "unstable us")
    rows = [head]
    for limits in found.limits:
        rows.append(
            (
                limits.algorithm,
                *(_us(limits.mesh_stiffness[s]) for s in MeshStiffness),
                *((_simulated(limits.simulated_limit),) if seen else ()),
                f"{limits.frequency:.0f}" if math.isfinite(limits.frequency) else "-",
                _bands(limits),
            )
        )
    lines += _table(rows)
    if seen:
        lines.append(f"runs: limit of the non-linear system; - is none up to {HIGHEST:g} times")
    if found.bonds:
        rule = "two-mass rule us: J0", "J1", "J2", "LI-3"
        head = ("bond", "bodies", "masses kg or kg.m2", "Hz", "damping ratio", *rule)
        lines += ["", *_table([head, *map(_bond_row, found.bonds)])]
        lines.append(f"all bonds together: {found.highest_frequency / (2.0 * math.pi):.0f} Hz")
    chosen = found.recommended
    if chosen:
        lines += [
            "",
            f"recommended for {100.0 * found.tolerance:g} %: --algorithm {chosen.algorithm} "
            f"--step {chosen.step:.3g}",
            f"expected error {100.0 * chosen.expected_error:.2g} %, bounded by {chosen.bounded_by}",
            f"rule: {chosen.source}",
        ]
    return "\n".join([*lines, *(f"note: {note}" for note in found.notes)])


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def stability_json(found: Stability) -> str:
    """One JSON object; steps in s, frequencies in Hz; null where no limit was found."""
    chosen = found.recommended
    content = {
        "system": found.system,
        "scene": found.scene,
        "tolerance": found.tolerance,
        "algorithms": [
            {
                "algorithm": limits.algorithm,
                "limit": _number(limits.limit),
                "unstable_bands": [[_number(x) for x in band] for band in limits.unstable_bands],
                "mesh_stiffness": {k: _number(v) for k, v in limits.mesh_stiffness.items()},
                "frequency": _number(limits.frequency),
                "simulated_limit": limits.simulated_limit,
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
        "recommended": chosen
        and {
            "algorithm": chosen.algorithm,
            "step": chosen.step,
            "expected_error": chosen.expected_error,
            "bounded_by": chosen.bounded_by,
            "source": chosen.source,
        },
        "notes": list(found.notes),
    }
    return json.dumps(content)


def write_stability(found: Stability, folder: Path) -> None:
    """Write stability.txt and stability.json to a folder, made if needed."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "stability.txt").write_text(stability_text(found) + "\n", encoding="utf-8")
    (folder / "stability.json").write_text(stability_json(found) + "\n", encoding="utf-8")
