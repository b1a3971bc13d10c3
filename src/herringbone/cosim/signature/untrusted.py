"""A part whose saved states do not bring back what was, as one that saves none."""

from typing import Any, cast

from herringbone.core.part import Addresses, Part


class _WithoutStates:
    def __init__(self, part: Part) -> None:
        self._part = part

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 (whatever the part has)
        return getattr(self._part, name)

    @property
    def addresses(self) -> Addresses:
        """Those of the part, without the functions of states."""
        return self._part.addresses._replace(get_state=0, set_state=0, free_state=0)


def without_states(part: Part) -> Part:
    """The part, as one that cannot repeat a step."""
    return cast("Part", _WithoutStates(part))
