"""Fixtures of the tests with FMUs of strangers."""

import pytest
from support.foreign.all_types import EVENTS, build_all_types


@pytest.fixture(scope="session")
def all_types(tmp_path_factory):
    """The FMU 3.0 without and with event mode."""
    folders = {name: tmp_path_factory.mktemp(name) for name in ("plain", "events")}
    abilities = {"plain": "", "events": EVENTS}
    return {name: build_all_types(folder, abilities[name]) for name, folder in folders.items()}
