# SPDX-License-Identifier: Apache-2.0
"""Limits for code that runs on a controller: banned words, and the length of functions, files and headers.

@satisfies SWR-PRF-007, SWR-PRF-008      Design: docs/design/launcher.md#layer-check
"""

from __future__ import annotations

import re
import statistics
from collections.abc import Iterator, Mapping

import tree_sitter_cpp
from tree_sitter import Language, Node, Parser

FUNCTION_LINES_MAX = 70
FILE_LINES_MAX = 500
MEASURED_HEADERS = "kernel/include"  # folder of the headers whose median length is limited
HEADER_LINES_MEDIAN_MAX = 90

BANNED_ANYWHERE = re.compile(r"\bFIXME\b|\bTODO\b(?!\(#\d+\))")
# Calls that block, format, or have unexpected effects; matrices whose size is known only at run time (they allocate).
BANNED_IN_CODE = re.compile(
    r"\b(?:(?:u|nano)?sleep(?:_for|_until)?|s?rand(?:om)?|v?(?:f|sn?)?printf"
    r"|(?:Matrix|Vector|RowVector|Array)X\w*|Eigen::Dynamic)\b"
)
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)

LANGUAGE = Language(tree_sitter_cpp.language())


def check_words(text: str) -> Iterator[tuple[int, str, str]]:
    """@return (line, rule, message) for each banned word. Comments and strings are not searched for calls."""
    for match in BANNED_ANYWHERE.finditer(text):
        yield _line_of(text, match), "word", f"'{match[0]}' must be finished, or written TODO(#n) with its issue"
    code = COMMENT_OR_TEXT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for match in BANNED_IN_CODE.finditer(code):
        yield _line_of(code, match), "word", f"'{match[0]}' has no place on a controller"


def check_size(text: str) -> Iterator[tuple[int, str, str]]:
    """@return (line, rule, message) for a file and for each function that is too long."""
    lines = text.count("\n")
    if lines > FILE_LINES_MAX:
        yield 1, "size", f"file has {lines} lines, {FILE_LINES_MAX} are the limit; split it"
    pending = [Parser(LANGUAGE).parse(text.encode("utf-8")).root_node]
    while pending:
        node = pending.pop()
        if node.type == "function_definition":
            length = node.end_point.row - node.start_point.row + 1
            if length > FUNCTION_LINES_MAX:
                yield (node.start_point.row + 1, "size",
                       f"{_name_of(node)} has {length} lines, {FUNCTION_LINES_MAX} are the limit; split it")
        pending.extend(node.children)


def check_headers(lines: Mapping[str, int]) -> Iterator[tuple[int, str, str]]:
    """@param lines of each header of MEASURED_HEADERS. @return (line, rule, message) if their median is too long."""
    if lines and (median := statistics.median(lines.values())) > HEADER_LINES_MEDIAN_MAX:
        longest = max(lines, key=lambda name: lines[name])
        yield (1, "size", f"median of {len(lines)} headers is {median:g} lines, {HEADER_LINES_MEDIAN_MAX} are the limit; "
                          f"split long ones, the longest is {longest} with {lines[longest]}")


def _name_of(function: Node) -> str:
    declarator = function.child_by_field_name("declarator")
    return declarator.text.decode("utf-8").partition("(")[0] if declarator and declarator.text else "function"


def _line_of(text: str, match: re.Match[str]) -> int:
    return text.count("\n", 0, match.start()) + 1
