"""The command `list`: what there is, or one thing of it."""

import argparse
from functools import partial
from pathlib import Path

from herringbone.commands.answers import Told, answered
from herringbone.commands.output import say, show
from herringbone.core.places.files import is_folder
from herringbone.core.process.telling import Tell


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare the command's options."""
    sub.add_argument(
        "name", nargs="?", help="component, whose variables are shown; system; or studies"
    )


def run(options: argparse.Namespace) -> int:
    """Show it.

    Raises:
        HerringboneError: there is nothing of that name.
    """
    own = options.name and is_folder(Path(options.name))  # whose scenes may come and go
    find = partial(_listed, options)
    show((find(say) if own else answered(options, find)).text)
    return 0


def _listed(options: argparse.Namespace, tell: Tell) -> Told:
    from herringbone.commands.listing.texts import described, overview  # noqa: PLC0415

    del tell
    return Told(described(options.name) if options.name else overview(), None)
