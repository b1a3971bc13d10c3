"""What is generated and committed, and how: in the order in which one thing needs another."""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import NamedTuple

from herringbone.commands.output import say
from herringbone.core import HerringboneError
from herringbone.core.places.paths import systems_folder

PICTURES = Path("examples", "pictures")


class Item(NamedTuple):
    """Something that is generated.

    Attributes:
        files: what is written, for people.
        takes: how long, for people.
        runs: arguments of Python, run one after another; `{out}` is a scratch folder.
        pictures: where in the scratch folder files are, by their name among the pictures.
        usual: made if nothing is named.
    """

    files: str
    takes: str
    runs: tuple[str, ...]
    pictures: Mapping[str, str] = {}
    usual: bool = False


def _chart(scene: str) -> str:
    options = "--t-end 0.02 --fuse --tolerances 1e-2 1e-3 1e-4"
    return f"-m herringbone chart test_rig --scene {scene} {options} -o {{out}}/{scene}"


_SCENES = ("loaded", "separation")
ITEMS: dict[str, Item] = {
    "gear-pair": Item(
        "values of the gear pair, in the components",
        "seconds",
        ("-m herringbone.gears.files.shipped_pair",),
        usual=True,
    ),
    "gear-table": Item(
        "stiffness table of the gear pair, in its resources in fmus",
        "half a minute on two idle cores, once; extra 'fe'",
        ("-m herringbone.gears.files.shipped_table",),
        usual=True,
    ),
    "housing": Item(
        "modal data of the housing, in its resources in fmus, and HOUSING.md",
        "five minutes and 4 GB; extra 'fe'",
        ("-m herringbone.housing.welded.default_data",),
    ),
    "housing-surface": Item(
        "surface of the housing with its four lowest modes, in fmus",
        "ten seconds; extra 'fe'",
        ("-m herringbone.housing.welded.surface_shapes",),
    ),
    "components": Item(
        "script, README.md and golden.csv in fmus/*",
        "half a minute",
        ("-m herringbone.fmi.generate",),
        usual=True,
    ),
    "systems": Item(
        "README.md and layout.png in system_models/*",
        "five minutes",
        ("-m herringbone.commands.generate.system_pages",),
    ),
    "thesis": Item(
        "docs/thesis",
        "five minutes on two idle cores, once",
        ("-m herringbone.thesis.docs",),
    ),
    "overview": Item(
        "overview.png",
        "seconds",
        ("-m herringbone run test_rig -o {out}",),
        {"overview.png": "overview.png"},
    ),
    "atlas": Item(
        "stability_atlas.png",
        "two minutes",
        ("-m herringbone stability test_rig --atlas -o {out}",),
        {"stability_atlas.png": "stability_atlas.png"},
    ),
    "charts": Item(
        "chart_*.csv, chart_*.png",
        "some ten minutes, on an idle machine: they hold times",
        tuple(map(_chart, _SCENES)),
        {f"chart_{s}.{kind}": f"{s}/chart.{kind}" for s in _SCENES for kind in ("csv", "png")},
    ),
}


def clone() -> Path:
    """The clone that this package runs from.

    Raises:
        HerringboneError: it is installed.
    """
    root = systems_folder().parent
    if not (root / "pyproject.toml").is_file():
        raise HerringboneError(
            "generated files belong to a clone; install it with 'pip install -e'"
        )
    return root


def generate(names: Collection[str], root: Path) -> None:
    """Make items in a clone; each in processes of its own, which see what was made before.

    Raises:
        HerringboneError: a process fails.
    """
    for name, item in ITEMS.items():
        if name not in names:
            continue
        say(f"{name}: {item.files}; {item.takes}")
        with tempfile.TemporaryDirectory() as scratch:
            for line in item.runs:
                _python(line.format(out=scratch).split(), root)
            for target, source in item.pictures.items():
                shutil.copyfile(Path(scratch, source), root / PICTURES / target)


def _python(arguments: list[str], root: Path) -> None:
    """Run Python on the sources of a clone."""
    environment = {**os.environ, "PYTHONPATH": str(root / "src")}
    command = [sys.executable, *arguments]
    if code := subprocess.run(command, check=False, env=environment, stdout=sys.stderr).returncode:
        raise HerringboneError(f"python {' '.join(arguments)} ended with exit code {code}")
