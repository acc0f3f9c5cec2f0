# SPDX-License-Identifier: Apache-2.0
"""The screen output: one line per step, a spinner on a terminal, a progress line every 30 s elsewhere.

rich follows NO_COLOR and omits colours and cursor moves if the output is not a terminal.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from mamori_tools.host.process import Tick

SIGN_OF_LIFE_S = 30.0
NEWS_LENGTH = 70
STYLES = {"passed": "green", "failed": "bold red", "skipped": "yellow", "inconclusive": "yellow"}


class _Output(Console):
    """When the reader has ended, rich would end the process with status 1; the command has a separate status for that."""

    def on_broken_pipe(self) -> None:
        raise  # rich calls this while it handles the BrokenPipeError


class Screen:
    """Writes to standard output, or to standard error if standard output is reserved for a result. Thread safety: none."""

    def __init__(self, to_stderr: bool = False) -> None:
        is_terminal = os.isatty(2 if to_stderr else 1)
        self._console = _Output(highlight=False, width=None if is_terminal else 110, soft_wrap=not is_terminal, stderr=to_stderr)

    def say(self, text: str = "", style: str = "") -> None:
        """One line of plain text."""
        self._console.print(escape(text), style=style or None)

    def say_verdict(self, verdict: str, text: str) -> None:
        """One line with a coloured verdict at its beginning."""
        self._console.print(f"  [{STYLES[verdict]}]{verdict:<8}[/] {escape(text)}")

    def print_table(self, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
        """A table; cells with a verdict are coloured."""
        table = Table(box=None, pad_edge=False, header_style="bold")
        for index, column in enumerate(columns):
            table.add_column(column, no_wrap=index == 0)
        for row in rows:
            table.add_row(*(f"[{STYLES[cell]}]{cell}[/]" if cell in STYLES else escape(cell) for cell in row))
        self._console.print(table, soft_wrap=False)

    @contextmanager
    def show_work(self, title: str) -> Iterator[Tick]:
        """Shows that `title` is running; the yielded function receives the latest status text."""
        start = last = time.monotonic()
        if self._console.is_terminal:
            with self._console.status(escape(title)) as status:

                def spin(news: str) -> None:
                    line = f"{title}, {time.monotonic() - start:.0f} s  {news}"
                    status.update(Text(line, no_wrap=True, overflow="ellipsis"))

                yield spin
            return

        def write(news: str) -> None:
            nonlocal last
            now = time.monotonic()
            if now - last >= SIGN_OF_LIFE_S:
                last = now
                self.say(f"  ...      {title}, {now - start:.0f} s  {news[:NEWS_LENGTH]}")

        yield write
