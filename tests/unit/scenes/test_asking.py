"""What scenes ask: read, written again, and refused in one line."""

import math
import re

import numpy as np
import pytest

from herringbone.analysis.leaner.form import Form
from herringbone.core import ParameterError
from herringbone.scenes import Ask, Model, Motion, Operating, Scene, read_scene
from herringbone.scenes.asking_text import asking_text

_ALL = """
[operating]
speed = [500, 3000]
torque = 200
solver_tolerance = 2e-6
[[ask]]
what = "seat velocity"
band = 2000
[[ask]]
what = ["bearing_force", "*.torque"]
as = "order"
orders = [1, 2]
tolerance = 0.05
[model]
hold = ["housing.q[7]"]
harmonics = { "first.gear_mesh" = 8, second = 0 }
error = 0.002
speed = 1000
"""
_R_MIN = 30.0 / math.pi


def _read(folder, text):
    file = folder / "mine.toml"
    file.write_text(text, encoding="utf-8")
    return read_scene(file)


def test_all_that_can_be_asked(tmp_path):
    found = _read(tmp_path, _ALL)
    assert found.operating == Operating(
        Motion.STEADY, (500.0 / _R_MIN, 3000.0 / _R_MIN), (200.0, 200.0), 2e-6
    )
    assert found.asks == (
        Ask(("seat velocity",), Form.SPECTRUM, 0.01, 2000.0),
        Ask(("bearing_force", "*.torque"), Form.ORDER, 0.05, math.inf, (1.0, 2.0)),
    )
    at = 1000.0 / _R_MIN
    tables = (("first.gear_mesh", 8), ("second", 0))
    assert found.model == Model(("housing.q[7]",), harmonics=tables, error=0.002, speed=(at, at))


