"""What `herringbone gear` tells of the loaded pair: rows of its table, JSON, CSV."""

import math
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np

from herringbone.core.declaring.roles import SIDES
from herringbone.core.declaring.units import RAD_S
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.load.deviating_teeth import DeviatingLoad
from herringbone.gears.load.figures import Loaded
from herringbone.gears.load.flank_load import MEANS, FlankLoad, axial_position


def loaded_rows(loaded: Loaded) -> list[tuple[str, str]]:
    """Rows of the table; a heading has no value."""
    pair, flanks = loaded.pair, loaded.flanks
    two = "" if len(flanks) == 1 else "; left   right"
    rows = [
        (f"Under {pair.torque:.6g} N m of the pinion{_symmetry(loaded)}{two}", ""),
        (
            "transmission error, mean and peak to peak",
            f"{1e6 * pair.transmission_error.mean():.3f} um {1e6 * pair.peak_to_peak:.3f} um, "
            "transverse: mean normal deflection / cos(base helix angle)",
        ),
    ]
    if loaded.conditions.symmetry:
        rows += [
            ("share of the load", _sides([pair.share_left, 1.0 - pair.share_left], 1.0, 4)),
            (
                "mean stiffness k_L, k_R",
                f"{_sides([half.secant.mean() for half in pair.halves], 1e-6, 1)} N/um",
            ),
            ("axial shift of the pinion, mean", f"{1e6 * pair.axial_shift.mean():.3f} um"),
        ]
    return [
        *rows,
        ("largest line load", f"{_sides([f.largest_line_load for f in flanks], 1e-3, 1)} N/mm"),
        (
            "largest contact pressure",
            f"{_sides([f.largest_pressure for f in flanks], 1e-6, 0)} MPa",
        ),
        (
            "place of this pressure on the path, from A",
            f"{_sides([f.where[0] for f in flanks], 1e3, 1)} mm",
        ),
        ("and on the face", f"{_sides([f.where[1] for f in flanks], 1e3, 1)} mm"),
        *_teeth_rows(loaded.teeth),
        *_factor_rows(loaded),
    ]


def _teeth_rows(teeth: DeviatingLoad | None) -> list[tuple[str, str]]:
    if teeth is None:
        return []
    heading = f"Over a turn of the wheel, coupled slices: {teeth.deviations}, drive flanks"
    peaks = np.ptp(teeth.transmission_error, axis=1).tolist()
    return [
        (heading, ""),
        ("transmission error, peak to peak", f"{_sides(peaks, 1e6, 3)} um"),
        ("largest line load", f"{_sides(teeth.largest_line_load.tolist(), 1e-3, 1)} N/mm"),
        ("largest contact pressure", f"{_sides(teeth.largest_pressure.tolist(), 1e-6, 0)} MPa"),
    ]


def _symmetry(loaded: Loaded) -> str:
    symmetry = loaded.conditions.symmetry
    if symmetry is None:
        return ""
    held = symmetry.pinion_axial_stiffness
    how = "floating" if held == 0.0 else "rigid" if math.isinf(held) else f"held by {held:g} N/m"
    return f", f_A {1e6 * symmetry.deviation:g} um, pinion axially {how}"


def _factor_rows(loaded: Loaded) -> list[tuple[str, str]]:
    factor, conditions = loaded.factor, loaded.conditions
    heading = (
        f"Dynamic factor (ISO 6336-1 B) at {conditions.speed / RAD_S:g} r/min, "
        f"class {conditions.grade}, K_A {conditions.load_factor:g}"
    )
    if isinstance(factor, str):
        return [(heading, ""), ("not known", factor)]
    return [
        (heading, ""),
        ("resonance speed n_E1", f"{factor.resonance_speed / RAD_S:.0f} r/min"),
        ("resonance ratio N", f"{factor.resonance_ratio:.4f}, {factor.speed_range}"),
        ("K_v", f"{factor.factor:.4f}"),
    ]


def _sides(values: Sequence[float], factor: float, digits: int) -> str:
    return " ".join(f"{factor * value:9.{digits}f}" for value in values)


def loaded_json(loaded: Loaded) -> dict:
    """The same and the curves over phase and torque, in SI units."""
    pair, symmetry = loaded.pair, loaded.conditions.symmetry
    factor = loaded.factor
    return {
        "symmetry": _finite(asdict(symmetry)) if symmetry else None,
        "transmission_error": {
            "phase": pair.phases.tolist(),
            "value": pair.transmission_error.tolist(),
            "mean": float(pair.transmission_error.mean()),
            "peak_to_peak": pair.peak_to_peak,
        },
        "over_torque": {
            "torque": [p.torque for p in loaded.torques],
            "transmission_error": [float(p.transmission_error.mean()) for p in loaded.torques],
            "peak_to_peak": [p.peak_to_peak for p in loaded.torques],
            "share_left": [p.share_left for p in loaded.torques],
        },
        "halves": [
            {name: getattr(half, name).tolist() for name in ("force", "deflection", "secant")}
            for half in pair.halves
        ],
        "axial_shift": pair.axial_shift.tolist(),
        "flank_load": [
            {
                "largest_line_load": flank.largest_line_load,
                "largest_pressure": flank.largest_pressure,
                "path": flank.where[0],
                "face": flank.where[1],
            }
            for flank in loaded.flanks
        ],
        "deviating_teeth": _teeth_json(loaded.teeth),
        "dynamic_factor": {"unknown": factor} if isinstance(factor, str) else asdict(factor),
    }


def _teeth_json(teeth: DeviatingLoad | None) -> dict | None:
    if teeth is None:
        return None
    return {
        "deviations": str(teeth.deviations),
        "phase": teeth.phases.tolist(),
        "transmission_error": teeth.transmission_error.tolist(),
        "largest_line_load": teeth.largest_line_load.tolist(),
        "largest_pressure": teeth.largest_pressure.tolist(),
    }


def _finite(values: dict[str, float]) -> dict[str, float | str]:
    """JSON knows no infinity."""
    return {name: "rigid" if math.isinf(value) else value for name, value in values.items()}


def flank_text(pair: GearPair, flanks: Sequence[FlankLoad]) -> str:
    """Maps of load and pressure as CSV."""
    lines = [
        "# units: path m, face m, axial m, line_load N/m, pressure Pa",
        "# path: from its start, the pinion's root; axial: from the middle, + to the left",
        f"# line_load, pressure: {MEANS}; the largest of points: herringbone gear",
        "side,path,face,axial,line_load,pressure",
    ]
    for side, flank in enumerate(flanks):
        axial = axial_position(pair, side, flank.face)
        for i, path in enumerate(flank.path):
            lines += [
                f"{SIDES[side]},{path:.6e},{face:.6e},{z:.6e},{load:.5e},{pressure:.5e}"
                for face, z, load, pressure in zip(
                    flank.face, axial, flank.line_load[i], flank.pressure[i], strict=True
                )
            ]
    return "\n".join(lines) + "\n"
