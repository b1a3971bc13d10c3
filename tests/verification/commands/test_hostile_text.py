"""Names from files and the command line are neither code nor paths, whatever they look like."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from herringbone.commands.main import main
from herringbone.core.names import is_identifier
from herringbone.cosim.ssp.read import read_ssp

COUNT = 10_000
PARTS_OF_RUN = 7
"""No divisor of the kinds and commands, so that each part meets all of them."""
SEED = 11
PIECES = (
    '"', "'", '"""', "'''", "\\", "\\\\", "\n", "\r", "\t", "\x1b[31m", "{", "}", "{0}", "{name}",
    "%s", "%n", "*/", "/*", "//", "#", "$(touch pwned)", "`touch pwned`", ";", "&&", "|", "..",
    "../", "../../", "/", "/tmp/pwned", "C:\\Users\\rig", ".", "", " ", "nul", "\x7f", "é",
    "\u202e", "\u2028", "\ud7ff", "\U0001f600", "]]>", "<!--", "&amp;", "<x/>", "=", ",", "[", "]",
    "??/", "import os", 'os.system("touch pwned")', 'open("pwned","w")', "__import__", "0", "9x",
    "class", "a" * 300, "x", "gear_mesh", "-", "--help", "@x", "~",
)  # fmt: skip
CODE = 'x"""; import os; os.system("touch pwned"); """'


@cache
def hostile_names():
    """Seeded; the first ones are those that once ran as code, or wrote outside the cache."""
    rng = np.random.default_rng(SEED)
    names = [CODE, "C:\\Users\\rig", "../../x", "*/ int x; /*"]
    while len(names) < COUNT:
        name = "".join(rng.choice(PIECES, rng.integers(1, 7)))
        if not is_identifier(name):
            names.append(name)
    return names


def quoted(text):
    """A TOML string."""
    plain = (c.isascii() and c.isprintable() and c not in '"\\' for c in text)
    found = (c if p else f"\\U{ord(c):08X}" for c, p in zip(text, plain, strict=True))
    return '"' + "".join(found) + '"'


def sendable(text):
    """What XML can carry of a text."""
    return "".join(c for c in text if c in "\t\n\r" or (c >= " " and c != "\x7f")) or "x"


def escaped(text):
    """A value of an XML attribute."""
    return "".join(c if c.isalnum() and c.isascii() else f"&#{ord(c)};" for c in sendable(text))


PARTS = '[parts.a]\ncomponent = "shaft_coupling"\n'
TOML = (
    "name = {0}\n" + PARTS,
    PARTS + '[parts.{0}]\ncomponent = "shaft_coupling"\n',
    PARTS + '[ports]\n{0} = "a.flange_a"\n',
    PARTS + '[channels]\n{0} = ["a.*"]\n',
)
COMMANDS = (
    ["run", "{system}", "--t-end", "1e-4", "--fmu", "in-process"],
    ["stability", "{system}"],
    ["chart", "{system}", "--t-end", "1e-4"],
    ["export", "{system}", "--as-fmu"],
    ["export", "{system}"],
)
OPTIONS = (
    ["run", "{system}", "--set", "{name}.x=1"],
    ["run", "{system}", "--replace", "{name}=x.fmu"],
    ["run", "{system}", "--slow", "{name}=2"],
    ["run", "{system}", "--scene", "{name}"],
    ["run", "{system}", "--algorithm", "{name}"],
    ["run", "{name}"],
    ["stability", "{name}"],
    ["chart", "{name}"],
    ["export", "{name}"],
    ["export", "{system}", "--as-fmu", "--outside", "{name}"],
    ["stability", "{system}", "--set", "{name}.x=1"],
    ["export", "{system}", "--set", "{name}.x=1"],
)


