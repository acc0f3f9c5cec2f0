# SPDX-License-Identifier: Apache-2.0
"""Reads `@satisfies` tags from comments of shell scripts and CMake files; they belong to the whole file.

@satisfies SWR-TRC-002      Design: docs/design/trace.md#code-tags
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import is_test_file, list_paths, note_unreadable, read_text, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.evidence import CodeTag
from mamori_trace.readers.tag_text import FILE_SYMBOL, has_mark, make_tags

_SUFFIXES = (".sh", ".cmake", "CMakeLists.txt")


def read_script_tags(root: Path, problems: list[Problem]) -> list[CodeTag]:
    """Tags of scripts: files with the suffix of a script anywhere, and files in the root that begin with `#!`."""
    scripts = [(path, path.name) for path in list_paths(root, "*", root, problems) if _is_plain_script(path, problems)]
    tags: list[CodeTag] = []
    for path, shown in [*scripts, *walk_sources(root, _SUFFIXES, problems)]:
        if is_test_file(shown):
            continue
        for number, line in enumerate(read_text(path, shown, problems).splitlines(), start=1):
            if has_mark(line) and line.lstrip().startswith("#"):
                tags.extend(make_tags(line, Place(shown, number), FILE_SYMBOL, problems))
    return tags


def _is_plain_script(path: Path, problems: list[Problem]) -> bool:
    if path.suffix or not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            return file.read(2) == b"#!"
    except OSError as error:
        note_unreadable(error, path.name, problems)
        return False
