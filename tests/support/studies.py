"""Points that cost nothing, each of which depends on its neighbour to the last bit."""

import math
import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from herringbone.core import ParameterError
from herringbone.studies.evaluators.evaluator import Evaluated, Figure


@dataclass(frozen=True)
class Cheap:
    """x = cos(speed x / 100), by few iterations from the neighbour's x.

    Attributes:
        seconds: that a point waits.
        refused: speed that cannot be evaluated.
        deadly: speed whose first evaluation kills its process; noted in the file `mark`.
        log: file with a line for each evaluation.
    """

    longest: int | None = None
    seconds: float = 0.0
    refused: float = math.nan
    deadly: float = math.nan
    mark: str = ""
    log: str = ""
    modules: tuple[str, ...] = ()
    has_series: bool = False
    columns: tuple[str, ...] = ()

    def opened(self, base):
        del base
        return self

    def kept(self, near):
        return {"x": np.array(near)}

    def renewed(self, kept):
        return float(kept["x"])

    def __call__(self, point, near, *, series):
        del series
        speed = float(point["speed"])
        if self.log:
            with Path(self.log).open("a") as stream:
                stream.write(f"{speed}\n")
        if speed == self.refused:
            raise ParameterError(f"{speed:g} is refused")
        if speed == self.deadly and (not self.mark or not Path(self.mark).exists()):
            if self.mark:
                Path(self.mark).touch()
            os.kill(os.getpid(), signal.SIGKILL)
        time.sleep(self.seconds)
        x = 0.5 if near is None else near
        for _ in range(3):
            x = math.cos(speed * x / 100.0)
        return Evaluated("completed", "", {"x": Figure(x, "m")}, x)
