"""Compliance of the teeth of both gears: large meshes by two processes, and kept in the cache."""

from collections.abc import Callable

import numpy as np

from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.finite_elements.blocks import Resolution
from herringbone.gears.finite_elements.compliance import (
    ToothCompliance,
    layer_count,
    tooth_compliance,
    tooth_mesh,
)
from herringbone.gears.finite_elements.second_process import SecondProcess
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stored import Arrays, content_key, stored_arrays

_LARGE = 1e10
"""Work from which another process, and a file in the cache, are worth it; some three seconds."""

Teeth = tuple[ToothCompliance, ToothCompliance]
Done = Callable[[float], None]


def both_teeth(pair: GearPair, resolution: Resolution, ahead: int, progress: Done) -> Teeth:
    """Compliance of a tooth of pinion and wheel, on one thread each.

    Args:
        pair: gear pair.
        resolution: of the meshes.
        ahead: how many teeth ahead of the loaded one are measured as well.
        progress: called with the share of the work done.

    Raises:
        ParameterError: see `tooth_compliance`.
        ResourceError: the cache folder cannot be made.
    """
    pinion, wheel = (_work(pair, gear, resolution) for gear in range(2))
    of_pinion = pinion / (pinion + wheel)

    def told(done_pinion: float, done_wheel: float) -> None:
        progress(of_pinion * done_pinion + (1.0 - of_pinion) * done_wheel)

    jobs = [(pair, gear, resolution, ahead) for gear in range(2)]
    with one_blas_thread():
        if pinion + wheel < _LARGE:
            first = tooth_compliance(*jobs[0], lambda done: told(done, 0.0))
            return first, tooth_compliance(*jobs[1], lambda done: told(1.0, done))

        def make() -> Arrays:
            with SecondProcess(jobs[1]) as other:
                first = tooth_compliance(*jobs[0], lambda done: told(done, other.done))
                second = other.result(lambda done: told(1.0, done))
            return _arrays(first, second)

        key = content_key("herringbone.gears.finite_elements.compliance", *jobs)
        return _teeth(stored_arrays("tooth_compliance", key, make))


def _work(pair: GearPair, gear: int, resolution: Resolution) -> float:
    """Operations of an elimination section by section: tells large meshes from small ones."""
    section = tooth_mesh(pair, gear, resolution)
    return section.points.shape[1] ** 3 * layer_count(pair, resolution, section)


def _arrays(*teeth: ToothCompliance) -> Arrays:
    return {
        f"{name}{gear}": np.asarray(value)
        for gear, tooth in enumerate(teeth)
        for name, value in (
            ("path", tooth.path),
            ("face", tooth.face),
            ("matrices", tooth.matrices),
            ("asymmetry", tooth.asymmetry),
            ("unknowns", tooth.unknowns),
        )
    }


def _teeth(arrays: Arrays) -> Teeth:
    first, second = (
        ToothCompliance(
            arrays[f"path{gear}"],
            arrays[f"face{gear}"],
            arrays[f"matrices{gear}"],
            float(arrays[f"asymmetry{gear}"]),
            int(arrays[f"unknowns{gear}"]),
        )
        for gear in range(2)
    )
    return first, second
