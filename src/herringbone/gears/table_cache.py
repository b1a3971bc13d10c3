"""Tables of a job as files in the cache, made if they are not there."""

from pathlib import Path

from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.keys import digest_of
from herringbone.core.caching.remembered import Remembered
from herringbone.core.places.paths import cache_folder
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.files.pair_law_file import pair_law_text, tooth_deviations_text
from herringbone.gears.files.table_file import table_text
from herringbone.gears.job import GearJob
from herringbone.gears.job_pair_law import pair_law_for
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.pair_values import coast_periods

_law_texts: Remembered[str] = Remembered(8)
"""Of sixty thousand numbers each, for studies of one pair."""


def cached_table(job: GearJob) -> Path:
    """File of the table; its name follows from its content.

    Raises:
        ParameterError, ResourceError: see `stiffness_for`.
    """
    return _cached("mesh_stiffness", job, table_text(stiffness_for(job)))


def cached_pair_law(job: GearJob) -> Path:
    """File of the force law of one pair of teeth, as `cached_table`."""
    law = pair_law_for(job)
    key = law.pair, law.method, law.per_period, law.first, law.unit, law.stiffness.tobytes()
    return _cached("pair_law", job, _law_texts(key, lambda: pair_law_text(law)))


def cached_deviations(job: GearJob, deviations: GivenDeviations) -> Path:
    """File of the deviations of the teeth, as `cached_table`.

    Raises:
        ParameterError, ResourceError: see `GivenDeviations`.
    """
    text = tooth_deviations_text(
        job.pair,
        deviations.of_halves(job.pair),
        deviations.of_coast_flanks(job.pair),
        coast_periods(job),
    )
    return _cached("tooth_deviations", job, text)


def _cached(kind: str, job: GearJob, text: str) -> Path:
    content = text.encode()
    first, second = job.pair.number_of_teeth
    name = f"{kind}-{first}-{second}-{digest_of(content)}.csv"
    file = cache_folder("stiffness-tables") / name
    if not is_stored(file):
        store(file, content)
    return file
