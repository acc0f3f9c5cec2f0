# SPDX-License-Identifier: Apache-2.0
"""Finds `verifies("ID", ...)` in C++ tests with the test of each call, and tags in the comments of tests.

@satisfies SWR-TRC-003, SWR-TRC-040, SWR-TRC-104, SWR-TRC-105      Design: docs/design/trace.md#tests-and-results
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.files import is_test_file, read_text, walk_sources
from mamori_trace.base.finding import Place, Problem
from mamori_trace.model.evidence import SourceTest
from mamori_trace.readers.cpp_heads import CppHeads, Head, list_cpp_heads
from mamori_trace.readers.cpp_plain import Plain
from mamori_trace.readers.cpp_tags import SUFFIXES
from mamori_trace.readers.tag_text import ID_PATTERN, find_verified, has_mark

_MORE = (".c", ".cxx", ".hh", ".hxx")
_CALL = re.compile(r'\bverifies\(\s*"([^"]*)"([^;]*?)\)\s*;')
_TECHNIQUE = re.compile(r"\bTechnique::k(\w+)")
_POLARITY = re.compile(r"\bPolarity::k(\w+)")
_CAPITAL = re.compile(r"(?<!^)([A-Z])")


def read_cpp_tests(root: Path, problems: list[Problem], id_pattern: str = ID_PATTERN) -> list[SourceTest]:
    """Tests of all C++ test files below `root`."""
    tests: list[SourceTest] = []
    for path, shown in walk_sources(root, (*SUFFIXES, *_MORE), problems):
        if is_test_file(shown):
            text = read_text(path, shown, problems)
            if "verifies(" in text or has_mark(text):
                tests.extend(parse_cpp_tests(text, shown, id_pattern))
    return tests


def parse_cpp_tests(text: str, shown: str, id_pattern: str = ID_PATTERN) -> list[SourceTest]:
    """Tests of one file. A call outside all tests has an empty test name: its id is checked, but no result is expected."""
    plain = Plain(text)
    heads = list_cpp_heads(plain, shown)
    tests: list[SourceTest] = []
    line, counted = 1, 0
    for call in _CALL.finditer(plain.code):
        if not plain.shape.startswith("verifies", call.start()):
            continue  # in a string literal
        line += text.count("\n", counted, call.start())
        counted = call.start()
        head = heads.find_around(call.start())
        technique = _read_enumerator(call[2], _TECHNIQUE, "requirements_based")
        polarity = _read_enumerator(call[2], _POLARITY, "nominal")
        tests.append(SourceTest(call[1], *_name(head, shown), technique, polarity, Place(shown, line)))
    if has_mark(text):
        tests.extend(_find_tagged(text, plain, heads, shown, id_pattern))
    return tests


def _name(head: Head | None, shown: str) -> tuple[str, str]:
    return (head.suite, head.name) if head is not None else (shown, "")


def _find_tagged(text: str, plain: Plain, heads: CppHeads, shown: str, id_pattern: str) -> Iterator[SourceTest]:
    """Tests for which a comment names an id: the test that contains the comment, or the declaration below it; never the test above."""
    for comment in plain.comments:
        if not has_mark(comment[0]) or plain.is_dead(comment.start()):
            continue
        head = heads.find_around(comment.start()) or heads.find_below(comment.end())
        first = text.count("\n", 0, comment.start()) + 1
        of_test = head is not None or not _speaks_for_file(comment[0], comment.start(), plain)
        for offset, requirement in find_verified(comment[0], id_pattern):
            yield SourceTest(requirement, *_name(head, shown), "requirements_based", "nominal", Place(shown, first + offset), by_comment=of_test)


def _speaks_for_file(comment: str, start: int, plain: Plain) -> bool:
    """Whether the comment contains `@file` or precedes all code."""
    return "@file" in comment or not plain.shape[:start].strip()


def _read_enumerator(arguments: str, enumerator: re.Pattern[str], default: str) -> str:
    """`Technique::kBoundaryValues` -> `boundary_values`."""
    match = enumerator.search(arguments)
    return _CAPITAL.sub(r"_\1", match[1]).lower() if match else default
