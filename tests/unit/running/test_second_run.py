"""The second run in a process parses nothing, unpacks nothing and linearises nothing."""

import pytest

import herringbone as hb
from herringbone.components.resources import flat_csv
from herringbone.cosim.fmu import unpacked
from herringbone.running import remembered_answers

ONCE = [
    (flat_csv, "_read"),
    (unpacked, "read_fmu"),
    (unpacked, "extract_fmu"),
    (remembered_answers, "loaded_start"),
    (remembered_answers, "fastest_bond"),
    (remembered_answers, "warn_if_unstable"),
]


@pytest.fixture
def calls(monkeypatch):
    """Names of what was called."""
    found = []

    def counted(module, name):
        function = getattr(module, name)

        def call(*arguments, **options):
            found.append(name)
            return function(*arguments, **options)

        monkeypatch.setattr(module, name, call)

    for module, name in ONCE:
        counted(module, name)
    return found


def test_second_run(calls):
    first = hb.run("test_rig", t_end=2e-4, fmu="native")
    calls.clear()
    second = hb.run("test_rig", t_end=2e-4, fmu="native")
    assert calls == []
    assert second.data.equals(first.data)
    assert second.info.notes == first.info.notes
    hb.run("test_rig", t_end=2e-4, fmu="native", values={"gear_mesh.symmetry_deviation": 1.2e-5})
    assert set(calls) == {"loaded_start", "fastest_bond", "warn_if_unstable"}
