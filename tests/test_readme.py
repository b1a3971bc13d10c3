"""The README: its test command is the one that CI runs, and what it links to exists."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
OTHER_TOOLS = (ROOT / "docs" / "other_tools.md").read_text(encoding="utf-8")
LINKS = sorted(set(re.findall(r"\]\(([^)#\s]+)", README)))
LOCAL = [link for link in LINKS if "://" not in link and not link.startswith("mailto:")]


def test_test_command_is_what_ci_runs():
    fences = "\n".join(re.findall(r"^```sh\n(.*?)^```$", README, re.MULTILINE | re.DOTALL))
    (command,) = [line for line in fences.splitlines() if line.endswith("-m pytest")]
    steps = (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    assert [steps.count(step) for step in command.split(" && ")] == [1, 1, 1]


@pytest.mark.parametrize("link", LOCAL)
def test_link(link):
    assert (ROOT / link).exists()


def test_there_are_links():
    assert any(link.endswith(".png") for link in LOCAL)


def test_files_in_text_exist():
    files = re.findall(r"`((?:examples|fmus|tests|system_models)/[\w./-]+)`", README)
    assert [file for file in files if not (ROOT / file).exists()] == []


def test_versions_of_other_tools_are_those_that_the_tests_run():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pinned = [word.split("==") for word in project["optional-dependencies"]["dev"] if "==" in word]
    assert len(pinned) == 3
    for package, version in pinned:
        assert f"| {package} {version} " in OTHER_TOOLS
    assert "fmpy>=0.3.23,<0.4" in project["dependencies"]
    assert "| fmpy 0.3 |" in OTHER_TOOLS
