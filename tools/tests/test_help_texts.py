# SPDX-License-Identifier: Apache-2.0
# Goal: each command has one help text, for every form of the call. Method: the stored files are compared with the parsers, and parsers with
# one layout rule each are formatted.
from __future__ import annotations

import argparse
import shlex
from pathlib import Path

import pytest

from mamori_tools.command.help_texts import FOLDER, make_texts, store_texts
from mamori_tools.command.main import main, make_parser
from mamori_tools.host.arguments import Parser, add_jobs
from mamori_tools.host.help_format import WIDTH

RENEW = "python -P -m mamori_tools.command.help_texts"
TEXTS = make_texts()


def read_folder(folder: Path) -> dict[str, str]:
    return {path.stem: path.read_text(encoding="utf-8") for path in folder.iterdir()}


def list_actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """The arguments of `parser` and of its actions."""
    found = []
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            found += [each for own in action.choices.values() for each in list_actions(own)]
        elif not isinstance(action, argparse._HelpAction):
            found.append(action)
    return found


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
def test_the_stored_files_are_what_the_parsers_make() -> None:
    assert read_folder(FOLDER) == TEXTS, f"call .venv/bin/{RENEW} and commit {FOLDER}"


@pytest.mark.verifies("SWR-CLI-004", technique="back_to_back")
@pytest.mark.parametrize("words", [["--help"], ["-h"], ["help"], *([name, "--help"] for name in TEXTS if name != "all")], ids=" ".join)
def test_python_prints_the_same_text(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    try:
        status = main(words)
    except SystemExit as end:
        status = int(end.code or 0)

    assert (status, capsys.readouterr().out) == (0, TEXTS["all" if words[0] in ("help", "-h", "--help") else words[0]])


@pytest.mark.verifies("SWR-CLI-004", technique="interface")
def test_each_example_is_taken_by_the_command_that_shows_it() -> None:
    examples = [(name, shlex.split(line)) for name, text in TEXTS.items() for line in text.splitlines() if line.startswith("  ./mamori ")]

    assert len(examples) >= 10
    for name, words in examples:
        assert make_parser(name).parse_args(words[1:]).command == name


@pytest.mark.verifies("SWR-CLI-004")
def test_each_argument_of_each_command_and_action_is_described() -> None:
    actions = list_actions(make_parser(with_trace=True))

    assert len(actions) > 100
    assert [action.dest for action in actions if not action.help] == []


@pytest.mark.verifies("SWR-CLI-004", technique="boundary_values")
@pytest.mark.parametrize(("columns", "colour"), [("20", "1"), ("300", "")])
def test_no_terminal_changes_a_text(columns: str, colour: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    monkeypatch.setenv("FORCE_COLOR", colour)

    assert make_texts() == TEXTS
    assert max(len(line) for text in TEXTS.values() for line in text.splitlines()) <= WIDTH


@pytest.mark.verifies("SWR-CLI-004")
def test_a_parser_shows_alternatives_defaults_and_its_own_statuses() -> None:
    parser = Parser(prog="mamori paint", description="Paints.\n\nTwice.", epilog="Example: ./mamori paint")
    parser.statuses, parser.usage_end = {1: "wet"}, "[-- REST]"
    parser.add_argument("walls", nargs="+", metavar="WALL", help="a wall")
    either = parser.add_mutually_exclusive_group(required=True)
    either.add_argument("--red", action="store_true", help="5 %% of red")
    either.add_argument("--tone", choices=("dark", "light"), default="dark", help="lines\n  stay lines; default: %(default)s")
    add_jobs(parser, "of the brush")

    lines = parser.format_help().splitlines()

    assert lines[:10] == ["usage: ./mamori paint WALL ... --red | --tone dark|light [--jobs N] [-- REST]", "", "Paints.", "", "Twice.", "",
                          "  WALL ...           a wall", "  --red              5 % of red", "  --tone dark|light  lines",
                          "                       stay lines; default: dark"]  # fmt: skip
    assert "  --jobs N           parallel jobs of the brush (at least 1); default: number of processors" in lines
    assert "  1    wet" in lines
    assert "Example: ./mamori paint" in lines


@pytest.mark.verifies("SWR-CLI-004", technique="boundary_values")
@pytest.mark.parametrize(("length", "is_alone"), [(24, False), (25, True)])
def test_a_long_option_has_its_description_below(length: int, is_alone: bool) -> None:
    option = "--" + "x" * (length - 2)
    parser = Parser(prog="mamori paint")
    parser.add_argument(option, action="store_true", help="text")

    assert (f"  {option}" in parser.format_help().splitlines()) is is_alone


@pytest.mark.verifies("SWR-CLI-004", technique="boundary_values")
def test_a_usage_line_has_at_most_the_width() -> None:
    lead = "usage: ./mamori paint "
    for length, lines in ((WIDTH - len(lead), 1), (WIDTH - len(lead) + 1, 2)):
        parser = Parser(prog="mamori paint", add_help=False)
        parser.add_argument("a", metavar="A")
        parser.add_argument("b", metavar="B" * (length - 2))

        assert parser.format_help().partition("\n\n")[0].count("\n") + 1 == lines


@pytest.mark.verifies("SWR-CLI-004")
def test_storing_renews_a_file_and_removes_that_of_a_command_that_no_longer_exists(tmp_path: Path) -> None:
    (tmp_path / "demo.txt").write_text("old", encoding="utf-8")
    (tmp_path / "gone.txt").write_text("old", encoding="utf-8")

    store_texts(tmp_path)

    assert read_folder(tmp_path) == TEXTS
