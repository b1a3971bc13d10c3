"""Native and Python FMUs take the same resource files, and refuse others with the same words."""

import random
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core import HerringboneError, Instance, ResourceError
from herringbone.core.places.paths import component_folder
from herringbone.fmi.host import Host

FILES = [(c.name, t.name, t.start) for c in COMPONENTS.values() for t in c.declaration.texts]
CASES = 400
ESCAPED = re.compile(r"\\x[0-9a-f]{2}|\\u[0-9a-f]{4}")
LENGTH = 150  # lists of columns end sooner in native messages
PIECES = (
    ",", "-", "e999", "nan", ".", "left", " ", "#", "0", "e300", "# units:", "\n", '"a"', "ü", '"',
    '""', "_", "1_0", "0x1", "inf", "\uff11", "\u0663", "\v", "\f", "\x1c", "\x85", "\u2028", "\r",
    "1" * 400, "1" * 401, "\ufeff",
)  # fmt: skip


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


def python_refusal(
    component: str, text: str, file: Path, parameters: Mapping[str, float] = MappingProxyType({})
) -> str:
    instance = Instance(COMPONENTS[component], "part")
    for name, value in {**files_of(component, text, file), **parameters}.items():
        instance.set(name, value)
    try:
        instance.initialise()
    except ResourceError as error:
        return str(error)
    return ""


@pytest.fixture
def native_refusal(native_fmus: dict[str, Path]) -> Callable[..., str]:
    hosts: dict[str, Host] = {}

    def refusal(
        component: str,
        text: str,
        file: Path,
        parameters: Mapping[str, float] = MappingProxyType({}),
    ) -> str:
        if component not in hosts:
            hosts[component] = Host("part", native_fmus[component])
        host = hosts[component]
        host.slave.reset()
        try:
            host.initialise({**files_of(component, text, file), **parameters})
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
    native_refusal: Callable[..., str],
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
        wanted = ESCAPED.sub(" ", wanted)  # the log of an FMU breaks lines there
        told = ESCAPED.sub(" ", told)
        assert told[:LENGTH].rstrip() == wanted[:LENGTH].rstrip()  # a last name may be empty
        refused += bool(wanted)
    assert CASES // 5 < refused < CASES


PAIR = "27 81 0.05029800641 0.1508940192 0.4891166664 0.0473"
TAKEN = f"'# pair:' takes {len(PAIR.split())} finite numbers"
OTHER_PAIR = {
    "pinion.number_of_teeth": 23.0,
    "wheel.number_of_teeth": 57.0,
    "wheel.base_radius": 0.05029800641062931 * 57 / 23,
}


@pytest.mark.parametrize(
    ("line", "parameters", "said"),
    [
        (f"# pair: {PAIR}", {}, ""),
        ("# no pair", {"face_width": 0.1}, ""),
        (f"# pair: {PAIR}", {"face_width": 0.0473 * (1 + 0.5e-4)}, ""),
        (f"# pair: {PAIR}", {"face_width": 0.0473 * (1 + 2e-4)}, "face width 0.04730946 m; set"),
        (f"# pair: {PAIR}", {"base_helix_angle": -0.4891166664}, ""),
        (f"# pair: {PAIR}", {"base_helix_angle": 0.4893}, "angle 0.4893 rad, face"),
        (f"# pair: {PAIR}", OTHER_PAIR, "pair z 27/81"),
        (f"# pair: {PAIR}", OTHER_PAIR, "the parameters are of z 23/57"),
        ("# pair: 23 57 0.05 0.15 0.5 0.05", {}, "pair z 23/57"),
        (f"# pair: {PAIR}", {"wheel.number_of_teeth": 80.0}, "27/80 do not fit base radii"),
        ("# no pair", {"pinion.base_radius": 0.051}, "(ratio 3 against 2.958706)"),
        ("# pair:", {}, f"line 2: {TAKEN}"),
        (f"# pair: {PAIR} 1", {}, TAKEN),
        (f"# pair: {PAIR[:-6]}", {}, TAKEN),
        (f"# pair: {PAIR[:-6]}nan", {}, TAKEN),
        (f"# pair: {PAIR[:-6]}b", {}, TAKEN),
    ],
)
def test_table_of_another_pair(
    line: str,
    parameters: Mapping[str, float],
    said: str,
    native_refusal: Callable[..., str],
    tmp_path: Path,
) -> None:
    """Refused with both pairs named; a table that tells no pair is taken."""
    [(component, text, start)] = [f for f in FILES if f[1] == "stiffness_table"]
    lines = (component_folder(component) / "resources" / start).read_text().splitlines()
    assert lines[1] == f"# pair: {PAIR}"
    file = tmp_path / "table.csv"
    file.write_text("\n".join([lines[0], line, *lines[2:]]))
    wanted = python_refusal(component, text, file, parameters)
    assert said in wanted
    assert bool(said) == bool(wanted)
    assert native_refusal(component, text, file, parameters) == wanted
