# SPDX-License-Identifier: Apache-2.0
"""Accepts a draft only if the item reader finds no problem in it, and appends the draft atomically.

@satisfies SWR-TRC-078      Design: docs/design/trace.md#new-items
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.errors import InputError
from mamori_trace.base.finding import Problem
from mamori_trace.base.system_error import explain
from mamori_trace.base.write import write_whole
from mamori_trace.model.item import Schema
from mamori_trace.readers.markdown_items import parse_items


def check_file(root: Path, file: Path) -> None:
    """Raises InputError if the reader would not read items of `file`."""
    base = (root / "requirements").resolve()
    try:
        path = file.resolve()
    except RuntimeError:
        raise InputError(f"{file}: is a loop of links; mend the link") from None
    named = file.parent.resolve() / file.name  # a link there is read, regardless of its target
    if not any(_is_item_file(each, base) for each in (named, path)):
        raise InputError(f"{file}: items are read from Markdown files below {root / 'requirements'} only; name one of these")
    if not path.parent.is_dir():
        raise InputError(f"{file}: there is no folder {path.parent}; make it, or name another file")
    if path.exists() and not path.is_file():
        raise InputError(f"{file}: is no file; name another")


def _is_item_file(path: Path, base: Path) -> bool:
    return path.is_relative_to(base) and path.suffix == ".md" and path.name != "README.md" and "schema" not in path.relative_to(base).parts


def check_block(block: str, item_id: str, schema: Schema) -> None:
    """Raises InputError with the first deviation from the format."""
    problems: list[Problem] = []
    items = parse_items(block, "draft", schema, problems)
    if problems:
        raise InputError(f"new: {problems[0].message}")
    if [item.id for item in items] != [item_id]:
        raise InputError("new: a text holds a heading; texts are one line each")


def append_block(file: Path, block: str, item_id: str) -> int:
    """@return the line of the heading. Raises InputError; the file is then unchanged."""
    try:
        old = file.read_text(encoding="utf-8") if file.exists() else f"# {file.stem.replace('_', ' ').capitalize()}\n"
    except OSError as error:
        raise InputError(f"{file}: cannot be read: {explain(error)}") from None
    except UnicodeDecodeError:
        raise InputError(f"{file}: is not UTF-8; nothing was appended, save it as UTF-8") from None
    text = old.rstrip("\n") + "\n\n" + block
    write_whole(file, text)
    return text[: text.rindex(f"## {item_id} ")].count("\n") + 1
