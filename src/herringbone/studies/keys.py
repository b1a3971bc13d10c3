"""Addresses of points and chains by content: the same ones have the same rows."""

from collections.abc import Iterable
from contextlib import chdir
from dataclasses import dataclass, replace
from pathlib import Path

from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.places.files import beside, is_file
from herringbone.running.content import digest_of_file
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.output.settings import settings_of
from herringbone.running.prepared import prepared
from herringbone.scenes import Start
from herringbone.studies.evaluators.evaluator import Base, Evaluator
from herringbone.studies.study import Point, Study, Value


@dataclass(frozen=True)
class Chain:
    """Points each of which starts from the one before.

    Attributes:
        numbers: of its points in the study.
        keys: of each point: of all that it depends on, the points before it included.
    """

    numbers: range
    keys: tuple[str, ...]

    @property
    def key(self) -> str:
        """Key of the whole chain: of its last point."""
        return self.keys[-1]


def base_settings(base: Base, evaluator: Evaluator) -> dict[str, str]:
    """Digests of what all points have in common, as messages call it.

    The system, its files and the versions of what computes are told as a run's settings are. The
    start is that of each point, so that none is looked for here.

    Raises:
        HerringboneError: something about the system or scene is wrong.
    """
    asked = replace(base.wishes, start=Start.REST.value, lean=True)
    with chdir(base.folder):
        own = load_scene(system_and_folder(base.system)[1], base.scene)
        system, scene, _ = prepared(base.system, own, asked)
    start = own.start if base.wishes.start is None else base.wishes.start
    settings = settings_of(system, scene, (evaluator, start))
    return {**settings, "studies": kernels_key(*evaluator.modules, __name__)}


def chains_of(study: Study, base: Base, evaluator: Evaluator, common: str) -> list[Chain]:
    """The chains of a study with their addresses.

    Args:
        study, base, evaluator: of the study.
        common: key of `base_settings`.
    """
    folder, files = Path(base.folder), _Files()
    found = []
    for numbers in study.chains(evaluator.longest):
        keys: list[str] = []
        for number in numbers:
            told = files.told(study.point(number), folder)
            keys.append(digest_of(common, *told, keys[-1] if keys else ""))
        found.append(Chain(numbers, tuple(keys)))
    return found


class _Files:
    """Values as texts; the content of a file in place of its name."""

    def __init__(self) -> None:
        self._known: dict[str, str] = {}

    def told(self, point: Point, folder: Path) -> Iterable[str]:
        return [f"{name} {self._text(value, folder)}" for name, value in sorted(point.items())]

    def _text(self, value: Value, folder: Path) -> str:
        if not isinstance(value, str):
            return repr(value)
        if value not in self._known:
            file = Path(str(beside(value, folder)))
            self._known[value] = digest_of_file(file) if is_file(file) else value
        return self._known[value]
