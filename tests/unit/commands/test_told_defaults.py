"""Help tells the default of each option that has a number as one."""

import argparse
import re

from herringbone.commands.main import _parser

NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e-?\d+)?")


def options_of(parser, name=""):
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for command, sub in action.choices.items():
                yield from options_of(sub, f"{name} {command}".strip())
        elif type(action.default) in {int, float}:
            yield name, action


def test_numbers_are_told():
    untold = [
        (name, action.option_strings[-1], action.default)
        for name, action in options_of(_parser())
        if action.default not in map(float, NUMBER.findall(action.help % vars(action)))
    ]
    assert not untold
