"""The table of a job: its method, its calibration, its place in the cache, its uncertainty."""

import logging
import math
import sys
from copy import copy
from dataclasses import fields, replace

import numpy as np
import pytest
from support.gearing.gears import SPUR, THESIS, gear_pair

from herringbone.core import ParameterError
from herringbone.core.places.paths import CACHE_VARIABLE
from herringbone.gears import GearJob, GearPair, Modification, job_stiffness, stiffness_for
from herringbone.gears.files.table_file import table_text
from herringbone.gears.pair_values import pair_values
from herringbone.gears.stiffness import methods
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.gears.stored import content_key

JOB = GearJob(gear_pair(SPUR), torque=200.0, phases=8, method="slices")


@pytest.fixture(autouse=True)
def cache(tmp_path, monkeypatch):
    """A cache of its own, empty."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    return tmp_path / "mesh_stiffness"


def test_computed_once(monkeypatch):
    """The second time it comes out of the cache, to the last bit."""
    first = stiffness_for(JOB)
    monkeypatch.setattr(job_stiffness, "mesh_stiffness", lambda *_: pytest.fail("computed again"))
    second = stiffness_for(JOB)
    assert table_text(second) == table_text(first)
    for name in ("loads", "phases", "deflection", "tangent", "zero_load_secant"):
        assert np.array_equal(getattr(second, name), getattr(first, name)), name
    assert np.array_equal(second.uncertainty.harmonics, first.uncertainty.harmonics)


@pytest.mark.parametrize(
    "changes",
    [
        {"pair": gear_pair(SPUR, face_width=15e-3)},
        {"modification": Modification((1e-6, 0.0))},
        {"torque": 201.0},
        {"phases": 10},
        {"method": "coupled-slices"},
        {"calibration": {"slices": 0.9}},
        {"slices": 60},
        {"corner_contact": True},
    ],
    ids=lambda changes: next(iter(changes)),
)
def test_other_jobs_have_other_tables(cache, changes):
    texts = {table_text(stiffness_for(job)) for job in (JOB, replace(JOB, **changes))}
    assert len(texts) == len(list(cache.glob("*.npz"))) == 2


def _next(value: float) -> float:
    """The next number of the same type."""
    return value + 1 if isinstance(value, int) else math.nextafter(value, math.inf)


@pytest.mark.parametrize("name", [field.name for field in fields(GearPair)])
def test_every_value_of_the_pair_is_in_the_key(name):
    """Also those that people are not shown."""
    pair = gear_pair(SPUR)
    other = copy(pair)
    value = getattr(pair, name)
    changed = (value[0], _next(value[1])) if isinstance(value, tuple) else _next(value)
    object.__setattr__(other, name, changed)
    keys = {content_key("herringbone.gears.job", p, 1, None, "text", (2.0, [True])) for p in
            (pair, gear_pair(SPUR), other)}  # fmt: skip
    assert len(keys) == 2


def test_key_of_something_else_is_refused():
    with pytest.raises(TypeError, match="has no place in a key"):
        content_key("herringbone.gears.job", np.zeros(3))


def test_what_is_not_asked_for_does_not_matter(cache):
    """The factor of another method."""
    stiffness_for(JOB)
    stiffness_for(replace(JOB, calibration={"coupled-slices": 1.1}))
    assert len(list(cache.glob("*.npz"))) == 1


def test_damaged_file_is_made_anew(cache, caplog):
    first = stiffness_for(JOB)
    file = next(cache.glob("*.npz"))
    file.write_bytes(b"nothing")
    with caplog.at_level(logging.WARNING, logger="herringbone"):
        assert table_text(stiffness_for(JOB)) == table_text(first)
    assert "is damaged" in caplog.text


def test_best_method_is_said_if_it_is_missing(monkeypatch, caplog):
    monkeypatch.setattr(methods, "has_finite_elements", lambda: False)
    job_stiffness._tell_missing.cache_clear()  # another test may have had this pair
    with caplog.at_level(logging.WARNING, logger="herringbone"):
        found = stiffness_for(replace(JOB, method="auto"))
        stiffness_for(replace(JOB, method="auto"))
    assert caplog.text.count("is made by coupled slices") == 1
    assert "slices coupled over" in found.method
    assert "z 16/24 is made by coupled slices, its mean within 4 %" in caplog.text


def test_finite_elements_are_refused_without_the_extra(monkeypatch):
    """A file that names the method gets no other one."""
    monkeypatch.setitem(sys.modules, "skfem", None)
    with pytest.raises(ParameterError, match=r"pip install 'herringbone\[fe\]'"):
        stiffness_for(replace(JOB, method="fe"))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"method": "best"}, "method 'best' is none of slices, coupled-slices, fe, auto"),
        ({"calibration": {"fe": 1.0}}, "calibration of method 'fe' is unknown"),
        ({"calibration": {"slices": -1.0}}, "calibration factor -1 must be positive"),
    ],
)
def test_bad_job(changes, message):
    with pytest.raises(ParameterError, match=message):
        stiffness_for(replace(JOB, **changes))


def test_slices_have_the_mean_of_coupled_slices():
    """At the load of the calibration exactly, to its four digits; at others within 0.5 %."""
    job = GearJob(gear_pair(THESIS))
    load = job.pair.tooth_forces(job.pinion_torque).normal
    loads = [0.1 * load, load, 3.0 * load]
    factor = job.task().calibration_of("slices")
    plain = SliceMesh(job.pair, calibration=factor).solve(loads).secant.mean(axis=1)
    coupled = CoupledSliceMesh(job.pair).solve(loads).secant.mean(axis=1)
    assert plain[1] == pytest.approx(coupled[1], rel=2e-4)
    assert plain == pytest.approx(coupled, rel=5e-3)


def test_given_calibration_is_of_its_method_alone():
    task = GearJob(gear_pair(THESIS), calibration={"slices": 0.5}).task()
    assert task.calibration_of("slices") == 0.5
    assert task.calibration_of("coupled-slices") == 1.0


def test_uncertainty_of_slices_is_their_distance_from_coupled_slices():
    """On top of that of the coupled slices, at every load."""
    job = GearJob(gear_pair(THESIS), torque=200.0, phases=32)
    plain, coupled = (stiffness_for(job, name) for name in ("slices", "coupled-slices"))
    h = coupled.harmonics()[:, :4]
    own = np.maximum(0.15 * h, 3e-4)
    apart = np.abs(plain.harmonics()[:, :4] - h)
    np.testing.assert_allclose(coupled.uncertainty.harmonics, own, rtol=1e-12)
    np.testing.assert_allclose(plain.uncertainty.harmonics, own + apart, rtol=1e-12)
    p, c = (table.secant[1:].mean(axis=1) for table in (plain, coupled))
    assert coupled.uncertainty.mean == 0.04
    assert plain.uncertainty.mean == pytest.approx((0.04 * c / p + np.abs(c / p - 1.0)).max())


@pytest.mark.parametrize(
    ("changes", "share"),
    [
        ({"modification": Modification(helix_crowning=1e-5)}, 0.15),
        ({"calibration": {"slices": 1.5}}, 0.2),
    ],
)
def test_means_of_plain_slices_that_are_off(changes, share):
    """Crowning, which their calibration does not see; a calibration of the user's."""
    job = GearJob(gear_pair(THESIS), torque=200.0, phases=8, **changes)
    plain, coupled = (stiffness_for(job, name) for name in ("slices", "coupled-slices"))
    means = (table.secant[1:].mean(axis=1) for table in (coupled, plain))
    off = float(np.abs(np.divide(*means) - 1.0).max())
    assert share < off < plain.uncertainty.mean < off + 0.04 * (1.0 + off) + 1e-9


def test_slices_that_another_method_does_not_take_are_told():
    job = GearJob(gear_pair(THESIS), slices=20, method="coupled-slices")
    said = "slices = 20 is of the method 'slices'; the table is made by coupled slices"
    assert job.unused() == (said,)
    assert said in pair_values(job)[1]
    assert job.unused("slices") == GearJob(job.pair).unused("fe") == ()
