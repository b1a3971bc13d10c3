"""Where the deviations of a pair's teeth come from: a tolerance class with a seed, or files."""

from dataclasses import dataclass
from pathlib import Path

from herringbone.core import ParameterError
from herringbone.gears.accuracy.deviation_file import read_deviations
from herringbone.gears.accuracy.deviations import ToothDeviations, deviations
from herringbone.gears.geometry.gear_pair import GearPair


@dataclass(frozen=True)
class GivenDeviations:
    """Deviations of the teeth of a pair: a class, or files of both halves.

    Attributes:
        grade: ISO 1328-1 tolerance class, one or (pinion, wheel).
        seed: of the class's random numbers.
        left, right: files of the halves, see `deviation_file`.
    """

    grade: int | tuple[int, int] | None = None
    seed: int = 0
    left: str | None = None
    right: str | None = None

    def __post_init__(self) -> None:
        files = (self.left, self.right)
        given = (self.grade is not None, self.left is not None, self.right is not None)
        if given not in {(True, False, False), (False, True, True)}:
            raise ParameterError(
                f"deviations of teeth take a grade, or files left and right; they have "
                f"grade = {self.grade}, left and right = {files[0]} and {files[1]}"
            )

    def of_halves(self, pair: GearPair) -> list[tuple[ToothDeviations, ToothDeviations]]:
        """Pinion and wheel of the left and of the right half.

        Raises:
            ParameterError: see `deviations`.
            ResourceError: see `read_deviations`.
        """
        if self.grade is not None:
            return [deviations(pair, self.grade, self.seed, half) for half in range(2)]
        return [read_deviations(Path(file), pair) for file in (self.left, self.right) if file]

    def __str__(self) -> str:
        """What they are, for people; the flanks that carry at negative torque have none."""
        return f"{self._source()}; drive flanks only: at negative torque the teeth are perfect"

    def _source(self) -> str:
        if self.grade is None:
            return f"teeth deviate as in {self.left} and {self.right}"
        grades = self.grade if isinstance(self.grade, tuple) else (self.grade, self.grade)
        classes = f"{grades[0]}" if grades[0] == grades[1] else f"{grades[0]} and {grades[1]}"
        return f"teeth deviate as ISO 1328-1 class {classes} lets pass, seed {self.seed}"
