"""What a scene asks of a housing that is reduced: its band, and what the reduction changes."""

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from herringbone.commands.output import say
from herringbone.core import ParameterError
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.reduction import BAND
from herringbone.core.wording import percent
from herringbone.housing import ModalHousing, write_housing

if TYPE_CHECKING:
    from herringbone.studies.planning.housing_band import Asked


def asked_by(options: argparse.Namespace, full: ModalHousing) -> "Asked | None":
    """Lines of what the scene asks of the system with the full data; None without a scene.

    Args:
        options: of the command.
        full: data that are reduced.

    Raises:
        ParameterError: a scene without its system.
        HerringboneError: it has no steady state.
    """
    if options.system is None:
        if options.scene is not None:
            raise ParameterError("--scene: of which system? add --for SYSTEM")
        return None
    from herringbone.studies.planning.housing_band import asked_of  # noqa: PLC0415 (numba)

    with _as_folder(full) as folder:
        return asked_of(options.system, options.scene, folder)


def band_for(options: argparse.Namespace, asked: "Asked | None", good_to: float) -> float:
    """The band [Hz]: as given, else as far as the scene has lines; a warning if that is farther.

    Args:
        options: of the command.
        asked: by the scene.
        good_to: end of the band for which the data are good [Hz].
    """
    if asked is None:
        return BAND if options.band is None else float(options.band)
    needed = asked.band(options.tolerance)
    band = min(needed, good_to) if options.band is None else float(options.band)
    share, question = asked.beyond(band)
    if share > options.tolerance:
        better = f"take --band {needed:g}"
        if needed > good_to:
            better = f"the data are good to {good_to:g} Hz, --band {needed:g} would be needed"
        say(
            f"herringbone: warning: lines beyond {band:g} Hz have {percent(share)} of the "
            f"{question.name}, the largest line of the scene is at {asked.largest:.5g} Hz: a bound "
            f"to {band:g} Hz says nothing of these; {better}"
        )
    return band


def changes(asked: "Asked", reduced: ModalHousing) -> dict[str, dict]:
    """What the reduced data change of what is asked."""
    with _as_folder(reduced) as folder:
        found = asked.changed_by(folder)
    return {
        question.name: {
            "error": apart.error, "worst": apart.worst, "worst_error": apart.worst_error
        }
        for question, apart in found
    }  # fmt: skip


@contextmanager
def _as_folder(housing: ModalHousing) -> Iterator[Path]:
    """The data as systems take them, wherever they have come from."""
    with temporary_folder() as folder:
        write_housing(housing, folder)
        yield folder
