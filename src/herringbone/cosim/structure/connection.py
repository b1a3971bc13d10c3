"""One connection between two parts."""

from dataclasses import dataclass

from herringbone.core.part import Value


@dataclass(frozen=True, slots=True)
class Connection:
    """An output that feeds an input; parts by their place in the network.

    Attributes:
        source, output: where the signal comes from.
        target, input: where it goes.
        factor, offset: the input's value is the output's times the factor plus the offset, where
            their units differ; of doubles, which parts give in SI units, always 1 and 0.
    """

    source: int
    output: str
    target: int
    input: str
    factor: float = 1.0
    offset: float = 0.0

    def converted(self, value: Value) -> Value:
        """A value of the output in the input's unit."""
        if self.factor == 1.0 and self.offset == 0.0:
            return value
        return float(value) * self.factor + self.offset
