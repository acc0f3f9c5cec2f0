# SPDX-License-Identifier: Apache-2.0
"""Takes a draft only when the reader of items finds nothing wrong with it, and appends it whole or not at all.

@satisfies SWR-TRC-078      Design: docs/design/trace_actions.md#new
"""

from __future__ import annotations

from pathlib import Path

from mamori.trace.model.finding import Problem
from mamori.trace.model.item import Schema
from mamori.trace.readers.files import InputError
from mamori.trace.readers.markdown_items import parse_items
from mamori.trace.write import write_whole


def check_file(root: Path, file: Path) -> None:
    """Raises InputError when items of `file` would not be read."""
    base = (root / "requirements").resolve()
    try:
        path = file.resolve()
    except RuntimeError:
        raise InputError(f"{file}: is a loop of links") from None
    if not path.is_relative_to(base) or path.suffix != ".md" or path.name == "README.md" or "schema" in path.relative_to(base).parts:
        raise InputError(f"{file}: items are read from Markdown files below {root / 'requirements'} only")
    if not path.parent.is_dir():
        raise InputError(f"{file}: there is no folder {path.parent.name}")
    if path.exists() and not path.is_file():
        raise InputError(f"{file}: is no file")


def check_block(block: str, item_id: str, schema: Schema) -> None:
    """Raises InputError with the first departure from the format."""
    problems: list[Problem] = []
    items = parse_items(block, "draft", schema, problems)
    if problems:
        raise InputError(f"new: {problems[0].message}")
    if [item.id for item in items] != [item_id]:
        raise InputError("new: a text holds a heading; texts are one line each")


def append_block(file: Path, block: str, item_id: str) -> int:
    """@return the line of the heading. Raises InputError, or OSError; the file is as it was then."""
    path = file.resolve()
    try:
        old = path.read_text(encoding="utf-8") if path.exists() else f"# {path.stem.replace('_', ' ').capitalize()}\n"
    except UnicodeDecodeError:
        raise InputError(f"{file}: is not UTF-8; nothing was appended") from None
    text = old.rstrip("\n") + "\n\n" + block
    write_whole(path, text)
    return text[: text.rindex(f"## {item_id} ")].count("\n") + 1