def test_what_is_written_is_read_again(tmp_path):
    found = _read(tmp_path, _ALL)
    again = _read(tmp_path, "\n".join(asking_text(found.asks, found.operating, found.model)))
    assert (again.asks, again.model) == (found.asks, found.model)
    assert again.operating.solver_tolerance == found.operating.solver_tolerance
    assert again.operating.speed == pytest.approx(found.operating.speed, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[ask]]\nwhat = ""', "ask: what = '': it takes a name or a list of names"),
        ('[[ask]]\nwhat = "x"\nband = true', "ask: band = True: it takes a finite number"),
        (
            "[operating]\nsolver_tolerance = 2",
            "operating: solver_tolerance = 2: it must lie between",
        ),
        ('[ask]\nwhat = "x"', "ask: it takes tables [[ask]]"),
        ("[[ask]]\ntolerance = 0.1", "ask: what: it takes the names"),
        ('[[ask]]\nwhat = "x"\ntolerance = 1', "ask: tolerance = 1: it must lie between 0 and 1"),
        ('[[ask]]\nwhat = "x"\ntolerance = 1e-9', "ask: tolerance = 1e-09: at least 2e-07"),
        ('[[ask]]\nwhat = "x"\nas = "sound"', "ask: as = 'sound'; it must be one of signal,"),
        ('[[ask]]\nwhat = "x"\nas = "order"', "ask: orders: a list of positive mesh orders"),
        ('[[ask]]\nwhat = "x"\nas = "level"\nband = 5', "ask: band = 5 Hz: it must be positive"),
        ("[operating]\nspeed = [3, 1]", "operating: speed = [3, 1]: the lower one first"),
        ('[operating]\nmotion = "transient"\nspeed = 9', "a transient has those of its cycle"),
        (
            "[model]\nholds = []",
            "model: unknown key holds; known: error, frozen, harmonics, hold, linear, one_way",
        ),
        ("[model]\nharmonics = { x = true }", "it takes { PART = COUNT }, whole numbers from 0"),
        ("[model]\nharmonics = { x = -1 }", "it takes { PART = COUNT }, whole numbers from 0"),
        ("[model]\nharmonics = 4", "model: harmonics = 4: it takes { PART = COUNT }"),
    ],
)
def test_refused_in_one_line(tmp_path, text, message):
    with pytest.raises(ParameterError, match=re.escape(message)) as error:
        _read(tmp_path, text)
    assert str(tmp_path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Ask("  "), "ask: what = '  ': it takes a name or a list of names"),
        (lambda: Ask(5), "ask: what = 5: it takes a name or a list of names"),
        (lambda: Ask("x", tolerance="1%"), "ask: tolerance = '1%': it takes a finite number"),
        (lambda: Ask("x", band=math.nan), "ask: band = nan: it takes a finite number"),
        (lambda: Ask("x", "order", orders=(math.nan,)), "ask: orders = nan: it takes a finite num"),
        (lambda: Operating(speed=(2.0, 1.0)), "operating: speed = [2, 1]: the lower one first"),
        (lambda: Operating(speed=(math.nan,) * 2), "operating: speed = nan: it takes a finite"),
        (lambda: Operating(speed=(-1.0, 1.0)), "no standstill between"),
        (lambda: Operating(torque=(1.0, 2.0, 3.0)), "operating: torque = (1.0, 2.0, 3.0): a numb"),
        (lambda: Operating("transient", speed=9.0), "a transient has those of its cycle"),
        (lambda: Scene("x", asks="torque"), "scene: asks = 'torque': it takes Ask(...), or sever"),
        (lambda: Scene("x", model="torque"), "scene: model = 'torque': it takes Model(...)"),
        (lambda: Model(hold=5), "model: hold = 5: it takes a name or a list of names"),
        (lambda: Model(hold=("q", 1)), "model: hold = ('q', 1): it takes a name or a list"),
        (lambda: Model(one_way=None), "model: one_way = None: it takes a name or a list of names"),
        (lambda: Model(frozen=" "), "model: frozen = ' ': it takes a name or a list of names"),
        (lambda: Model(linear={"x": 1}), "model: linear = {'x': 1}: it takes a name or a list of"),
        (lambda: Model(harmonics="mesh"), "model: harmonics = 'mesh': it takes { PART = COUNT }"),
        (lambda: Model(harmonics=("mesh", 8)), "model: harmonics = ('mesh', 8): it takes { PART ="),
        (lambda: Model(harmonics={"mesh": 8.0}), "model: harmonics = {'mesh': 8.0}: it takes { P"),
        (lambda: Model(harmonics={5: 8}), "model: harmonics = {5: 8}: it takes { PART = COUNT }"),
        (lambda: Model(error="1%"), "model: error = '1%': it takes a finite number"),
        (lambda: Model(speed=(2.0, 1.0)), "model: speed = [2, 1]: the lower one first"),
        (lambda: Model(torque="low"), "model: torque = 'low': it takes a finite number"),
    ],
)
def test_scripts_are_refused_as_files_are(make, message):
    with pytest.raises(ParameterError, match=re.escape(message)):
        make()


def test_what_stands_for_one_is_one():
    assert Operating(speed=104.7, torque=np.float64(-30)) == Operating(
        speed=(104.7, 104.7), torque=(-30.0, -30.0)
    )
    assert Ask("x", "order", orders=1).orders == (1.0,)
    assert Model("housing.q[7]", harmonics={"mesh": 8}, speed=9) == Model(
        hold=("housing.q[7]",), harmonics=(("mesh", 8),), speed=(9.0, 9.0)
    )
    assert Scene("x", asks=Ask("torque")).asks == (Ask(("torque",)),)
    assert Scene("x", asks=[Ask("torque")]).asks == (Ask(("torque",)),)


def test_choices_given_as_texts():
    """What answers asks `form is Form.LEVEL` and `motion is Motion.TRANSIENT`."""
    assert Ask("seat velocity", form="level").form is Form.LEVEL
    assert Operating("transient").motion is Motion.TRANSIENT
    with pytest.raises(ParameterError, match="ask: as = 'sound'; it must be one of signal, "):
        Ask("seat velocity", form="sound")
    with pytest.raises(ParameterError, match="motion = 'still'; it must be one of steady, "):
        Operating("still")
