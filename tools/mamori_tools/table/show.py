# SPDX-License-Identifier: Apache-2.0
"""Prints the text of a table. rich keeps to NO_COLOR and leaves colours out where the output is no terminal.

@satisfies SWR-TAB-004      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from mamori_tools.table.document import Table
from mamori_tools.table.text import make_lines


class _Console(Console):
    """A reader who has seen enough ends the printing, not the program: rich would end that too."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def print_table(table: Table) -> None:
    console = _Console(highlight=False, soft_wrap=True, markup=False, emoji=False)
    for line, style in make_lines(table):
        console.print(Text(line, style=style))
