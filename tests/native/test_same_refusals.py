"""Native and Python FMUs take the same resource files, and refuse others with the same words."""

import random
from collections.abc import Callable
from pathlib import Path

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core import HerringboneError, Instance, ResourceError
from herringbone.core.paths import component_folder
from herringbone.fmi.host import Host

FILES = [(c.name, t.name, t.start) for c in COMPONENTS.values() for t in c.declaration.texts]
CASES = 200
LENGTH = 200  # lists of columns end sooner in native messages
PIECES = (",", "-", "e999", "nan", ".", "left", " ", "#", "0", "e300", "# units:", "\n", '"a"', "ü")
"""No unclosed quotes, which Python lets run over line ends."""


def mutate(lines: list[str], chance: random.Random) -> str:
    """One change, so that there is one error to tell."""
    lines = list(lines)
    at = chance.randrange(len(lines))
    line = lines[at]
    place = chance.randrange(len(line) + 1)
    action = chance.randrange(6)
    if action == 0:
        lines[at] = line[:place] + chance.choice(PIECES) + line[place:]
    elif action == 1:
        lines[at] = line[:place] + line[place + chance.randint(1, 6) :]
    elif action == 2:
        lines[at] = line[:place] + str(chance.randrange(10)) + line[place + 1 :]
    elif action == 3:
        lines[at : at + chance.randint(1, 30)] = []
    elif action == 4:
        lines[at:at] = lines[at : at + chance.randint(1, 3)]
    else:
        other = chance.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    return "\n".join(lines)


def files_of(component: str, text: str, file: Path) -> dict[str, str]:
    """Absolute names of all resource files, one of them replaced."""
    texts = COMPONENTS[component].declaration.texts
    files = {t.name: str(component_folder(component) / "resources" / t.start) for t in texts}
    return files | {text: str(file)}


def python_refusal(component: str, text: str, file: Path) -> str:
    instance = Instance(COMPONENTS[component], "part")
    for name, value in files_of(component, text, file).items():
        instance.set(name, value)
    try:
        instance.load_resources()
    except ResourceError as error:
        return str(error)
    return ""


@pytest.fixture
def native_refusal(native_fmus: dict[str, Path]) -> Callable[[str, str, Path], str]:
    hosts: dict[str, Host] = {}

    def refusal(component: str, text: str, file: Path) -> str:
        if component not in hosts:
            hosts[component] = Host("part", native_fmus[component])
        host = hosts[component]
        host.slave.reset()
        try:
            host.initialise(files_of(component, text, file))
        except HerringboneError as error:
            return str(error).partition("does not initialise: ")[2].removesuffix(" (t = 0 s)")
        return ""

    yield refusal
    for host in hosts.values():
        host.close()


@pytest.mark.parametrize(("component", "text", "start"), FILES)
def test_same_refusals(
    component: str,
    text: str,
    start: str,
    native_refusal: Callable[[str, str, Path], str],
    tmp_path: Path,
) -> None:
    lines = (component_folder(component) / "resources" / start).read_text().splitlines()
    chance = random.Random(4)
    refused = 0
    for n in range(CASES):
        file = tmp_path / f"{n}.csv"
        file.write_text(mutate(lines, chance))
        wanted = python_refusal(component, text, file)
        told = native_refusal(component, text, file)
        assert told[:LENGTH] == wanted[:LENGTH]
        refused += bool(wanted)
    assert CASES // 5 < refused < CASES
