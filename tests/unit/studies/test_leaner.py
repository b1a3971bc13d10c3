"""What a sweep says of a leaner model at its points."""

import math
from dataclasses import replace

import pytest

from herringbone.scenes import Model
from herringbone.studies.leaner import leaner_notes
from herringbone.studies.study import PER_MINUTE, Study, grid

R_MIN = math.pi / 30.0
MODEL = Model(hold=("housing.q[1]",), error=0.02, speed=(1000 * R_MIN, 2000 * R_MIN))


@pytest.mark.parametrize(
    ("study", "given", "told"),
    [
        (grid({"bearing.f": [1.0]}), {}, "not known with other values of bearing.f"),
        (Study(("speed",), ((1000.0,), (2000.0,)), speed_unit=PER_MINUTE), {}, "2000 r/min"),
        (grid({"speed": [1500 * R_MIN]}), {}, "2000 r/min"),
        (grid({"speed": [1500 * R_MIN, 2001 * R_MIN]}), {}, "not known at other points"),
        (grid({"speed": [999 * R_MIN, 1500 * R_MIN]}), {}, "not known at other points"),
        (grid({"speed": [1500 * R_MIN], "torque": [9.0]}), {}, "not known at other points"),
        (grid({"bearing.stiffness": [1e8, 1e9]}), {}, "not known with other values of bearing.st"),
        (grid({"speed": [1500 * R_MIN]}), {"mesh.play": 1.0}, "other values of mesh.play"),
    ],
)
def test_where_the_error_holds(study, given, told):
    (line,) = leaner_notes(MODEL, study, given, (1500 * R_MIN, None))
    assert told in line
    assert ("not known" in line) == (told != "2000 r/min")


def test_a_whole_model_has_no_line():
    assert leaner_notes(Model(), grid({"speed": [1.0]}), {}, (None, None)) == ()


@pytest.mark.parametrize(("own", "known"), [(1500.0, True), (999.0, False), (None, False)])
def test_a_speed_that_is_not_varied_is_that_of_the_system(own, known):
    """A plan's operating points need not be those at which its scene stands."""
    torques = grid({"torque": [9.0]})
    model = replace(MODEL, torque=(0.0, 10.0))
    at = (None if own is None else own * R_MIN, None)
    (line,) = leaner_notes(model, torques, {}, at)
    assert ("not known" not in line) == known
