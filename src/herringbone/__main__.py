"""The command line, `herringbone` and `python -m herringbone`.

Loading it takes a tenth of a second, in which Ctrl-C ends it in a line, too.
"""

import sys


def main() -> int:
    """Run the command line; returns the exit code."""
    try:
        from herringbone.core.process.streams import open_streams  # noqa: PLC0415 (see above)

        open_streams()
        from herringbone.commands.main import main as run  # noqa: PLC0415
    except KeyboardInterrupt:
        sys.stderr.write("herringbone: interrupted\n")
        return 130
    return run()


if __name__ == "__main__":
    sys.exit(main())
