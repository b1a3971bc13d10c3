"""One sentence about a trend."""

from dataclasses import dataclass

from herringbone.thesis.readings.trends import LITTLE, SEEN, Margin

GROWTH, RATIO, SPREAD = "growth", "ratio", "spread"
"""How a margin is told: least growth from step to step; how many times larger; sensors' spread."""
COMPUTED, MEASURED = "computed", "measured"
"""What sentences are about: chapters 2 to 4, and the rig."""
_RIG = "5", "6"


@dataclass(frozen=True)
class Sentence:
    """A sentence about a trend.

    Attributes:
        name: short.
        text: what the thesis says, in our words.
        source: where.
        margin: see the module.
        needs: least margin with which it agrees.
        kind: how its margin is told.
    """

    name: str
    text: str
    source: str
    margin: Margin
    needs: float = SEEN
    kind: str = GROWTH

    @property
    def about(self) -> str:
        """COMPUTED or MEASURED."""
        return MEASURED if self.source.startswith(_RIG) else COMPUTED

    def told(self, margin: float) -> tuple[float, str, str]:
        """A margin as a number with its unit, and what it is."""
        if self.kind == RATIO:
            return 1.0 + margin, "", "times as large, in the least of the compared cases"
        if self.kind == SPREAD:
            return 100.0 * LITTLE * (1.0 - margin), "%", "is what the largest exceeds the least by"
        return 100.0 * margin, "%", "is the least change from step to step, in the stated direction"
