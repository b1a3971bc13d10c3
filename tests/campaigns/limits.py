"""Predicted limits of systems with foreign parts against runs of these parts.

    python -m campaigns.limits FOLDER ... [--algorithms A ...] [--draw PATH=LOW:HIGH ...]

in tests/; each folder is that of a system, and `--draw` draws a value by the last commit, as of the
torque that loads teeth where nothing else does. A line for each algorithm: the limit, the frequency
that grows there, growth in runs at shares `TRIED` of it (a power of e per macro step, of a
perturbation; "ends" where a run ends early, "." where it decays, or grows by less than a run
shows), and a verdict. With contact a run must not grow at the first share, and must grow at another
one, or in the middle of a narrower band. A motion that does not repeat, as of teeth that rattle
without a load, grows at any step, and tells nothing of the coupling. Systems of foreign parts alone
are linear here: they decay at 0.98, and grow at 1.02 or in the middle of a narrower band.

A limit at 0 Hz is where the rotation of shafts grows by `RIGID` per step, see `rotation_growth`:
that rate itself is measured, and growth is that beyond it. Where other growth is slower than a run
shows, runs are longer.

Beside a part with a clock, steps that do not divide its period have no common one with it, and no
prediction: runs are made at the told step, and at the last one before it that does.
"""

import argparse
import math
import random
from collections.abc import Mapping, Sequence

from fuzz.campaign import last_commit
from support.foreign.rotation_growth import rotation_growth
from support.foreign.stranger_limits import limits

from campaigns.plans import tell
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import RIGID
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import Strangers, linear_network, real_parts
from herringbone.analysis.stability.steps.perturbed_run import perturbation_growth
from herringbone.analysis.stability.steps.simulated_limit import run_steps
from herringbone.analysis.stability.steps.step_limits import StepLimits, step_limits
from herringbone.analysis.stability.steps.step_scan import safe_growth
from herringbone.core import HerringboneError, ParameterError
from herringbone.cosim.algorithms import Algorithm, parse_algorithm
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.predictable import predictable
from herringbone.running.prepared import Wishes

TRIED = (0.9, 1.0, 1.02, 1.15)
"""Steps of the runs, over the predicted limit."""
HALF = 0.5
"""The same of a run that tells whether the motion itself is regular, where the first one grows."""
LINEAR = 0.02
SEEN, SHOWN, MOST = 1.8, 4.0, 100000
"""Growth over a whole run that shows, see `run_steps`, and that runs aim at in so many steps at
most, as powers of e."""


def contact_verdict(rates: Mapping[float, float], rate_at_half: float) -> str:
    """Of growth by share of the limit, with contact; the least share must not grow.

    Args:
        rates: growth by share; 0 where none shows.
        rate_at_half: the same at half the least share, where a run grows only if teeth rattle.
    """
    least, *others = sorted(rates)
    if rate_at_half > 0.0:
        return "no verdict: a run grows at half of it, too, as where teeth rattle"
    if rates[least] > 0.0:
        return "TOO BOLD: a run grows below the prediction"
    if any(rates[share] > 0.0 for share in others):
        return "as predicted"
    return f"TOO CAREFUL: no run grows up to {max(others):.3g} of the prediction"


class Runs:
    """Runs of a system, whose growth is compared with a prediction.

    Args:
        system: as it starts.
        strangers: its foreign parts.
        algorithm: of the coupling.
        predicted: its limits.
        steps: of each run.
    """

    def __init__(
        self,
        system: System,
        strangers: Strangers,
        algorithm: Algorithm,
        predicted: StepLimits,
        steps: int,
    ) -> None:
        self._system, self._strangers, self._algorithm = system, strangers, algorithm
        self._predicted, self._steps = predicted, steps

    def growth(self, share: float) -> float:
        """Per macro step at a share of the limit, as a power of e; 0 where none shows."""
        given = self._system, self._strangers, self._algorithm, share * self._predicted.limit
        if self._predicted.frequency == 0.0:
            return max(0.0, rotation_growth(*given) - RIGID)
        system, strangers, algorithm, step = given
        rate = perturbation_growth(
            system, lambda: real_parts(system, strangers), algorithm, step, steps=self._steps
        )
        return rate if rate * self._steps > SEEN else 0.0

    def growths(self) -> dict[float, float]:
        """By share of the limit: of a clock's neighbouring steps, or around it."""
        return {share: self.growth(share) for share in shares_of(self._predicted)}


