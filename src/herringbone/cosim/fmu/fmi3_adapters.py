"""Where the FMI 2.0 functions in front of FMUs 3.0 are; see `fmi3_calls`.

They are compiled by numba at their first use, or come from whoever has them compiled already: a
process that takes those starts without numba.
"""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from herringbone.kernels.compiling.linking import CFunction

ADAPTERS = (
    "set_real", "get_real", "do_step", "get_state", "set_state", "free_state", "get_derivatives",
)  # fmt: skip
"""What they stand for in `Addresses`."""
_addresses: dict[str, int] = {}


def adapters() -> "dict[str, CFunction]":
    """The functions by what they stand for."""
    from herringbone.cosim.fmu import fmi3_calls, fmi3_steps  # noqa: PLC0415 (numba)

    calls = (
        fmi3_calls.set_real,
        fmi3_calls.get_real,
        fmi3_steps.do_step,
        fmi3_calls.get_state,
        fmi3_calls.set_state,
        fmi3_calls.free_state,
        fmi3_calls.get_derivatives,
    )
    return dict(zip(ADAPTERS, calls, strict=True))


def adapter(name: str) -> int:
    """C address of an adapter."""
    if name not in _addresses:
        _addresses[name] = adapters()[name].address
    return _addresses[name]


def use_adapters(addresses: dict[str, int]) -> None:
    """Take adapters that were compiled elsewhere."""
    _addresses.update(addresses)
