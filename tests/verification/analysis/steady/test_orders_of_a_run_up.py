"""Order cuts of a slow run-up are those of steady states, found by another solver."""

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.runup import tracked

SPEED, HALF, RATE = 1110.0, 8.0, 20.0
"""At which they are compared, half of the run-up [r/min], and how fast it is [r/min per s]."""
BLOCK = 81.0
"""Mesh periods in a block: a turn of the wheel, so that run-outs make lines of their own."""
ORDERS = (1, 2, 3, 4)
SHARE = 0.02
"""Asked of a slow run-up."""
LEAST = 0.05


@pytest.fixture(scope="module")
def run_up(tmp_path_factory):
    cycle = tmp_path_factory.mktemp("cycle") / "cycle.csv"
    t_end = 2.0 * HALF / RATE
    cycle.write_text(
        "# units: time s, speed r/min, torque N.m\ntime,speed,torque\n"
        f"0,{SPEED - HALF},200\n{t_end},{SPEED + HALF},200\n"
    )
    return hb.run(
        "test_rig", t_end=t_end, record_step=4e-5, fuse=True, tolerance=1e-4,
        values={"bench_controller.cycle": str(cycle)},
        record=["bearing_force", "seat_velocity", "gear_mesh.pinion.w"],
    )  # fmt: skip


def test_order_cuts_against_steady_states(run_up):
    """Mesh orders that are 5 % of the largest one, or more."""
    steady = hb.steady("test_rig", speed=SPEED * np.pi / 30.0, torque=200.0)
    assert steady.converged
    for group in ("bearing_force", "seat_velocity"):
        maps = [tracked(run_up, c, block=BLOCK, highest=4.0) for c in run_up.channel(group)]
        speed = 60.0 * maps[0].speed / 27.0
        assert speed[0] < SPEED < speed[-1]
        table = steady.table(group)
        amplitudes = {}
        for order in ORDERS:
            cut = np.sqrt(np.mean([m.cut(order) ** 2 for m in maps], axis=0))
            rows = table[np.isclose(table["mesh_order"], order)]
            own = np.sqrt(np.mean(rows["amplitude"].to_numpy() ** 2))
            amplitudes[order] = float(np.interp(SPEED, speed, cut)), float(own)
        largest = max(own for _, own in amplitudes.values())
        compared = {k: pair for k, pair in amplitudes.items() if pair[1] >= LEAST * largest}
        assert len(compared) >= 3
        for order, (found, own) in compared.items():
            assert found == pytest.approx(own, rel=SHARE), (group, order)
