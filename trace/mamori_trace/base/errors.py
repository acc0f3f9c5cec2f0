# SPDX-License-Identifier: Apache-2.0
"""The errors of the host tools. The message is one line: what is wrong, where, and how to fix it."""

from __future__ import annotations

from pathlib import Path


class InputError(Exception):
    """An argument or a file cannot be used; exit status 2.

    `path` and `line` (counted from 1) are None if the error has no location in a file.
    """

    def __init__(self, text: str, path: Path | str | None = None, line: int | None = None) -> None:
        self.path = None if path is None else Path(path)
        self.line = line
        place = "" if path is None else f"{path}: " if line is None else f"{path}:{line}: "
        super().__init__(" ".join((place + text).splitlines()))


class MissingError(Exception):
    """Something that the command needs is not available: a tool, the lock of the project, a writable folder; exit status 3."""


class WorkError(Exception):
    """The work failed: a program failed, or gave no usable result; exit status 1."""


class FormatError(ValueError):
    """A text does not have the specified format. The caller adds the file. `column` counts from 1; None if there is none."""

    def __init__(self, text: str, column: int | None = None) -> None:
        self.column = column
        super().__init__(text if column is None else f"column {column}: {text}")
