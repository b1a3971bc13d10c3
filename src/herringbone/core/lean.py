"""What a leaner model leaves out, as a user, a plan and a condensed system name it."""

from collections.abc import Mapping
from dataclasses import dataclass, fields

from herringbone.core.errors import ParameterError
from herringbone.core.given import names

_PAIR = 2
"""A part and its count."""


def _counts(given: object) -> tuple[tuple[str, int], ...]:
    """Harmonics that are kept, by part; raises ParameterError."""
    pairs = tuple(given.items()) if isinstance(given, Mapping) else given
    if not isinstance(pairs, tuple) or not all(map(_is_count, pairs)):
        raise ParameterError(
            f"model: harmonics = {given!r}: it takes {{ PART = COUNT }}, whole numbers from 0"
        )
    return pairs


def _is_count(pair: object) -> bool:
    """True for a part's name and a whole number from 0."""
    if not isinstance(pair, tuple) or len(pair) != _PAIR:
        return False
    part, count = pair
    return isinstance(part, str) and bool(part.strip()) and type(count) is int and count >= 0


@dataclass(frozen=True)
class Lean:
    """What a leaner model leaves out.

    Attributes:
        hold: states that keep their start values, `instance.state`.
        one_way: parts that are driven but not felt.
        frozen: parts whose laws are straight lines about their mean deflections, of steady states.
        linear: parts whose laws have mean slopes besides.
        harmonics: parts, and how many harmonics of their laws' tables are kept.
    """

    hold: tuple[str, ...] = ()
    one_way: tuple[str, ...] = ()
    frozen: tuple[str, ...] = ()
    linear: tuple[str, ...] = ()
    harmonics: tuple[tuple[str, int], ...] = ()

    def __post_init__(self) -> None:
        """Take a text for one name and a mapping for harmonics, and check values.

        Raises:
            ParameterError: a value is of the wrong type, or a count is negative.
        """
        for key in ("hold", "one_way", "frozen", "linear"):
            object.__setattr__(self, key, names(getattr(self, key), f"model: {key}"))
        object.__setattr__(self, "harmonics", _counts(self.harmonics))

    def __bool__(self) -> bool:
        return bool(self.hold or self.parts)

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts of which something else is left out than motions."""
        return (*self.one_way, *self.straight, *(part for part, _ in self.harmonics))

    @property
    def straight(self) -> tuple[str, ...]:
        """Parts whose laws are straight lines, of slopes that go with the angle or are means."""
        return (*self.frozen, *self.linear)

    @property
    def only_held(self) -> bool:
        """True if all that is left out are motions."""
        return not self.parts

    def __ge__(self, other: "Lean") -> bool:
        """True if it leaves out at least what the other one does."""
        kept = dict(self.harmonics)
        return all(
            set(getattr(self, key)) >= set(getattr(other, key))
            for key in ("hold", "one_way", "frozen", "linear")
        ) and all(kept.get(part, count + 1) <= count for part, count in other.harmonics)

    def __or__(self, other: "Lean") -> "Lean":
        """What either of both leaves out, and nothing that is known of them besides."""
        keys = (field.name for field in fields(Lean))
        return Lean(*(tuple(dict.fromkeys(getattr(self, k) + getattr(other, k))) for k in keys))


WHOLE = Lean()
"""A model that leaves out nothing."""
