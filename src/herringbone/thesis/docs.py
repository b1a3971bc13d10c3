"""The pages of the thesis in the docs: `python -m herringbone.thesis.docs` writes them anew."""

import sys
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.core.places.paths import systems_folder
from herringbone.thesis.report.writing import write_pages
from herringbone.thesis.study import study


def pages_folder() -> Path:
    """Where the pages are in a clone."""
    return systems_folder().parent / "docs" / "thesis"


def main() -> None:
    """Compute what is missing, and write the pages.

    Raises:
        HerringboneError: an entry failed; the pages say which.
    """
    report = write_pages(study(told=lambda line: print(line, file=sys.stderr)), pages_folder())  # noqa: T201
    if report.failed:
        raise HerringboneError(f"failed: {', '.join(report.failed)}")


if __name__ == "__main__":
    main()
