# SPDX-License-Identifier: Apache-2.0
"""Stores the help texts that the launcher script prints on a host with only bash.

    python -P -m mamori_tools.command.help_texts

renews the files in command/help. A test compares them with the parsers.

@satisfies SWR-CLI-004      Design: docs/design/launcher.md#launcher
"""

from __future__ import annotations

import argparse
from pathlib import Path

from mamori_tools.command.main import make_parser
from mamori_trace.base.text_file import write_text

FOLDER = Path(__file__).with_name("help")
OVERVIEW = "all"


def make_texts() -> dict[str, str]:
    """@return the help text of each command by its name, and the overview."""
    parser = make_parser(with_trace=True)
    [commands] = [action for action in parser._actions if isinstance(action, argparse._SubParsersAction)]
    return {OVERVIEW: parser.format_help(), **{name: own.format_help() for name, own in commands.choices.items()}}


def store_texts(folder: Path = FOLDER) -> None:
    """Writes a file for each text and removes the files of commands that no longer exist."""
    texts = make_texts()
    folder.mkdir(exist_ok=True)
    for path in folder.glob("*.txt"):
        if path.stem not in texts:
            path.unlink()
    for name, text in texts.items():
        write_text(folder / f"{name}.txt", text)


if __name__ == "__main__":
    store_texts()
