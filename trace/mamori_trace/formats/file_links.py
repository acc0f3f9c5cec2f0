# SPDX-License-Identifier: Apache-2.0
"""Reads links from items to files: all code in the file realises the item, or all its tests verify it.

@satisfies SWR-TRC-047      Design: docs/design/trace_formats.md#tags-of-other-tools
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mamori_trace.base.files import get_shown_path, is_test_file
from mamori_trace.base.finding import Place, Problem
from mamori_trace.formats.files import read_whole
from mamori_trace.formats.model import ForeignItem, Relation
from mamori_trace.formats.sources import SUFFIXES
from mamori_trace.model.evidence import CodeTag, SourceTest
from mamori_trace.readers.tag_text import FILE_SYMBOL
from mamori_trace.readers.test_heads import list_heads


def add_file_links(
    items: Sequence[ForeignItem], folders: Sequence[Path], tags: list[CodeTag], tests: list[SourceTest], problems: list[Problem]
) -> None:
    """Tags and tests for the files that items name, below the first of `folders` that contains them; paths are relative to that folder.

    A file that is neither code nor test must only exist. A test that itself names the item is not counted twice.
    """
    known = {(test.requirement, test.suite, test.name) for test in tests}
    for item in items:
        for each in item.files:
            place = Place(item.place.file, each.line)
            file = _find(each, folders)
            if file is None:
                message = f"{item.id} names the file {each.target}, which is not there; mend it, or name the folder that it begins in with --root"
                problems.append(Problem("unknown-id", place, message, item.id))
            elif each.target.endswith(SUFFIXES):
                shown = get_shown_path(file, folders[0])
                if not is_test_file(each.target):
                    tags.append(CodeTag(item.id, Place(shown, 1), FILE_SYMBOL))
                else:
                    tests += [test for test in _list_tests(item, file, shown, place, problems) if test[:3] not in known]


def _find(link: Relation, folders: Sequence[Path]) -> Path | None:
    return next((folder / link.target for folder in folders if (folder / link.target).is_file()), None)


def _list_tests(item: ForeignItem, file: Path, shown: str, place: Place, problems: list[Problem]) -> list[SourceTest]:
    """All tests of the file. If none is known, one test without a name: only a result that names the item can satisfy it."""
    heads = list_heads(read_whole(file, shown, problems) or "", shown)
    if not heads:
        return [SourceTest(item.id, shown, "", "requirements_based", "nominal", place)]
    return [SourceTest(item.id, suite, name, "requirements_based", "nominal", Place(shown, line)) for line, suite, name in heads]
