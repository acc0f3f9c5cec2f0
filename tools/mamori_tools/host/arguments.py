# SPDX-License-Identifier: Apache-2.0
"""The description of a command under the entry points `mamori.commands` of pyproject.toml, and the parser of its arguments.

@satisfies SWR-CLI-004, SWR-CLI-005      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import NoReturn

from mamori_tools.host.help_format import format_help
from mamori_trace.base.errors import InputError
from mamori_trace.base.nearest_names import nearest_names

PROGRAM = "mamori"
DIGITS_MAX = 12  # maximum of an option that counts


@dataclass(frozen=True)
class Command:
    """`run` returns the exit status. It may raise InputError, MissingError or OSError, which are reported in one line.

    `summary` is the line of the overview. `statuses` replaces or extends the common meanings of exit statuses. `usage_end` names additional
    arguments that argparse does not know. `examples` are command lines without the program."""

    add_arguments: Callable[[argparse.ArgumentParser], None]
    run: Callable[[argparse.Namespace], int]
    summary: str
    description: str
    statuses: Mapping[int, str] = field(default_factory=dict)
    usage_end: str = ""
    examples: tuple[str, ...] = ()


class Parser(argparse.ArgumentParser):
    """Rejects an unknown word in one line with the nearest known words."""

    statuses: Mapping[int, str] = {}
    usage_end = ""

    def format_help(self) -> str:
        return format_help(self, self.statuses, self.usage_end)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{self.prog.removeprefix(PROGRAM).strip() or PROGRAM}: {message}")

    def _check_value(self, action: argparse.Action, value: object) -> None:
        if action.choices is not None and value not in action.choices:
            where = self.prog.removeprefix(PROGRAM).strip() or "the command line"
            raise InputError(f"{where}: there is no '{value}'; {nearest_names(str(value), map(str, action.choices))}")

    def parse_known_args(self, args=None, namespace=None):  # type: ignore[no-untyped-def]
        known, rest = super().parse_known_args(args, namespace)
        if rest:
            raise InputError(self._describe_unknown(rest[0]))
        return known, rest

    def _describe_unknown(self, word: str) -> str:
        command = self.prog.removeprefix(PROGRAM).strip()
        if not word.startswith("-"):
            return f"{command} does not take '{word}'; see ./mamori {command} --help"
        options = [text for action in self._actions for text in action.option_strings]
        return f"{command} has no option '{word}'; {nearest_names(word.partition('=')[0], options)}"


def at_least_one(text: str) -> int:
    """Type of an option that counts."""
    if not (text.isascii() and text.isdecimal()) or not text.strip("0"):
        raise argparse.ArgumentTypeError(f"'{text}' is not an integer of at least 1")
    if len(text) > DIGITS_MAX:
        raise argparse.ArgumentTypeError(f"'{text[:DIGITS_MAX]}...' has more than {DIGITS_MAX} digits; give a smaller number")
    return int(text)


def add_jobs(parser: argparse.ArgumentParser, scope: str = "") -> None:
    """The option of commands that compile or run several programs at the same time."""
    parser.add_argument("--jobs", type=at_least_one, default=os.cpu_count() or 1, metavar="N",
                        help=f"parallel jobs{scope and f' {scope}'} (at least 1); default: number of processors")  # fmt: skip
