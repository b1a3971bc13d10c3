"""`python -m herringbone`: the command line."""

import sys

from herringbone.cli import main

if __name__ == "__main__":
    sys.exit(main())
