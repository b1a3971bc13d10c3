"""Where the deviations of a pair's teeth come from: a tolerance class with a seed, or files."""

from dataclasses import dataclass
from pathlib import Path

from herringbone.core import ParameterError, ResourceError
from herringbone.gears.accuracy.deviation_file import Teeth, read_deviations
from herringbone.gears.accuracy.deviations import deviations
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

    def of_halves(self, pair: GearPair) -> list[Teeth]:
        """Pinion and wheel of the left and of the right half, drive flanks.

        Raises:
            ParameterError: see `deviations`.
            ResourceError: see `read_deviations`.
        """
        if self.grade is not None:
            return [deviations(pair, self.grade, self.seed, half) for half in range(2)]
        return [drive for drive, _ in self._read(pair)]

    def of_coast_flanks(self, pair: GearPair) -> list[Teeth]:
        """Pinion and wheel of the left and of the right half, coast flanks; [] if not known.

        Raises:
            ParameterError: see `deviations`.
            ResourceError: see `read_deviations`; or one of the files alone has coast flanks.
        """
        if self.grade is not None:
            return [deviations(pair, self.grade, self.seed, half, coast=True) for half in range(2)]
        known = [coast for _, coast in self._read(pair) if coast is not None]
        if len(known) == 1:
            raise ResourceError(
                f"one of {self.left} and {self.right} has no columns of coast flanks (coast_...); "
                "give both files the same columns"
            )
        return known

    def _read(self, pair: GearPair) -> list[tuple[Teeth, Teeth | None]]:
        return [read_deviations(Path(file), pair) for file in (self.left, self.right) if file]

    def __str__(self) -> str:
        """What they are, for people."""
        if self.grade is None:
            return f"teeth deviate as in {self.left} and {self.right}"
        grades = self.grade if isinstance(self.grade, tuple) else (self.grade, self.grade)
        classes = f"{grades[0]}" if grades[0] == grades[1] else f"{grades[0]} and {grades[1]}"
        return f"teeth deviate as ISO 1328-1 class {classes} lets pass, seed {self.seed}"
