# SPDX-License-Identifier: Apache-2.0
"""Finds `verifies("ID", ...)` in GoogleTest sources and the test that each call stands in.

@satisfies SWR-TRC-003      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

import re
from bisect import bisect_right
from pathlib import Path

from mamori.trace.model.evidence import SourceTest
from mamori.trace.model.finding import Place, Problem
from mamori.trace.readers.cpp_tags import SUFFIXES
from mamori.trace.readers.files import is_test_file, read_text, walk_sources

_COMMENT_OR_STRING = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_TEST = re.compile(r"^[ \t]*(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
_CALL = re.compile(r'\bverifies\(\s*"([^"]*)"([^;]*?)\)\s*;')
_CAPITAL = re.compile(r"(?<!^)([A-Z])")


def read_cpp_tests(root: Path, problems: list[Problem]) -> list[SourceTest]:
    """Tests of all C++ test files below `root`."""
    tests: list[SourceTest] = []
    for path, shown in walk_sources(root, SUFFIXES):
        if is_test_file(shown):
            text = read_text(path, shown, problems)
            if "verifies(" in text:
                tests.extend(parse_cpp_tests(text, shown))
    return tests


def parse_cpp_tests(text: str, shown: str) -> list[SourceTest]:
    """Tests of one file. A call outside of any test keeps an empty name: its id is checked, no result is expected."""
    plain = _COMMENT_OR_STRING.sub(_blank_comment, text)
    heads = list(_TEST.finditer(plain))
    starts = [head.start() for head in heads]
    tests: list[SourceTest] = []
    line, counted = 1, 0
    for call in _CALL.finditer(plain):
        line += plain.count("\n", counted, call.start())
        counted = call.start()
        index = bisect_right(starts, call.start()) - 1
        suite, name = (heads[index][1], heads[index][2]) if index >= 0 else (shown, "")
        technique = _read_enumerator(call[2], "Technique", "requirements_based")
        polarity = _read_enumerator(call[2], "Polarity", "nominal")
        tests.append(SourceTest(call[1], suite, name, technique, polarity, Place(shown, line)))
    return tests


def _blank_comment(match: re.Match[str]) -> str:
    """Strings stay; comments become blank, with their line ends."""
    return match[0] if match[0].startswith('"') else "\n" * match[0].count("\n")


def _read_enumerator(arguments: str, enumeration: str, default: str) -> str:
    """`Technique::kBoundaryValues` -> `boundary_values`."""
    match = re.search(rf"\b{enumeration}::k(\w+)", arguments)
    return _CAPITAL.sub(r"_\1", match[1]).lower() if match else default
