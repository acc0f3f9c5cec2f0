# SPDX-License-Identifier: Apache-2.0
"""Finds tests for which a comment names an id, in languages other than C++ and Python.

@satisfies SWR-TRC-104      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import is_test_file, read_text, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.evidence import SourceTest
from mamori_trace.readers.tag_text import ID_PATTERN, IMPLEMENTS, VERIFIES, find_words, has_mark
from mamori_trace.readers.test_heads import find_head, list_heads

SUFFIXES = (".rs", ".java", ".kt", ".go")
_LEADERS = ("//", "/*", "*")


def read_other_tests(root: Path, problems: list[Problem]) -> list[SourceTest]:
    """Tests of all files of these languages below `root`. Rust unit tests are in source files, so each file may contain tests."""
    tests: list[SourceTest] = []
    for path, shown in walk_sources(root, SUFFIXES, problems):
        text = read_text(path, shown, problems)
        if not has_mark(text):
            continue
        heads = list_heads(text, shown)
        lines = text.splitlines()
        for number, line in enumerate(lines, start=1):
            for word in find_words(line, ID_PATTERN) if line.lstrip().startswith(_LEADERS) else ():
                if word.role == VERIFIES or (is_test_file(shown) and word.role != IMPLEMENTS):
                    suite, name = find_head(number, lines, heads) or (shown, "")
                    tests.append(SourceTest(word.requirement, suite, name, "requirements_based", "nominal", Place(shown, number), by_comment=True))
    return tests
