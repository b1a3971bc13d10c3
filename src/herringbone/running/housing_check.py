"""Testing a housing FMU against the contract of housings before it runs."""

import hashlib
from pathlib import Path

from herringbone.analysis.housing.contract import check_housing
from herringbone.core import HerringboneError
from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import sources_key
from herringbone.core.places.paths import cache_folder
from herringbone.cosim.fmu.opening import open_fmu


def replacement_notes(fmu: Path) -> list[str]:
    """What a housing FMU that replaces the component does not hold; tested once per content.

    Wrong variables and units are left to the wiring, which refuses them.
    """
    try:
        digest = hashlib.sha256(fmu.read_bytes()).hexdigest()
    except OSError:
        return []
    known = cache_folder(f"housing-checks/{sources_key()}") / f"{digest}.json"
    if (notes := kept(known)) is not None:
        return notes
    try:
        findings = check_housing(lambda: open_fmu("housing", fmu))
    except HerringboneError as error:
        return [f"{fmu} could not be tested as housing: {error}"]
    notes = [
        f"{fmu} breaks the contract of housings: {f.test}: {f.measured} (limit {f.limit}); see "
        f"'herringbone check {fmu} --as housing'"
        for f in findings
        if not f.holds
    ]
    keep(known, notes)
    return notes
