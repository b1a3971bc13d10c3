"""`python -m herringbone`: the command line."""

import sys

from herringbone.commands.main import main

if __name__ == "__main__":
    sys.exit(main())
