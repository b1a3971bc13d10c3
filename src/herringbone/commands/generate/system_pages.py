"""The README.md and layout.png of systems: `python -m herringbone.commands.generate.system_pages`.

Of the shipped systems that are named, or of all. Steps are computed: the recommended one, and the
limit for masters that step all FMUs in parallel on held inputs.
"""

import math
import sys
import tomllib
from collections.abc import Sequence
from pathlib import Path

from herringbone.analysis.stability.limits import Stability, stability
from herringbone.analysis.stability.recommendation import rank
from herringbone.core.places.paths import systems_folder
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.structure.placing import places
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.system_file import FILE_NAME
from herringbone.running.loading import load_scene, load_system
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Scene

PAGE, PICTURE = "README.md", "layout.png"
_ALGORITHMS = (LI(), Jacobi(2), Jacobi(0), Jacobi(0, "parallel"))
_TOLERANCES = (1e-2, 1e-3, 1e-4)


def page(name: str) -> str:
    """The page of a shipped system, Markdown."""
    system, folder = load_system(name)
    scenes = [load_scene(folder, f.stem) for f in sorted((folder / "scenes").glob("*.toml"))]
    first = next((s for s in scenes if s.name == "loaded"), scenes[0])
    started, _, _ = prepared(name, first.name, Wishes())
    found = stability(started, first.name, _ALGORITHMS)
    return "\n".join([
        f"# {name}",
        "",
        f"{system.description}.",
        "",
        "Made by `python -m herringbone.commands.generate systems`; edit `system.toml`, which",
        "also says where its values are from.",
        "",
        f"![parts and what is joined]({PICTURE})",
        "",
        *_scenes(name, scenes),
        *_parts(system, folder),
        *_steps(first, found),
    ])  # fmt: skip


def _scenes(name: str, scenes: Sequence[Scene]) -> list[str]:
    rows = [f"| `{s.name}` | {s.description} | {s.t_end:g} |" for s in scenes]
    run = f"herringbone run {name}"
    return [
        "## Scenes",
        "",
        "| name | what | duration [s] |",
        "| --- | --- | --- |",
        *rows,
        "",
        "```sh",
        f"{run}",
        f"{run} --reference  # with the error of the coupling",
        f"herringbone export {name} -o {name}.ssp  # for other masters",
        "```",
        "",
    ]


def _parts(system: System, folder: Path) -> list[str]:
    """Parts of the system's own file, and its nested systems."""
    data = tomllib.loads((folder / FILE_NAME).read_text(encoding="utf-8"))
    rows = []
    for part, table in data.get("parts", {}).items():
        kind = table.get("component") or f"[{table['system']}](../{table['system']}/{PAGE})"
        values = ", ".join(f"{k} = {v}" for k, v in table.get("set", {}).items())
        rows.append(f"| `{part}` | {kind} | {values} |")
    joined = [f"| `{one}` | `{other}` |" for one, other in data.get("connections", [])]
    ports = [f"`{port}` is `{path}`" for port, path in data.get("ports", {}).items()]
    offered = [f"Ports for an outer system: {', '.join(ports)}.", ""] if ports else []
    felt = [f"`{name}` feels `{spec.path}`" for name, spec in system.sensors.items()]
    sensors = [f"Sensors, evaluated from the rows of a run: {', '.join(felt)}.", ""] if felt else []
    gear = [f"Gear pair: `{data['gear']}`.", ""] if "gear" in data else []
    return [
        "## Parts",
        "",
        "| part | component or system | set (SI units) |",
        "| --- | --- | --- |",
        *rows,
        "",
        *gear,
        *sensors,
        "| joined | to |",
        "| --- | --- |",
        *joined,
        "",
        *offered,
    ]


def _steps(scene: Scene, found: Stability) -> list[str]:
    """Tables of steps; two digits, as the last ones depend on the platform."""
    by_limit = [(a, x.limit) for a, x in zip(_ALGORITHMS, found.limits, strict=True)]
    rows = []
    for tolerance in _TOLERANCES:
        best = rank(by_limit, found.highest_frequency, tolerance).best
        if best is not None:
            rows.append(f"| {tolerance:g} | `{best.algorithm}` | {_digits(1e6 * best.step)} |")
    limits = [
        f"| `{x.algorithm}` | {_digits(1e6 * x.limit)} | {_digits(x.frequency)} |"
        for x in found.limits
    ]
    highest = found.highest_frequency / (2.0 * math.pi)
    return [
        "## Steps",
        "",
        f"At the start of `{scene.name}`, by `herringbone stability`. A relative error in bearing",
        "forces and seat velocities is reached by",
        "",
        "| error | algorithm | communication step [us] |",
        "| --- | --- | --- |",
        *rows,
        "",
        "Coupling is stable below these steps; the motion that grows first has this frequency.",
        "`schedule=parallel` is what masters do that step all FMUs at once on held inputs.",
        "",
        "| algorithm | limit [us] | frequency [Hz] |",
        "| --- | --- | --- |",
        *limits,
        "",
        f"All bonds together: {_digits(highest)} Hz.",
        "",
    ]


def _digits(value: float) -> str:
    """Two digits of a number."""
    return f"{float(f'{value:.2g}'):g}"


def write_pages(names: Sequence[str] = ()) -> None:
    """Write page and picture of shipped systems; of all if no names are given."""
    folder = systems_folder()
    for name in names or sorted(f.parent.name for f in folder.glob(f"*/{FILE_NAME}")):
        (folder / name / PAGE).write_text(page(name), encoding="utf-8")
        _draw(load_system(name)[0], folder / name / PICTURE)


def _draw(system: System, file: Path) -> None:
    """Write the picture of a system's layout."""
    from herringbone.plotting.system_layout import system_layout  # noqa: PLC0415 (matplotlib)

    joints = [(system.split(one)[0], system.split(other)[0]) for one, other in system.connections]
    kinds = {part.name: part.component or "FMU" for part in system.parts}
    system_layout(kinds, dict.fromkeys(joints), places(system.paths, joints)).savefig(file)


if __name__ == "__main__":
    write_pages(sys.argv[1:])
