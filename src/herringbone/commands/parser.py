"""The parser of the command line: its errors are one line, told by the command they concern."""

import argparse
import re
from collections.abc import Sequence
from typing import Any, NoReturn

from herringbone.core import one_line
from herringbone.core.names import meant

BAD_INPUT = 2
"""Exit code."""


_NO_NUMBER = re.compile(r"argument (\S+): invalid (?:float|int) value: ")


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line, and to which -1e-5 is a number and no option."""

    def __init__(self, *args: Any, **options: Any) -> None:  # noqa: ANN401 (argparse's own)
        super().__init__(*args, **options)
        self._negative_number_matcher = re.compile(r"-(\d|\.\d|inf|nan)")

    def parse_known_args(  # type: ignore[override]
        self,
        args: Sequence[str] | None = None,
        namespace: argparse.Namespace | None = None,
    ) -> tuple[argparse.Namespace, list[str]]:
        """As argparse does, but what is not known is told by the command whose options they are."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            options = [text.split("=")[0] for text in unknown if text.startswith("--")]
            hints = [meant(text, self._option_string_actions) for text in options]
            told = "; ".join(["unrecognized arguments: " + " ".join(unknown), *filter(None, hints)])
            self.error(told.strip())
        return found, unknown

    def error(self, message: str) -> NoReturn:
        """Say what is wrong, and end with the exit code of bad input."""
        if wrong := _NO_NUMBER.match(message):
            about = next(a.help for a in self._actions if wrong[1] == "/".join(a.option_strings))
            message = f"{message}; it takes a number alone: {about}"
        self.exit(BAD_INPUT, f"{self.prog}: {one_line(message)}; see '{self.prog} --help'\n")
