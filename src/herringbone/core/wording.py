"""How messages call what a caller can give: an option of the command line, or an argument.

Who types commands reads `--record-step 1e-4`, who writes scripts `record_step=1e-4`.
"""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

_as_options = [False]
_MANY = 1e6
"""Per cent, from which on a power of ten is shorter."""


@contextmanager
def words_of_commands() -> Iterator[None]:
    """Context of a command: its messages name options."""
    before, _as_options[0] = _as_options[0], True
    try:
        yield
    finally:
        _as_options[0] = before


def speaks_commands() -> bool:
    """True where messages name options of the command line."""
    return _as_options[0]


def percent(share: float, digits: int = 2) -> str:
    """A share, such as '0.12 %' or '210 %'.

    Args:
        share: 1 is 100 %.
        digits: that are shown; all before the point are.
    """
    value = 100.0 * share
    whole = 10.0 ** (digits - 1) <= abs(value) < _MANY
    return f"{value:.0f} %" if whole else f"{value:.{digits}g} %"


def several_values(name: str) -> str:
    """How several values of an option are given, by an example."""
    return f"--{name} 500:3000:26" if _as_options[0] else f"{name}=[100.0, 200.0, 300.0]"


def option(name: str, value: float | str | bool | list[str] | None = None) -> str:
    """An option, such as `--record-step 1e-4`, or the argument, `record_step=1e-4`.

    Args:
        name: of the argument.
        value: to be given; True of a switch, False of one that is on unless `--no-NAME` is given;
            a list where an option is given once for each; None: the name alone.
    """
    if isinstance(value, list):
        if _as_options[0]:
            return " ".join(option(name, one) for one in value)
        return f"{name}={json.dumps(value)}"
    if not _as_options[0]:
        shown = f'"{value}"' if isinstance(value, str) else _shown(value)
        return name if value is None else f"{name}={shown}"
    dashed = f"--{name.replace('_', '-')}"
    if value is False:
        return f"--no-{dashed[2:]}"
    return dashed if value is None or value is True else f"{dashed} {_shown(value)}"


def setting(path: str, value: float | str) -> str:
    """A value of a variable: `--set PATH=VALUE`, or `values={"PATH": VALUE}`.

    Args:
        path: `instance.variable`.
        value: a number, or what stands for one, such as "...".
    """
    return settings({path: value})


def settings(values: Mapping[str, float | str]) -> str:
    """Values of variables that are set together, see `setting`: an option each, or one argument."""
    if _as_options[0]:
        return " ".join(f"--set {_name(path)}={_shown(value)}" for path, value in values.items())
    entries = ", ".join(f'"{path}": {_shown(value)}' for path, value in values.items())
    return f"values={{{entries}}}"


def _name(path: str) -> str:
    """A name as the command line takes it, and shells leave it: quoted if it has a = itself."""
    return f"'\"{path}\"'" if "=" in path else path


def _shown(value: float | str | bool | None) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)
