"""Every file of a warm cache may be cut or empty: the next run gives the same bits.

`python test_damaged_cache.py FOLDER` damages each file that a run opens: several at a time, of
different folders, and in turn those that were then not made anew, so that they may not have been
read. The tests damage all files at once, but of the kernels a few.
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
code = main(["run", "test_rig", "--t-end", "0.001", "--no-pictures", "-o", sys.argv[3]])
listing.write_text("\\n".join(sorted(opened)))
sys.exit(code)
"""
KERNELS = 3
"""Damaged kernels of a test: compiling them takes seconds."""
TOGETHER = 8
"""Damaged files of a run of the sweep."""


class Cache:
    """A copy of the cache, in which files can be damaged."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.root = folder, folder / "cache"
        ignored = shutil.ignore_patterns("mypy", "fuzz", "locks")
        shutil.copytree(cache_root(), self.root, ignore=ignored)
        self.bits, self.files, _ = self.run()

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
    kinds = defaultdict(list)
    for file in cache.files:
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
    again, cache.files, _ = cache.run()
    assert again == cache.bits


def groups(files: list[Path], size: int) -> list[list[Path]]:
    """Files at random, so many together that lie in different folders."""
    found: list[list[Path]] = []
    for file in random.Random(1).sample(files, len(files)):
        place = (g for g in found if len(g) < size and file.parent not in {f.parent for f in g})
        group = next(place, None)
        if group is None:
            found.append([file])
        else:
            group.append(file)
    return found


def try_damaged(cache: Cache, files: list[Path], share: float) -> tuple[bool, list[Path]]:
    """True if a run with damaged files is as any other; the files that were not made anew."""
    for file in files:
        cache.damage(file, share)
    damaged = [file.read_bytes() for file in files]
    try:
        bits, _, said = cache.run()
    except AssertionError as error:
        sys.stdout.write(f"{error}\n")
        return False, files
    left = [f for f, content in zip(files, damaged, strict=True) if f.read_bytes() == content]
    return bits == cache.bits and "Traceback" not in said, left


def sweep(folder: Path) -> int:
    """Damage each file; lines on how far it is, and what is wrong. Number of wrong files."""
    cache, wrong = Cache(folder), 0
    files = cache.files
    for share in (0.5, 0.0):
        alone: list[list[Path]] = []
        for n, group in enumerate(groups(files, TOGETHER), 1):
            fine, left = try_damaged(cache, group, share)
            alone += [[file] for file in (left if fine else group)]
            sys.stdout.write(f"{share}: {n}, {len(group)} files, {'fine' if fine else 'WRONG'}\n")
            sys.stdout.flush()
        for (file,) in alone:
            fine, left = try_damaged(cache, [file], share)
            wrong += not fine
            kept = ", stays as it is" if left else ""
            name = file.relative_to(cache.root)
            sys.stdout.write(f"{share}: {name}: {'same bits' if fine else 'WRONG'}{kept}\n")
            sys.stdout.flush()
    sys.stdout.write(f"{len(files)} files, cut and empty; {wrong} wrong\n")
    return wrong


if __name__ == "__main__":
    sys.exit(sweep(Path(sys.argv[1])) > 0)
