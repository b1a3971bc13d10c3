"""Where the FMI 2.0 functions in front of FMUs 3.0 are; see `calls`.

They are compiled by numba at their first use, or come from whoever has them compiled already: a
process that takes those starts without numba.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.kernels.compiling.dispatching import CFunction

ADAPTERS = (
    "set_real", "get_real", "do_step", "get_state", "set_state", "free_state", "get_derivatives",
    "set_derivatives", "update",
)  # fmt: skip
"""What they stand for in `Addresses`; update: for fmi3IntermediateUpdateCallback."""
_addresses: dict[str, int] = {}


def adapters() -> "dict[str, CFunction]":
    """The functions by what they stand for."""
    from herringbone.cosim.fmu.fmi3 import calls, steps, within  # noqa: PLC0415 (numba)

    found = (
        calls.set_real,
        calls.get_real,
        steps.do_step,
        calls.get_state,
        calls.set_state,
        calls.free_state,
        calls.get_derivatives,
        within.set_derivatives,
        within.update,
    )
    return dict(zip(ADAPTERS, found, strict=True))


def adapter(name: str) -> int:
    """C address of an adapter."""
    if name not in _addresses:
        _addresses[name] = adapters()[name].address
    return _addresses[name]


def use_adapters(addresses: dict[str, int]) -> None:
    """Take adapters that were compiled elsewhere."""
    _addresses.update(addresses)
