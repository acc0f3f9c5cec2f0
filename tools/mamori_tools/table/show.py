# SPDX-License-Identifier: Apache-2.0
"""Prints the text of a table. rich follows NO_COLOR and omits colours if the output is not a terminal.

@satisfies SWR-TAB-004      Design: docs/design/cost.md#text
"""

from __future__ import annotations

from rich.console import Console
from rich.text import Text

from mamori_tools.table.document import Table
from mamori_tools.table.text import make_lines


class _Console(Console):
    """When the reader ends early, only the printing stops; rich would also end the program."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def print_table(table: Table) -> None:
    console = _Console(highlight=False, soft_wrap=True, markup=False, emoji=False)
    for line, style in make_lines(table):
        console.print(Text(line, style=style))