def shares_of(predicted: StepLimits) -> list[float]:
    """Of a limit, at which runs are made: with the middle of a narrow first band.

    Beside parts with clocks, the last step that goes with these before the limit, and the limit.
    """
    limit = predicted.limit
    if predicted.steps:
        return [predicted.below / limit, 1.0]
    low, high = predicted.unstable_bands[0] if predicted.unstable_bands else (limit, math.inf)
    middle = math.sqrt(low * high) / limit
    return sorted([*TRIED, *([middle] if TRIED[0] < middle < TRIED[-1] else [])])


def told(rates: Mapping[float, float]) -> str:
    """Growth by share, in one line."""
    words = {
        share: "." if rate <= 0.0 else "ends" if math.isinf(rate) else f"{rate:.1e}"
        for share, rate in rates.items()
    }
    return "  ".join(f"{share:.3f}: {word}" for share, word in words.items())


def compared(
    system: System, started: System, strangers: Strangers, algorithm: Algorithm
) -> tuple[str, str]:
    """What is predicted of an algorithm and what runs show, and the verdict."""
    if len(strangers) == len(system.parts):
        limit, seen, _, _, rates = limits(system, strangers, algorithm)
        right = math.isinf(limit) or abs(seen / limit - 1.0) <= LINEAR
        both = ", ".join(f"{rate:.1e}" for rate in rates)
        return f"{1e6 * limit:8.2f} us  {both}", "as predicted" if right else "OFF by more than 2 %"
    found = step_limits(system, algorithm, strangers=strangers)
    what = f"{1e6 * found.limit:8.2f} us {found.frequency:6.0f} Hz"
    if not found.promised:
        return what, f"nothing is promised: {100.0 * found.residual:.2g} % missed"
    if math.isinf(found.limit):
        return what, "no limit"
    if found.steps and not found.below:
        return what, "no verdict: nothing is known of shorter steps"
    growing = Amplification(*linear_network(system, strangers=strangers), algorithm).growth
    largest = max(safe_growth(growing, s * found.limit).radius for s in shares_of(found))
    shows = min(MOST, math.ceil(SHOWN / math.log(largest))) if 1.0 < largest < math.inf else 0
    runs = Runs(started, strangers, algorithm, found, max(run_steps(found.limit), shows))
    rates = runs.growths()
    grows_below = rates[min(rates)] > 0.0 and not found.steps
    verdict = contact_verdict(rates, runs.growth(HALF) if grows_below else 0.0)
    return f"{what}  {told(rates)}", verdict


def drawn(ranges: Sequence[str]) -> dict[str, float]:
    """Values by path, of PATH=LOW:HIGH, by the last commit."""
    chance = random.Random(last_commit())
    found = {}
    for text in ranges:
        path, _, ends = text.partition("=")
        low, high = map(float, ends.split(":"))
        found[path] = chance.uniform(low, high)
    return found


def main() -> int:
    """Print the table; 0 if all is as predicted."""
    parser = argparse.ArgumentParser(prog="campaigns.limits", description=__doc__)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--algorithms", nargs="*", help="default: all")
    parser.add_argument("--draw", nargs="*", default=[], metavar="PATH=LOW:HIGH")
    options = parser.parse_args()
    values = drawn(options.draw)
    if values:
        tell(", ".join(f"{path} = {value:.6g}" for path, value in values.items()))
    chosen = list(map(parse_algorithm, options.algorithms or [])) or default_algorithms()
    bad = 0
    for folder in options.folders:
        tell(folder)
        try:
            with predictable(folder, None, Wishes(start_offset={}, values=values), tell) as found:
                for algorithm in chosen:
                    try:
                        row = compared(found.system, found.started, found.strangers, algorithm)
                    except ParameterError as error:
                        row = "", f"not possible: {error}"
                    bad += row[1].split()[0].isupper()
                    tell(f"  {algorithm!s:28} {row[0]}  {row[1]}")
        except HerringboneError as error:
            tell(f"  {error}")
            bad += 1
    return int(bad > 0)


if __name__ == "__main__":
    raise SystemExit(main())
