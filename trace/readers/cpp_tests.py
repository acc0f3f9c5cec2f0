# SPDX-License-Identifier: Apache-2.0
"""Finds `verifies("ID", ...)` in GoogleTest sources and the test that each call stands in, and tags in the comments of tests.

@satisfies SWR-TRC-003, SWR-TRC-040      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path

from mamori.trace.model.evidence import SourceTest
from mamori.trace.model.finding import Place, Problem
from mamori.trace.readers.cpp_tags import SUFFIXES
from mamori.trace.readers.files import is_test_file, read_text, walk_sources
from mamori.trace.readers.tag_text import ID_PATTERN, find_verified, has_mark

_COMMENT_OR_STRING = re.compile(r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/', re.DOTALL)
_TEST = re.compile(r"^[ \t]*(?:TYPED_)?TEST(?:_F|_P)?\s*\(\s*(\w+)\s*,\s*(\w+)\s*\)", re.MULTILINE)
_CALL = re.compile(r'\bverifies\(\s*"([^"]*)"([^;]*?)\)\s*;')
_TECHNIQUE = re.compile(r"\bTechnique::k(\w+)")
_POLARITY = re.compile(r"\bPolarity::k(\w+)")
_CAPITAL = re.compile(r"(?<!^)([A-Z])")


def read_cpp_tests(root: Path, problems: list[Problem], id_pattern: str = ID_PATTERN) -> list[SourceTest]:
    """Tests of all C++ test files below `root`."""
    tests: list[SourceTest] = []
    for path, shown in walk_sources(root, SUFFIXES, problems):
        if is_test_file(shown):
            text = read_text(path, shown, problems)
            if "verifies(" in text or has_mark(text):
                tests.extend(parse_cpp_tests(text, shown, id_pattern))
    return tests


def parse_cpp_tests(text: str, shown: str, id_pattern: str = ID_PATTERN) -> list[SourceTest]:
    """Tests of one file. What stands outside of any test keeps an empty name: its id is checked, no result is expected."""
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
        technique = _read_enumerator(call[2], _TECHNIQUE, "requirements_based")
        polarity = _read_enumerator(call[2], _POLARITY, "nominal")
        tests.append(SourceTest(call[1], suite, name, technique, polarity, Place(shown, line)))
    if has_mark(text):
        tests.extend(_find_tagged(text, plain, heads, shown, id_pattern))
    return tests


def _find_tagged(text: str, plain: str, heads: list[re.Match[str]], shown: str, id_pattern: str) -> Iterator[SourceTest]:
    """Tests that a comment names an id for: the test below the comment, where nothing else stands between, or the one around it."""
    by_line = {plain.count("\n", 0, head.start(1)) + 1: head for head in heads}
    lines = sorted(by_line)
    code = [number for number, one in enumerate(plain.splitlines(), start=1) if one.strip()]
    for comment in _COMMENT_OR_STRING.finditer(text):
        if comment[0].startswith('"') or not has_mark(comment[0]):
            continue
        first = text.count("\n", 0, comment.start()) + 1
        below = bisect_right(code, first + comment[0].count("\n"))
        around = bisect_right(lines, first) - 1
        if below < len(code) and code[below] in by_line:
            head = by_line[code[below]]
        else:
            head = by_line[lines[around]] if around >= 0 else None
        suite, name = (head[1], head[2]) if head is not None else (shown, "")
        for offset, requirement in find_verified(comment[0], id_pattern):
            yield SourceTest(requirement, suite, name, "requirements_based", "nominal", Place(shown, first + offset), by_comment=True)


def _blank_comment(match: re.Match[str]) -> str:
    """Strings stay; comments become blank, with their line ends."""
    return match[0] if match[0].startswith('"') else "\n" * match[0].count("\n")


def _read_enumerator(arguments: str, enumerator: re.Pattern[str], default: str) -> str:
    """`Technique::kBoundaryValues` -> `boundary_values`."""
    match = enumerator.search(arguments)
    return _CAPITAL.sub(r"_\1", match[1]).lower() if match else default
