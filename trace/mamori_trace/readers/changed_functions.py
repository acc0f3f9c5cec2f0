# SPDX-License-Identifier: Apache-2.0
"""Finds the functions, classes and tests that contain a range of lines, in C++ (tree-sitter) and Python (ast).

@satisfies SWR-TRC-070      Design: docs/design/trace.md#impact
"""

from __future__ import annotations

import ast
from bisect import bisect_right
from dataclasses import dataclass

import tree_sitter
import tree_sitter_cpp

from mamori_trace.readers.cpp_functions import (
    capture,
    find_class_name,
    find_definitions,
    find_function_name,
    get_text,
    has_body,
    list_classes,
    qualify,
)
from mamori_trace.readers.python_functions import Definition, list_definitions

CPP_SUFFIXES = (".hpp", ".h", ".cpp", ".cc", ".ipp")
_LANGUAGE = tree_sitter.Language(tree_sitter_cpp.language())
_TESTS = ("TEST", "TEST_F", "TEST_P", "TYPED_TEST", "TYPED_TEST_P")
_DECLARED = tree_sitter.Query(_LANGUAGE, "(field_declaration) @function (enum_specifier) @class")
"""Parts without owners that a changed line may belong to. Only this module finds them, because each check would pay for the search."""


@dataclass(frozen=True, slots=True)
class Span:
    """A named part of a source with its first and last line, including its comment. A test is named `Suite.Name`."""

    name: str
    first: int
    last: int
    is_test: bool = False


def list_spans(text: str, file: str) -> list[Span]:
    """Functions, classes and tests of a source in order of their first lines; none for other kinds of files."""
    if file.endswith(CPP_SUFFIXES):
        return sorted(_list_cpp(text), key=lambda span: (span.first, -span.last))
    if file.endswith(".py"):
        return sorted(_list_python(text), key=lambda span: (span.first, -span.last))
    return []


def find_touched(spans: list[Span], ranges: list[tuple[int, int]]) -> tuple[list[Span], bool]:
    """The innermost spans that contain a line of `ranges`, and whether a line is outside all spans."""
    touched: dict[Span, None] = {}
    outside = False
    for first, last in ranges:
        meeting = [span for span in spans if span.first <= last and first <= span.last]
        for span in meeting:
            inner = [other for other in meeting if other is not span and _contains(span, other)]
            if _has_line_of_its_own(span, inner, first, last):
                touched[span] = None
        outside = outside or _has_line_of_its_own(Span("", first, last), meeting, first, last)
    return list(touched), outside


def _contains(outer: Span, inner: Span) -> bool:
    return outer.first <= inner.first and inner.last <= outer.last


def _has_line_of_its_own(span: Span, inner: list[Span], first: int, last: int) -> bool:
    """Whether a line of (first, last) inside `span` is outside all of `inner`."""
    line = max(first, span.first)
    for each in sorted(inner, key=lambda other: other.first):
        if each.first > line:
            return True
        line = max(line, each.last + 1)
    return line <= min(last, span.last)


def _list_cpp(text: str) -> list[Span]:
    root = tree_sitter.Parser(_LANGUAGE).parse(text.encode()).root_node
    captures = capture(root)
    declared = tree_sitter.QueryCursor(_DECLARED).captures(root)
    classes = list_classes(captures)
    definitions = list(find_definitions(captures, classes))
    starts = [node.start_byte for node, _ in definitions]

    def is_inside(node: tree_sitter.Node) -> bool:
        """Whether the node is inside a function, and therefore part of that function."""
        index = bisect_right(starts, node.start_byte) - 1
        return index >= 0 and node.start_byte < definitions[index][0].end_byte

    named = [(node, find_function_name(node)) for node in declared.get("function", ())]
    named += [(node, find_class_name(node)) for node in (*captures.get("class", ()), *declared.get("class", ())) if has_body(node)]
    free = [(node, qualify(node, name, classes)) for node, name in named if name and not is_inside(node)]
    return [_make_cpp_span(node, name) for node, name in definitions + free]


def _make_cpp_span(node: tree_sitter.Node, name: str) -> Span:
    first, last = _find_start(node), node.end_point.row + 1
    if name in _TESTS:
        declarator = node.child_by_field_name("declarator")
        parameters = declarator.child_by_field_name("parameters") if declarator is not None else None
        parts = [get_text(child) for child in parameters.named_children] if parameters is not None else []
        if len(parts) == 2:
            return Span(".".join(parts), first, last, is_test=True)
    return Span(name, first, last)


def _find_start(node: tree_sitter.Node) -> int:
    """First line of a definition, including its template head and the comment directly above it."""
    while node.parent is not None and node.parent.type in ("template_declaration", "declaration") and node.parent.parent is not None:
        node = node.parent
    row = node.start_point.row
    above = node.prev_named_sibling
    while above is not None and above.type == "comment" and above.end_point.row == row - 1 and "@file" not in get_text(above):
        row = above.start_point.row
        above = above.prev_named_sibling
    return row + 1


def _list_python(text: str) -> list[Span]:
    try:
        definitions = list_definitions(ast.parse(text))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []  # the complete file counts then
    return [Span(one.name.replace("::", "."), one.first, one.last, _is_python_test(one)) for one in definitions]


def _is_python_test(one: Definition) -> bool:
    return isinstance(one.node, ast.FunctionDef | ast.AsyncFunctionDef) and one.node.name.startswith("test")
