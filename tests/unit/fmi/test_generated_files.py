"""Committed files that are generated are what would be generated now."""

import numpy as np
import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.fmi.generate import script
from herringbone.fmi.readme import readme
from herringbone.gears.files.shipped_table import TABLE_FILE, shipped_stiffness
from herringbone.gears.files.table_file import table_text


@pytest.mark.parametrize("name", COMPONENTS)
def test_readme(name):
    committed = (COMPONENTS[name].folder / "README.md").read_text(encoding="utf-8")
    assert committed == readme(COMPONENTS[name]), "run python -m herringbone.fmi.generate"


@pytest.mark.parametrize("name", COMPONENTS)
def test_readme_lists_every_variable(name):
    text = readme(COMPONENTS[name])
    missing = [
        v.name for v in COMPONENTS[name].declaration.variables if f"| `{v.name}` |" not in text
    ]
    assert not missing


@pytest.mark.parametrize("name", COMPONENTS)
def test_script(name):
    committed = (COMPONENTS[name].folder / f"{name}.py").read_text(encoding="utf-8")
    assert committed == script(COMPONENTS[name]), "run python -m herringbone.fmi.generate"


@pytest.mark.slow
def test_stiffness_table():
    """The shipped table is that of its gear file; last digits depend on the platform."""
    stiffness = shipped_stiffness()
    for loads, secant in read_stiffness_table(TABLE_FILE):
        assert loads == pytest.approx(stiffness.loads, abs=1e-6)
        assert np.abs(secant / stiffness.secant - 1.0).max() < 2e-7, (
            "run python -m herringbone.gears.files.shipped_table"
        )
    committed = TABLE_FILE.read_text(encoding="utf-8").splitlines()
    assert committed[:5] == table_text(stiffness).splitlines()[:5]
