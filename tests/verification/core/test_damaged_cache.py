"""Every file of a warm cache may be cut or empty: the next run gives the same bits.

`python test_damaged_cache.py FOLDER 0 1` damages each file that a run opens in turn, which takes an
hour; the tests damage all of them at once, but of the kernels a few.
"""

import os
import random
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import pytest

from herringbone.core.places.paths import cache_root

RUN = """
import sys
from pathlib import Path
cache, listing, opened = sys.argv[1], Path(sys.argv[2]), set()
def hook(event, arguments):
    if event == "open" and isinstance(arguments[0], str) and arguments[0].startswith(cache):
        opened.add(arguments[0])
sys.addaudithook(hook)
from herringbone.commands.main import main
code = main(["run", "test_rig", "--t-end", "0.001", "-o", sys.argv[3]])
listing.write_text("\\n".join(sorted(opened)))
sys.exit(code)
"""
KERNELS = 3
"""Damaged kernels of a test: compiling them takes seconds."""


class Cache:
    """A copy of the cache, in which files can be damaged."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.root = folder, folder / "cache"
        ignored = shutil.ignore_patterns("mypy", "fuzz", "locks")
        shutil.copytree(cache_root(), self.root, ignore=ignored)
        self.bits, _, _ = self.run()

    def run(self) -> tuple[bytes, list[Path], str]:
        """Results of a run, the files of the cache that it opened, and what it said."""
        listing, out = self.folder / "listing", self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        run = subprocess.run(
            [sys.executable, "-c", RUN, str(self.root), str(listing), str(out)],
            capture_output=True, text=True, check=False,
            env={**os.environ, "HERRINGBONE_CACHE": str(self.root)},
        )  # fmt: skip
        assert run.returncode == 0, run.stderr[-3000:]
        files = [Path(line) for line in listing.read_text().splitlines()]
        kept = [f for f in files if f.is_file() and not f.name.endswith(".part")]
        return (out / "results.csv").read_bytes(), kept, run.stderr

    def damage(self, file: Path, share: float) -> None:
        content = file.read_bytes()
        file.write_bytes(content[: int(share * len(content))])


@pytest.fixture(scope="module")
def cache(tmp_path_factory):
    return Cache(tmp_path_factory.mktemp("damaged"))


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.5, 0.0])
def test_a_damaged_cache_gives_the_same_bits(cache, share):
    _, files, _ = cache.run()
    kinds = defaultdict(list)
    for file in files:
        kinds[file.relative_to(cache.root).parts[0], file.suffix].append(file)
    chance = random.Random(3)
    assert len(kinds) >= 5
    for (kind, _), of_kind in kinds.items():
        few = chance.sample(of_kind, min(KERNELS, len(of_kind))) if kind == "kernels" else of_kind
        for file in few:
            cache.damage(file, share)
    bits, _, said = cache.run()
    assert bits == cache.bits
    assert "Traceback" not in said
    assert cache.run()[0] == cache.bits


def sweep(folder: Path, first: int, step: int) -> None:
    """Damage each file in turn; lines on what is wrong, and how far it is, go to stdout."""
    cache = Cache(folder)
    _, files, _ = cache.run()
    jobs = [(file, share) for file in files for share in (0.5, 0.0)]
    random.Random(1).shuffle(jobs)
    for n, (file, share) in enumerate(jobs[first::step], 1):
        cache.damage(file, share)
        try:
            bits, _, said = cache.run()
            fine = bits == cache.bits and "Traceback" not in said
        except AssertionError as error:
            fine = False
            sys.stdout.write(f"{error}\n")
        line = f"{n} of {len(jobs)}: {file.relative_to(cache.root)}, {share}: "
        sys.stdout.write(line + ("same bits\n" if fine else "WRONG\n"))
        sys.stdout.flush()


if __name__ == "__main__":
    sweep(Path(sys.argv[1]), *map(int, sys.argv[2:]))
