"""An instance of an FMU is freed once, however often it is closed."""

import tempfile

import pytest
from support.foreign.c_flange import c_flange

from herringbone.cosim.fmu.fmi2_part import Fmu2Part
from herringbone.cosim.fmu.opening import open_fmu


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("initialised", [False, True])
def test_an_instance_is_freed_once(tmp_path, monkeypatch, fmi, initialised):
    """A trial closes what does not initialise, and so may whoever has given it the part."""
    part = open_fmu("rotor", c_flange(tmp_path, "ROTOR", fmi=fmi))
    if initialised:
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()
    own, freed = part.slave.freeInstance, []

    def free():
        freed.append(part.slave.component)
        if len(freed) == 1:  # the process would end at another one
            own()

    monkeypatch.setattr(part.slave, "freeInstance", free)
    part.close()
    part.close()
    assert len(freed) == 1


def test_no_files_stay_of_an_instance_that_is_interrupted(tmp_path, monkeypatch):
    def interrupted(part):
        raise KeyboardInterrupt

    file, temporary = c_flange(tmp_path, "ROTOR"), tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    monkeypatch.setattr(Fmu2Part, "_instantiate", interrupted)
    with pytest.raises(KeyboardInterrupt):
        open_fmu("rotor", file)
    assert not list(temporary.iterdir())
