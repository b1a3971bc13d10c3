"""Commands are killed at random moments: `python -m campaigns.kills COUNT [SEED [CASE ...]]`.

What is left must be right or absent, never wrong: rows are the first ones of a whole run, files are
whole, no process and no temporary folder stays. A run is resumed, or refused in a line; any other
command is given again. Both must end with the bits that they have without a kill.
"""

import random
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from campaigns.kill_cases import Case, all_cases
from campaigns.kill_field import Field, contents


def try_case(case: Case, count: int, chance: random.Random, folder: Path) -> Counter:
    """Kill a command so many times; how it went on. Raises AssertionError."""
    field, found = Field(case, folder), Counter()
    field.renew()
    for n in range(count):
        if not case.grows:
            field.renew()
        field.clear()
        share = chance.uniform(0.0, 0.3 if case.grows else 1.0)
        killed = field.kill(share, with_rows=case.runs and not case.grows and n % 2 == 1)
        if killed and case.grows:
            found["again"] += 1
            continue
        found[field.judge() if killed else "was through"] += 1
        if not killed:
            assert contents(field.output) == field.whole, "other bits"
            field.renew()
    if case.grows:
        found[field.judge()] += 1
    return found


def main(count: int, seed: int, names: list[str]) -> int:
    """Try all cases, or some; number of those that went wrong."""
    bad = 0
    with tempfile.TemporaryDirectory() as scratch:
        cases = all_cases(Path(scratch))
        for name in names or cases:
            started = time.monotonic()
            try:
                chance = random.Random(f"{seed} {name}")
                said = str(dict(try_case(cases[name], count, chance, Path(scratch, name))))
            except AssertionError as error:
                said, bad = f"WRONG: {error}", bad + 1
            sys.stdout.write(f"{name:26} {count:4d} {time.monotonic() - started:7.1f} s {said}\n")
            sys.stdout.flush()
    return bad


if __name__ == "__main__":
    numbers = [*map(int, sys.argv[1:3]), 1]
    sys.exit(main(numbers[0], numbers[1], sys.argv[3:]))
