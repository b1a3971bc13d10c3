"""Fixtures of the tests of the command line."""

import pytest

from herringbone.commands.main import main


@pytest.fixture
def refused(capsys, tmp_path, monkeypatch):
    """Run the test rig, or another system, with arguments that must be refused; gives the line."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments, system="test_rig", fmu="in-process"):
        assert main(["run", str(system), "--t-end", "0.001", "--fmu", fmu, *arguments]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert len(err.splitlines()) == 1
        assert err.startswith("herringbone: ")
        assert not (tmp_path / "results").exists()
        return err

    return run
