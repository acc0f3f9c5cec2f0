# SPDX-License-Identifier: Apache-2.0
"""Finds and reads the files of an external project. Each file is read once, even if several links lead to it; only UTF-8 is accepted.

@satisfies SWR-TRC-048      Design: docs/design/trace_formats.md#bad-input
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.files import UNREADABLE, get_shown_path, read_text, walk_folders
from mamori_trace.base.finding import Place, Problem

_SKIPPED = {"node_modules", "__pycache__", "build", "output"}


def list_files(path: Path, suffixes: tuple[str, ...], root: Path, problems: list[Problem]) -> Iterator[Path]:
    """The file itself, or the files below a folder with one of `suffixes`, in order. Links to folders are not followed."""
    if path.is_file():
        yield path
        return
    for folder, folders, files in walk_folders(path, root, problems):
        folders[:] = sorted(name for name in folders if name not in _SKIPPED and not name.startswith("."))
        for name in sorted(files):
            if name.endswith(suffixes) and not name.startswith("."):
                yield Path(folder) / name


def read_texts(path: Path, suffixes: tuple[str, ...], root: Path, problems: list[Problem]) -> Iterator[tuple[str, str]]:
    """(shown path, text) of each file that was read completely."""
    for file in list_files(path, suffixes, root, problems):
        shown = get_shown_path(file, root)
        text = read_whole(file, shown, problems)
        if text is not None:
            yield shown, text


def read_whole(file: Path, shown: str, problems: list[Problem]) -> str | None:
    """Text of a file, or None and one problem if it is not UTF-8 text."""
    before = len(problems)
    text = read_text(file, shown, problems)
    if len(problems) > before:
        return None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        problems.append(Problem(UNREADABLE, Place(shown, line), "holds a zero byte, so it is no text; save it as UTF-8"))
        return None
    return text
