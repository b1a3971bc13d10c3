"""The stiffness table of a job as a file in the cache, made if it is not there."""

from pathlib import Path

from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.keys import digest_of
from herringbone.core.paths import cache_folder
from herringbone.gears.files.table_file import table_text
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for


def cached_table(job: GearJob) -> Path:
    """File of the table; its name follows from its content.

    Raises:
        ParameterError, ResourceError: see `stiffness_for`.
    """
    content = table_text(stiffness_for(job)).encode()
    first, second = job.pair.number_of_teeth
    name = f"mesh_stiffness-{first}-{second}-{digest_of(content)}.csv"
    file = cache_folder("stiffness-tables") / name
    if not is_stored(file):
        store(file, content)
    return file
