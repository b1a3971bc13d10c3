"""What stands in front of a part hands on what it does not change."""

from collections.abc import Mapping, Sequence

from herringbone.core.part import Addresses, Part, PartVariable, Value, ValueOrArray
from herringbone.cosim.signature.signature import Signature


class PartAdapter:
    """A part in front of another one, which belongs to it.

    Args:
        part: behind it.
    """

    def __init__(self, part: Part) -> None:
        self.part, self.name = part, part.name
        self.has_states: bool | None = part.has_states
        self.once, self.one_step = part.once, part.one_step
        self.variables: Mapping[str, PartVariable] = part.variables
        self.signature: Signature | None = None

    @property
    def addresses(self) -> Addresses:
        """See `Part`."""
        return self.part.addresses

    def new_state(self) -> int:
        """See `Part`."""
        return self.part.new_state()

    def set(self, name: str, value: ValueOrArray) -> None:
        """See `Part`."""
        self.part.set(name, value)

    def get(self, names: Sequence[str]) -> list[float]:
        """See `Part`."""
        return self.part.get(names)

    def put_values(self, values: Mapping[str, Value]) -> None:
        """See `Part`."""
        self.part.put_values(values)

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """See `Part`."""
        return self.part.get_values(names)

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """See `Part`."""
        self.part.enter_initialization(start_time, stop_time, tolerance)

    def exit_initialization(self) -> None:
        """See `Part`."""
        self.part.exit_initialization()

    def failed(self) -> None:
        """See `Part`."""
        self.part.failed()

    def ended(self) -> float | None:
        """See `Part`."""
        return self.part.ended()

    def messages(self) -> list[str]:
        """See `Part`."""
        return self.part.messages()

    def close(self) -> None:
        """See `Part`."""
        self.part.close()


class WithoutStates(PartAdapter):
    """A part whose saved states do not bring back what was, as one that cannot repeat a step."""

    @property
    def addresses(self) -> Addresses:
        """Those of the part, without the functions of states."""
        return self.part.addresses._replace(get_state=0, set_state=0, free_state=0)