@pytest.fixture
def refused(tmp_path, monkeypatch, capsys):
    """Call the command line; it must refuse in one line, and leave nothing behind."""
    home = tmp_path / "outer" / "inner" / "home"
    home.mkdir(parents=True)
    monkeypatch.chdir(home)

    def call(arguments):
        before = sorted(tmp_path.rglob("*"))
        try:
            code = main(arguments)
        except SystemExit as end:
            code = end.code
        out, err = capsys.readouterr()
        assert code == 2, (arguments, err)
        assert out == ""
        assert err.startswith("herringbone")
        assert err.endswith("\n")
        assert err[:-1].isprintable(), (arguments, err)
        assert sorted(tmp_path.rglob("*")) == before, arguments

    return call


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS_OF_RUN))
def test_no_name_becomes_code_or_a_path(refused, tmp_path, part):
    """In TOML and SSP through all commands, and on the command line.

    The FMU of the .ssp is missing, which is found after its names were read.
    """
    system, plain, ssp = (tmp_path / name for name in ("rig", "plain", "ssp"))
    for folder in (system, plain, ssp):
        folder.mkdir()
    (plain / "system.toml").write_text(PARTS)
    for n, name in list(enumerate(hostile_names()))[part::PARTS_OF_RUN]:
        command, kind = COMMANDS[n // 3 % len(COMMANDS)], n % 3
        if kind == 0:
            text = TOML[n // 3 % len(TOML)].replace("{0}", quoted(name))
            (system / "system.toml").write_text(text, encoding="utf-8")
            refused([word.format(system=system) for word in command])
        elif kind == 1:
            write_structure(ssp, name, name)
            refused([word.format(system=ssp) for word in command])
        elif "--help" not in name and not _legal_on_the_command_line(name):
            option = OPTIONS[n // 3 % len(OPTIONS)]
            words = (word.replace("{system}", str(plain)) for word in option)
            refused([word.replace("{name}", name) for word in words])


def _legal_on_the_command_line(name):
    """Folders that exist may be systems and scenes, and are told apart by what they contain."""
    return name.strip("./~ ") == ""


def write_ssp_folder(folder, fmu, system, component):
    (folder / "resources").mkdir(parents=True, exist_ok=True)
    (folder / "resources" / "part.fmu").write_bytes(fmu.read_bytes())
    write_structure(folder, system, component)


def write_structure(folder, system, component):
    (folder / "SystemStructure.ssd").write_text(
        '<?xml version="1.0" encoding="UTF-8"?><ssd:SystemStructureDescription version="1.0" '
        'xmlns:ssd="http://ssp-standard.org/SSP1/SystemStructureDescription" name="x">'
        f'<ssd:System name="{escaped(system)}"><ssd:Elements>'
        f'<ssd:Component name="{escaped(component)}" type="application/x-fmu-sharedlibrary" '
        'source="resources/part.fmu"/></ssd:Elements></ssd:System>'
        "</ssd:SystemStructureDescription>",
        encoding="utf-8",
    )


def test_names_of_ssp_files_become_identifiers_with_a_line(python_fmus, tmp_path):
    for name in hostile_names()[:300]:
        names = name, name.replace(".", "")
        write_ssp_folder(tmp_path, python_fmus["drive_motor"], *names)
        system = read_ssp(tmp_path)
        assert is_identifier(system.name)
        assert is_identifier(system.parts[0].name)
        assert len(system.notes) == sum(not is_identifier(sendable(n)) for n in names)
        assert all("is called" in note and note.isprintable() for note in system.notes)


@pytest.mark.parametrize(
    ("name", "component"),
    [(CODE, "drive_motor"),  # which has a condensed form: the name stands in more kernels
     ("C:\\Users\\rig", "shaft_coupling"),
     ("*/ #error /* \\", "shaft_coupling"),
     ("é{name}%n", "shaft_coupling")],
)  # fmt: skip
def test_an_ssp_file_with_hostile_names_runs(
    python_fmus, tmp_path, monkeypatch, capsys, name, component
):
    monkeypatch.chdir(tmp_path)
    folder = Path("rig")
    write_ssp_folder(folder, python_fmus[component], name, name.replace(".", ""))
    common = [str(folder), "--fmu", "in-process", "--t-end", "0.001"]
    assert main(["run", *common, "--json", "-o", "out"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert is_identifier(summary["system"])
    assert any("is called" in note for note in summary["notes"])
    assert main(["export", str(folder), "-o", "again.ssp"]) == 0
    assert main(["export", str(folder), "--as-fmu", "-o", "again.fmu"]) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["again.fmu", "again.ssp", "out", "rig"]
