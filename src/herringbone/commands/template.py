"""The command `template`: a file to begin with, such as the pair's or the housing's."""

import argparse
import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from herringbone.commands.output import check_writable, show
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.places.files import write_whole
from herringbone.core.places.paths import systems_folder


class Template(NamedTuple):
    """A file to begin with.

    Attributes:
        file: the shipped one.
        use: what it is for, in a line.
        more: what is shown, of the file's text.
        named: what the file is called in a folder of its own; empty if it needs none.
    """

    file: Callable[[], Path]
    use: str
    more: Callable[[str], str] = str
    named: str = ""


def _of(role: Role, name: str) -> Callable[[], Path]:
    def file() -> Path:
        from herringbone.components.registry import component_for  # noqa: PLC0415 (numba)

        return component_for(role).folder / name

    return file


def _gear_file(text: str) -> str:
    """By the best method that is there, in place of the shipped table's; and all other keys."""
    from herringbone.gears.files.known_keys import optional_keys  # noqa: PLC0415 (numba)
    from herringbone.gears.stiffness.methods import AUTO  # noqa: PLC0415 (numba)

    text = re.sub(r'^method = ".*"$', f'method = "{AUTO}"', text, flags=re.MULTILINE)
    return f"{text}\n{optional_keys(text)}"


TEMPLATES = {
    "gear": Template(
        _of(Role.GEAR_PAIR, "gear_pair.toml"),
        "A gear pair: herringbone gear FILE; herringbone run SYSTEM --gear FILE",
        _gear_file,
    ),
    "housing": Template(
        _of(Role.HOUSING, "welded_housing.toml"),
        "A welded housing: herringbone housing build FILE; herringbone run SYSTEM --housing FILE",
    ),
    "seats": Template(
        _of(Role.HOUSING, "seats.toml"),
        "Seats of a housing of another program: herringbone housing import MODEL --seats FILE",
    ),
    "system": Template(
        lambda: systems_folder() / "gearbox" / "system.toml",
        "A system: FOLDER/system.toml, its scenes in FOLDER/scenes; herringbone run FOLDER",
        named="system.toml",
    ),
    "scene": Template(
        lambda: systems_folder() / "gearbox" / "scenes" / "loaded.toml",
        "A scene of the gearbox: herringbone run SYSTEM --scene FILE",
    ),
    "study": Template(
        lambda: systems_folder() / "test_rig" / "studies" / "speeds.toml",
        "Points of a sweep: herringbone sweep SYSTEM --study FILE",
    ),
}


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument("kind", help=", ".join(TEMPLATES))
    sub.add_argument(
        "-o",
        "--output",
        type=Path,
        help="file to write, of a system FOLDER or FOLDER/system.toml; shown if not given",
    )


def template(kind: str, output: Path | None) -> str:
    """Text of a template; if a file is given it is written, and what is returned says so.

    Raises:
        ParameterError: there is no such template, or the file is there.
        HerringboneError: it cannot be written.
    """
    if kind not in TEMPLATES:
        raise ParameterError(f"there is no template '{kind}': give one of {', '.join(TEMPLATES)}")
    found = TEMPLATES[kind]
    text = f"# {found.use}\n#\n{found.more(found.file().read_text(encoding='utf-8'))}"
    if output is None:
        return text.rstrip("\n")
    if found.named and (output.is_dir() or output.suffix != Path(found.named).suffix):
        output /= found.named
    if output.exists():
        raise ParameterError(f"{output} is there already; give another name with -o")
    check_writable(output.parent, output)
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        write_whole(output, text)
    except OSError as error:
        raise HerringboneError(f"cannot write {output}: {error.strerror}") from error
    return f"{output}: {found.use}"


def run(options: argparse.Namespace) -> int:
    """Show or write a template."""
    show(template(options.kind, options.output))
    return 0
