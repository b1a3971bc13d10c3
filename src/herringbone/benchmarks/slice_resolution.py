"""Resolution study of the slice method: the table in the documentation of `slices`."""

import numpy as np

from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.slices import SliceMesh

_FINE_SLICES, _FINE_PHASES = 1920, 1024
_SLICES = (10, 20, 40, 60, 120, 240, 480)
_PHASES = (8, 16, 32, 64, 128, 256)


def resolution_table(pair: GearPair, load: float) -> str:
    """Error of slices and phases for a pair at a normal load of one half [N], as text."""
    from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

    fine = SliceMesh(pair, slices=_FINE_SLICES).solve([load])
    corner = SliceMesh(pair, slices=_FINE_SLICES, corner_contact=True).solve([load])
    rows = ["slices    mean error %    largest error %    false %    false %, corner contact"]
    for count in _SLICES:
        found = SliceMesh(pair, slices=count).solve([load])
        early = SliceMesh(pair, slices=count, corner_contact=True).solve([load])
        error = 100.0 * (found.secant[0] / fine.secant[0] - 1.0)
        mean = 100.0 * (found.secant.mean() / fine.secant.mean() - 1.0)
        false = [
            100.0 * np.abs(a.harmonics() - b.harmonics())[0, 10:].max()
            for a, b in ((found, fine), (early, corner))
        ]
        rows.append(
            f"{count:6d}{mean:14.4f}{np.abs(error).max():19.4f}{false[0]:13.4f}{false[1]:13.4f}"
        )
    every = SliceMesh(pair).solve([load], _FINE_PHASES)
    rows += ["", "phases    largest error %, cubic spline    linear"]
    for count in _PHASES:
        step = _FINE_PHASES // count
        at = np.arange(count + 1) / count
        values = np.append(every.secant[0, ::step], every.secant[0, 0])
        spline = CubicSpline(at, values, bc_type="periodic")(every.phases)
        linear = np.interp(every.phases, at, values)
        worst = [100.0 * np.abs(v / every.secant[0] - 1.0).max() for v in (spline, linear)]
        rows.append(f"{count:6d}{worst[0]:20.3f}{worst[1]:20.3f}")
    return "\n".join("    " + row if row else "" for row in rows)
