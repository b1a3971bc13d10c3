"""A sensor that a system declares: it acts on nothing, and is evaluated from the rows of a run."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Self

from herringbone.core.errors import StructureError

_VELOCITY = "v_"
_AXES = ("x", "y", "z")


@dataclass(frozen=True)
class SensorSpec:
    """Where a sensor sits, what it feels, and how it differs from the shipped one.

    Attributes:
        part: path of the part on which it sits.
        point: name of the place there, as the data of the part have it.
        axis: direction that it feels.
        values: parameters of the component that is a sensor, SI units; the others as declared.
    """

    part: str
    point: str
    axis: str
    values: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def at(cls, path: str, values: Mapping[str, float], where: str) -> Self:
        """The sensor of a path `part.point.v_axis`.

        Args:
            path: of what it feels.
            values: see above.
            where: which sensor it is, for the message.

        Raises:
            StructureError: the path has another form.
        """
        part, _, rest = path.rpartition(".")
        part, _, point = part.rpartition(".")
        axis = rest.removeprefix(_VELOCITY)
        if not part or not point or axis not in _AXES or rest == axis:
            raise StructureError(
                f"{where}: of = {path!r}: it takes PART.POINT.v_x, v_y or v_z, such as "
                '"housing.A.v_z"'
            )
        return cls(part, point, axis, values)

    @property
    def path(self) -> str:
        """`part.point.v_axis`."""
        return f"{self.part}.{self.point}.{_VELOCITY}{self.axis}"
