# SPDX-License-Identifier: Apache-2.0
# Goal: the manual page shows every action, and the tool accepts each command line in it.
from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest

from mamori_trace.command import add_arguments
from mamori_trace.model.query_syntax import parse

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "manual" / "trace.md").read_text(encoding="utf-8")
EXAMPLES = [line.strip().partition("  #")[0] for line in PAGE.splitlines() if line.startswith("    ./mamori trace ")]


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser()
    add_arguments(parser.add_subparsers())
    return parser


def list_choices(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    """The parsers of its commands."""
    [commands] = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return commands.choices


@pytest.mark.parametrize("line", EXAMPLES)
@pytest.mark.verifies("SWR-TRC-010", technique="interface", polarity="nominal")
def test_each_example_of_the_manual_is_taken(line: str) -> None:
    arguments = make_parser().parse_args(shlex.split(line)[1:])

    if arguments.trace_action == "query":
        assert parse(arguments.expression)


@pytest.mark.verifies("SWR-TRC-010", technique="interface", polarity="nominal")
def test_each_action_has_an_example_a_row_and_a_line_of_help() -> None:
    choices = list_choices(list_choices(make_parser())["trace"])
    shown = {shlex.split(line)[2] for line in EXAMPLES}
    commands = (ROOT / "docs" / "manual" / "commands.md").read_text(encoding="utf-8")
    overview = (ROOT / "tools" / "mamori_tools" / "command" / "help" / "trace.txt").read_text(encoding="utf-8")

    assert set(choices) <= shown
    for action in choices:
        assert re.search(rf"^\| `trace {action}\b", commands, re.MULTILINE), action
        assert re.search(rf"^  {action}\b", overview, re.MULTILINE), action


@pytest.mark.verifies("SWR-TRC-079", technique="interface", polarity="nominal")
def test_the_manual_names_each_field_of_a_query() -> None:
    source = (ROOT / "trace" / "mamori_trace" / "model" / "query.py").read_text(encoding="utf-8")
    fields = set(re.findall(r'"(\w+)": lambda item', source))

    table = PAGE[PAGE.index("| field |") : PAGE.index("A word that no item")]
    assert len(fields) > 20
    assert {field for field in fields if f"`{field}`" not in table} == set()
