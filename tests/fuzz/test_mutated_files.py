"""Whatever happens to a file of a stranger, its reader gives a result or a line, and soon.

`python -m fuzz.campaign 1000000` in the folder `tests` does the same at length. No binary is ever
loaded: the FMUs have none.
"""

import pytest

from fuzz.campaign import last_commit, try_many
from fuzz.kinds import all_kinds

COUNT = 20_000
KINDS = all_kinds()
TOTAL = sum(kind.weight for kind in KINDS)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_a_good_file_is_read(kind, tmp_path):
    """Else its mutations would all be refused for the same reason."""
    kind.read(kind.content, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.name)
def test_mutated_files(kind, tmp_path):
    count = COUNT * kind.weight // TOTAL + 1
    refusals, found = try_many(kind, count, last_commit(), tmp_path, tmp_path)
    assert not found
    assert 0.3 * count < refusals
