"""Figures of a run of which the memory keeps the last records alone: those of all of it."""

import numpy as np

import herringbone as hb
from herringbone.analysis.figures.sensing.velocity_sensor import sensor_velocity
from herringbone.result.folder import stored_table

T_END, STEP, KEPT = 0.1, 2e-5, 2000
"""Of 5001 records the last ones; the slowest mode, 1 % of 249 Hz, rings for 64 ms."""


def test_sensors_and_sound_are_those_of_all_records(tmp_path, monkeypatch):
    """A housing that began to move anew at the first record in memory had other ones.

    Splines of forces end at that record, too, where they err by 0.1 %.
    """
    run = {"t_end": T_END, "record_step": STEP}
    whole = hb.run("test_rig", **run)
    monkeypatch.setattr(stored_table, "_KEPT", KEPT * 8 * len(whole.data.columns))
    end = hb.run("test_rig", **run, output=tmp_path / "run")
    assert (len(end.data), len(end.before)) == (KEPT, len(whole.data) - KEPT)
    monkeypatch.undo()
    true, found = sensor_velocity(whole)[-KEPT:], sensor_velocity(end)
    np.testing.assert_allclose(found, true, atol=2e-3 * np.abs(true).max())
