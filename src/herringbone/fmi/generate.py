"""All that is generated of a component: `python -m herringbone.fmi.generate [COMPONENT ...]`.

Into the component's folder it writes the script for pythonfmu, the README with the equations and
the tables of variables, and the golden result; of all components if none is named. A new component
is one module in `components` and one line in its registry; then this command. Data that components
ship are made by `herringbone.gears.files.shipped_table` and
`herringbone.housing.welded.default_data`.
"""

import subprocess
import sys
from collections.abc import Sequence

from herringbone.components.registry import COMPONENTS, component
from herringbone.core import Component, FmuError, HerringboneError
from herringbone.fmi.readme import readme

_SCRIPT = '''"""pythonfmu script of the component {name}."""

from herringbone.fmi.python.slave import ComponentSlave


class {name}(ComponentSlave):
    """The methods stand here because pythonfmu needs two functions in the script itself."""

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance by `step_size` [s]; False discards the step."""
        return self.advance(current_time, step_size)

    def terminate(self) -> None:
        """End the run."""
        self.end()
'''


def script(component: Component) -> str:
    """The script that pythonfmu packs."""
    return _SCRIPT.format(name=component.name)


def generate(names: Sequence[str] = ()) -> None:
    """Write what is generated of components; of all if no names are given.

    Raises:
        HerringboneError: there is no component of that name, or its FMU cannot be built or run.
    """
    found = [component(name) for name in names or COMPONENTS]
    for one in found:
        one.folder.mkdir(parents=True, exist_ok=True)
        (one.folder / f"{one.name}.py").write_text(script(one), encoding="utf-8")
        (one.folder / "README.md").write_text(readme(one), encoding="utf-8")
    # A process of its own: what was just written decides on what FMUs are built from.
    command = [sys.executable, "-m", "herringbone.fmi.golden", *(one.name for one in found)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        lines = run.stderr.strip().splitlines() or [f"exit code {run.returncode}"]
        raise FmuError(f"no golden result of {', '.join(one.name for one in found)}: {lines[-1]}")


if __name__ == "__main__":
    try:
        generate(sys.argv[1:])
    except HerringboneError as error:
        sys.exit(f"herringbone: {error}")
