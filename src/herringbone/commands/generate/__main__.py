"""`python -m herringbone.commands.generate [WHAT ...]`: all that is generated and committed.

For those who change the package, in a clone. Without WHAT it makes what takes a minute; what takes
longer is made if it is named. `--check` makes it in a copy of the clone and says what differs from
what is there; pictures, and what holds measured times, are not compared.
"""

import argparse
import sys
from collections.abc import Sequence

from herringbone.commands.generate.difference import differences
from herringbone.commands.generate.items import ITEMS, clone, generate
from herringbone.commands.output import say, show
from herringbone.core import HerringboneError


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; the exit code is 1 if something differs, and 2 if something fails."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if unknown := set(options.what) - {*ITEMS, "all"}:
        parser.error(
            f"there is no {', '.join(sorted(unknown))}; there are: {', '.join(ITEMS)}, all"
        )
    usual = [name for name, item in ITEMS.items() if item.usual]
    names = [*ITEMS] if "all" in options.what else options.what or usual
    try:
        if not options.check:
            generate(names, clone())
            return 0
        found = differences([name for name in names if not ITEMS[name].pictures], clone())
    except HerringboneError as error:
        say(f"herringbone: {error}")
        return 2
    for line in found:
        show(line)
    return 1 if found else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m herringbone.commands.generate",
        description="Make what is generated and committed.",
        epilog="; ".join(f"{name}: {item.files} ({item.takes})" for name, item in ITEMS.items()),
    )
    usual = ", ".join(name for name, item in ITEMS.items() if item.usual)
    parser.add_argument(
        "what",
        nargs="*",
        metavar="WHAT",
        help=f"{', '.join(ITEMS)} or all; {usual} if not given",
    )
    parser.add_argument("--check", action="store_true", help="only say what differs")
    return parser


if __name__ == "__main__":
    sys.exit(main())
